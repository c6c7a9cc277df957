"""The jobs: from what cameras saw to a Recording. Each is the same run as the command of its name."""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from . import _core
from ._core import Error
from ._filters import MakeFilter, Maker
from ._frames import Frames
from ._instant import Instant, Names
from ._interop import rows_of_detections
from ._recording import Recording
from ._rig import Rig

Path = str | os.PathLike[str]
Detector = Callable[[Any], Any]
Progress = Callable[[str, int, int | None], None]
Sink = Callable[[Instant], object] | Path | Any


class Warning(UserWarning):
    """A doubt that did not stop a job: what was lost, what was assumed."""


class _Sink:
    """What the corridor calls: a function of an Instant, or an object with begin, write and finish."""

    def __init__(self, target: Any) -> None:
        self._target = target
        self._write = target.write if hasattr(target, "write") else target
        self._names = Names()

    def __repr__(self) -> str:
        return f"the sink {self._target!r}"

    def begin(self, header: dict[str, Any]) -> None:
        if hasattr(self._target, "begin"):
            self._target.begin(header)

    def write(self, given: tuple[Any, ...]) -> None:
        self._write(self._names.instant(given))

    def finish(self) -> None:
        if hasattr(self._target, "finish"):
            self._target.finish()


def _sinks(given: Iterable[Sink]) -> dict[str, Any]:
    files: list[tuple[str, str]] = []
    objects: list[tuple[_Sink, bool]] = []
    for sink in given:
        if isinstance(sink, (str, os.PathLike)):
            files.append((os.fspath(sink), ""))
        elif callable(sink) or hasattr(sink, "write"):
            objects.append((_Sink(sink), bool(getattr(sink, "pictures", False))))
        else:
            raise Error(f"{sink!r} is no sink; give a file's name, a function of an Instant, or an object with write")
    return {"files": files, "sinks": objects}


def _finish(result: tuple[_core.Recording, dict[str, Any]]) -> Recording:
    core, summary = result
    for sentence in summary["warnings"]:
        warnings.warn(sentence, Warning, stacklevel=3)
    return Recording(core, summary)


def _given(options: Mapping[str, Any]) -> dict[str, Any]:
    """What was asked for: by name for the core, and in words for the recording, which keeps it as the command line would."""
    chosen = {name: value for name, value in options.items() if value is not None and value is not False}
    if callable(own := chosen.get("filter")):
        maker = Maker(own)
        return _given({**options, "filter": maker.name}) | {"filter": None, "own_filter": maker}
    said = {name.replace("_", "-"): "true" if value is True else str(value) for name, value in chosen.items()}
    return {**chosen, "given": said}


def _camera(source: Path | Frames | np.ndarray[Any, Any] | None, detections: Path | None, detector: Detector | None) -> dict[str, Any]:
    if (source is None) == (detections is None):
        raise Error("give either a source or detections: what is to be tracked?")
    if detections is not None:
        if detector is not None:
            raise Error("detections come from a file already; leave out the detector")
        return {"detections": os.fspath(detections)}
    options: dict[str, Any] = {}
    if isinstance(source, (str, os.PathLike)):
        options["source"] = os.fspath(source)
    elif isinstance(source, Frames):
        options |= {"source": source.name, "frames": source, "frames_again": source.again}
    else:
        raise Error("the source is neither a file's name nor marey.Frames; wrap pictures: marey.Frames(pictures, rate=25)")
    if detector is not None:
        options["detector"] = lambda picture: rows_of_detections(detector(picture))
    return options


def track(
    source: Path | Frames | None = None,
    *,
    targets: str = "people",
    detections: Path | None = None,
    rate: float | None = None,
    filter: str | MakeFilter | None = None,
    background: str | None = None,
    outline: bool = False,
    seen_only: bool = False,
    labels: Sequence[str] | None = None,
    threshold: float | None = None,
    dark: bool = False,
    colour: str | None = None,
    fit_noise: bool = False,
    live: bool = False,
    delay: float | None = None,
    detector: Detector | None = None,
    sinks: Iterable[Sink] = (),
    keep: bool = True,
    progress: Progress | None = None,
) -> Recording:
    """Follows people, or markers, in what one fixed camera saw: `marey track`.

    source: a video file, a folder of pictures, a pattern of names, or `Frames`. targets: "people" or "markers".
    detections: in place of source, MOT text of another program's boxes. rate: Hz, where the source does not tell it.
    detector: a function from a picture (H×W×3 uint8, blue first) to supervision's Detections or an array N×4 to N×6 (x1, y1, x2, y2 in px, score in
        [0, 1], class), in place of background subtraction; people only. What it raises ends the run and comes out as it is.
    filter: a motion filter by name (`marey track --help` lists them), or a function (z, R, unit) that begins one of your own (`marey.Filter`) at a
        target's first measurement. What it raises ends the run and comes out as it is.
    sinks: files to write beside, functions of an `Instant`, or objects with `write(instant)` and, if they like, `begin(header)`, `finish()` and
        `pictures = True`. They are called on threads of the run, one call at a time each.
    labels: of markers, from left to right in the first frame. threshold: grey level that markers pass. colour: their hue in degrees, "120" or
        "120+-15". live: nothing is improved by what came later; delay: s that it may look ahead.
    keep: False for a run into sinks alone: the recording that is returned is empty, and memory does not grow with a live one.
    progress: called now and then with (step, done, total or None).

    Returns a Recording in px. Raises marey.Error where the source cannot be read or a sink cannot be written, KeyboardInterrupt.
    """
    options = _camera(source, detections, detector) | _sinks(sinks) | {"keep": keep}
    shared = {"filter": filter, "live": live, "rate": rate}
    if targets == "markers":
        if detector is not None or detections is not None:
            raise Error("a detector and detections bring boxes, not markers")
        given = _given({"targets": targets, **shared, "threshold": threshold, "dark": dark, "colour": colour, "fit_noise": fit_noise})
        return _finish(_core.track_markers(options | given | {"labels": list(labels or []), "progress": progress}))
    if targets != "people":
        raise Error(f'targets is "{targets}"; known are people and markers')
    given = _given({**shared, "background": background, "outline": outline, "seen_only": seen_only, "delay": delay})
    return _finish(_core.track_people(options | given | {"progress": progress}))


