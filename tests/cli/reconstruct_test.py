"""`marey reconstruct` as docs/reconstruct.md tells it, on a simulated room with videos, and on input that cannot be used.

Usage: reconstruct_test.py MAREY [unittest options]. Nothing else is needed.
"""

import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

MAREY = ""


class Reconstruct(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="marey_reconstruct_"))
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        cls.marey("simulate", "room", "--frames", 60, "--cameras", 4, "--markers", 12, "--size", 640, 512, "--render", "--no-occlusion",
                  "-o", "room", "-q")

    @classmethod
    def marey(cls, *arguments, code=0):
        done = subprocess.run([MAREY, *map(str, arguments)], capture_output=True, text=True, cwd=cls.folder, timeout=300)
        assert done.returncode == code, f"{arguments}\n{done.stdout}\n{done.stderr}"
        return done

    def refused(self, *arguments):
        said = self.marey("reconstruct", *arguments, "-o", "never.marey", code=1).stderr.strip()
        self.assertFalse((self.folder / "never.marey").exists())
        self.assertTrue(said.splitlines()[-1].startswith("marey: "), said)
        return said

    def edited(self, name, change):
        text = (self.folder / "room/rig.toml").read_text()
        changed = change(text)
        self.assertNotEqual(text, changed)
        (self.folder / "room" / name).write_text(changed)
        return f"room/{name}"

    def test_videos_and_observations_agree(self):
        from_videos = json.loads(self.marey("reconstruct", "room/rig.toml", "-o", "videos.marey", "--json").stdout)
        from_file = json.loads(
            self.marey("reconstruct", "room/rig.toml", "--observations", "room/observations.csv", "-o", "file.marey", "--json").stdout)
        for summary in (from_videos, from_file):
            self.assertEqual(summary["frames"], 60)
            self.assertGreaterEqual(summary["markers"], 10)
            self.assertGreater(summary["points"]["measured"], 0.7 * 60 * 12)
            self.assertIn("correspond", summary["stages"])
        self.assertLess(from_videos["residual_px"], 0.5)

    def test_a_take_is_solved_again(self):
        self.marey("reconstruct", "room/rig.toml", "--observations", "room/observations.csv", "-o", "first.marey", "-q")
        first = json.loads(self.marey("info", "first.marey", "--json").stdout)
        for again in (["first.marey"], ["room/rig.toml", "--observations", "first.marey"], ["--observations", "first.marey"]):
            summary = json.loads(self.marey("reconstruct", *again, "--max-gap", 0, "-o", "again.marey", "--json").stdout)
            self.assertEqual(summary["frames"], 60)
            self.assertEqual(summary["points"]["filled"], 0)
            self.assertGreater(summary["points"]["measured"], 0.7 * 60 * 12)
        self.assertEqual(json.loads(self.marey("info", "again.marey", "--json").stdout).keys(), first.keys())
        self.marey("convert", "first.marey", "walk.c3d", "-q")
        self.marey("convert", "walk.c3d", "bare.marey", "-q")
        self.assertIn("cameras", self.refused("bare.marey"))

    def test_names_are_kept_when_a_take_is_solved_again(self):
        self.marey("simulate", "room", "--motion", "walk", "--markers", 20, "--frames", 100, "-o", "named", "-q")
        self.marey("reconstruct", "named/rig.toml", "--observations", "named/observations.csv", "--labels", "named/labels.csv", "-o", "named.marey", "-q")
        for again in (("named.marey",), ("named/rig.toml", "--observations", "named.marey")):
            told = json.loads(self.marey("reconstruct", *again, "-o", "again.marey", "--json", "-q").stdout)
            self.assertEqual(told["labelled"], 20)
        first, second = (json.loads(self.marey("info", take, "--json").stdout) for take in ("named.marey", "again.marey"))
        self.assertEqual({t["label"] for t in first["tracks"]}, {t["label"] for t in second["tracks"]})

    def test_other_formats(self):
        for ending in ("c3d", "trc", "csv"):
            self.marey("reconstruct", "room/rig.toml", "--observations", "room/observations.csv", "-o", f"walk.{ending}", "-q")
            self.assertGreater((self.folder / f"walk.{ending}").stat().st_size, 1000)
        self.assertEqual(list(self.folder.glob("*.part.*")), [])

    def test_a_calibration_for_another_resolution(self):
        half = self.edited("wrong.toml", lambda text: text.replace("size = [640, 512]", "size = [640, 480]"))
        self.assertIn("640", self.refused(half))

    def test_what_cannot_be_used(self):
        self.refused("nothing.toml")
        self.refused("room/rig.toml", "--observations", "nothing.csv")
        self.refused("room/rig.toml", "cam9=room/cam1.mp4")
        self.refused("room/rig.toml", "cam1=room/rig.toml")
        self.refused("room/start.toml", "--observations", "room/observations.csv")
        (self.folder / "names.txt").write_text("head\nhead\n")
        self.assertIn("twice", self.refused("room/rig.toml", "--observations", "room/observations.csv", "--labels", "names.txt"))


if __name__ == "__main__":
    MAREY = sys.argv.pop(1)
    unittest.main()
