"""Frames that a program has in memory, or gets from a reader of its own: what `track` takes in place of a file."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._core import Error

Image = NDArray[np.uint8]


class Frames:
    """Images of one camera, in order.

    images: an array N×H×W×3 or N×H×W (uint8), a sequence of images, a function without arguments that returns an iterator (it is called again
        for each inspection at them), or an iterator (inspected once: the empty scene is then learned as it goes). An image is H×W×3 or H×W, uint8, of
        any strides; an iterator may also give (time in s, image).
    rate: images a second. Times are index / rate where images do not bring their own.
    colour: order of the three channels: "bgr" as OpenCV reads them, or "rgb".

    Raises marey.Error where an image has another shape or type than this, or a time is not later than the last one's.
    """

    def __init__(
        self,
        pictures: NDArray[np.uint8] | Sequence[Image] | Iterable[Any] | Callable[[], Iterable[Any]],
        rate: float,
        *,
        colour: str = "bgr",
        name: str = "frames",
    ) -> None:
        if not (np.isfinite(rate) and rate > 0):
            raise Error(f"{name}: the rate is {rate} frames a second; it must be positive")
        if colour not in ("bgr", "rgb"):
            raise Error(f'{name}: colour is "{colour}"; supported: bgr and rgb')
        self.rate = float(rate)
        self.colour = colour
        self.name = name
        self.count: int | None = None
        self._make: Callable[[], Iterable[Any]]
        self.again = True
        if callable(pictures):
            self._make = pictures
        elif hasattr(pictures, "__len__") and hasattr(pictures, "__getitem__"):
            whole: Sequence[Any] = pictures  # type: ignore[assignment]
            self.count = len(whole)
            self._make = lambda: iter(whole)
        else:
            once: Iterator[Any] = iter(pictures)
            self.again = False
            self._make = lambda: once
        first = next(self._first(), None)
        if first is None:
            raise Error(f"{name}: there is no image in it")
        self.size: tuple[int, int] = (first[1].shape[0], first[1].shape[1])

    def _first(self) -> Iterator[tuple[float | None, Image]]:
        """The first image, without losing it where images can be had only once."""
        pictures = _Images(self)
        given = pictures.next()
        if given is None:
            return
        if not self.again:
            rest = self._make()

            def all_of_them() -> Iterator[Any]:
                yield given
                yield from rest

            chained = all_of_them()
            self._make = lambda: chained
        yield given

    def open(self) -> _Images:
        return _Images(self)


class _Images:
    """One inspection at them."""

    def __init__(self, frames: Frames) -> None:
        self._frames = frames
        self._left = iter(frames._make())
        self._index = -1
        self._time: float | None = None

    def next(self) -> tuple[float | None, Image] | None:
        try:
            given = next(self._left)
        except StopIteration:
            return None
        self._index += 1
        time: float | None = None
        if isinstance(given, tuple):
            if len(given) != 2:
                raise self._error(f"is a tuple of {len(given)}; give an image, or (time in s, image)")
            time = None if given[0] is None else float(given[0])
            given = given[1]
        if time is not None:
            if not np.isfinite(time):
                raise self._error(f"its time is {time} s; it must be a finite number")
            if self._time is not None and time <= self._time:
                raise self._error(f"its time {time} s is not later than the last one's, {self._time} s")
            self._time = time
        return time, self._checked(given)

    def _error(self, what: str) -> Error:
        return Error(f"{self._frames.name}: image {self._index}: {what}")

    def _checked(self, given: Any) -> Image:
        if not isinstance(given, np.ndarray):
            raise self._error(f"is a {type(given).__name__}; give a NumPy array, H×W×3 or H×W, uint8")
        if given.dtype != np.uint8:
            raise self._error(f"is of {given.dtype}; give uint8, 0 to 255")
        if given.ndim == 3 and given.shape[2] == 1:
            given = given[:, :, 0]
        if not (given.ndim == 2 or (given.ndim == 3 and given.shape[2] == 3)) or 0 in given.shape:
            raise self._error(f"has the shape {given.shape}; give H×W×3 or H×W")
        size = getattr(self._frames, "size", None)
        if size is not None and given.shape[:2] != size:
            raise self._error(f"has {given.shape[1]}×{given.shape[0]} px, those before {size[1]}×{size[0]}")
        if given.ndim == 3 and self._frames.colour == "rgb":
            given = given[:, :, ::-1]
        return np.ascontiguousarray(given)
