"""Where cameras stand, from recordings."""

from __future__ import annotations

import os
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from html import escape
from typing import Any

from . import _core
from ._jobs import Path, Progress, Warning, _given, _rig, _sources
from ._rig import Rig


@dataclass(frozen=True)
class Calibration:
    """A rig, and how well it explains what was seen. Errors are 2-D distances in px, by camera and over all."""

    rig: Rig
    grade: str
    grade_text: str
    mean_px: float
    rms_px: float
    cameras: dict[str, dict[str, Any]]
    notes: list[str]

    def _repr_html_(self) -> str:
        rows = "".join(
            f"<tr><td>{escape(name)}</td><td>{fit['mean_px']:.3f}</td><td>{fit['rms_px']:.3f}</td><td>{fit['inliers']}</td></tr>"
            for name, fit in self.cameras.items()
        )
        head = "<tr><th>camera</th><th>mean, px</th><th>rms, px</th><th>seen</th></tr>"
        return f"<p>{escape(self.grade)}: {escape(self.grade_text)}</p><table>{head}{rows}</table>"


def wand(
    rig: Path | Rig | None = None,
    *,
    distances: Sequence[float] | None,
    observations: Path | None = None,
    sources: Mapping[str, Path] | None = None,
    synced: bool = False,
    seed: int = 1,
    threshold: float | None = None,
    dark: bool = False,
    progress: Progress | None = None,
) -> Calibration:
    """Where the rig's cameras stand, by a wand that was waved before them: `marey calibrate wand`.

    rig: a rig file, or a Rig; may be omitted where observations name the cameras. distances: of the wand's markers from the first, m: [0, 0.12,
    0.30]; None for a single light. observations: what another program saw of it. synced: the cameras' clocks are right.

    Raises marey.Error, with the cause and what to do, for what cannot become a rig; KeyboardInterrupt.
    """
    options = _given({"synced": synced, "threshold": threshold, "dark": dark}) | _rig(rig)
    options |= {"distances": [float(d) for d in distances or []], "sources": _sources(sources), "seed": seed, "progress": progress}
    options |= {"observations": os.fspath(observations) if observations is not None else None}
    core, report = _core.calibrate_wand(options)
    for sentence in report["warnings"]:
        warnings.warn(sentence, Warning, stacklevel=2)
    return Calibration(
        rig=Rig(core),
        grade=report["grade"],
        grade_text=report["grade_text"],
        mean_px=report["all"]["mean_px"],
        rms_px=report["all"]["rms_px"],
        cameras=report["cameras"],
        notes=report["notes"],
    )
