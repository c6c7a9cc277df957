"""Markers from the command line, as their user meets them: simulated, tracked, named; and input that cannot be used.

Usage: markers_test.py MAREY [unittest options]
"""

import csv
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

MAREY = ""


class Markers(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="marey_markers_"))
        self.addCleanup(shutil.rmtree, self.folder)

    def marey(self, *arguments, code=0):
        done = subprocess.run([MAREY, *map(str, arguments)], capture_output=True, text=True, cwd=self.folder, timeout=300)
        self.assertEqual(done.returncode, code, f"{arguments}\n{done.stdout}\n{done.stderr}")
        return done

    def rows(self, name):
        with open(self.folder / name, newline="") as file:
            return list(csv.DictReader(file))

    def names(self, *lines):
        (self.folder / "names.txt").write_text("\n".join(lines) + "\n")

    def far_from_truth(self, tracks, truth):
        """Rows whose label, by its truth's first place, is not within 2 px of that marker."""
        places = {(row["frame"], row["label"]): (float(row["x"]), float(row["y"])) for row in truth if row["visible"] == "1"}
        first = sorted((float(row["x"]), float(row["y"]), row["label"]) for row in truth if row["frame"] == "0")
        true_name = {name: label for name, (_, _, label) in zip(("left", "right"), first)}
        far = 0
        for row in tracks:
            place = places.get((row["frame"], true_name[row["label"]]))
            far += place is not None and abs(float(row["x"]) - place[0]) + abs(float(row["y"]) - place[1]) > 2
        return far

    def test_crossing_markers_keep_their_names(self):
        self.marey("simulate", "markers", "crossing", "--seed", 3, "-o", "crossing")
        self.names("left", "right")
        for mode in ([], ["--live"], ["--estimate-noise"], ["--filter", "kalman-acceleration"]):
            with self.subTest(mode=mode):
                self.marey("track", "crossing/video.mp4", "--targets", "markers", "--labels", "names.txt", "-o", "t.csv", *mode)
                tracks = self.rows("t.csv")
                self.assertEqual({row["label"] for row in tracks}, {"left", "right"})
                self.assertEqual(len(tracks), 160)
                self.assertLessEqual(self.far_from_truth(tracks, self.rows("crossing/truth.csv")), 16)

    def test_detected_markers_are_written_drawn_and_tracked(self):
        self.marey("simulate", "markers", "crossing", "--seed", 3, "-o", "crossing", "-q")
        done = self.marey("detect", "crossing/video.mp4", "-o", "blobs.csv", "--overlay", "blobs.mp4", "--json")
        summary = json.loads(done.stdout)
        rows = self.rows("blobs.csv")
        self.assertEqual(len(rows), summary["markers"])
        self.assertEqual(summary["frames"], 80)
        self.assertGreater(len(rows), 150)
        self.assertTrue(all(0 < float(row["var_x"]) < 0.1 and float(row["area"]) > 20 for row in rows))
        self.assertTrue((self.folder / "blobs.mp4").exists())
        self.marey("detect", "crossing/video.mp4", "-o", "blobs.jsonl", "--overlay", "first.png", "-q")
        self.assertEqual((self.folder / "first.png").read_bytes()[1:4], b"PNG")
        self.names("left", "right")
        for name in ("blobs.csv", "blobs.jsonl"):
            self.marey("track", "--targets", "markers", "--detections", name, "--labels", "names.txt", "-o", "t.csv", "-q")
            tracks = self.rows("t.csv")
            self.assertEqual({row["label"] for row in tracks}, {"left", "right"})
            self.assertLessEqual(self.far_from_truth(tracks, self.rows("crossing/truth.csv")), 16)
        self.assertIn("blobs", self.marey("info", "blobs.jsonl").stdout)
        one = self.marey("detect", "first.png", "-o", "-", "-q").stdout
        self.assertTrue(one.startswith("camera,frame,time,x,y,"))

    def test_blobs_that_cannot_be_used_are_refused(self):
        head = "camera,frame,x,y\n"
        for text, said in ((head + "a,0,1,2\nb,0,3,4\n", "several cameras"), (head + "a,5,1,2\na,3,3,4\n", "sort the lines"),
                           (head + "a,0,x,2\n", "must be a number"), (head + "a,-1,1,2\n", "whole number from 0")):
            with self.subTest(said=said):
                (self.folder / "blobs.csv").write_text(text)
                done = self.marey("track", "--targets", "markers", "--detections", "blobs.csv", "-o", "t.csv", code=1)
                self.assertIn(said, done.stderr)

    def test_the_same_seed_gives_the_same_files(self):
        for name in ("a", "b"):
            self.marey("simulate", "markers", "plain", "--seed", 9, "--frames", 12, "--markers", 5, "-o", name, "-q")
        for name in ("truth.csv", "video.mp4"):
            self.assertEqual((self.folder / "a" / name).read_bytes(), (self.folder / "b" / name).read_bytes())

    def test_overlay_and_summary(self):
        self.marey("simulate", "markers", "plain", "--frames", 20, "--markers", 4, "-o", "plain", "-q")
        done = self.marey("track", "plain/video.mp4", "--targets", "markers", "-o", "t.jsonl", "--overlay", "o.mp4", "--json")
        summary = json.loads(done.stdout)
        self.assertEqual((summary["frames"], summary["markers"], summary["rows"]), (20, 4, 80))
        self.assertTrue((self.folder / "o.mp4").stat().st_size > 1000)

    def test_labels_that_do_not_fit(self):
        self.marey("simulate", "markers", "crossing", "--frames", 12, "-o", "crossing", "-q")
        track = ("track", "crossing/video.mp4", "--targets", "markers", "-o", "t.csv", "--labels", "names.txt")
        for lines, said in (
            (("a", "b", "c"), "3 labels, but 2 markers"),
            (("a", "a"), 'names.txt:2: the name "a" occurs twice'),
            (("", " "), "holds no name"),
        ):
            with self.subTest(lines=lines):
                self.names(*lines)
                self.assertIn(said, self.marey(*track, code=1).stderr)
                self.assertFalse((self.folder / "t.csv").exists())
        self.names("only")
        self.marey(*track)
        self.assertEqual({row["label"] for row in self.rows("t.csv")}, {"only", ""})

    def test_no_marker_in_view(self):
        self.record("black.mp4", "color=black:size=320x240:rate=25")
        done = self.marey("track", "black.mp4", "--targets", "markers", "-o", "t.csv")
        self.assertIn("no marker was seen in any frame", done.stderr)
        self.assertEqual(self.rows("t.csv"), [])

    def test_a_saturated_image(self):
        self.record("white.mp4", "color=white:size=320x240:rate=25")
        self.assertIn("no marker was seen", self.marey("track", "white.mp4", "--targets", "markers", "-o", "t.csv").stderr)

    def test_glare_is_bounded(self):
        self.marey("simulate", "markers", "plain", "--frames", 6, "--clutter", 1000, "--radius", 1.5, "-o", "glare", "-q")
        self.marey("track", "glare/video.mp4", "--targets", "markers", "-o", "t.csv")

    def test_options_that_cannot_be_used(self):
        self.marey("simulate", "markers", "plain", "--frames", 6, "-o", "plain", "-q")
        track = ("track", "plain/video.mp4", "--targets", "markers", "-o", "t.csv")
        self.assertIn("cannot be read", self.marey(*track, "--labels", "no.txt", code=1).stderr)
        self.assertIn("no such file", self.marey(*track, "--mask", "no.png", code=1).stderr)
        self.assertIn("colour", self.marey(*track, "--colour", "blue-ish", code=2).stderr)
        self.marey(*track, "--filter", "magic", code=2)
        self.marey("simulate", "markers", "juggling", code=2)

    def test_experiment_prints_the_papers_tables(self):
        done = self.marey("experiment", "trackers", "--videos", 1, "--output", "plots")
        for title in ("Table I.", "Table II.", "Table III.", "Table IV.", "Tables V-VII."):
            self.assertIn(title, done.stdout)
        self.assertEqual(len(list((self.folder / "plots").glob("*.svg"))), 6)
        marey = [line for line in done.stdout.splitlines() if line.startswith("Marey ")][0]
        self.assertEqual(marey.split()[1:], ["0"] * 5, "Marey's own tracker lost a name")

    def record(self, name, source):
        subprocess.run(["ffmpeg", "-nostdin", "-v", "error", "-f", "lavfi", "-i", source, "-t", "1", self.folder / name], check=True)


if __name__ == "__main__":
    MAREY = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main(verbosity=2)
