"""The jobs: from what cameras saw to a Recording. Each is the same run as the command of its name."""

from __future__ import annotations

import difflib
import inspect
import numbers
import os
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, TypeVar, Unpack

from . import _core
from ._core import Error
from ._filters import MakeFilter, Maker
from ._frames import Frames
from ._instant import Instant, Names
from ._interop import rows_of_detections
from ._options import AugmentOptions, GroundOptions, ReconstructOptions, SolveOptions, TrackOptions
from ._recording import Recording
from ._rig import Rig

Path = str | os.PathLike[str]
Detector = Callable[[Any], Any]
Progress = Callable[[str, int, int | None], None]
Sink = Callable[[Instant], object] | Path | Any
_Function = TypeVar("_Function", bound=Callable[..., Any])


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
        elif hasattr(sink, "pictures"):
            raise Error(f"{sink!r}: write `images = True` in place of `pictures`")
        elif callable(sink) or hasattr(sink, "write"):
            objects.append((_Sink(sink), bool(getattr(sink, "images", False))))
        else:
            raise Error(f"{sink!r} is not a sink; give a file's name, a function of an Instant, or an object with write")
    return {"files": files, "sinks": objects}


def _finish(result: tuple[_core.Recording, dict[str, Any]]) -> Recording:
    core, summary = result
    for sentence in summary["warnings"]:
        warnings.warn(sentence, Warning, stacklevel=3)
    return Recording(core, summary)


def _given(options: Mapping[str, Any]) -> dict[str, Any]:
    """What was asked for: by name for the core, and as text for the recording."""
    chosen = {name: value for name, value in options.items() if value is not None and value is not False}
    said = {name.replace("_", "-"): "true" if value is True else str(value) for name, value in chosen.items()}
    return {**chosen, "given": said}


def _text(name: str, value: Any) -> str:
    """As the command line has it: 2.5, FILE, 105x68 of two numbers, "x,y x,y x,y" of corners."""
    if value is True:
        return "true"
    if isinstance(value, (str, os.PathLike)):
        return os.fspath(value)
    if isinstance(value, numbers.Integral):
        return str(int(value))
    if isinstance(value, numbers.Real):
        return repr(float(value))
    try:
        if all(isinstance(each, numbers.Real) for each in value):
            return "x".join(_text(name, each) for each in value)
        return " ".join(",".join(_text(name, each) for each in corner) for corner in value)
    except TypeError:
        raise Error(f"{name}: {value!r} is neither a number nor text nor a path") from None


def _rows(job: str, options: Mapping[str, Any]) -> dict[str, Any]:
    """The options of a job by their names, as text; None and False are defaults. A filter of the user's own is an object."""
    known = {row["name"].replace("-", "_"): row["kind"] for row in _core.job_options(job)}
    rows: list[tuple[str, str]] = []
    own: dict[str, Any] = {}
    for name, value in options.items():
        if value is None or value is False:
            continue
        if name == "filter" and callable(value):
            maker = Maker(value)
            own = {"own_filter": maker, "own_filter_name": maker.name}
            continue
        if name not in known:
            near = difflib.get_close_matches(name, known, 1)
            raise Error(f"{name} is not an option of this job ({job}); {f'did you mean {near[0]}?' if near else 'help() lists them'}")
        values = value if known[name] == "texts" and not isinstance(value, (str, os.PathLike)) else [value]
        rows += [(name.replace("_", "-"), _text(name, each)) for each in values]
    return {"rows": rows, **own}


def _shows(*jobs: str) -> Callable[[_Function], _Function]:
    """help() and the signature of a function name the options of its jobs."""

    def show(function: _Function) -> _Function:
        signature = inspect.signature(function)
        explicit = {name: parameter for name, parameter in signature.parameters.items() if name != "options"}
        rows = {row["name"].replace("-", "_"): row for job in jobs for row in _core.job_options(job)}
        added = [inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=None) for name in rows if name not in explicit]
        function.__signature__ = signature.replace(parameters=[*explicit.values(), *added])  # type: ignore[attr-defined]
        lines = [f"    {name}: {_described(row)}" for name, row in rows.items()]
        function.__doc__ = (function.__doc__ or "").rstrip() + "\n\n    Options, as on the command line:\n\n" + "\n".join(lines) + "\n    "
        return function

    return show


def _described(row: Mapping[str, Any]) -> str:
    unit = f"{row['value']}: " if row["kind"] in ("number", "whole") else ""
    choices = ": " + ", ".join(row["choices"]) if row["choices"] else ""
    default = f" (default: {row['default']})" if row["default"] else ""
    return f"{unit}{row['help']}{choices}{default}"


