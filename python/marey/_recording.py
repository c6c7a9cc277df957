"""The one result of every job."""

from __future__ import annotations

import os
from collections.abc import Sequence
from html import escape
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core, _interop
from ._core import Error
from ._provenance import PROVENANCE
from ._rig import Rig

if TYPE_CHECKING:
    import pandas as pd  # type: ignore[import-untyped,unused-ignore]
    import xarray as xr

COLOURS = ("#1f77b4", "#d62728", "#2ca02c", "#9467bd", "#ff7f0e", "#17becf", "#8c564b", "#e377c2")


class Track:
    """One target over the whole recording, in columns; row i of each belongs together. Columns marked "view" are the recording's own memory: nothing
    is copied, and they cannot be written."""

    def __init__(self, core: _core.Recording, index: int, about: tuple[int, str, str, int, str]) -> None:
        self._core, self._index = core, index
        self.id, self.label, self.team, self._rows, self._kind = about

    def __len__(self) -> int:
        return self._rows

    def __repr__(self) -> str:
        return f"<marey.Track {self.id}{' ' + self.label if self.label else ''}: {self._rows} rows>"

    @property
    def kind(self) -> str | None:
        """"person", "ball", "marker", "keypoint", or None if the recording does not specify it."""
        return self._kind or None

    @property
    def name(self) -> str:
        """Its label, or else its number."""
        return self.label or str(self.id)

    def _column(self, name: str) -> Any:
        return self._core.column(self._index, name)

    @property
    def at(self) -> NDArray[np.int32]:
        """Which of the recording's instants each row belongs to. View."""
        return self._column("at")  # type: ignore[no-any-return]

    @property
    def x(self) -> NDArray[np.float64]:
        """px or m. View."""
        return self._column("x")  # type: ignore[no-any-return]

    @property
    def y(self) -> NDArray[np.float64]:
        """px (down) or m. View."""
        return self._column("y")  # type: ignore[no-any-return]

    @property
    def z(self) -> NDArray[np.float64]:
        """m, up; empty in two dimensions. View."""
        return self._column("z")  # type: ignore[no-any-return]

    @property
    def position(self) -> NDArray[np.float64]:
        """N×2 or N×3."""
        columns = [self.x, self.y] if self._core.dimensions == 2 else [self.x, self.y, self.z]
        return np.column_stack(columns)

    @property
    def provenance(self) -> NDArray[np.uint8]:
        """0 measured, 1 filled, 2 predicted, 3 solved. View."""
        return self._column("provenance")  # type: ignore[no-any-return]

    @property
    def cameras(self) -> NDArray[np.uint64]:
        """Bit i: camera i saw it. View."""
        return self._column("cameras")  # type: ignore[no-any-return]

    def optional(self, name: str) -> NDArray[np.float64]:
        """A column that not every row has: "velocity" (N×3, a second), "covariance" (N×6: upper triangle), "score", "box" (N×4: left, top, width,
        height, px), "residual_px", "residual_m". NaN where it is not known; a view where all rows are known."""
        values, known = self._column(name)
        if len(values) == len(known) and known.all():
            return values  # type: ignore[no-any-return]
        whole = np.full((len(known), *values.shape[1:]), np.nan)
        whole[: len(values)][known[: len(values)]] = values[known[: len(values)]]
        return whole


