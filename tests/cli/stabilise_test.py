"""`marey track --stabilise`: a fixed shaking camera, in the image and on the ground, and videos that cannot be stabilised.

Usage: stabilise_test.py MAREY [unittest options]. Nothing else is needed.
"""

import json
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile
import unittest

MAREY = ""
SIZE = (160, 120)


def scene(seed):
    """An image with corners, 40 px larger than SIZE: rows of grey levels."""
    rnd = random.Random(seed)
    rows = [[110] * (SIZE[0] + 40) for _ in range(SIZE[1] + 40)]
    for _ in range(160):
        x, y, w, h, level = rnd.randrange(190), rnd.randrange(150), rnd.randrange(4, 14), rnd.randrange(4, 14), rnd.randrange(40, 210)
        for row in rows[y:y + h]:
            row[x:x + w] = [level] * len(row[x:x + w])
    return rows


def write_images(folder, pictures):
    folder.mkdir()
    for i, rows in enumerate(pictures):
        (folder / f"{i:04}.pgm").write_bytes(b"P5\n%d %d\n255\n" % (len(rows[0]), len(rows)) + b"".join(map(bytes, rows)))


def window(rows, x, y):
    return [row[20 + x:20 + x + SIZE[0]] for row in rows[20 + y:20 + y + SIZE[1]]]


class Stabilise(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="marey_steady_"))
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        film = ("--situation", "crowd", "--seed", "5", "--size", "640", "360", "--height", "60", "--frames", "150", "-q")
        cls.reports = {}
        cls.run_marey("simulate", "people", "-o", "still", *film)
        cls.run_marey("simulate", "people", "-o", "shaken", "--shake", "6", *film)

    @classmethod
    def run_marey(cls, *arguments, code=0):
        done = subprocess.run([MAREY, *arguments], capture_output=True, text=True, cwd=cls.folder, timeout=280)
        assert done.returncode == code, f"{arguments}\n{done.returncode}\n{done.stdout}\n{done.stderr}"
        return done

    def tracked(self, film, *options):
        """The report of tracking the video, whose tracks are in FILM/tracks_OPTIONS.txt; computed once."""
        key = (film, *options)
        if key not in self.reports:
            self.reports[key] = json.loads(self.run_marey("track", f"{film}/video.mp4", "-o", self.tracks(*key), "--json", *options).stdout)
        return self.reports[key]

    @staticmethod
    def tracks(film, *options):
        return f"{film}/tracks{''.join(options)}.txt"

    def idf1(self, film, *options):
        self.tracked(film, *options)
        score = self.run_marey("evaluate", "--truth", f"{film}/truth.txt", "--tracks", self.tracks(film, *options), "--json")
        return json.loads(score.stdout)["idf1"]

    def test_people_before_a_shaking_camera_are_tracked_as_before_one_that_stands(self):
        self.assertEqual((self.folder / "still/truth.txt").read_text(), (self.folder / "shaken/truth.txt").read_text())
        still, shaken, steadied = self.idf1("still"), self.idf1("shaken"), self.idf1("shaken", "--stabilise")
        print(f"IDF1: still {still:.3f}, shaken {shaken:.3f}, stabilised {steadied:.3f}")
        self.assertGreater(still - shaken, 0.2)
        self.assertLess(still - steadied, 0.1)

    def test_it_is_stated_how_far_the_camera_moved_and_that_stabilised_would_help(self):
        self.assertIn("--stabilise", "".join(self.tracked("shaken")["warnings"]))
        report = self.tracked("shaken", "--stabilise")
        self.assertEqual(report["warnings"], [])
        self.assertRegex(report["notes"][0], r"stabilised 150 of 150 images: the camera moved by \d+\.\d px")
        self.assertEqual(self.tracked("still")["warnings"], [])

    def test_the_same_video_gives_the_same_tracks_and_an_overlay(self):
        self.tracked("shaken", "--stabilise")
        self.run_marey("track", "shaken/video.mp4", "--stabilise", "-o", "again.txt", "--overlay", "again.mp4", "-q")
        self.assertEqual((self.folder / "again.txt").read_bytes(), (self.folder / self.tracks("shaken", "--stabilise")).read_bytes())
        self.assertTrue((self.folder / "again.mp4").stat().st_size)

    def test_on_the_ground_and_live(self):
        for name, film, *options in (("still", "still"), ("without", "shaken"), ("with", "shaken", "--stabilise")):
            self.run_marey("track", f"{film}/rig.toml", "--ground", "-o", f"{name}.csv", "-q", *options)
        scores = {name: json.loads(self.run_marey("evaluate", "--truth", "still.csv", "--tracks", f"{name}.csv", "--distance", "1",
                                                  "--json").stdout) for name in ("without", "with")}
        self.assertGreater(scores["with"]["idf1"], scores["without"]["idf1"] + 0.1)
        self.run_marey("track", "shaken/video.mp4", "--stabilise", "--live", "-o", "live.txt", "-q")
        self.assertTrue((self.folder / "live.txt").read_text())

    def test_images_that_show_nothing_that_stands_are_refused(self):
        rnd = random.Random(1)
        flat = [[[118 + rnd.randrange(3) for _ in range(SIZE[0])] for _ in range(SIZE[1])] for _ in range(25)]
        write_images(self.folder / "flat", flat)
        done = self.run_marey("track", "flat", "--rate", "10", "--stabilise", "-o", "none.txt", code=1)
        self.assertIn("nothing that stands", done.stderr)
        self.assertEqual(len(done.stderr.strip().splitlines()), 1)
        self.assertFalse((self.folder / "none.txt").exists())

    def test_black_images_and_a_cut_are_excluded_and_stated(self):
        here, there, rnd = scene(1), scene(2), random.Random(3)
        pictures = [[[0] * SIZE[0]] * SIZE[1]]
        pictures += [window(here, rnd.randrange(-4, 5), rnd.randrange(-4, 5)) for _ in range(40)]
        pictures += [window(there, 0, 0)] * 20
        write_images(self.folder / "cut", pictures)
        report = json.loads(self.run_marey("track", "cut", "--rate", "10", "--stabilise", "-o", "cut.txt", "--json").stdout)
        self.assertEqual(report["frames"], 40)
        self.assertIn("21 of 61 images could not be stabilised", "".join(report["warnings"]))

    def test_where_max_would_be_excluded_nothing_is_stabilised_and_that_is_stated(self):
        scenes = [scene(seed) for seed in range(10, 14)]
        pictures = [window(scenes[0], 0, 0) for _ in range(25)] + [window(scenes[1 + i // 12], i % 3, 0) for i in range(36)]
        write_images(self.folder / "most", pictures)
        report = json.loads(self.run_marey("track", "most", "--rate", "10", "--stabilise", "-o", "most.txt", "--json").stdout)
        self.assertEqual(report["frames"], 61)
        self.assertRegex("".join(report["warnings"]), r"--stabilise would omit too many images \(\d+ of \d+ of the beginning could not be stabilised\)")

    def test_what_it_cannot_be_requested_for(self):
        self.run_marey("track", "--detections", "still/truth.txt", "--stabilise", "-o", "none.txt", code=2)
        self.run_marey("track", "shaken/video.mp4", "--targets", "markers", "--stabilise", "-o", "none.txt", code=2)


if __name__ == "__main__":
    MAREY = sys.argv.pop(1)
    unittest.main()
