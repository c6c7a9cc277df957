"""docs/mocap.md, each command run as it is written there; what comes out against the simulation's truth; rooms that cannot be.

Usage: mocap_test.py MAREY ROOT [unittest options]
"""

import csv
import math
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import tomllib
import unittest

MAREY = ""
ROOT = pathlib.Path()


def commands(page):
    """The lines of the page's blocks that call the program, in order."""
    blocks = [block for language, block in re.findall(r"^```(\w*)\n(.*?)^```$", page.read_text(), re.M | re.S) if not language]
    return [line for block in blocks for line in block.splitlines() if line.startswith("marey ")]


class Mocap(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="marey_mocap_"))
        self.addCleanup(shutil.rmtree, self.folder)

    def marey(self, *arguments, code=0):
        done = subprocess.run([MAREY, *map(str, arguments)], capture_output=True, text=True, cwd=self.folder, timeout=600)
        self.assertEqual(done.returncode, code, f"{arguments}\n{done.stdout}\n{done.stderr}")
        return done

    def rows(self, name):
        with open(self.folder / name, newline="") as file:
            return list(csv.DictReader(file))

    def centres(self, name):
        """Where the cameras of a rig file stand: -Rᵀ t."""
        with open(self.folder / name, "rb") as file:
            cameras = tomllib.load(file)["camera"]
        return {c["name"]: [-sum(c["rotation"][k][i] * c["translation"][k] for k in range(3)) for i in range(3)] for c in cameras}

    def test_the_page_as_it_is_written(self):
        lines = commands(ROOT / "docs" / "mocap.md")
        self.assertGreaterEqual(len(lines), 9)
        for line in lines:
            with self.subTest(line=line):
                self.marey(*shlex.split(line)[1:])
        self.cameras_stand_where_they_do()
        self.markers_are_where_they_were()
        for name in ("walk.c3d", "walk.trc", "rig.yml"):
            self.assertGreater((self.folder / name).stat().st_size, 1000)

    def cameras_stand_where_they_do(self):
        """Distances between cameras, which no frame of the world changes."""
        found, true = self.centres("rig.toml"), self.centres("wand/rig.toml")
        names = sorted(true)
        self.assertEqual(sorted(found), names)
        for i, a in enumerate(names):
            for b in names[:i]:
                self.assertAlmostEqual(math.dist(found[a], found[b]), math.dist(true[a], true[b]), delta=0.003)

    def markers_are_where_they_were(self):
        """Distances between the markers of one frame, sorted: they tell the same points apart from the frame of the world."""
        def spread(rows, frame):
            points = [tuple(float(row[k]) for k in "xyz") for row in rows if row["frame"] == frame]
            return len(points), sorted(math.dist(p, q) for i, p in enumerate(points) for q in points[:i])

        seen = [row for row in self.rows("walk/truth.csv") if int(row["cameras"]) >= 3]
        count, found = spread(self.rows("walk.csv"), "600")
        true_count, true = spread(seen, "600")
        self.assertGreaterEqual(count, 0.9 * true_count)
        self.assertAlmostEqual(found[-1], true[-1], delta=0.01)
        self.assertAlmostEqual(found[len(found) // 2], true[len(true) // 2], delta=0.03)

    def test_the_same_seed_gives_the_same_room_and_the_same_cameras_for_every_motion(self):
        for name, motion in (("a", "walk"), ("b", "walk"), ("c", "wave")):
            self.marey("simulate", "room", "--motion", motion, "--frames", 5, "--seed", 4, "-o", name, "-q")
        for name in ("rig.toml", "start.toml", "observations.csv", "blobs.csv", "truth.csv"):
            self.assertEqual((self.folder / "a" / name).read_bytes(), (self.folder / "b" / name).read_bytes())
        self.assertEqual((self.folder / "a/rig.toml").read_bytes(), (self.folder / "c/rig.toml").read_bytes())
        self.assertNotEqual((self.folder / "a/truth.csv").read_bytes(), (self.folder / "c/truth.csv").read_bytes())

    def test_a_room_with_videos(self):
        self.marey("simulate", "room", "--cameras", 2, "--frames", 4, "--size", 320, 240, "--render", "--bump", "2,0.01,0.02", "-o", "v")
        rig = tomllib.loads((self.folder / "v/start.toml").read_text())
        for camera in rig["camera"]:
            self.assertNotIn("rotation", camera)
            self.assertGreater((self.folder / "v" / camera["source"]).stat().st_size, 0)
        before, after = self.centres("v/rig.toml"), self.centres("v/rig_after.toml")
        self.assertEqual(before["cam1"], after["cam1"])
        self.assertGreater(math.dist(before["cam2"], after["cam2"]), 0.005)

    def test_rooms_that_cannot_be(self):
        self.assertIn("is no number", self.marey("simulate", "room", "--wand", "0,x", code=2).stderr)
        self.assertIn("must grow", self.marey("simulate", "room", "--wand", "0.3,0", code=2).stderr)
        self.assertIn("there are 8 cameras", self.marey("simulate", "room", "--bump", "9,1,1", code=2).stderr)
        self.marey("simulate", "room", "--cameras", 0, code=2)
        self.marey("simulate", "room", "--motion", "fly", code=2)
        (self.folder / "file").write_text("")
        self.assertIn("cannot be made", self.marey("simulate", "room", "-o", "file/room", code=1).stderr)
        self.assertEqual(os.listdir(self.folder), ["file"])

    def test_all_problems_of_a_rig_are_reported_at_once(self):
        (self.folder / "rig.toml").write_text('[[camera]]\nname = "left"\nsize = [640, 480]\nfocal = [0, 500]\nprincipal = [320, 240]\n'
                                              '[[camera]]\nname = "left"\nfocol = 3\n')
        said = self.marey("convert", "rig.toml", "rig.yml", code=1).stderr
        for part in ('rig.toml:4: camera "left": focal length is 0; it must be positive', "rig.toml:7:", 'rig.toml:8: camera "left": unknown key "focol"'):
            self.assertIn(part, said)
        self.assertFalse((self.folder / "rig.yml").exists())


if __name__ == "__main__":
    MAREY = sys.argv.pop(1)
    ROOT = pathlib.Path(sys.argv.pop(1))
    unittest.main()
