"""Tracks against the truth."""

from __future__ import annotations

import os
from dataclasses import dataclass, fields
from html import escape

from . import _core
from ._core import Error
from ._recording import Recording


@dataclass(frozen=True)
class Evaluation:
    """What `marey evaluate` reports; shares are in [0, 1], None where they divide by nothing."""

    frames: int
    objects: int
    tracks: int
    truths: int
    reported: int
    mota: float | None
    motp: float | None
    recall: float | None
    precision: float | None
    false_positives: int
    misses: int
    switches: int
    fragmentations: int
    idf1: float | None
    idp: float | None
    idr: float | None
    hota: float
    deta: float
    assa: float
    loca: float
    position_rms_m: float | None = None
    distance_error: float | None = None

    def _repr_html_(self) -> str:
        rows = "".join(f"<tr><th>{escape(f.name)}</th><td>{_shown(getattr(self, f.name))}</td></tr>" for f in fields(self))
        return f"<table>{rows}</table>"


def _shown(value: float | int | None) -> str:
    return "–" if value is None else f"{value:.4f}" if isinstance(value, float) else str(value)


def evaluate(
    truth: Recording | str | os.PathLike[str],
    tracks: Recording | str | os.PathLike[str],
    *,
    iou: float = 0.5,
    distance: float | None = None,
    motchallenge: bool = False,
) -> Evaluation:
    """Evaluates tracks against the truth: CLEAR-MOT, IDF1 and HOTA, as `marey evaluate` does.

    truth, tracks: recordings, or files. iou: overlap from which a box counts as found. distance: m; evaluates places on the ground instead of boxes.
    motchallenge: rows of a truth file whose seventh column is 0 are not evaluated. Raises marey.Error where one of them cannot be read, or holds
    something else.
    """
    if not 0 < iou <= 1:
        raise Error(f"iou is {iou}; give an overlap in (0, 1]")
    if distance is not None:
        if not distance > 0:
            raise Error(f"distance is {distance} m; it must be positive")
        return Evaluation(**_core.evaluate_places(_recording(truth)._core, _recording(tracks)._core, distance))
    if isinstance(truth, Recording) or isinstance(tracks, Recording):
        if motchallenge:
            raise Error("motchallenge is for files: a recording has no seventh column")
        return Evaluation(**_core.evaluate_boxes(_recording(truth)._core, _recording(tracks)._core, iou))
    return Evaluation(**_core.evaluate_box_files(os.fspath(truth), os.fspath(tracks), iou, motchallenge))


def _recording(given: Recording | str | os.PathLike[str]) -> Recording:
    from ._files import read

    return given if isinstance(given, Recording) else read(given)
