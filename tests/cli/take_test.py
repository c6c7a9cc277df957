"""Takes of every job: written, looked into, measured, forwarded, refused where their positions do not fit. take_test.py MAREY."""

import csv
import json
import pathlib
import shutil
import sqlite3
import subprocess
import sys
import tempfile
import unittest

MAREY = ""


class Takes(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="marey_takes_"))
        self.addCleanup(shutil.rmtree, self.folder)

    def run_marey(self, *arguments, code=0):
        done = subprocess.run([MAREY, *map(str, arguments)], capture_output=True, text=True, cwd=self.folder, timeout=120)
        self.assertEqual(done.returncode, code, f"{arguments}\n{done.stdout}\n{done.stderr}")
        return done

    def boxes(self):
        rows = "".join(f"{i},-1,{100 + 3 * i},80,30,90,0.9\n" for i in range(1, 80))
        (self.folder / "boxes.txt").write_text(rows)
        return "boxes.txt"

    def assert_same_rows(self, one, other):
        """To the last digit, but for velocities, which a take keeps as float32."""
        with open(self.folder / one) as a, open(self.folder / other) as b:
            rows = list(zip(csv.DictReader(a), csv.DictReader(b), strict=True))
        self.assertGreater(len(rows), 1000)
        for mine, theirs in rows:
            for name, value in mine.items():
                if name in ("vx", "vy"):
                    self.assertAlmostEqual(float(value), float(theirs[name]), delta=0.0011)
                else:
                    self.assertEqual(value, theirs[name], (name, mine))

    def test_people_in_a_image(self):
        self.run_marey("track", "--detections", self.boxes(), "--rate", "25", "-o", "street.marey", "-q")
        said = json.loads(self.run_marey("info", "street.marey", "--json").stdout)
        self.assertEqual(said["frames"], 79)
        refused = self.run_marey("measure", "street.marey", "-o", "no.csv", code=1).stderr
        self.assertIn("px", refused)
        self.assertFalse((self.folder / "no.csv").exists())
        said = self.run_marey("convert", "street.marey", "street.c3d", code=2).stderr
        self.assertIn("holds points in space, and not tracks in an image", said)

    def test_people_on_the_ground(self):
        self.run_marey("simulate", "match", "--cameras", "3", "--seconds", "8", "--boxes", "-o", "match", "-q")
        self.run_marey("track", "match/rig.toml", "--ground", "-o", "match.marey", "-q")
        self.run_marey("track", "match/rig.toml", "--ground", "-o", "match.csv", "-q")
        self.run_marey("convert", "match.marey", "again.csv", "--format", "ground")
        self.assert_same_rows("again.csv", "match.csv")
        measured = json.loads(self.run_marey("measure", "match.marey", "-o", "measured.csv", "--json").stdout)
        self.assertGreater(len(measured["people"]), 15)
        with sqlite3.connect(self.folder / "match.marey") as take:
            self.assertEqual(dict(take.execute("SELECT name, value FROM option"))["ground"], "true")
            self.assertEqual([row[0] for row in take.execute("SELECT name FROM input")], ["cam1.txt", "cam2.txt", "cam3.txt"])

    def test_the_same_run_gives_the_same_bytes(self):
        for name in ("a.marey", "b.marey"):
            self.run_marey("track", "--detections", self.boxes(), "--rate", "25", "-o", name, "-q")
        self.assertEqual((self.folder / "a.marey").read_bytes(), (self.folder / "b.marey").read_bytes())


if __name__ == "__main__":
    MAREY = sys.argv.pop(1)
    unittest.main()
