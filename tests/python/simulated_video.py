"""What the tests of jobs have in common: the command line beside Python, and a simulated video of three people.

A test is called: NAME_test.py MAREY ROOT [unittest options]; what imports this takes the first two out of sys.argv.
"""

import pathlib
import subprocess
import sys
import tempfile
import unittest
import warnings

try:
    import numpy as np
except ImportError:
    print("the tests' virtual environment has no numpy; script/setup --tests installs it")
    sys.exit(77)

import marey

MAREY = sys.argv.pop(1)
ROOT = pathlib.Path(sys.argv.pop(1))


def command(*words, cwd):
    done = subprocess.run([MAREY, *map(str, words)], cwd=cwd, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, (words, done.stderr)
    return done.stdout


class SimulatedVideo(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        holder = tempfile.TemporaryDirectory(prefix="marey_python_")
        cls.addClassCleanup(holder.cleanup)
        cls.folder = pathlib.Path(holder.name)
        command("simulate", "people", "--situation", "crowd", "--people", 3, "--frames", 80, "--seed", 4, "-o", "film", "-q", cwd=cls.folder)
        cls.film = cls.folder / "film" / "video.mp4"
        raw = subprocess.run(["ffmpeg", "-v", "error", "-i", cls.film, "-f", "rawvideo", "-pix_fmt", "bgr24", "-"], capture_output=True, check=True)
        size = subprocess.run(
            ["ffprobe", "-v", "error", "-show_entries", "stream=width,height", "-of", "csv=p=0", cls.film], capture_output=True, text=True, check=True
        )
        width, height = map(int, size.stdout.strip().rstrip(",").split(","))
        cls.pictures = np.frombuffer(raw.stdout, dtype=np.uint8).reshape(-1, height, width, 3)

    def setUp(self):
        warnings.simplefilter("error", marey.Warning)

    def bright(self, picture):
        """A detector: every person of the simulated video differs from the median image."""
        background = self.__dict__.setdefault("_background", np.median(self.pictures[::8], axis=0).astype(np.int16))
        mask = np.abs(picture.astype(np.int16) - background).sum(axis=2) > 60
        columns = np.flatnonzero(mask.sum(axis=0) > 4)
        boxes = []
        for run in np.split(columns, np.flatnonzero(np.diff(columns) > 3) + 1) if len(columns) else []:
            rows = np.flatnonzero(mask[:, run[0] : run[-1] + 1].any(axis=1))
            if len(run) > 5 and len(rows) > 20:
                boxes.append([run[0], rows[0], run[-1] + 1, rows[-1] + 1, 0.9])
        return np.asarray(boxes, dtype=float)
