"""Marey turns what cameras see into motion you can measure.

    import marey
    people = marey.track("street.mp4")
    people.to_pandas()

Jobs: `track`, `track_ground`, `reconstruct`, `augment`, `solve`, `calibrate.wand`, `evaluate`, `live`; files: `read`, `read_rig`. Each job returns a `Recording`.
Positions are px in an image (integer coordinates are pixel centres, y down) and m elsewhere (z up); times are s from the beginning.
What the outside world did wrong is a `marey.Error`, in one sentence; doubts are `marey.Warning`s. While a job runs other threads have Python,
and Ctrl-C ends it.
"""

try:
    from ._core import Error, version as __version__
except ImportError as _error:
    from ._compiled import explain as _explain

    raise _explain(_error) from None

from . import calibrate
from ._evaluate import Evaluation, evaluate
from ._files import formats, read, read_rig
from ._filters import Filter
from ._frames import Frames
from ._instant import Instant
from ._jobs import Warning, augment, reconstruct, solve, threads, track, track_ground
from ._live import live
from ._provenance import PROVENANCE
from ._recording import Recording, Track
from ._rig import Camera, Rig

Error.__module__ = "marey"
Error.__doc__ = "The outside world failed: a file, a device, a setting. One sentence: what, where, and what to do."

__all__ = [
    "Camera",
    "Error",
    "Evaluation",
    "Filter",
    "Frames",
    "Instant",
    "PROVENANCE",
    "Recording",
    "Rig",
    "Track",
    "Warning",
    "__version__",
    "augment",
    "calibrate",
    "evaluate",
    "formats",
    "live",
    "read",
    "read_rig",
    "reconstruct",
    "solve",
    "threads",
    "track",
    "track_ground",
]
