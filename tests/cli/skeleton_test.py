"""docs/skeleton.md and docs/gait.md, each command run as it is written there, on real recordings; what cannot be is refused.

Usage: skeleton_test.py MAREY ROOT [unittest options]; exits 77 (skipped) where the recordings are not here.
"""

import csv
import json
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import unittest

MAREY = ""
ROOT = pathlib.Path()
DATA = pathlib.Path()

FILES = {
    "walk.trc": "opensim_ik/synthetic/subject01_synthetic_marker_data.trc",
    "model.osim": "opensim_ik/synthetic/subject01_simbody.osim",
    "walk.c3d": "gait_children/HC002D/straight_HC002D06.c3d",
    "run.c3d": "gait_children/HC002D/turn_HC002D25.c3d",
    "standing.c3d": "gait_children/HC002D/static_HC002D02.c3d",
    "other.c3d": "gait_children/HC044A/static_HC044A01.c3d",
    "punches.c3d": "cmu_02_05/cmu_02_05.c3d",
    "figure.bvh": "bvh_dialects/openmocap/default.bvh",
}


def commands(page):
    blocks = re.findall(r"^```\n(.*?)^```", page.read_text(), re.M | re.S)
    return [line for block in blocks for line in block.splitlines() if line.startswith("marey ")]


class Skeleton(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="marey_skeleton_"))
        self.addCleanup(shutil.rmtree, self.folder)
        for name, source in FILES.items():
            shutil.copy(DATA / source, self.folder / name)

    def marey(self, *arguments, code=0):
        done = subprocess.run([MAREY, *map(str, arguments)], capture_output=True, text=True, cwd=self.folder, timeout=600)
        self.assertEqual(done.returncode, code, f"{arguments}\n{done.stdout}\n{done.stderr}")
        return done

    def test_the_pages_as_they_are_written(self):
        for page, least in (("skeleton.md", 4), ("gait.md", 1)):
            lines = commands(ROOT / "docs" / page)
            self.assertGreaterEqual(len(lines), least)
            for line in lines:
                with self.subTest(line=line):
                    self.marey(*shlex.split(line)[1:])
        for name in ("walk.mot", "walk.bvh", "run.bvh", "person.toml", "cycles.csv", "angles.csv", "gait.html"):
            self.assertGreater((self.folder / name).stat().st_size, 1000, name)

    def test_the_summary_says_what_fits_and_what_is_not_seen(self):
        done = self.marey("solve", "walk.trc", "--skeleton", "model.osim", "-o", "walk.mot")
        self.assertIn("mm RMS", done.stderr)
        self.assertIn("not observed, no marker shows them to 10°: mtp_angle_r, mtp_angle_l", done.stderr)
        summary = json.loads(self.marey("solve", "walk.trc", "--skeleton", "model.osim", "-o", "walk.mot", "--json").stdout)
        self.assertEqual(summary["frames"], 73)
        self.assertLess(summary["rms_mm"], 0.05)

    def test_the_same_bytes_again(self):
        for name in ("a", "b"):
            self.marey("solve", "walk.c3d", "--static", "standing.c3d", "-o", f"{name}.mot", "-o", f"{name}.bvh", "-o", f"{name}.glb", "-q")
        for ending in ("mot", "bvh", "glb"):
            self.assertEqual((self.folder / f"a.{ending}").read_bytes(), (self.folder / f"b.{ending}").read_bytes())

    def test_gait_finds_the_steps(self):
        said = json.loads(self.marey("gait", "walk.c3d", "--static", "standing.c3d", "-o", "cycles.csv", "--json").stdout)
        self.assertEqual(len([e for e in said["events"] if e["event"] == "strike"]), 6)
        with open(self.folder / "cycles.csv", newline="") as file:
            rows = [row for row in csv.DictReader(file) if row["angle"] == "left_knee_flexion"]
        self.assertEqual([int(row["percent"]) for row in rows], list(range(101)))
        self.assertGreater(max(float(row["mean_deg"]) for row in rows), 45)
        self.assertTrue(any("left shoulder plane" in warning for warning in said["warnings"]), said["warnings"])

    def test_gait_of_who_does_not_walk_is_refused(self):
        done = self.marey("gait", "punches.c3d", "-o", "none.csv", code=1)
        self.assertIn("no gait cycle", done.stderr)
        self.assertFalse((self.folder / "none.csv").exists())

    def test_gait_warns_of_another_persons_static_trial(self):
        done = self.marey("gait", "run.c3d", "--static", "other.c3d", "-o", "cycles.csv", "-q")
        self.assertIn("LASI and RASI are 33 mm farther apart", done.stderr)

    def test_what_cannot_be_is_refused(self):
        def says(code, words, *arguments):
            done = self.marey("solve", *arguments, code=code)
            self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
            for word in words:
                self.assertIn(word, done.stderr)

        says(1, ["figure.bvh", "markers"], "walk.trc", "--skeleton", "figure.bvh", "-o", "x.mot")
        says(1, ["skeleton is wanted"], "walk.trc", "-o", "x.mot")
        says(1, ["stands still"], "walk.c3d", "--static", "walk.c3d", "-o", "x.mot")
        says(2, ["x.png"], "walk.trc", "--skeleton", "model.osim", "-o", "x.png")
        says(1, ["no skeleton that Marey knows"], "walk.trc", "--skeleton", "walk.trc", "-o", "x.mot")
        self.assertFalse((self.folder / "x.mot").exists())


if __name__ == "__main__":
    MAREY, ROOT = str(pathlib.Path(sys.argv.pop(1)).resolve()), pathlib.Path(sys.argv.pop(1)).resolve()
    DATA = pathlib.Path(os.environ.get("MAREY_DATA", ROOT / "../shared/data"))
    if not (DATA / "gait_children").exists():
        print(f"skipped: {DATA / 'gait_children'} is not here")
        sys.exit(77)
    unittest.main()
