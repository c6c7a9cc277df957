"""What is known of one instant, as sinks and `live` are given it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class Instant:
    """Who is where at one instant. Rows of all arrays belong together, by growing id.

    index: counts from 0 at the beginning; some may be omitted. time: s from the beginning.
    id: N. position: N×2 (px, or m on the ground) or N×3 (m). provenance: N, indices of `marey.PROVENANCE`.
    score: N, in [0, 1], NaN where none is known. box: N×4, left, top, right, bottom in px, NaN where there is none.
    labels, teams: of each id that was named so far.
    frames: the images of the instant (H×W×3, blue first), where the sink asked for them.
    """

    index: int
    time: float
    id: NDArray[np.int32]
    position: NDArray[np.float64]
    provenance: NDArray[np.uint8]
    score: NDArray[np.float64]
    box: NDArray[np.float64]
    labels: dict[int, str] = field(default_factory=dict)
    teams: dict[int, str] = field(default_factory=dict)
    frames: tuple[NDArray[np.uint8], ...] = ()

    def __len__(self) -> int:
        return len(self.id)

    def to_supervision(self) -> Any:
        """`supervision.Detections` of the rows with a box: xyxy (float32), confidence (1 where none is known), tracker_id, class_id 0."""
        from ._interop import detections_of

        return detections_of(self.id, self.box, self.score)


class Names:
    """Labels and teams, as instants tell them."""

    def __init__(self) -> None:
        self.labels: dict[int, str] = {}
        self.teams: dict[int, str] = {}

    def instant(self, given: tuple[Any, ...]) -> Instant:
        index, time, ids, position, provenance, score, box, named, frames = given
        for number, label, team in named:
            self.labels[number] = label
            self.teams[number] = team
        return Instant(
            index, time, ids, position, provenance, score, box, dict(self.labels), dict(self.teams), tuple(frames)
        )
