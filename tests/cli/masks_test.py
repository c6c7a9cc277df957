"""`marey evaluate` of masks against TrackEval's figures; contours written as MOTS text and COCO instances.

Usage: masks_test.py MAREY [unittest options]

tests/data/mots holds made cases (discs that move, are missed, exchange identities) and what TrackEval 1.3.0 (MOTSChallenge, the
class pedestrian) prints of them.
"""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

MAREY = ""
DATA = pathlib.Path(__file__).resolve().parents[1] / "data" / "mots"


def marey(*arguments, **options):
    return subprocess.run([MAREY, *map(str, arguments)], capture_output=True, text=True, timeout=300, **options)


class Masks(unittest.TestCase):
    def test_the_figures_are_those_of_trackeval(self):
        for name, expected in json.loads((DATA / "trackeval.json").read_text()).items():
            done = marey("evaluate", "--truth", DATA / f"{name}_truth.txt", "--tracks", DATA / f"{name}_tracks.txt", "--json")
            self.assertEqual(done.returncode, 0, done.stderr)
            found = json.loads(done.stdout)
            for figure, value in expected.items():
                with self.subTest(case=name, figure=figure):
                    self.assertAlmostEqual(found[figure], value, delta=1e-9)

    def test_of_the_truth_itself_is_perfect(self):
        truth = DATA / "plain_truth.txt"
        found = json.loads(marey("evaluate", "--truth", truth, "--tracks", truth, "--json").stdout)
        for figure in ("smotsa", "motsp", "hota", "idf1"):
            self.assertAlmostEqual(found[figure], 1, msg=figure, delta=1e-12)

    def test_contours_are_written_as_masks(self):
        with tempfile.TemporaryDirectory() as folder:
            options = {"cwd": folder}
            made = marey("simulate", "people", "--situation", "overlap", "--frames", 50, "--seed", 4, "-o", "people", "-q", **options)
            self.assertEqual(made.returncode, 0, made.stderr)
            for form in ("mots", "coco-instances"):
                done = marey("track", "people/video.mp4", "--contour", "--format", form, "-o", form, "-q", **options)
                self.assertEqual(done.returncode, 0, done.stderr)
            rows = [line.split() for line in pathlib.Path(folder, "mots").read_text().splitlines()]
            self.assertGreater(len(rows), 40)
            self.assertEqual({tuple(row[2:5]) for row in rows}, {("2", "576", "768")})
            coco = json.loads(pathlib.Path(folder, "coco-instances").read_text())
            self.assertEqual(len(coco["images"]), 50)
            self.assertGreaterEqual(len(coco["annotations"]), len(rows))
            # The same contours: whole in COCO, their visible part in MOTS.
            same = json.loads(marey("evaluate", "--truth", "coco-instances", "--tracks", "mots", "--json", **options).stdout)
            self.assertGreater(same["motsp"], 0.85)
            self.assertEqual(same["fp"], 0)
            boxes = marey("convert", "mots", "boxes.csv", "--rate", 25, **options)
            self.assertEqual(boxes.returncode, 0, boxes.stderr)
            self.assertEqual(len(pathlib.Path(folder, "boxes.csv").read_text().splitlines()), len(rows) + 1)

    def test_malformed_masks_are_refused(self):
        with tempfile.TemporaryDirectory() as folder:
            bad = pathlib.Path(folder, "bad.txt")
            bad.write_text("1 5 2 4 3 534\n2 5 2 4 3 53\n")
            done = marey("evaluate", "--truth", bad, "--tracks", DATA / "plain_tracks.txt")
            self.assertEqual(done.returncode, 1)
            self.assertIn("bad.txt:2:", done.stderr)
            other = pathlib.Path(folder, "other.txt")
            other.write_text("1 5 2 4 3 534\n")
            done = marey("evaluate", "--truth", other, "--tracks", DATA / "plain_tracks.txt")
            self.assertEqual(done.returncode, 1)
            self.assertIn("expected one size", done.stderr)

    def test_masks_of_targets_and_figures_of_their_contours(self):
        with tempfile.TemporaryDirectory() as folder:
            options = {"cwd": folder}
            made = marey("simulate", "people", "--situation", "apart", "--people", 3, "--frames", 40, "--seed", 2, "-o", "people", "-q", **options)
            self.assertEqual(made.returncode, 0, made.stderr)
            done = marey("track", "people/video.mp4", "--contour", "-o", "take.marey", "--target-masks", "masks", "-q", **options)
            self.assertEqual(done.returncode, 0, done.stderr)
            masks = sorted(pathlib.Path(folder, "masks").iterdir())
            self.assertEqual([path.name for path in masks], [f"target{i + 1:06}.png" for i in range(40)])
            self.assertEqual(masks[0].read_bytes()[24:26], bytes([16, 0]), "16 bits, grey")
            again = marey("track", "people/video.mp4", "--contour", "-o", "other.marey", "--target-masks", "masks", "-q", **options)
            self.assertEqual(again.returncode, 1)
            self.assertIn("is not empty", again.stderr)
            alone = marey("track", "people/video.mp4", "-o", "other.marey", "--target-masks", "others", "-q", **options)
            self.assertEqual(alone.returncode, 2, "--target-masks needs --contour")
            measured = marey("measure", "take.marey", "-o", "bodies.csv", "--series", "series.csv", "--json", **options)
            self.assertEqual(measured.returncode, 0, measured.stderr)
            found = json.loads(measured.stdout)
            self.assertEqual(found["unit"], "px")
            self.assertGreaterEqual(len(found["people"]), 2)
            for person in found["people"]:
                self.assertGreater(person["measured"], 10)
                self.assertTrue(40 < person["height"]["mean"] < 80, person)
                self.assertLess(person["width"]["mean"], person["height"]["mean"])
                self.assertLess(abs(person["lean_deg"]["mean"]), 25)
                for figure in ("area", "width", "height", "lean_deg", "leg_opening"):
                    self.assertGreater(person[figure]["sigma"], 0)
            rows = pathlib.Path(folder, "series.csv").read_text().splitlines()
            self.assertTrue(rows[0].startswith("frame,time,id,area_px2,area_px2_sigma,width_px,"), rows[0])
            self.assertEqual(len(rows) - 1, sum(person["measured"] for person in found["people"]))

    def test_what_has_no_contours_is_refused(self):
        with tempfile.TemporaryDirectory() as folder:
            options = {"cwd": folder}
            made = marey("simulate", "people", "--situation", "apart", "--people", 2, "--frames", 30, "--seed", 2, "-o", "people", "-q", **options)
            self.assertEqual(made.returncode, 0, made.stderr)
            marey("track", "people/video.mp4", "-o", "take.marey", "-q", **options)
            done = marey("measure", "take.marey", "-o", "bodies.csv", "-q", **options)
            self.assertEqual(done.returncode, 1)
            self.assertIn("without contours", done.stderr)
            self.assertFalse(pathlib.Path(folder, "bodies.csv").exists())


if __name__ == "__main__":
    MAREY = sys.argv.pop(1)
    unittest.main()
