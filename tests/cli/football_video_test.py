"""docs/football.md on the real match that it tells of, each command run as it is written there. Skipped where the match is not here.

Usage: football_video_test.py MAREY ROOT [unittest options]; the match is searched for in $MAREY_DATA/football, else beside the checkout.
"""

import collections
import csv
import math
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import tomllib
import unittest

SKIPPED = 77
MAREY = ""
ROOT = pathlib.Path()
MATCH = pathlib.Path()


def blocks(page):
    return [block for language, block in re.findall(r"^```(\w*)\n(.*?)^```$", page.read_text(), re.M | re.S) if not language]


class FootballVideo(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="marey_match_"))
        self.addCleanup(shutil.rmtree, self.folder)
        for file in MATCH.iterdir():
            (self.folder / file.name).symlink_to(file)

    def marey(self, line):
        done = subprocess.run([MAREY, *shlex.split(line)[1:]], capture_output=True, text=True, cwd=self.folder, timeout=900)
        self.assertEqual(done.returncode, 0, f"{line}\n{done.stdout}\n{done.stderr}")

    def test_the_page_as_it_is_written(self):
        pages = self.rig_of_the_page()
        lines = [line for block in pages for line in block.splitlines()
                 if line.startswith("marey ") and "--elements" not in line]  # of another recording
        self.assertEqual([line.split()[1] for line in lines], ["calibrate", "track", "measure"])
        for line in lines:
            self.marey(line)
        self.the_cameras_are_out_of_step()
        self.all_players_are_tracked()
        for name in ("overlays/left.mp4", "overlays/right.mp4", "above.mp4", "pictures/left.jpg", "report/report.html"):
            self.assertGreater((self.folder / name).stat().st_size, 10_000, name)
        self.marey("marey convert match.csv match.dat --rig pitch.toml")

    def test_the_ball_is_found(self):
        """In the left camera's frames in which it was inspected by eye: on the grass, before trees in the air twice, and coming down."""
        self.rig_of_the_page()
        self.marey("marey calibrate pitch rig.toml --points left=left_keypoints.xml --points right=right_keypoints.xml --size 105x68 -o pitch.toml")
        self.marey("marey track pitch.toml --ground --ball --format mot --camera left -o left.txt")
        boxes = collections.defaultdict(list)
        for line in (self.folder / "left.txt").read_text().splitlines():
            frame, _, left, top, width, height = map(float, line.split(",")[:6])
            if max(width, height) < 30:  # px: no person is as small here
                boxes[int(frame) - 1].append((left + width / 2, top + height / 2))
        self.assertGreaterEqual(len(boxes), 45)
        for frame, ball in {27: (2696, 1309), 200: (2849, 640), 222: (2141, 679), 234: (1718, 879)}.items():
            self.assertEqual(len(boxes[frame]), 1, frame)
            self.assertLess(math.dist(boxes[frame][0], ball), 15, frame)

    def rig_of_the_page(self):
        pages = blocks(ROOT / "docs" / "football.md")
        (self.folder / "rig.toml").write_text(next(block for block in pages if block.startswith("[[camera]]")))
        return pages

    def the_cameras_are_out_of_step(self):
        """By the steps of a runner the right camera was started four frames after the left one."""
        with open(self.folder / "pitch.toml", "rb") as file:
            cameras = {camera["name"]: camera for camera in tomllib.load(file)["camera"]}
        self.assertAlmostEqual(cameras["right"]["offset_s"] - cameras["left"]["offset_s"], 0.16, delta=0.06)

    def all_players_are_tracked(self):
        """22 players, a referee, and his two assistants, who stand at the touchlines and are hard to see.

        With the right camera's clock moved by up to 8 ms, 21 to 24 people stay (bench/tuning.md): the bounds are of the clock
        that is found, and of tracks without doubles.
        """
        with open(self.folder / "match.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        lasting = collections.Counter(row["id"] for row in rows)
        stayed = {person for person, count in lasting.items() if count > 225}
        self.assertGreaterEqual(len(stayed), 22)
        self.assertLessEqual(len(lasting), 28)  # several short ones are of one
        teams = collections.Counter({row["id"]: row["team"] for row in rows}.values())
        self.assertGreaterEqual(min(teams["white"], teams["blue"]), 9)
        both = {row["id"] for row in rows if len(row["cameras"].split()) == 2}
        self.assertGreaterEqual(len(both), 8)


if __name__ == "__main__":
    MAREY = sys.argv.pop(1)
    ROOT = pathlib.Path(sys.argv.pop(1))
    MATCH = pathlib.Path(os.environ.get("MAREY_DATA", ROOT.parent / "shared" / "data")) / "football"
    if not MATCH.is_dir():
        print(f"{MATCH} is not here (CONTRIBUTING.md tells where it comes from)")
        sys.exit(SKIPPED)
    unittest.main()
