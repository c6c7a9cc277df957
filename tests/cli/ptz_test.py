"""`marey calibrate ptz`: a PTZ camera, from a simulated video to people in metres, and input that cannot be used.

Usage: ptz_test.py MAREY [unittest options]. Nothing else is needed.
"""

import csv
import json
import re
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

MAREY = ""


class Ptz(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="marey_turning_"))
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        cls.run_marey("simulate", "ptz", "-o", "film", "--seconds", "8", "--size", "640", "360", "-q")

    @classmethod
    def run_marey(cls, *arguments, code=0):
        done = subprocess.run([MAREY, *arguments], capture_output=True, text=True, cwd=cls.folder, timeout=280)
        assert done.returncode == code, f"{arguments}\n{done.returncode}\n{done.stdout}\n{done.stderr}"
        return done

    def rows(self, name):
        with open(self.folder / name, newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def test_a_video_becomes_a_rig_and_people_have_positions(self):
        report = json.loads(self.run_marey("calibrate", "ptz", "film/main.mp4", "--points", "film/clicks.csv", "-o",
                                           "film/found.toml", "--json").stdout)
        self.assertEqual(report["frames"], 200)
        self.assertLess(report["lost"], 5)
        truth, found = self.rows("film/rig_main_ptz.csv"), self.rows("film/found_main_ptz.csv")
        self.assertEqual(len(truth), len(found))
        for is_, was in zip(truth, found):
            if was["pan"]:
                self.assertLess(abs(float(is_["focal"]) / float(was["focal"]) - 1), 0.02)
        self.run_marey("track", "film/found.toml", "--ground", "main=film/boxes.txt", "-o", "film/found.csv", "-q")
        score = json.loads(self.run_marey("evaluate", "--truth", "film/truth.csv", "--tracks", "film/found.csv", "--distance", "1.5", "--json").stdout)
        self.assertTrue(score)

    def test_lines_alone_give_the_camera_and_its_side_is_stated(self):
        done = self.run_marey("calibrate", "ptz", "film/main.mp4", "-o", "film/alone.toml", "--json")
        report = json.loads(done.stdout)
        self.assertTrue(report["searched"])
        self.assertLess(report["lost"], 20)
        self.assertIn("half a turn", done.stderr)
        self.assertIn("--side far", done.stderr)
        for is_, was in zip(self.rows("film/rig_main_ptz.csv"), self.rows("film/alone_main_ptz.csv")):
            if was["pan"]:
                self.assertLess(abs(float(is_["focal"]) / float(was["focal"]) - 1), 0.05)
        far = self.run_marey("calibrate", "ptz", "film/main.mp4", "--side", "far", "-o", "film/far.toml")
        self.assertNotIn("half a turn", far.stderr)
        for name in ("alone", "far"):
            self.run_marey("track", f"film/{name}.toml", "--ground", "main=film/boxes.txt", "-o", f"{name}.csv", "-q")
        near, turned = (json.loads(self.run_marey("evaluate", "--truth", "film/truth.csv", "--tracks", f"{name}.csv", "--distance", "1.5",
                                                  "--json").stdout) for name in ("alone", "far"))
        self.assertNotEqual(near, turned)
        self.run_marey("calibrate", "ptz", "film/main.mp4", "--side", "left", "-o", "none.toml", code=2)

    def test_without_a_pitch_a_frame_to_click_is_named(self):
        self.run_marey("simulate", "ptz", "-o", "hockey", "--scene", "hockey", "--seconds", "4", "--size", "640", "360", "-q")
        said = self.run_marey("calibrate", "ptz", "hockey/main.mp4", "-o", "none.toml", code=1).stderr
        self.assertRegex(said, r"frame \d+")
        self.assertFalse((self.folder / "none.toml").exists())

    def test_a_click_on_another_line_is_named(self):
        lines = (self.folder / "film/clicks.csv").read_text().splitlines()
        frame, x, y, u, v = lines[2].split(",")
        lines[2] = ",".join([frame, x, y, str(float(u) + (90 if float(u) < 400 else -90)), v])
        (self.folder / "odd.csv").write_text("\n".join(lines) + "\n")
        said = self.run_marey("calibrate", "ptz", "film/main.mp4", "--points", "odd.csv", "-o", "odd.toml").stderr
        self.assertRegex(said, rf"frame {frame}: the click on .* px from where the other clicks place it")

    def test_rigs_of_earlier_versions_are_read(self):
        rig = (self.folder / "film/rig.toml").read_text()
        earlier = rig
        for today, before in (("ptz", "turns"), ("pivot", "tripod"), ("axis_tilt", "lean"), ("radial", "bend")):
            self.assertRegex(earlier, rf"(?m)^{today} = ")
            earlier = re.sub(rf"(?m)^{today} = ", f"{before} = ", earlier)
        (self.folder / "film/earlier.toml").write_text(earlier)
        for name in ("rig", "earlier"):
            self.run_marey("track", f"film/{name}.toml", "--ground", "main=film/boxes.txt", "-o", f"{name}.csv", "-q")
        self.assertEqual((self.folder / "rig.csv").read_bytes(), (self.folder / "earlier.csv").read_bytes())

    def test_people_are_found_before_the_mosaic_of_the_empty_scene(self):
        self.run_marey("track", "film/rig.toml", "--ground", "-o", "mosaic.csv", "-q")
        self.run_marey("track", "film/rig.toml", "--ground", "main=film/boxes.txt", "-o", "boxes.csv", "-q")
        mosaic, boxes = (json.loads(self.run_marey("evaluate", "--truth", "film/truth.csv", "--tracks", f"{name}.csv", "--distance", "1.5",
                                                   "--json").stdout) for name in ("mosaic", "boxes"))
        self.assertGreater(mosaic["found"], 0.5 * boxes["found"])
        self.assertLess(mosaic["false"], 0.35)

    def test_clicks_have_to_report_their_frame_and_lie_on_the_pitch(self):
        (self.folder / "no_frame.csv").write_text("x,y,u,v\n0,0,10,10\n")
        said = self.run_marey("calibrate", "ptz", "film/main.mp4", "--points", "no_frame.csv", "-o", "none.toml", code=1).stderr
        self.assertIn("frame,x,y,u,v", said)
        (self.folder / "far.csv").write_text("frame,x,y,u,v\n0,300,0,10,10\n")
        said = self.run_marey("calibrate", "ptz", "film/main.mp4", "--points", "far.csv", "-o", "none.toml", code=1).stderr
        self.assertIn("--size", said)
        self.assertFalse((self.folder / "none.toml").exists())

    def test_rotations_that_cannot_be_read_are_reported_with_their_line(self):
        rig = (self.folder / "film/rig.toml").read_text()
        (self.folder / "film/bad.toml").write_text(rig.replace("rig_main_ptz.csv", "bad_turns.csv"))
        turns = (self.folder / "film/rig_main_ptz.csv").read_text().splitlines()
        (self.folder / "film/bad_turns.csv").write_text("\n".join([turns[0], turns[2], turns[1]]) + "\n")
        said = self.run_marey("track", "film/bad.toml", "--ground", "main=film/boxes.txt", "-o", "none.csv", code=1).stderr
        self.assertIn("bad_turns.csv:3", said)
        (self.folder / "film/bad.toml").write_text(rig.replace("rig_main_ptz.csv", "missing.csv"))
        said = self.run_marey("track", "film/bad.toml", "--ground", "main=film/boxes.txt", "-o", "none.csv", code=1).stderr
        self.assertIn("missing.csv", said)


if __name__ == "__main__":
    MAREY = sys.argv.pop(1)
    unittest.main()