class Recording:
    """Where everything was, when, how well that is known, and how it was found out. Jobs and `marey.read` return it; `from_arrays` makes one."""

    def __init__(self, core: _core.Recording, summary: dict[str, Any] | None = None) -> None:
        self._core = core
        #: What the run counted: frames, tracks, samples, what was omitted and why; empty of a recording that was read.
        self.summary: dict[str, Any] = summary or {}
        self._tracks = [Track(core, index, about) for index, about in enumerate(core.tracks)]

    @classmethod
    def from_arrays(
        cls,
        position: ArrayLike,
        *,
        rate: float,
        frame: str,
        times: ArrayLike | None = None,
        labels: Sequence[str] | None = None,
        teams: Sequence[str] | None = None,
    ) -> Recording:
        """A recording of T instants and N targets.

        position: T×N×2 or T×N×3; NaN where a target is not known. rate: instants a second. frame: "image" (px), "ground", "user_ground" or "space"
        (m; three axes). times: s, growing; index / rate by default. Raises marey.Error where shapes do not fit or a time does not grow.
        """
        places = np.ascontiguousarray(position, dtype=np.float64)
        axes = 3 if frame == "space" else 2
        if places.ndim != 3 or places.shape[2] != axes:
            raise Error(f"position has the shape {places.shape}; a recording in {frame} wants instants × targets × {axes}")
        if np.isinf(places).any() or (np.isnan(places).any(axis=2) != np.isnan(places).all(axis=2)).any():
            raise Error("position has an axis that is infinite, or unknown where others are known; unknown is NaN on all axes")
        if not (np.isfinite(rate) and rate > 0):
            raise Error(f"the rate is {rate} instants a second; it must be positive")
        seconds = np.arange(len(places)) / rate if times is None else np.ascontiguousarray(times, dtype=np.float64)
        if seconds.shape != (len(places),):
            raise Error(f"times has the shape {seconds.shape}; give one for each of the {len(places)} instants")
        if not np.isfinite(seconds).all() or (np.diff(seconds) <= 0).any():
            raise Error("times must be finite and grow from instant to instant")
        count = places.shape[1]
        for what, given in (("labels", labels), ("teams", teams)):
            if given is not None and len(given) != count:
                raise Error(f"{what} has {len(given)} names for {count} targets")
        names = list(zip(labels or [""] * count, teams or [""] * count))
        return cls(_core.from_arrays(places, seconds, frame, float(rate), names))

    # ---- what it is

    @property
    def kind(self) -> str:
        """ "image" (px), "ground" or "user_ground" (m on the ground), "space" (m)."""
        return self._core.kind

    @property
    def frame(self) -> str:
        """The frame of reference, in words."""
        return self._core.frame

    @property
    def time_base(self) -> str | None:
        """Whose clock the times follow, in words; None if the source does not specify it."""
        return self._core.time_base

    @property
    def dimensions(self) -> int:
        return self._core.dimensions

    @property
    def rate(self) -> float:
        """Instants a second."""
        return self._core.rate_hz

    @property
    def name(self) -> str:
        return self._core.name

    @property
    def made_by(self) -> dict[str, Any]:
        """Program and version, the options that were given, the inputs with their hashes."""
        return self._core.made_by

    @property
    def rig(self) -> Rig | None:
        return None if self._core.rig is None else Rig(self._core.rig)

    @property
    def tracks(self) -> list[Track]:
        """By id."""
        return self._tracks

    @property
    def indices(self) -> NDArray[np.int64]:
        """Of the instants, growing; some may be omitted. View."""
        return self._core.moments()[0]

    @property
    def times(self) -> NDArray[np.float64]:
        """Of the instants, s."""
        return np.asarray(self._core.moments()[1] * 1e-9, dtype=np.float64)

    def __getitem__(self, key: int | str) -> Track:
        """By id, or by label."""
        for track in self._tracks:
            if key == track.id or (isinstance(key, str) and key == track.label):
                return track
        raise KeyError(f"no track {key!r} in the recording")

    def __len__(self) -> int:
        return len(self.indices)

    def __repr__(self) -> str:
        return (
            f"<marey.Recording {self.name!r}: {len(self._tracks)} tracks, {len(self)} instants at {self.rate:g} Hz, "
            f"{self.frame}>"
        )

    # ---- what others make of it

    def _column_array(self, name: str, width: int) -> NDArray[np.float64]:
        shape = (len(self), len(self._tracks), width) if width > 1 else (len(self), len(self._tracks))
        whole = np.full(shape, np.nan)
        for number, track in enumerate(self._tracks):
            whole[track.at, number] = track.optional(name)
        return whole

    def _box_shapes(self) -> NDArray[np.float64]:
        return self._column_array("box", 4)[:, :, 2:]

    def to_numpy(self) -> NDArray[np.float64]:
        """Positions, instants × tracks × 2 or 3 axes; NaN where a track is not known. `Track` has the columns themselves, without a copy."""
        whole = np.full((len(self), len(self._tracks), self.dimensions), np.nan)
        for number, track in enumerate(self._tracks):
            whole[track.at, number, 0] = track.x
            whole[track.at, number, 1] = track.y
            if self.dimensions == 3:
                whole[track.at, number, 2] = track.z
        return whole

    def to_pandas(self) -> pd.DataFrame:
        """A row for each target and instant: frame, time (s), id, label, team, x, y[, z], provenance, and where the recording has them vx, vy[, vz],
        score, left, top, width, height (px), residual. Needs pandas."""
        pandas = _interop.required("pandas", "to_pandas()")
        axes = ["x", "y", "z"][: self.dimensions]
        columns: dict[str, list[Any]] = {name: [] for name in ("frame", "time", "id", "label", "team", *axes, "provenance")}
        extra: dict[str, list[NDArray[np.float64]]] = {}
        indices, times = self.indices, self.times
        for track in self._tracks:
            columns["frame"].append(indices[track.at])
            columns["time"].append(times[track.at])
            columns["id"].append(np.full(len(track), track.id))
            columns["label"].append(np.full(len(track), track.label, dtype=object))
            columns["team"].append(np.full(len(track), track.team, dtype=object))
            for axis in axes:
                columns[axis].append(getattr(track, axis))
            columns["provenance"].append(np.asarray(PROVENANCE, dtype=object)[track.provenance])
            for name, value in self._extras(track, axes):
                extra.setdefault(name, []).append(value)
        whole = {name: np.concatenate(parts) if parts else np.zeros(0) for name, parts in columns.items()}
        for name, parts in extra.items():
            joined = np.concatenate(parts)
            if not np.isnan(joined).all():
                whole[name] = joined
        table: pd.DataFrame = pandas.DataFrame(whole).sort_values(["frame", "id"], kind="stable").reset_index(drop=True)
        return table

    @staticmethod
    def _extras(track: Track, axes: list[str]) -> list[tuple[str, NDArray[np.float64]]]:
        velocity, box = track.optional("velocity"), track.optional("box")
        found = [(f"v{axis}", velocity[:, number]) for number, axis in enumerate(axes)]
        found.append(("score", track.optional("score")))
        found += [(name, box[:, number]) for number, name in enumerate(("left", "top", "width", "height"))]
        return found + [("residual_px", track.optional("residual_px"))]

    def to_xarray(self) -> xr.Dataset:
        """movement's Dataset: of boxes (time, space, individuals) in an image and on the ground, of poses (time, space, keypoints, individuals) in
        space. Needs xarray."""
        return _interop.xarray_of(self)  # type: ignore[no-any-return]

    def to_floodlight(self) -> dict[str, Any]:
        """floodlight's XY, by team: two columns (m) a player, in the order of `tracks`. Of the ground alone."""
        teams = sorted({track.team for track in self._tracks})
        return {team: _interop.floodlight_of(self, [t for t in self._tracks if t.team == team]) for team in teams}

    def to_napari(self) -> NDArray[np.float64]:
        """napari's Tracks: N×4 (id, frame, y, x), in space N×5 (id, frame, z, y, x); no NaN."""
        return _interop.napari_of(self)

    def to_supervision(self, instant: int) -> Any:
        """`supervision.Detections` of one instant (counted from 0): xyxy, confidence, tracker_id. Needs supervision."""
        if not 0 <= instant < len(self):
            raise IndexError(f"instant {instant} of {len(self)}")
        ids, boxes, scores = [], [], []
        for track in self._tracks:
            row = int(np.searchsorted(track.at, instant))
            if row == len(track) or track.at[row] != instant:
                continue
            box = track.optional("box")[row]
            ids.append(track.id)
            boxes.append([box[0], box[1], box[0] + box[2], box[1] + box[3]])
            scores.append(track.optional("score")[row])
        return _interop.detections_of(
            np.asarray(ids, dtype=np.int32), np.asarray(boxes, dtype=np.float64).reshape(-1, 4), np.asarray(scores, dtype=np.float64)
        )

    def write(self, path: str | os.PathLike[str], *, format: str | None = None) -> list[str]:
        """Writes a file of the format of its ending, or of `format`; atomically. Returns what the format could not hold, one sentence each.
        Raises marey.Error where it cannot be written."""
        return self._core.write(os.fspath(path), format or "")

    def _repr_html_(self) -> str:
        return f"{_image(self)}<div>{escape(repr(self).strip('<>'))}</div>"