def _camera(source: Path | Frames | None, detections: Path | None, detector: Detector | None) -> dict[str, Any]:
    if (source is None) == (detections is None):
        raise Error("give either a source or detections: what is to be tracked?")
    if detections is not None:
        if detector is not None:
            raise Error("detections come from a file already; omit the detector")
        return {}
    options: dict[str, Any] = {}
    if isinstance(source, (str, os.PathLike)):
        options["source"] = os.fspath(source)
    elif isinstance(source, Frames):
        options |= {"source": source.name, "frames": source, "frames_again": source.again}
    else:
        raise Error("the source is neither a file's name nor marey.Frames; wrap images: marey.Frames(images, rate=25)")
    if detector is not None:
        options["detector"] = lambda picture: rows_of_detections(detector(picture))
    return options


_TARGETS: dict[str, tuple[Any, dict[str, Any]]] = {
    "people": (_core.track_people, {}),
    "keypoints": (_core.track_people, {"keypoints": True}),
    "markers": (_core.track_markers, {}),
}


@_shows("track keypoints", "track markers")
def track(
    source: Path | Frames | None = None,
    *,
    targets: str = "people",
    filter: str | MakeFilter | None = None,
    detector: Path | Detector | None = None,
    labels: Path | Sequence[str] | None = None,
    sinks: Iterable[Sink] = (),
    keep: bool = True,
    progress: Progress | None = None,
    **options: Unpack[TrackOptions],
) -> Recording:
    """Tracks people, their body points or markers in a recording of one static camera: `marey track`.

    source: a video file, a folder of images, a pattern of names, or `Frames`; or detections in place of it. targets: "people", "keypoints" or
        "markers".
    detector: the file of a detection network, or a function from an image (H×W×3 uint8, blue first) to supervision's Detections or an array N×4 to N×6
        (x1, y1, x2, y2 in px, score in [0, 1], class), in place of background subtraction; not of markers. An exception of it ends the run and is raised.
    filter: a motion filter by name, or a function (z, R, unit) that begins one of your own (`marey.Filter`) at a target's first measurement. An
        exception of it ends the run and is raised.
    labels: of markers, a file or names, from left to right in the first frame.
    sinks: files to write, functions of an `Instant`, or objects with `write(instant)` and, optionally, `begin(header)`, `finish()` and
        `images = True`. They are called on threads of the run, one call at a time each.
    keep: False for a run into sinks alone: the recording that is returned is empty, and memory does not grow with a live one.
    progress: called now and then with (step, done, total or None).

    Returns a Recording in px. Raises marey.Error if the source cannot be read or a sink cannot be written, KeyboardInterrupt.
    """
    if targets not in _TARGETS:
        raise Error(f'targets is "{targets}"; use one of people, keypoints, markers')
    run, objects = _TARGETS[targets]
    rows: dict[str, Any] = {**options, "filter": filter}
    if isinstance(detector, (str, os.PathLike)):
        rows["detector"] = detector
        detector = None
    if detector is not None and targets == "markers":
        raise Error("a detector brings boxes, not markers")
    if isinstance(labels, (str, os.PathLike)) or labels is None:
        rows["labels"] = labels
    else:
        objects = {**objects, "label_names": list(labels)}
    given = _camera(source, options.get("detections"), detector) | _sinks(sinks) | {"keep": keep, "progress": progress}
    return _finish(run(given | objects | _rows(f"track {targets}", rows)))


def _rig(rig: Path | Rig | None) -> dict[str, Any]:
    if rig is None:
        return {}
    return {"rig_object": rig._core} if isinstance(rig, Rig) else {"rig": os.fspath(rig)}


def _sources(sources: Mapping[str, Path] | None) -> list[str]:
    return [f"{camera}={os.fspath(path)}" for camera, path in (sources or {}).items()]


