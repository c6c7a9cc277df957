"""One orientation of the ground: over a rig whose ground_from_world is a reflection, the viewer of a take, the viewer of its CSV, the view from above
and the report show a corner of the pitch as the same corner; and what does not specify its orientation is reported.

Usage: orientation_test.py MAREY [unittest options]. ffmpeg decodes the view from above.
"""

import csv
import json
import math
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import shown_page
from shown_page import Shown

WIDTH, LENGTH, ROUND = 68, 105, 5  # m; round the pitch of the view from above, with the default margin


def marey(*arguments, code=0):
    done = subprocess.run([shown_page.MAREY, *map(str, arguments)], capture_output=True, text=True, cwd=shown_page.FOLDER, timeout=300)
    assert done.returncode == code, f"{arguments}\n{done.stdout}\n{done.stderr}"
    return done


def rows_of(name):
    return list(csv.DictReader((shown_page.FOLDER / name).read_text().splitlines()))


def shown(*words):
    """Whether the viewer draws y downwards, and what it says."""
    with Shown(shown_page.MAREY, "view", *words, "--port", "0", "-q") as page:
        scene = page.scene()
        return scene["y_down"], " ".join(scene["warnings"])


def drawn_in_report(folder):
    """(x, y) in m on the page's own image, right and down from the corner that is drawn on the left above, of all first points of paths."""
    page = (shown_page.FOLDER / folder / "report.html").read_text()
    picture = page[page.index("Where every person went") : page.index("One by one")]
    left, top = map(float, re.search(r'viewBox="(\S+) (\S+)', picture).groups())
    down = int(re.search(r'transform="scale\(1 (-?1)\)"', picture)[1])
    return [(float(x) - left - 3, down * float(y) - top - 3) for x, y in re.findall(r'<polyline [^>]*?points="([-\d.]+),([-\d.]+)', picture)]