def _rig(rig: Path | Rig | None) -> dict[str, Any]:
    if rig is None:
        return {}
    return {"rig_object": rig._core} if isinstance(rig, Rig) else {"rig": os.fspath(rig)}


def _sources(sources: Mapping[str, Path] | None) -> list[str]:
    return [f"{camera}={os.fspath(path)}" for camera, path in (sources or {}).items()]


def track_ground(
    rig: Path | Rig,
    *,
    sources: Mapping[str, Path] | None = None,
    rate: float | None = None,
    pitch: tuple[float, float] | None = None,
    area: Sequence[tuple[float, float]] | None = None,
    margin: float | None = None,
    teams: str | None = None,
    ball: bool = False,
    steady: bool = False,
    associate: str | None = None,
    filter: str | MakeFilter | None = None,
    background: str | None = None,
    live: bool = False,
    sinks: Iterable[Sink] = (),
    progress: Progress | None = None,
) -> Recording:
    """Follows everybody on the ground that a rig's cameras look at, under one identity: `marey track --ground`.

    rig: a rig file, or a Rig (PTZ cameras need the file). sources: {camera: file} in place of the rig's own. pitch: length and width in m,
    (105, 68), or area: corners [(x, y), ...] in m; only people on it, and `margin` m round it, count. ball: track the ball too. steady: stabilise
    cameras that shake. teams: "white,blue" or "City=white,United=blue". associate: "gnn", "jpda", "mht" or "bramble". The rest as in `track`.

    Returns a Recording in m on the ground, in the coordinates of the rig's user. Raises marey.Error where a camera is not calibrated or cannot be
    read, KeyboardInterrupt.
    """
    given = _given(
        {
            "margin": margin,
            "teams": teams,
            "associate": associate,
            "filter": filter,
            "background": background,
            "live": live,
            "rate": rate,
            "ball": ball,
            "steady": steady,
        }
    )
    options = _rig(rig) | _sinks(sinks) | given | {"sources": _sources(sources), "progress": progress}
    if area is not None:
        options["area"] = [[float(x), float(y)] for x, y in area]
    if pitch is not None:
        options["pitch"] = [float(pitch[0]), float(pitch[1])]
    return _finish(_core.track_ground(options))


def reconstruct(
    rig: Path | Rig | None = None,
    *,
    observations: Path | None = None,
    sources: Mapping[str, Path] | None = None,
    labels: Path | None = None,
    rate: float | None = None,
    noise: float | None = None,
    fill: float | None = None,
    predict: float | None = None,
    marker_width: float | None = None,
    max_speed: float | None = None,
    filter: MakeFilter | None = None,
    threshold: float | None = None,
    dark: bool = False,
    sinks: Iterable[Sink] = (),
    progress: Progress | None = None,
) -> Recording:
    """Places and follows the markers that several calibrated cameras see: `marey reconstruct`.

    rig: a rig file, or a Rig; may be left out where observations name the cameras. observations: blobs that another program found, a CSV with
    camera,frame,x,y[,marker]. labels: CSV label,x,y,z (m), or a name a line. noise: px. fill, predict: s. marker_width: m. max_speed: m/s.
    filter: a function that begins a motion filter of your own, as in `track`.

    Returns a Recording in m, z up. Raises marey.Error where an input cannot be read, KeyboardInterrupt.
    """
    given = _given(
        {
            "rate": rate,
            "noise": noise,
            "fill": fill,
            "predict": predict,
            "marker_width": marker_width,
            "max_speed": max_speed,
            "filter": filter,
            "threshold": threshold,
            "dark": dark,
        }
    )
    options = _rig(rig) | _sinks(sinks) | given | {"sources": _sources(sources), "progress": progress}
    options |= {"observations": os.fspath(observations) if observations is not None else None}
    options |= {"labels": os.fspath(labels) if labels is not None else None}
    return _finish(_core.reconstruct(options))


def threads(count: int) -> None:
    """So many threads compute at once from now on, in this process; results are the same for any number."""
    if not 1 <= count <= 1024:
        raise Error(f"{count} threads; give 1 to 1024")
    _core.use_threads(count)
