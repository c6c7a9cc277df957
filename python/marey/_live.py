"""What cameras see, instant by instant, while they see it."""

from __future__ import annotations

import os
import queue
import sys
import threading
import warnings
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any

from . import _core
from ._core import Error
from ._frames import Frames
from ._instant import Instant
from ._jobs import Path, Sink, Warning, _rig, _rows, _shows, _sinks, track
from ._rig import Rig

_KEPT = 8  # instants that wait for who iterates


class _Left(Exception):
    """The loop over the instants was left."""


@_shows("live")
def live(
    source: Path | Frames | Rig | Sequence[str],
    *,
    targets: str | None = None,
    take: Path | None = None,
    sinks: Iterable[Sink] = (),
    phones: Callable[[str, str], object] | None = None,
    **options: Any,
) -> Iterator[Instant]:
    """People or markers, one instant after the other, while cameras observe them: `for instant in marey.live("rig.toml")`. The run ends with the loop.

    source: a rig file or Rig whose cameras are live, or live sources alone, each a camera ("v4l2:/dev/video0", "rtsp://…",
        "sim://room?cameras=4"): `marey live`. If the loop is slow, instants are omitted, as their `index` shows.
        Or one video, or Frames: `track` with `live=True`, and its options; there nothing is omitted, the run waits for the loop.
    targets: "markers", "people" or "keypoints" (body points; of several calibrated cameras in space); default: markers of live cameras, people of one video. take: NAME.marey, written as it grows.
    sinks: functions or objects, as in `track`; of live cameras no files: name a take. One that raises is closed, which a `marey.Warning` states at
        the end, and the run continues.
    phones: of cameras "phone:NAME", called with the address that each phone opens and the SHA-256 of its certificate; default: both are printed to
        standard error.

    Raises what `track` raises, and marey.Error if no camera delivered a frame.
    """
    cameras = _live_cameras(source)
    if cameras is None:
        if take is not None or {"ground", "connect_timeout", "frame_timeout", "preroll"} & options.keys():
            raise Error("ground, take, frame_timeout, preroll and connect_timeout are for live cameras: a rig, or sources such as v4l2:/dev/video0")
        if targets is not None:
            options["targets"] = targets
        return _time_steps(lambda put, ends: _track_video(source, put, sinks, options), waits=True)
    if targets not in (None, "markers", "people", "keypoints"):
        raise Error(f'targets is "{targets}"; use one of people, markers, keypoints')
    given = _rows("live", options) | {"phones": phones or _invite, "targets": targets or "markers", "take": None if take is None else os.fspath(take), "keep": False}
    return _time_steps(lambda put, ends: _track_cameras(cameras | given, put, ends, sinks), waits=False)


def _live_cameras(source: Path | Frames | Rig | Sequence[str]) -> dict[str, Any] | None:
    """What the core is to open, or None for one video or Frames."""
    if isinstance(source, Rig):
        return _rig(source)
    if isinstance(source, (str, os.PathLike)):
        name = os.fspath(source)
        if _core.is_live(name):
            return {"cameras": [name]}
        return {"rig": name} if name.endswith(".toml") else None
    if isinstance(source, Sequence) and source and all(isinstance(each, str) for each in source):
        return {"cameras": list(source)}
    return None


def _invite(address: str, fingerprint: str) -> None:
    print(f"marey: open {address} on each phone, in the same network (the SHA-256 of its certificate is {fingerprint})", file=sys.stderr, flush=True)


def _track_video(source: Any, put: Callable[[Instant | None], None], sinks: Iterable[Sink], options: dict[str, Any]) -> list[str]:
    track(source, live=True, keep=False, sinks=[put, *sinks], **options)
    return []


def _track_cameras(
    options: dict[str, Any], put: Callable[[Instant | None], None], ends: Callable[[], bool], sinks: Iterable[Sink]
) -> list[str]:
    given = _sinks([put, *sinks])
    if given["files"]:
        raise Error("live cameras write no files but a take: take='walk.marey'")
    _, summary = _core.live(options | given | {"ends": ends})
    return list(summary["warnings"])


def _time_steps(follow: Callable[[Callable[[Instant | None], None], Callable[[], bool]], list[str]], *, waits: bool) -> Iterator[Instant]:
    """What `follow(put, ends)` puts, on a thread of its own. waits: it is held up while nothing is requested; else the oldest instants give way."""
    waiting: queue.Queue[Instant | None] = queue.Queue(maxsize=_KEPT)
    left = threading.Event()
    failure: list[BaseException] = []
    doubts: list[str] = []

    def ends() -> bool:
        return left.is_set() or not threading.main_thread().is_alive()

    def put(item: Instant | None) -> None:
        while not ends():
            try:
                return waiting.put(item, timeout=0.1 if waits else 0)
            except queue.Full:
                if not waits:
                    _dropped(waiting)
        raise _Left

    def run() -> None:
        try:
            doubts.extend(follow(put, ends))
        except _Left:
            return
        except BaseException as raised:  # handed to who iterates
            failure.append(raised)
        try:
            put(None)
        except _Left:
            pass

    worker = threading.Thread(target=run, name="marey.live")
    worker.start()
    try:
        while (instant := waiting.get()) is not None:
            yield instant
    finally:
        left.set()
        worker.join()
    for sentence in doubts:
        warnings.warn(sentence, Warning, stacklevel=2)
    if failure:
        raise failure[0]


def _dropped(waiting: queue.Queue[Instant | None]) -> None:
    try:
        waiting.get_nowait()
    except queue.Empty:
        pass