class Orientation(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        marey("simulate", "match", "--layout", "football", "--seconds", 3, "--seed", 4, "-o", "match", "-q")
        marey("track", "match/rig.toml", "--ground", "--size", "105x68", "-o", "take.marey", "--pitch-view", "above.mp4", "-q")
        marey("convert", "take.marey", "match.csv", "-q")
        rows = rows_of("match.csv")
        columns = [name for name in rows[0] if name != "y_down"]
        with open(shown_page.FOLDER / "old.csv", "w", newline="") as out:  # of another program: it does not specify it
            old = csv.DictWriter(out, [name for name in columns if name not in ("state", "cameras")], extrasaction="ignore")
            old.writeheader()
            old.writerows(rows)

    def test_a_file_states_it(self):
        for name in ("match.csv", "match/truth.csv"):
            self.assertEqual({row["y_down"] for row in rows_of(name)}, {"1"}, name)
        marey("track", "match/rig.toml", "--ground", "--size", "105x68", "-o", "tracked.csv", "-q")
        self.assertEqual(rows_of("tracked.csv")[0]["y_down"], "1")
        self.assertIn("y grows downwards", marey("info", "match.csv").stdout)
        marey("simulate", "match", "--cameras", 1, "--seconds", 1, "-o", "round", "-q")
        self.assertNotIn("y_down", rows_of("round/truth.csv")[0])

    def test_the_viewer_shows_a_csv_as_its_take(self):
        self.assertEqual(shown("take.marey"), (True, ""))
        self.assertEqual(shown("match.csv"), (True, ""))
        down, words = shown("old.csv")
        self.assertFalse(down)
        self.assertIn("old.csv: does not specify whether y grows upwards or downwards", words)
        self.assertEqual(shown("old.csv", "--rig", "match/rig.toml"), (True, ""))
        self.assertEqual(shown("old.csv", "--y-down"), (True, ""))
        marey("view", "old.csv", "--rig", "match/rig.toml", "--y-down", code=2)
        (shown_page.FOLDER / "bare.toml").write_text('[[camera]]\nname = "a"\n')
        self.assertIn("says nothing of the ground", marey("view", "old.csv", "--rig", "bare.toml", code=1).stderr)

    def test_the_view_from_above_shows_a_corner_where_the_viewer_does(self):
        if shutil.which("ffmpeg") is None:
            self.skipTest("ffmpeg is not installed")
        frame = 50
        pixels = subprocess.run(["ffmpeg", "-nostdin", "-v", "error", "-i", "above.mp4", "-vf", f"select=eq(n\\,{frame})", "-frames:v", "1", "-f", "rawvideo",
                                 "-pix_fmt", "rgb24", "-"], capture_output=True, check=True, cwd=shown_page.FOLDER).stdout
        scale = 1280 / (LENGTH + 2 * ROUND)

        def drawn(x, y):
            at = 3 * (int(y * scale) * 1280 + int(x * scale))
            return min(math.dist(pixels[at : at + 3], grass) for grass in ((52, 110, 58), (57, 118, 63))) > 60

        people = [(float(row["x"]) + ROUND, float(row["y"])) for row in rows_of("match.csv") if int(row["frame"]) == frame and row["state"] == "measured"]
        self.assertGreater(len(people), 15)
        downwards = sum(drawn(x, y + ROUND) for x, y in people)
        upwards = sum(drawn(x, WIDTH - y + ROUND) for x, y in people)
        self.assertGreater(downwards, 0.9 * len(people))
        self.assertLess(upwards, 0.6 * len(people))

    def test_the_report_shows_a_corner_where_the_viewer_does(self):
        marey("measure", "match.csv", "-o", "figures.csv", "--report", "report", "-q")
        marey("measure", "take.marey", "-o", "figures.csv", "--report", "take", "-q")
        first = {}
        for row in rows_of("match.csv"):
            first.setdefault(row["id"], (float(row["x"]), float(row["y"])))
        for folder in ("report", "take"):
            drawn = drawn_in_report(folder)
            self.assertGreater(len(drawn), 15)
            for x, y in drawn:  # as from above, the corner (0, 0) on the left above
                self.assertLess(min(abs(x - a) + abs(y - b) for a, b in first.values()), 1.5, folder)
        told = marey("measure", "old.csv", "-o", "figures.csv", "--report", "old")
        self.assertIn("does not specify whether y grows", told.stderr)
        self.assertIn("does not specify whether y grows", (shown_page.FOLDER / "old/report.html").read_text())
        by_x = {round(x, 1): y for x, y in drawn_in_report("report")}
        upwards = drawn_in_report("old")
        self.assertGreater(sum(round(x, 1) in by_x and abs(by_x[round(x, 1)] - (WIDTH - y)) < 0.1 for x, y in upwards), 15)
        for how in (("--rig", "match/rig.toml"), ("--y-down",)):
            self.assertNotIn("does not specify", marey("measure", "old.csv", "-o", "figures.csv", "--report", "old", *how).stderr)
            self.assertEqual(drawn_in_report("old"), drawn_in_report("report"))

    def test_conversions_keep_it(self):
        marey("convert", "match.csv", "by_file.dat", "-q")
        marey("convert", "old.csv", "by_rig.dat", "--rig", "match/rig.toml", "-q")
        marey("convert", "take.marey", "by_take.dat", "-q")
        self.assertEqual((shown_page.FOLDER / "by_file.dat").read_text(), (shown_page.FOLDER / "by_rig.dat").read_text())
        by_take, by_file = (re.split("[:;,]", (shown_page.FOLDER / name).read_text()) for name in ("by_take.dat", "by_file.dat"))
        self.assertEqual(len(by_take), len(by_file))
        for one, other in zip(by_take, by_file):  # cm; the CSV's places are rounded
            self.assertTrue(one == other or abs(float(one) - float(other)) < 1.1, (one, other))
        self.assertEqual(shown("by_file.dat"), (False, ""))  # TRACAB's y grows upwards, whatever the rig's did
        marey("convert", "by_file.dat", "back.csv", "--y-down", "-q")
        self.assertEqual(shown("back.csv"), (True, ""))
        marey("convert", "old.csv", "stated.csv", "--rig", "match/rig.toml", "-q")
        self.assertEqual(shown("stated.csv"), (True, ""))
        marey("convert", "back.csv", "no_cameras.marey", "-q")
        self.assertEqual(shown("no_cameras.marey"), (True, ""))
        self.assertEqual(json.loads(marey("info", "no_cameras.marey", "--json").stdout)["y_down"], True)
        marey("convert", "by_file.dat", "up.marey", "-q")
        self.assertEqual(shown("up.marey"), (False, ""))

    def test_what_is_neither_is_refused(self):
        for values in ("2", "0.5"), ("1", "0"):
            text = "frame,time,id,x,y,y_down\n" + "".join(f"{i},{i / 25},1,3,4,{value}\n" for i, value in enumerate(values))
            (shown_page.FOLDER / "wrong.csv").write_text(text)
            self.assertIn("y_down", marey("info", "wrong.csv", code=1).stderr)


if __name__ == "__main__":
    shown_page.MAREY = str(pathlib.Path(sys.argv.pop(1)).resolve())
    with tempfile.TemporaryDirectory(prefix="marey_orientation_") as folder:
        shown_page.FOLDER = pathlib.Path(folder)
        unittest.main()