def _image(recording: Recording, max_points: int = 400) -> str:
    """The paths, from above or in the image, as a small SVG."""
    drawn = [track for track in recording.tracks if len(track) > 1][:60]
    if not drawn:
        return ""
    down = recording.kind in ("image", "user_ground")
    x0, x1 = min(float(t.x.min()) for t in drawn), max(float(t.x.max()) for t in drawn)
    y0, y1 = min(float(t.y.min()) for t in drawn), max(float(t.y.max()) for t in drawn)
    scale = 320 / max(x1 - x0, y1 - y0, 1e-9)
    width, height = (x1 - x0) * scale + 8, (y1 - y0) * scale + 8
    lines = []
    for number, track in enumerate(drawn):
        step = max(1, len(track) // max_points)
        xs, ys = (track.x[::step] - x0) * scale + 4, (track.y[::step] - y0) * scale + 4
        points = " ".join(f"{x:.1f},{(y if down else height - y):.1f}" for x, y in zip(xs, ys))
        colour = COLOURS[number % len(COLOURS)]
        lines.append(f'<polyline fill="none" stroke="{colour}" points="{points}"><title>{escape(track.name)}</title></polyline>')
    return f'<svg width="{width:.0f}" height="{height:.0f}" xmlns="http://www.w3.org/2000/svg">{"".join(lines)}</svg>'
