"""Motion filters of one's own: one object a target, which says where it is and where it goes."""

from __future__ import annotations

import copy
from collections.abc import Callable, Sequence
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from ._core import Error

Array = NDArray[np.float64]


class Filter(Protocol):
    """One target. D is 2 in images and on the ground, 3 in space; lengths are px in an image, else m; times s."""

    position: Any  #: D
    velocity: Any  #: D, per second
    covariance: Any  #: D×D, of the position

    def predict(self, dt: float) -> object:
        """Moves the state dt ≥ 0 seconds ahead; dt differs from call to call."""

    def correct(self, z: Array, R: Array) -> object:
        """Takes in a measured position z (D) with covariance R (D×D)."""


#: Begins a target at its first measurement: position (D), its covariance (D×D), and how long 1 is for parameters that scale with the
#: target: a person's height in px in an image, else 1.
MakeFilter = Callable[[Array, Array, float], Filter]


class _Model:
    """What the core calls: numbers in, one row of numbers out."""

    def __init__(self, own: Filter, dimensions: int) -> None:
        self._own = own
        self._dimensions = dimensions

    def copy(self) -> _Model:
        return _Model(copy.deepcopy(self._own), self._dimensions)

    def predict(self, dt: float) -> Array:
        self._own.predict(dt)
        return self.estimate()

    def correct(self, z: Sequence[float], R: Sequence[float]) -> Array:
        self._own.correct(np.array(z), _square(R, self._dimensions))
        return self.estimate()

    def estimate(self) -> Array:
        size = self._dimensions
        parts = [self._part("position", (size,)), self._part("velocity", (size,)), self._part("covariance", (size, size))]
        return np.concatenate(parts)

    def _part(self, name: str, shape: tuple[int, ...]) -> Array:
        values = np.asarray(getattr(self._own, name), dtype=np.float64)
        if values.size != np.prod(shape) or values.ndim > 2:
            raise Error(f"the filter {type(self._own).__name__} gave a {name} of shape {values.shape}; it must be {shape}")
        return values.reshape(-1)


def _square(R: Sequence[float], size: int) -> Array:
    return np.array(R).reshape(size, size)


class Maker:
    """Makes what the core calls, for each target."""

    def __init__(self, make: MakeFilter) -> None:
        self.name = str(getattr(make, "__name__", type(make).__name__))
        self._make = make

    def __call__(self, z: Sequence[float], R: Sequence[float], unit: float) -> _Model:
        return _Model(self._make(np.array(z), _square(R, len(z)), unit), len(z))