@_shows("track ground")
def track_ground(
    rig: Path | Rig,
    *,
    sources: Mapping[str, Path] | None = None,
    pitch: tuple[float, float] | None = None,
    filter: str | MakeFilter | None = None,
    sinks: Iterable[Sink] = (),
    progress: Progress | None = None,
    **options: Unpack[GroundOptions],
) -> Recording:
    """Tracks people on the ground that the cameras of a rig face, with one identity in all of them: `marey track --ground`.

    rig: a rig file, or a Rig (PTZ cameras need the file). sources: {camera: file} in place of the rig's own. pitch: the size of the pitch. Sizes are
    (length, width) in m, areas [(x, y), ...]. filter, sinks, progress: as in `track`.

    Returns a Recording in m on the ground, in the coordinates of the rig's user. Raises marey.Error if a camera is not calibrated or cannot be read,
    KeyboardInterrupt.
    """
    rows: dict[str, Any] = {**options, "filter": filter}
    if pitch is not None:
        rows["size"] = pitch
    given = _rig(rig) | _sinks(sinks) | {"sources": _sources(sources), "progress": progress}
    return _finish(_core.track_ground(given | _rows("track ground", rows)))


@_shows("reconstruct markers", "reconstruct keypoints")
def reconstruct(
    rig: Path | Rig | None = None,
    *,
    targets: str = "markers",
    observations: Path | None = None,
    sources: Mapping[str, Path] | None = None,
    filter: MakeFilter | None = None,
    sinks: Iterable[Sink] = (),
    progress: Progress | None = None,
    **options: Unpack[ReconstructOptions],
) -> Recording:
    """Reconstructs and tracks the markers, or people's body keypoints, that several calibrated cameras observe: `marey reconstruct`.

    rig: a rig file, or a Rig; may be omitted if observations name the cameras. targets: "markers" or "keypoints"; of keypoints each camera's source
    names a file or folder of them. observations: blobs of another program, a CSV with camera,frame,x,y[,marker]. sources: {camera: file} in place of
    the rig's own. filter: a function that begins a motion filter of your own. sinks, progress: as in `track`.

    Returns a Recording in m, z up. Raises marey.Error if an input cannot be read, KeyboardInterrupt.
    """
    if targets not in ("markers", "keypoints"):
        raise Error(f'targets is "{targets}"; use one of markers, keypoints')
    given = _rig(rig) | _sinks(sinks) | {"sources": _sources(sources), "progress": progress}
    given |= {"observations": os.fspath(observations) if observations is not None else None}
    if targets == "keypoints":
        if observations is not None or filter is not None:
            raise Error("observations and a filter are of markers; remove them")
        return _finish(_core.reconstruct_keypoints(given | _rows("reconstruct keypoints", options)))
    return _finish(_core.reconstruct(given | _rows("reconstruct markers", {**options, "filter": filter})))


@_shows("augment")
def augment(
    recording: Path, *, sinks: Iterable[Sink] = (), progress: Progress | None = None, **options: Unpack[AugmentOptions]
) -> Recording:
    """Makes 43 anatomical markers, and joints' angles, of a person's body keypoints in space: `marey augment`.

    recording: a file, as `reconstruct` with targets="keypoints" writes it. height and mass are always wanted. sinks, progress: as in `track`.

    Returns a Recording in m, z up. Its summary has for each angle its lowest and highest value and its median deviation (rad; None without covariances
    of the keypoints); each instant's are in the file `angles`. Raises marey.Error if a file cannot be read or written, if it has no keypoints of legs and
    shoulders, or if script/model --augmenter has not made the networks; KeyboardInterrupt.
    """
    given = {"recording": os.fspath(recording), "progress": progress} | _sinks(sinks)
    return _finish(_core.augment(given | _rows("augment", options)))


@_shows("solve")
def solve(
    recording: Path, *, outputs: Iterable[Path] = (), progress: Progress | None = None, **options: Unpack[SolveOptions]
) -> dict[str, Any]:
    """Solves the motion of a skeleton from labelled markers, or from body keypoints, in space: `marey solve`.

    recording: a file. outputs: files to write: .mot or .sto (angles), .bvh or .glb (bones), or the recording with its bodies (.marey, .c3d, ...).
    progress: as in `track`.

    Returns a summary: markers' errors in mm, and for each coordinate its lowest and highest value (rad or m) and the fraction of instants in which
    markers show it. Raises marey.Error if a file cannot be read or written, or none of the skeleton's markers is recorded; KeyboardInterrupt.
    """
    given = {"recording": os.fspath(recording), "outputs": [os.fspath(path) for path in outputs], "progress": progress}
    summary = _core.solve(given | _rows("solve", options))
    for sentence in summary["warnings"]:
        warnings.warn(sentence, Warning, stacklevel=2)
    return summary


def threads(count: int) -> None:
    """This many threads compute at once from now on, in this process; results are the same for any number."""
    if not 1 <= count <= 1024:
        raise Error(f"{count} threads; give 1 to 1024")
    _core.use_threads(count)
