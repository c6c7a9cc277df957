"""marey augment: anatomical markers and joint angles of keypoints in space, and input that cannot be used.

Usage: augment_test.py MAREY MODELS [unittest options]. What needs the networks is skipped where script/model --augmenter has not made them.
"""

import csv
import json
import math
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

MAREY, MODELS = "", ""
CAMERAS = ["cam1", "cam2", "cam3", "cam4"]
PERSON = ["--height", 1.75, "--mass", 70]


class Augment(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="marey_augment_"))
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        cls.marey("simulate", "room", "--motion", "walk", "--keypoints", "--cameras", 4, "--markers", 4, "--size", 1080, 1920, "--rate", 60, "--zoom", 2, "--volume", 4.7, 4.7, 2.5,
                  "--frames", 90, "--seed", 3, "-q", "-o", "room")
        cls.marey("reconstruct", "room/rig.toml", "--targets", "keypoints", *(f"{camera}=room/keypoints_{camera}.json" for camera in CAMERAS), "-q", "-o", "walk.marey")
        cls.marey("convert", "walk.marey", "walk.csv", "-q")

    @classmethod
    def marey(cls, *arguments, code=0, models=None):
        done = subprocess.run([MAREY, *map(str, arguments)], capture_output=True, text=True, cwd=cls.folder, timeout=300, env=os.environ | {"MAREY_MODELS": str(models or MODELS)})
        assert done.returncode == code, f"{arguments}\n{done.stdout}\n{done.stderr}"
        return done

    def refused(self, *arguments, code=1, models=None):
        said = self.marey("augment", *arguments, "-o", "never.trc", code=code, models=models).stderr.strip()
        self.assertFalse((self.folder / "never.trc").exists())
        return said

    def with_networks(self):
        if not pathlib.Path(MODELS, "augmenter_lower.onnx").is_file():
            self.skipTest("script/model --augmenter has not made the networks")

    def augment(self, recording, *more, **other):
        return json.loads(self.marey("augment", recording, *PERSON, "--json", *more, **other).stdout)

    def angles(self, recording, name, *more):
        made = self.augment(recording, "--angles", name, *more)
        with open(self.folder / name) as file:
            return made, [{key: float(value) if value else None for key, value in row.items()} for row in csv.DictReader(file)]

    def test_input_that_cannot_be_used(self):
        self.assertIn("script/model --augmenter", self.refused("walk.marey", *PERSON, models=self.folder))
        self.assertIn("no keypoints of legs and shoulders of a person P9", self.refused("walk.marey", *PERSON, "--person", "P9"))
        self.marey("reconstruct", "room/rig.toml", "--observations", "room/observations.csv", "--labels", "room/labels.csv", "-q", "-o", "markers.marey")
        self.assertIn("has no body keypoints", self.refused("markers.marey", *PERSON))
        self.marey("convert", "walk.marey", "short.csv", "--frames", "0:20", "-q")
        self.assertIn("half a second", self.refused("short.csv", *PERSON))
        self.assertIn("--height", self.refused("walk.marey", "--height", 17.5, "--mass", 70, code=2))
        self.assertIn("--mass", self.refused("walk.marey", "--height", 1.75, code=2))
        self.assertIn("--angles", self.marey("augment", "walk.marey", *PERSON, code=2).stderr)

    def test_networks_that_are_others(self):
        self.with_networks()
        other = self.folder / "other"
        other.mkdir()
        for name in ("augmenter_lower.onnx", "augmenter_upper.onnx"):
            shutil.copy(pathlib.Path(MODELS, "augmenter_lower.onnx"), other / name)
        self.assertIn("is another network", self.refused("walk.marey", *PERSON, models=other))
        (other / "augmenter_lower.onnx").write_bytes(b"\x08\x07" * 99)
        self.assertIn("script/model --augmenter", self.refused("walk.marey", *PERSON, models=other))

    def test_markers_for_a_model(self):
        self.with_networks()
        made = self.augment("walk.marey", "-o", "walk.trc")
        self.assertEqual((made["markers"], made["frames"]), (43, 90))
        self.assertTrue(60 < made["augmented"] <= 90, made["augmented"])  # not where a keypoint is absent
        self.assertFalse(made["warnings"])
        self.assertTrue(2 < made["marker_deviation_mm"] < 40, made["marker_deviation_mm"])
        again = self.augment("walk.marey", "-o", "again.trc")
        again.pop("outputs"), made.pop("outputs")
        self.assertEqual(again, made)
        self.assertIn("r_knee_study", (self.folder / "walk.trc").read_text().splitlines()[3])
        solved = json.loads(self.marey("solve", "walk.trc", "--up", "z", "--skeleton", f"{MODELS}/anatomical.osim", "--calibrate", "-o", "walk.mot", "--json").stdout)
        self.assertLess(solved["rms_mm"], 20)
        self.assertFalse(solved["not_recorded"])

    def test_angles_with_deviations(self):
        self.with_networks()
        made, rows = self.angles("walk.marey", "angles.csv")
        self.assertEqual(len(rows), 90)
        known = [row for row in rows if row["left_knee_flexion"] is not None]
        self.assertEqual(len(known), made["augmented"])
        knee = [row["left_knee_flexion"] for row in known]
        self.assertTrue(20 < max(knee) - min(knee) < 90, (min(knee), max(knee)))
        deviations = [row["left_knee_flexion_deviation"] for row in known]
        self.assertTrue(all(0.1 < deviation < 15 for deviation in deviations), (min(deviations), max(deviations)))
        self.assertEqual({angle["name"] for angle in made["angles"] if "deviation_deg" in angle}, {angle["name"] for angle in made["angles"]})

    def test_the_same_walk_in_another_direction(self):
        """Without covariances, which CSV has not: a warning says so, and no deviations are given."""
        self.with_networks()
        made, rows = self.angles("walk.csv", "straight.csv")
        self.assertTrue([warning for warning in made["warnings"] if "no covariances" in warning], made["warnings"])
        self.assertTrue(all(row["left_knee_flexion_deviation"] is None for row in rows))
        turn = math.radians(67)
        with open(self.folder / "walk.csv") as file, open(self.folder / "turned.csv", "w") as out:
            reader = csv.DictReader(file)
            writer = csv.DictWriter(out, reader.fieldnames)
            writer.writeheader()
            for row in reader:
                x, y = float(row["x"]), float(row["y"])
                writer.writerow(row | {"x": math.cos(turn) * x - math.sin(turn) * y, "y": math.sin(turn) * x + math.cos(turn) * y})
        _, turned = self.angles("turned.csv", "turned_angles.csv")
        for straight, other in zip(rows, turned, strict=True):
            for name in ("left_hip_flexion", "right_hip_rotation", "left_knee_flexion", "right_ankle_dorsiflexion"):
                self.assertEqual(straight[name] is None, other[name] is None)
                if straight[name] is not None:
                    self.assertAlmostEqual(straight[name], other[name], delta=0.05)

    def test_hips_that_are_joints(self):
        """The simulation's are: moved to where the networks expect hips, the thigh is upright where it was 8 to 16 degrees bent."""
        self.with_networks()
        mean = {}
        for hips in ("keypoints", "joints"):
            _, rows = self.angles("walk.marey", f"{hips}.csv", "--hips", hips)
            known = [row["left_knee_flexion"] for row in rows if row["left_knee_flexion"] is not None]
            mean[hips] = sum(known) / len(known)
        self.assertGreater(abs(mean["keypoints"] - mean["joints"]), 2)
        self.marey("augment", "walk.marey", *PERSON, "--hips", "somewhere", "-o", "never.trc", code=2)

    def test_a_height_that_does_not_fit(self):
        self.with_networks()
        tall = json.loads(self.marey("augment", "walk.marey", "--height", 2.4, "--mass", 30, "-o", "tall.trc", "--json").stdout)
        self.assertTrue([warning for warning in tall["warnings"] if "is the height right" in warning], tall["warnings"])
        self.assertTrue([warning for warning in tall["warnings"] if "body mass index" in warning], tall["warnings"])


if __name__ == "__main__":
    MAREY, MODELS = str(pathlib.Path(sys.argv.pop(1)).resolve()), str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main()
