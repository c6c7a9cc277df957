"""The cameras of one setup."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _core


@dataclass(frozen=True)
class Camera:
    """One camera of a rig, as much of it as is known.

    size: width, height in px. K: 3×3, px. lens: "brown" (OpenCV's k1 k2 p1 p2 k3 k4 k5 k6), "fisheye" (k1 … k4) or "tsai".
    R, t: camera = R · world + t, m; x right, y down, z ahead.
    """

    name: str
    source: str
    size: tuple[int, int] | None
    rate_hz: float | None
    offset_s: float | None
    rms_px: float | None
    lens: str | None
    K: NDArray[np.float64] | None
    distortion: NDArray[np.float64] | None
    R: NDArray[np.float64] | None
    t: NDArray[np.float64] | None


class Rig:
    """The cameras of one setup: `marey.read_rig` reads it, `marey.calibrate` makes it."""

    def __init__(self, core: _core.Rig) -> None:
        self._core = core

    @property
    def cameras(self) -> list[Camera]:
        return [_camera_of(given) for given in self._core.cameras]

    def __getitem__(self, name: str) -> Camera:
        for camera in self.cameras:
            if camera.name == name:
                return camera
        raise KeyError(f"the rig has no camera {name!r}, but {', '.join(c.name for c in self.cameras)}")

    def write(self, path: str | os.PathLike[str]) -> None:
        """Writes a rig file (docs/rig.md), atomically. Raises marey.Error where that cannot be."""
        self._core.write(os.fspath(path))

    def __repr__(self) -> str:
        return f"<marey.Rig of {len(self._core.cameras)} cameras: {', '.join(c['name'] for c in self._core.cameras)}>"


def _camera_of(given: dict[str, Any]) -> Camera:
    lens = given["lens"]
    return Camera(
        name=given["name"],
        source=given["source"],
        size=given["size"],
        rate_hz=given["rate_hz"],
        offset_s=given["offset_s"],
        rms_px=given["rms_px"],
        lens=None if lens is None else lens[0],
        K=None if lens is None else np.asarray(lens[1]),
        distortion=None if lens is None else np.asarray(lens[2]),
        R=given["rotation"],
        t=None if given["translation"] is None else np.asarray(given["translation"]).reshape(3),
    )
