"""Recordings and rigs in files."""

from __future__ import annotations

import os
import warnings

from . import _core
from ._recording import Recording
from ._rig import Rig


def read(path: str | os.PathLike[str], *, format: str | None = None, rate: float = 25, metadata: str | os.PathLike[str] | None = None) -> Recording:
    """A recording out of a file of any format that Marey reads: a take, C3D, TRC, MOT, CSV, TRACAB, EPTS, … (docs/formats.md).

    format: by name, where the content does not specify it. rate: Hz, where the file does not. metadata: of TRACAB, EPTS or DFL, where it is not beside
    the file. Raises marey.Error for what cannot be read.
    """
    from ._jobs import Warning

    core, doubts = _core.read(os.fspath(path), format or "", rate, os.fspath(metadata) if metadata is not None else "")
    for sentence in doubts:
        warnings.warn(sentence, Warning, stacklevel=2)
    return Recording(core)


def read_rig(path: str | os.PathLike[str]) -> Rig:
    """A rig file (docs/rig.md). Raises marey.Error with every problem of the file."""
    return Rig(_core.read_rig(os.fspath(path)))


def formats() -> dict[str, list[str]]:
    """The names of formats of recordings that are read and written."""
    read_names, written_names = _core.formats()
    return {"read": read_names.split(", "), "written": written_names.split(", ")}
