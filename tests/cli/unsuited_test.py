"""`marey track` of images that background subtraction is not made for: each time a warning names the cause. And of a real room, where people
come near the camera one after another, if its video is there (MAREY_DATA).

Usage: unsuited_test.py MAREY ROOT [unittest options].
"""

import csv
import json
import os
import pathlib
import pty
import random
import shutil
import subprocess
import sys
import tempfile
import unittest

from stabilise_test import scene, window, write_images

MAREY = ""
ROOT = pathlib.Path()
# When a person is in clips/walk_in_room.mp4, six people one after another: frames in which 2 % of the image, a fifth of a person, differ by 60
# levels from the empty room, as no shadow does.
VISITS = ((61, 195), (228, 445), (503, 695), (746, 865), (922, 1196), (1236, 1357))


def run(*arguments):
    done = subprocess.run([MAREY, *map(str, arguments)], capture_output=True, text=True, timeout=280)
    assert done.returncode == 0, f"{arguments}\n{done.stdout}\n{done.stderr}"
    return done


class Unsuited(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="marey_unsuited_"))
        cls.addClassCleanup(shutil.rmtree, cls.folder)

    def warnings(self, name, pictures, *options):
        write_images(self.folder / name, pictures)
        done = run("track", self.folder / name, "--rate", "10", "-o", self.folder / f"{name}.txt", "--json", *options)
        return json.loads(done.stdout)["warnings"]

    def test_a_camera_that_stands_is_not_warned_of(self):
        here = scene(1)
        said = self.warnings("still", [window(here, 0, 0)] * 60)
        self.assertEqual(len(said), 1, said)
        self.assertIn("no person was found", said[0])  # which is so, and all there is to say

    def test_a_camera_that_pans_and_what_to_do(self):
        here = scene(4)
        said = self.warnings("pan", [window(here, -20 + i // 2, 0) for i in range(80)])
        self.assertRegex(said[0], r"the camera pans or tilts, by \d+ % of the image's width between 0\.\d and 7\.\d s.*marey calibrate ptz")
        self.assertNotIn("--stabilise", "".join(said))

    def test_a_camera_that_was_rotated_once(self):
        here = scene(4)
        said = self.warnings("turned", [window(here, -10 + 20 * (i >= 60), 0) for i in range(150)])
        self.assertRegex(said[0], r"the camera was turned by 1\d % of the image's width at about [4-7]\.\d s.*--stabilise")

    def test_a_video_that_is_cut_and_where(self):
        scenes = [scene(seed) for seed in (5, 6, 7)]
        for options in ((), ("--live",)):
            with self.subTest(options):
                said = self.warnings(f"cut{len(options)}", [window(scenes[i // 30], 0, 0) for i in range(90)], *options)
                self.assertIn("the video is cut at 3.0, 6.0 s:", said[0])

    def test_on_the_ground_the_same_is_stated(self):
        scenes = [scene(seed) for seed in (5, 6)]
        films = {"ground_cut": [window(scenes[i // 30], 0, 0) for i in range(60)],
                 "ground_pan": [window(scenes[0], -20 + i // 2, 0) for i in range(80)]}
        for name, pictures in films.items():
            write_images(self.folder / name, pictures)
        (self.folder / "rig.toml").write_text(
            "".join(f'[[camera]]\nname = "{name}"\nsource = "{name}"\nsize = [160, 120]\n'
                    "ground_from_image = [[0.1, 0.0, 0.0], [0.0, 0.1, 0.0], [0.0, 0.0, 1.0]]\n" for name in films))
        done = run("track", self.folder / "rig.toml", "--ground", "--area", "0,0 16,0 16,12 0,12", "--rate", "10", "-o", self.folder / "ground.csv", "--json")
        said = "\n".join(json.loads(done.stdout)["warnings"])
        self.assertIn('camera "ground_cut": the video is cut at 3.0 s', said)
        self.assertIn('camera "ground_pan": the camera pans or tilts', said)

    def test_a_terminal_is_reported_before_the_end(self):
        scenes = [scene(seed) for seed in (5, 6)]
        write_images(self.folder / "early", [window(scenes[i // 30], 0, 0) for i in range(60)])
        here, terminal = pty.openpty()
        self.addCleanup(os.close, here)
        done = subprocess.run([MAREY, "track", self.folder / "early", "--rate", "10", "-o", self.folder / "early.txt"], stdout=subprocess.PIPE,
                              stderr=terminal, timeout=280)
        os.close(terminal)
        self.assertEqual(done.returncode, 0)
        text = ""
        try:
            while part := os.read(here, 4096):
                text += part.decode()
        except OSError:  # its other end is closed
            pass
        first, last = text.index("the video is cut at 3.0 s: the scene is another from there on"), text.index("warning: the video is cut at 3.0 s:")
        self.assertLess(first, last)

    def test_a_screen_that_is_scrolled(self):
        draw, here = random.Random(8), scene(8)
        page = [[draw.choice((30, 240)) for _ in range(45)] for _ in range(400)]  # coarse letters, twice as large below
        pictures = []
        for i in range(80):
            rows = [list(row) for row in window(here, 0, 0)]
            for y in range(24, 116):
                line = page[(y + 3 * max(0, i - 5)) // 2]
                rows[y][50:140] = [level for level in line for _ in range(2)]
            pictures.append(rows)
        self.assertIn("as on a screen that is scrolled", "".join(self.warnings("screen", pictures)))

    def test_what_leaves_its_position_from_image_to_image(self):
        draw, here = random.Random(3), scene(9)
        pictures = []
        for _ in range(60):
            rows = [list(row) for row in window(here, 0, 0)]
            for _ in range(3):
                x, y = draw.randrange(140), draw.randrange(80)
                for row in rows[y:y + 30]:
                    row[x:x + 11] = [250] * 11
            pictures.append(rows)
        self.assertIn("a time lapse", "".join(self.warnings("lapse", pictures)))


class Room(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.video = pathlib.Path(os.environ.get("MAREY_DATA") or ROOT.parent / "shared" / "data") / "clips" / "walk_in_room.mp4"
        if not cls.video.exists():
            raise unittest.SkipTest(f"{cls.video} is not there; set MAREY_DATA")
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="marey_room_"))
        cls.addClassCleanup(shutil.rmtree, cls.folder)

    def test_a_person_coming_near_is_one_person(self):
        for options in ((), ("--live",), ("--stabilise",)):
            with self.subTest(options):
                report = json.loads(run("track", self.video, "-o", self.folder / "room.csv", "--json", *options).stdout)
                self.assertEqual(report["warnings"], [])
                self.assertEqual(report["frames"], 1394)
                at_once, frames_of = {}, {}
                with open(self.folder / "room.csv", encoding="utf-8") as file:
                    for row in csv.DictReader(file):
                        at_once[int(row["frame"])] = at_once.get(int(row["frame"]), 0) + 1
                        frames_of.setdefault(row["id"], set()).add(int(row["frame"]))
                self.assertLessEqual(max(at_once.values()), 2)
                self.assertLessEqual(len(frames_of), len(VISITS) + 1)
                for begin, end in VISITS:
                    covered = max(len(frames & set(range(begin, end + 1))) for frames in frames_of.values()) / (end + 1 - begin)
                    print(f"{' '.join(options):9} frames {begin:4} to {end:4}: {covered:.1%}")
                    self.assertGreaterEqual(covered, 0.9 if options == ("--live",) else 0.95)


if __name__ == "__main__":
    MAREY = sys.argv.pop(1)
    ROOT = pathlib.Path(sys.argv.pop(1))
    unittest.main()
