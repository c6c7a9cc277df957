"""`marey calibrate wand` and `ground` as docs/wand.md tells them, on a simulated room, and on input that cannot be used.

Usage: wand_test.py MAREY [unittest options]. Nothing else is needed.
"""

import json
import math
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import tomllib
import unittest

MAREY = ""


class Wand(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="marey_wand_"))
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        cls.marey("simulate", "room", "--motion", "wand", "--frames", 400, "--cameras", 5, "-o", "room", "-q")
        cls.marey("simulate", "room", "--motion", "ground", "--frames", 20, "--cameras", 5, "-o", "floor", "-q")

    @classmethod
    def marey(cls, *arguments, code=0):
        done = subprocess.run([MAREY, *map(str, arguments)], capture_output=True, text=True, cwd=cls.folder, timeout=300)
        assert done.returncode == code, f"{arguments}\n{done.stdout}\n{done.stderr}"
        return done

    def refused(self, *arguments, code=1):
        said = self.marey("calibrate", *arguments, "-o", "never.toml", code=code).stderr.strip()
        self.assertFalse((self.folder / "never.toml").exists())
        self.assertEqual(len(said.splitlines()), 1, said)
        self.assertTrue(said.startswith("marey: "), said)
        return said

    def test_wand_then_floor(self):
        wand = ("calibrate", "wand", "room/start.toml", "--observations", "room/observations.csv", "--wand", "0,0.12,0.30")
        report = json.loads(self.marey(*wand, "-o", "rig.toml", "--json").stdout)
        self.assertEqual(set(report["cameras"]), {f"cam{i}" for i in range(1, 6)})
        for part in [report["all"], *report["cameras"].values()]:
            self.assertLess(part["mean_px"], 0.14)
            self.assertLessEqual(part["mean_px"], part["rms_px"])
            self.assertLessEqual(part["inliers"], part["observations"])
        table = self.marey(*wand, "-o", "again.toml").stdout
        self.assertIn("grade: ", table)
        self.assertEqual((self.folder / "rig.toml").read_text(), (self.folder / "again.toml").read_text(), "the same twice")
        ground = self.marey("calibrate", "ground", "rig.toml", "--observations", "floor/observations.csv", "-o", "ground.toml", "--json")
        self.assertLess(json.loads(ground.stdout)["rms_mm"], 2)

    def live_rig(self, name, motion):
        source = f"sim://room?cameras=4&rate=60&motion={motion}&blobs&size=1280x1024&noise=0.1"
        cameras = [f'[[camera]]\nname = "cam{c}"\nsize = [1280, 1024]\nsource = "{source}&camera={c}"\n' for c in range(1, 5)]
        (self.folder / name).write_text("\n".join(cameras))

    def centres(self, rig):
        cameras = []
        for camera in tomllib.loads((self.folder / rig).read_text())["camera"]:
            turn, shift = camera["rotation"], camera["translation"]
            cameras.append([-sum(turn[row][axis] * shift[row] for row in range(3)) for axis in range(3)])
        return cameras

    def test_waved_before_live_cameras(self):
        self.live_rig("live.toml", "wand")
        done = self.marey("calibrate", "wand", "live.toml", "--wand", "0,0.12,0.30", "-o", "waved.toml", "--duration", 60, "--json")
        report = json.loads(done.stdout)
        self.assertIn("has seen enough", done.stderr)
        self.assertIn("all of them have", done.stderr, "it ends by itself")
        self.assertIn(report["grade"], ("excellent", "good"))
        self.assertIn("sim://room", (self.folder / "waved.toml").read_text(), "the rig continues with its live cameras")
        self.marey("simulate", "room", "--motion", "wand", "--frames", 2, "--cameras", 4, "-o", "waved_room", "-q")
        found, truth = self.centres("waved.toml"), self.centres("waved_room/rig.toml")
        for a in range(4):
            for b in range(a):
                self.assertAlmostEqual(math.dist(found[a], found[b]), math.dist(truth[a], truth[b]), delta=0.03)
        floor = (self.folder / "waved.toml").read_text().replace("motion=wand", "motion=ground")
        (self.folder / "on_floor.toml").write_text(floor)
        ground = json.loads(self.marey("calibrate", "ground", "on_floor.toml", "-o", "grounded.toml", "--json").stdout)
        self.assertLess(ground["rms_mm"], 2)

    def test_live_cameras_that_observe_too_little(self):
        self.live_rig("live.toml", "wand")
        stopped = subprocess.Popen([MAREY, "calibrate", "wand", "live.toml", "--wand", "0,0.12,0.30", "-o", "never.toml"], cwd=self.folder,
                                   stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        time.sleep(1)
        stopped.send_signal(signal.SIGINT)
        said = stopped.communicate(timeout=30)[1]
        self.assertEqual(stopped.returncode, 130, said)
        self.assertIn("nothing was written", said)
        self.assertFalse((self.folder / "never.toml").exists())
        self.live_rig("elsewhere.toml", "ground")
        said = self.marey("calibrate", "wand", "elsewhere.toml", "--wand", "0,0.12,0.30", "-o", "never.toml", "--duration", 1, code=1).stderr
        self.assertFalse((self.folder / "never.toml").exists())
        self.assertIn("marey: ", said.splitlines()[-1])

    def test_what_cannot_be_used(self):
        seen = ("--observations", "room/observations.csv")
        self.assertIn("no number", self.refused("wand", "room/start.toml", *seen, "--wand", "0,a", code=2))
        self.assertIn("single light", self.refused("wand", "room/start.toml", *seen, "--wand", "0", code=2))
        self.assertIn("grow from 0", self.refused("wand", "room/start.toml", *seen, "--wand", "0,0.3,0.1"))
        self.assertIn("CAM1,CAM2=METRES", self.refused("wand", "room/start.toml", *seen, "--wand", "led", "--distance", "3", code=2))
        self.assertIn("no source", self.refused("wand", "room/start.toml", "--wand", "0,0.12,0.30"))
        self.assertIn("no camera", self.refused("wand", "room/start.toml", "nobody=a.mp4", "--wand", "0,0.12,0.30"))
        self.assertIn("--wand", self.refused("wand", "room/start.toml", *seen, "--wand", "0,0.20,0.30"))
        self.assertIn("calibrate them first", self.refused("ground", "room/start.toml", "--observations", "floor/observations.csv"))
        self.assertIn("on a line", self.refused("ground", "room/rig.toml", "--observations", "floor/observations.csv", "--l-frame", "0,0;1,0;2,0"))
        self.assertIn("not found", self.refused("ground", "room/rig.toml", *seen))


if __name__ == "__main__":
    MAREY = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main()
