"""The commands of docs/markerless.md on a real street, and what is refused.

Usage: keypoints_test.py MAREY MODELS [unittest options]; MODELS is where script/model puts the networks
"""

import csv
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile
import unittest

MAREY = ""
MODELS = pathlib.Path()
PAGE = pathlib.Path(__file__).resolve().parents[2] / "docs" / "markerless.md"
STREET = pathlib.Path("/usr/share/doc/opencv-doc/examples/data/vtest.avi")


def commands_of(page):
    """Lines of the page's code blocks that begin with marey, without what is said about them."""
    blocks = [block for language, block in re.findall(r"^```(\w*)\n(.*?)^```$", page.read_text(), re.M | re.S) if not language]
    return [line.partition("  #")[0].strip() for block in blocks for line in block.splitlines() if line.startswith("marey track people.mp4")]


def marey(arguments, folder, models=None):
    environment = os.environ | {"MAREY_MODELS": str(models or MODELS)}
    return subprocess.run([MAREY, *arguments], cwd=folder, env=environment, capture_output=True, text=True, timeout=600)


class Keypoints(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.temporary.name)
        if STREET.is_file():
            subprocess.run(["ffmpeg", "-nostdin", "-v", "error", "-i", STREET, "-frames:v", "36", self.folder / "people.mp4"], check=True)
        else:
            self.skipTest(f"{STREET} is not here; Debian's opencv-doc brings it")

    def tearDown(self):
        self.temporary.cleanup()

    def need_models(self):
        if not (MODELS / "pose_landmark_lite.onnx").is_file():
            self.skipTest("script/model has not made the networks")

    def test_live_in_space_with_a_skeleton(self):
        self.need_models()
        data = pathlib.Path(os.environ.get("MAREY_DATA", pathlib.Path(__file__).resolve().parents[3] / "shared" / "data")) / "markerless"
        if not data.is_dir():
            self.skipTest(f"{data} is not here")
        cameras = [f"cam0{number}" for number in (1, 2, 3, 4)]
        for camera in cameras:  # small and slow enough for any machine
            subprocess.run(["ffmpeg", "-nostdin", "-v", "error", "-i", data / "videos" / f"{camera}.mp4", "-vf", "pad=1088:1920,scale=iw/4:ih/4", "-r", "10",
                            self.folder / f"{camera}.mp4"], check=True)
        done = marey(["convert", data / "calibration" / "Calib.qca.txt", "rig.toml"], self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        files = [f"{camera}={camera}.mp4" for camera in cameras]
        said = marey(["reconstruct", "rig.toml", *files, "--targets", "keypoints", "--model", "lite", "-o", "dance.marey", "--quiet"], self.folder)
        self.assertEqual(said.returncode, 0, said.stderr)
        said = marey(["solve", "dance.marey", "-o", "dance.bvh", "--write-skeleton", "person.toml", "--quiet"], self.folder)
        self.assertEqual(said.returncode, 0, said.stderr)
        live = ["live", "rig.toml", *(f"{camera}=play:{camera}.mp4?loop" for camera in cameras), "--targets", "keypoints", "--people", "1", "--skeleton",
                "person.toml", "--duration", "8", "-o", "live.marey", "--json"]
        said = marey(live, self.folder)
        self.assertEqual(said.returncode, 0, said.stderr)
        summary = json.loads(said.stdout)
        self.assertEqual(summary["job"], "keypoints in space")
        self.assertEqual(summary["people"], 1)
        self.assertGreater(summary["samples"], 0)  # how many depends on the machine's load
        self.assertLess(summary["person_searches"], summary["instants"])
        self.assertIn("keypoints", summary["stages"])
        info = marey(["info", "live.marey"], self.folder).stdout
        self.assertIn("P1:left_knee", info + marey(["info", "live.marey", "--json"], self.folder).stdout)

    def refused(self, code, says, *arguments, models=None):
        before = sorted(self.folder.iterdir())
        done = marey(arguments, self.folder, models)
        self.assertEqual(done.returncode, code, done.stderr)
        self.assertIn(says, done.stderr)
        self.assertEqual(len(done.stderr.strip().splitlines()), 1, done.stderr)
        self.assertEqual(sorted(self.folder.iterdir()), before)

    def test_what_cannot_be_is_one_message(self):
        track = ("track", "people.mp4", "--targets", "keypoints", "--quiet")
        with tempfile.TemporaryDirectory() as empty:
            self.refused(1, "script/model", *track, "--model", "lite", models=empty)
            self.refused(1, "script/model", *track, "--no-background", models=empty)
            for content in (b"", b"no network"):
                (pathlib.Path(empty) / "pose_landmark_full.onnx").write_bytes(content)
                self.refused(1, "script/model", *track, models=empty)
            numbers = ("track", "people.mp4", "--quiet", "--numbers", "numbers.csv")
            self.refused(1, "script/model --numbers", *numbers, models=empty)
            for content in (b"", b"no network"):
                (pathlib.Path(empty) / "shirt_numbers.onnx").write_bytes(content)
                self.refused(1, "script/model --numbers", *numbers, models=empty)
        self.refused(2, ".csv", "track", "people.mp4", "--numbers", "numbers.txt")
        self.refused(2, "lite, full or heavy", *track, "--model", "tiny")
        self.refused(2, "--ground", *track, "--ground")
        self.refused(2, "requires --detector", "track", "people.mp4", "--detector-interval", "3")
        self.refused(2, "requires --detector", "track", "people.mp4", "--no-background")
        self.need_models()
        self.refused(1, "another network", *track, "--model", MODELS / "person.onnx")

    def test_the_page_s_commands(self):
        self.need_models()
        commands = commands_of(PAGE)
        self.assertGreaterEqual(len(commands), 3)
        for command in commands:
            done = marey(shlex.split(command)[1:], self.folder)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn("keypoints: in ", done.stderr)
        with open(self.folder / "people.csv") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(list(rows[0]), "frame,time,id,point,x,y,sd,visibility,presence".split(","))
        bodies = {(row["frame"], row["id"]) for row in rows}
        self.assertEqual(len(rows), 33 * len(bodies))
        self.assertGreater(len(bodies), 80)
        self.assertTrue(all(0 <= float(row[name]) <= 1 for row in rows for name in ("visibility", "presence")))
        noses = sorted((int(row["frame"]), round(float(row["x"]), 1)) for row in rows if row["point"] == "nose")
        coco = json.loads((self.folder / "people.json").read_text())
        self.assertEqual(len(coco["categories"][0]["keypoints"]), 33)
        self.assertEqual(sorted((one["image_id"], round(one["keypoints"][0], 1)) for one in coco["annotations"]), noses)
        openpose = []
        for path in sorted((self.folder / "people_json").iterdir()):
            frame = int(path.stem.split("_")[1])
            openpose += [(frame, round(person["pose_keypoints_2d"][0], 1)) for person in json.loads(path.read_text())["people"]]
        self.assertEqual(sorted(openpose), noses)
        self.assertTrue(all(float(row["sd"]) > 0 for row in rows))
        objects = [json.loads(line) for line in (self.folder / "people.jsonl").read_text().splitlines()]
        with_points = [one for one in objects if "keypoints" in one]
        self.assertEqual(len(with_points), len(bodies))
        self.assertEqual(len(with_points[0]["keypoints"]["points"]), 33)
        self.assertTrue((self.folder / "people_drawn.mp4").stat().st_size > 0)
        done = marey(["convert", "people.marey", "converted.csv"], self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        with open(self.folder / "converted.csv") as file:
            converted = list(csv.DictReader(file))
        self.assertEqual(len(converted), len(rows))
        for row, again in zip(rows, converted):
            self.assertEqual((row["frame"], row["id"], row["point"]), (again["frame"], again["id"], again["point"]))
            self.assertAlmostEqual(float(row["x"]), float(again["x"]), delta=0.002)
            self.assertAlmostEqual(float(row["sd"]), float(again["sd"]), delta=0.002)

    def test_without_background(self):
        self.need_models()
        done = marey(["track", "people.mp4", "--targets", "keypoints", "--model", "lite", "--no-background", "-o", "alone.csv"], self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        with open(self.folder / "alone.csv") as file:
            self.assertGreater(len(list(file)), 33 * 40)

    def test_where_none_is_found_the_other_trajectory_is_named(self):
        self.need_models()
        (self.folder / "still").mkdir()
        for frame in range(20):
            (self.folder / "still" / f"{frame:02}.pgm").write_bytes(b"P5 160 120 255\n" + bytes(range(160)) * 120)
        done = marey(["track", "still", "--rate", "10", "--targets", "keypoints", "--model", "lite", "-o", "still.csv"], self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("no person was found", done.stderr)
        self.assertIn("--no-background finds people who fill the image", done.stderr)

    def test_what_holds_no_points_states_so(self):
        self.need_models()
        done = marey(["track", "people.mp4", "--targets", "keypoints", "--model", "lite", "--detector-interval", "8", "-o", "boxes.txt"], self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("holds no keypoints", done.stderr)


if __name__ == "__main__":
    MAREY = sys.argv.pop(1)
    MODELS = pathlib.Path(sys.argv.pop(1))
    unittest.main()
