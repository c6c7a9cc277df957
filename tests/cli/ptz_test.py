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

    def off(self, truth, found):
        """For each frame that both know: the larger of the rotation's error (degrees) and the focal length's (percent)."""
        off = []
        for is_, was in zip(self.rows(truth), self.rows(found)):
            if is_["pan"] and was["pan"]:
                turned = max(abs(float(is_[axis]) - float(was[axis])) for axis in ("pan", "tilt"))
                off.append(max(turned, 100 * abs(float(was["focal"]) / float(is_["focal"]) - 1)))
        return off

    def changed(self, name, filters):
        """The video once more as FILTERS of ffmpeg change it."""
        subprocess.run(["ffmpeg", "-v", "error", "-y", "-i", "film/main.mp4", "-vf", filters, name], cwd=self.folder, check=True)
        return name

    def test_another_camera_between_is_lost_and_the_first_is_found_again(self):
        self.run_marey("simulate", "ptz", "-o", "cut", "--seconds", "8", "--size", "640", "360", "--cut", "3", "-q")
        for name, clicks in (("clicked", ["--points", "cut/clicks.csv"]), ("alone", [])):
            with self.subTest(name):
                self.run_marey("calibrate", "ptz", "cut/main.mp4", *clicks, "-o", f"cut/{name}.toml")
                truth, found = self.rows("cut/rig_main_ptz.csv"), self.rows(f"cut/{name}_main_ptz.csv")
                away = [i for i, row in enumerate(truth) if not row["pan"]]
                self.assertGreater(len(away), 30)
                self.assertEqual([i for i in away if found[i]["pan"]], [])
                after = [row["pan"] != "" for row in found[away[-1] + 1:]]
                self.assertGreater(sum(after), 0.8 * len(after))
                self.assertLess(max(self.off("cut/rig_main_ptz.csv", f"cut/{name}_main_ptz.csv")), 3)

    def test_graphics_over_half_of_the_image_give_no_wrong_frame(self):
        self.run_marey("simulate", "ptz", "-o", "covered", "--seconds", "8", "--size", "640", "360", "--graphics", "2", "-q")
        for name, clicks in (("clicked", ["--points", "covered/clicks.csv"]), ("alone", [])):
            with self.subTest(name):
                self.run_marey("calibrate", "ptz", "covered/main.mp4", *clicks, "-o", f"covered/{name}.toml")
                off = self.off("covered/rig_main_ptz.csv", f"covered/{name}_main_ptz.csv")
                self.assertGreater(len(off), 80)
                self.assertLess(max(off), 3)

    def test_an_interview_before_the_pitch_is_refused_or_lost(self):
        # The camera stands; a coat and a head fill the middle of the image.
        person = ("trim=end_frame=1,loop=loop=99:size=1,setpts=N/25/TB,drawbox=x=200:y=130:w=260:h=230:color=0x302838:t=fill,"
                  "drawbox=x=280:y=20:w=110:h=130:color=0xb08878:t=fill")
        said = self.run_marey("calibrate", "ptz", self.changed("interview.mp4", person), "-o", "interview.toml", code=1).stderr
        self.assertRegex(said, r"interview\.mp4: .*(click in frame|is it a video)")
        self.assertFalse((self.folder / "interview.toml").exists())

    def test_a_video_of_the_stand_is_refused(self):
        stand = self.changed("stand.mp4", "crop=iw/4:ih/8:0:0,scale=640:360")
        for clicks in ([], ["--points", "film/clicks.csv"]):
            said = self.run_marey("calibrate", "ptz", stand, *clicks, "-o", "stand.toml", code=1).stderr
            self.assertRegex(said, r"stand\.mp4: .*is it a video")
            self.assertFalse((self.folder / "stand.toml").exists())

    def test_clicks_on_the_wrong_half_are_named_with_their_frame(self):
        lines = (self.folder / "film/clicks.csv").read_text().splitlines()
        last = lines[-1].split(",")[0]
        turned = [lines[0]]
        for line in lines[1:]:
            frame, x, y, u, v = line.split(",")
            turned.append(",".join([frame, str(105 - float(x)) if frame == last else x, y, u, v]))
        (self.folder / "half.csv").write_text("\n".join(turned) + "\n")
        said = self.run_marey("calibrate", "ptz", "film/main.mp4", "--points", "half.csv", "-o", "half.toml", code=1).stderr
        self.assertRegex(said, r"clicks of frame \d+ contradict the others, and fit them on the other half of the pitch")
        self.assertFalse((self.folder / "half.toml").exists())

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
