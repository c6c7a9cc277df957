"""Arrays as other packages want them. None of these packages is needed before its function is called."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ._core import Error

if TYPE_CHECKING:
    from ._recording import Recording


def required(package: str, what: str) -> Any:
    """The package, or a marey.Error that says how to get it."""
    import importlib

    try:
        return importlib.import_module(package)
    except ImportError as missing:
        name = package.split(".")[0]
        raise Error(f"{what} needs the package {name}: pip install {name}") from missing


def detections_of(ids: NDArray[np.int32], box: NDArray[np.float64], score: NDArray[np.float64]) -> Any:
    supervision = required("supervision", "to_supervision()")
    with_box = ~np.isnan(box[:, 0]) if len(box) else np.zeros(0, dtype=bool)
    confidence = np.where(np.isnan(score), 1.0, score)[with_box]
    return supervision.Detections(
        xyxy=box[with_box].astype(np.float32),
        confidence=confidence.astype(np.float32),
        class_id=np.zeros(int(with_box.sum()), dtype=int),
        tracker_id=ids[with_box].astype(int),
    )


def rows_of_detections(given: Any) -> NDArray[np.float64]:
    """What a detector returned, as rows x1, y1, x2, y2, score: supervision's Detections, or an array N×4 to N×6 (score is the fifth)."""
    if given is None:
        return np.zeros((0, 5))
    if hasattr(given, "xyxy"):
        boxes = np.asarray(given.xyxy, dtype=np.float64).reshape(-1, 4)
        confidence = getattr(given, "confidence", None)
        scores = np.ones(len(boxes)) if confidence is None else np.asarray(confidence, dtype=np.float64)
    else:
        rows = np.asarray(given, dtype=np.float64)
        if rows.size == 0:
            return np.zeros((0, 5))
        if rows.ndim != 2 or not 4 <= rows.shape[1] <= 6:
            raise Error(f"the detector returned an array of shape {rows.shape}; give N×4 to N×6: x1, y1, x2, y2, score, class")
        boxes = rows[:, :4]
        scores = rows[:, 4] if rows.shape[1] > 4 else np.ones(len(rows))
    table = np.column_stack([boxes, scores])
    if not np.isfinite(table).all():
        raise Error("the detector returned a box that is not finite")
    if (table[:, 2:4] <= table[:, 0:2]).any():
        raise Error("the detector returned a box without area; give x1 < x2 and y1 < y2, in px")
    if ((table[:, 4] < 0) | (table[:, 4] > 1)).any():
        raise Error("the detector returned a score that is not in [0, 1]")
    return np.ascontiguousarray(table)


def xarray_of(recording: Recording) -> Any:
    xarray = required("xarray", "to_xarray()")
    position, confidence, shape = recording.to_numpy(), recording._column_array("score", 1), recording._box_shapes()
    names = [track.name for track in recording.tracks]
    attributes = {
        "fps": recording.rate,
        "time_unit": "seconds",
        "source_software": "Marey",
        "source_file": recording.name or None,
        "space_unit": "pixels" if recording.kind == "image" else "metres",
        "frame_of_reference": recording.frame,
    }
    position = position.transpose(0, 2, 1)  # time, space, individuals
    axes = ["x", "y", "z"][: position.shape[1]]
    coordinates: dict[str, Any] = {"time": recording.times, "space": axes}
    if recording.kind == "space":
        coordinates |= {"keypoints": names, "individuals": ["subject"]}
        dims = ("time", "space", "keypoints", "individuals")
        variables = {"position": (dims, position[..., None]), "confidence": (("time", "keypoints", "individuals"), confidence[..., None])}
        return xarray.Dataset(variables, coordinates, attributes | {"ds_type": "poses"})
    coordinates["individuals"] = names
    dims3 = ("time", "space", "individuals")
    variables = {"position": (dims3, position), "shape": (dims3, shape.transpose(0, 2, 1)), "confidence": (("time", "individuals"), confidence)}
    return xarray.Dataset(variables, coordinates, attributes | {"ds_type": "bboxes"})


def floodlight_of(recording: Recording, tracks: list[Any]) -> Any:
    core = required("floodlight.core.xy", "to_floodlight()")
    if recording.kind == "image":
        raise Error("floodlight wants metres on a pitch; these positions are px of an image")
    places = recording.to_numpy()[:, :, :2]
    numbers = [recording.tracks.index(track) for track in tracks]
    chosen = places[:, numbers, :]
    return core.XY(xy=chosen.reshape(len(chosen), -1), framerate=recording.rate)


def napari_of(recording: Recording) -> NDArray[np.float64]:
    """N×4 (id, frame, y, x), or N×5 (id, frame, z, y, x): napari's order, without NaN, by id and frame."""
    parts = []
    for track in recording.tracks:
        ids = np.full(len(track), track.id, dtype=np.float64)
        frames = recording.indices[track.at].astype(np.float64)
        parts.append(np.column_stack([ids, frames, track.position[:, ::-1]]))
    return np.concatenate(parts) if parts else np.zeros((0, 2 + recording.dimensions))
