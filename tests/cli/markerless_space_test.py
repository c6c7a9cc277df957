"""Body keypoints of several cameras in space, as docs/markerless_space.md tells it, and input that cannot be used.

Usage: markerless_space_test.py MAREY [unittest options]. Nothing else is needed; MAREY_DATA adds real cameras.
"""

import csv
import json
import math
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
CAMERAS = ["cam1", "cam2", "cam3", "cam4"]


class Keypoints(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="marey_keypoints_"))
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        room = ["simulate", "room", "--keypoints", "--cameras", 4, "--markers", 4, "--size", 1080, 1920, "--rate", 50, "-q"]
        cls.marey(*room, "--zoom", 2, "--volume", 4.7, 4.7, 2.5, "--frames", 150, "-o", "one")
        cls.marey(*room, "--zoom", 1.3, "--volume", 2.8, 2.8, 2.5, "--frames", 100, "--actors", 3, "-o", "three")

    @classmethod
    def marey(cls, *arguments, code=0):
        done = subprocess.run([MAREY, *map(str, arguments)], capture_output=True, text=True, cwd=cls.folder, timeout=300)
        assert done.returncode == code, f"{arguments}\n{done.stdout}\n{done.stderr}"
        return done

    def keypoints(self, room, **other):
        return [f"{camera}={other.get(camera, f'{room}/keypoints_{camera}.json')}" for camera in CAMERAS]

    def reconstruct(self, room, *more, out="out.marey", **other):
        return json.loads(
            self.marey("reconstruct", f"{room}/rig.toml", "--targets", "keypoints", *self.keypoints(room, **other), "-o", out, "--json",
                       *more).stdout)

    def refused(self, *arguments):
        said = self.marey("reconstruct", "one/rig.toml", "--targets", "keypoints", *arguments, "-o", "never.marey", code=1).stderr.strip()
        self.assertFalse((self.folder / "never.marey").exists())
        self.assertEqual(len(said.splitlines()), 1, said)
        self.assertTrue(said.startswith("marey: "), said)
        return said

    def rows(self, recording):
        self.marey("convert", recording, "rows.csv")
        with open(self.folder / "rows.csv") as file:
            return {(int(row["frame"]), row["label"]): tuple(float(row[axis]) for axis in "xyz") for row in csv.DictReader(file)}

    def test_the_page_as_it_is_written(self):
        page = (pathlib.Path(__file__).parents[2] / "docs/markerless_space.md").read_text()
        blocks = [block for language, block in re.findall(r"^```(\w*)\n(.*?)^```$", page, re.S | re.M) if not language]
        lines = [line for block in blocks for line in block.splitlines() if line.startswith("marey ")]
        self.assertGreaterEqual(len(lines), 3)
        for line in lines:
            with self.subTest(line=line):
                self.marey(*shlex.split(line)[1:])

    def test_one_person_is_where_it_truly_is(self):
        summary = self.reconstruct("one")
        self.assertEqual(len(summary["people"]), 1)
        self.assertEqual(summary["keypoint_set"], "body_25b")
        self.assertEqual(summary["warnings"], [])
        with open(self.folder / "one/keypoints_truth.csv") as file:
            truth = {(int(row["frame"]), row["label"]): tuple(float(row[axis]) for axis in "xyz") for row in csv.DictReader(file)}
        errors = [math.dist(place, truth[at]) for at, place in self.rows("out.marey").items()]
        self.assertGreater(len(errors), 0.95 * len(truth))
        self.assertLess(sum(errors) / len(errors), 0.024)

    def test_people_have_names_and_go_into_other_formats(self):
        summary = self.reconstruct("three", out="three.marey")
        self.assertEqual([person["label"] for person in summary["people"]], ["P1", "P2", "P3"])
        for name in ("three.c3d", "three.trc", "three.csv"):
            self.marey("convert", "three.marey", name)
        self.assertIn("P3:left_knee", (self.folder / "three.trc").read_text())
        self.assertEqual(len(self.reconstruct("three", "--people", 2)["people"]), 2)

    def test_a_skeleton_is_solved_without_a_static_trial(self):
        self.reconstruct("one", out="walk.marey")
        self.marey("solve", "walk.marey", "-o", "walk.bvh", "-o", "walk.mot", "-o", "walk.c3d", "--write-skeleton", "person.toml", "-q")
        bvh = (self.folder / "walk.bvh").read_text()
        for joint in ("pelvis", "left_thigh", "right_shank", "left_forearm", "head"):
            self.assertIn(f" {joint}\n", bvh)
        self.marey("solve", "walk.marey", "--skeleton", "person.toml", "-o", "again.mot", "-q")
        self.reconstruct("three", out="three.marey")
        said = self.marey("solve", "three.marey", "--person", "P2", "-o", "p2.bvh", "--json").stdout
        self.assertEqual(json.loads(said)["skeleton"], "P2")
        said = self.marey("solve", "three.marey", "--person", "P9", "-o", "p9.bvh", code=1).stderr
        self.assertIn("there are P1, P2, P3", said)

    def test_unsuitable_input_is_refused_in_one_message(self):
        good = self.folder / "one/keypoints_cam1.json"
        (self.folder / "cut.json").write_text(good.read_text()[:3000])
        self.assertIn("breaks off", self.refused(*self.keypoints("one", cam1="cut.json")))
        (self.folder / "nan.json").write_text('[{"image_id": 0, "keypoints": [NaN, 1, 1]}]')
        self.assertIn("NaN", self.refused(*self.keypoints("one", cam1="nan.json")))
        (self.folder / "few.json").write_text(json.dumps([{"image_id": 0, "keypoints": [1, 2, 0.5] * 7}]))
        self.assertIn("7 points", self.refused(*self.keypoints("one", cam1="few.json")))
        (self.folder / "other.json").write_text(json.dumps([{"image_id": 0, "keypoints": [1, 2, 0.5] * 17}]))
        self.assertIn("one set", self.refused(*self.keypoints("one", cam2="other.json")))
        (self.folder / "empty").mkdir()
        self.assertIn("needs a video, or keypoints", self.refused(*self.keypoints("one", cam1="empty")))
        self.assertIn("only one", self.refused("cam1=one/keypoints_cam1.json"))

    def test_cameras_that_observe_different_people_position_none(self):
        for camera in CAMERAS[:2]:
            text = json.loads((self.folder / f"one/keypoints_{camera}.json").read_text())
            if camera == "cam2":
                for person in text["annotations"]:
                    person["keypoints"][1::3] = [1919 - y for y in person["keypoints"][1::3]]
            (self.folder / f"differ_{camera}.json").write_text(json.dumps(text))
        said = self.refused("cam1=differ_cam1.json", "cam2=differ_cam2.json")
        self.assertIn("no two cameras see the same person", said)

    def test_swapped_cameras_are_named(self):
        done = self.marey("reconstruct", "one/rig.toml", "--targets", "keypoints",
                          *self.keypoints("one", cam1="one/keypoints_cam2.json", cam2="one/keypoints_cam1.json"), "-o", "swapped.marey")
        self.assertIn('keypoints of "cam1" and "cam2" exchanged', done.stderr)

    def test_options_of_markers_are_refused(self):
        said = self.marey("reconstruct", "one/rig.toml", "--targets", "keypoints", "--observations", "one/observations.csv", "-o", "x.marey",
                          code=2).stderr
        self.assertIn("--targets keypoints", said)
        said = self.marey("reconstruct", "one/rig.toml", "--targets", "keypoints", *self.keypoints("one"), "--keypoint-set", "hands", "-o",
                          "x.marey", code=2).stderr
        self.assertIn("body_25b", said)

    def test_real_cameras(self):
        data = pathlib.Path(os.environ.get("MAREY_DATA", pathlib.Path(__file__).parents[2] / "../shared/data")) / "markerless"
        if not data.exists():
            self.skipTest(f"{data} is not here")
        self.marey("convert", data / "calibration/Calib.qca.txt", "rig.toml")
        summary = json.loads(
            self.marey("reconstruct", "rig.toml", "--targets", "keypoints", *[f"cam0{i}={data}/peer_2d/cam0{i}_json" for i in range(1, 5)],
                       "--rate", 60, "-o", "dance.marey", "--json").stdout)
        self.assertEqual(summary["keypoint_set"], "body_25b")
        self.assertEqual(len(summary["people"]), 2)
        self.assertLess(summary["residual_px"], 15)
        solved = json.loads(self.marey("solve", "dance.marey", "-o", "dance.bvh", "--json").stdout)
        self.assertLess(solved["rms_mm"], 25)


if __name__ == "__main__":
    MAREY = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main()
