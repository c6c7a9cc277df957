"""Simulated people and the experiment on outlines, as their user sees them.

Usage: people_test.py MAREY [unittest options].
"""

import csv
import json
import math
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

MAREY = ""
SMALL = ["--size", "320", "240", "--frames", "30", "--height", "40", "--quiet"]


def silhouette(size, counts):
    """Pixels of COCO's run lengths: a set of (column, row)."""
    pixels, at, inside = set(), 0, False
    for length in counts:
        if inside:
            pixels.update(divmod(i, size[0]) for i in range(at, at + length))
        at, inside = at + length, not inside
    assert at == size[0] * size[1]
    return pixels


class People(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="marey_people_"))
        self.addCleanup(shutil.rmtree, self.folder)

    def run_marey(self, *arguments, code=0):
        done = subprocess.run([MAREY, *map(str, arguments)], capture_output=True, text=True, cwd=self.folder, timeout=300)
        self.assertEqual(done.returncode, code, f"{arguments}\n{done.stdout}\n{done.stderr}")
        return done

    def test_the_truth_agrees_with_itself(self):
        self.run_marey("simulate", "people", "-o", "film", *SMALL)
        folder = self.folder / "film"
        self.assertEqual(sorted(p.name for p in folder.iterdir()),
                         ["positions.csv", "rig.toml", "silhouettes.jsonl", "truth.txt", "video.mp4"])
        boxes = {}
        for line in (folder / "truth.txt").read_text().splitlines():
            frame, person, left, top, width, height, *_ = map(float, line.split(","))
            boxes[frame - 1, person] = (left - 1, top - 1, width, height)
        self.assertGreater(len(boxes), 60)
        seen = 0
        for line in (folder / "silhouettes.jsonl").read_text().splitlines():
            row = json.loads(line)
            whole, visible = (silhouette(row["size"], row[name]) for name in ("whole", "visible"))
            self.assertLessEqual(visible, whole)
            if not whole:
                continue
            left, top, width, height = boxes[row["frame"], row["id"]]
            self.assertGreaterEqual(min(x for x, _ in whole), left - 1)
            self.assertLessEqual(max(x for x, _ in whole) + 1, left + width + 1)
            self.assertGreaterEqual(min(y for _, y in whole), top - 1)
            self.assertLessEqual(max(y for _, y in whole) + 1, top + height + 1)
            seen += 1
        self.assertGreater(seen, 60)

    def test_the_same_seed_gives_the_same_video(self):
        for name, seed in (("a", 3), ("b", 3), ("c", 4)):
            self.run_marey("simulate", "people", "-o", name, "--seed", seed, *SMALL)
        read = [(self.folder / name / "silhouettes.jsonl").read_bytes() for name in "abc"]
        self.assertEqual(read[0], read[1])
        self.assertNotEqual(read[0], read[2])

    def test_every_filter_finds_people_at_a_low_rate(self):
        self.run_marey("simulate", "people", "-o", "film", "--size", "320", "240", "--height", "40", "--frames", "36", "--rate", "6", "--people", "4",
                       "--situation", "apart", "-q")
        there = {line.split(",")[1] for line in (self.folder / "film/truth.txt").read_text().splitlines()}
        self.assertGreaterEqual(len(there), 2)
        for name in ("imm", "ekf", "ukf", "condensation", "condensation-velocity", "kalman-acceleration", "kalman-paper", "alpha-beta"):
            for live in ([], ["--live"]):
                self.run_marey("track", "film/video.mp4", "--filter", name, "--measured-only", "-o", "t.txt", "-q", *live)
                people = {line.split(",")[1] for line in (self.folder / "t.txt").read_text().splitlines()}
                self.assertGreaterEqual(len(people), len(there), f"{name} {live}")

    def test_a_run_that_finds_none_states_why(self):
        self.run_marey("simulate", "people", "-o", "film", *SMALL, "--people", "0")
        self.assertIn("no person was found: nothing moved", self.run_marey("track", "film/video.mp4", "-o", "t.txt").stderr)
        (self.folder / "boxes.txt").write_text("1,-1,10,10,20,40,1\n2,-1,200,10,20,40,1\n9,-1,90,80,20,40,1\n")
        said = self.run_marey("track", "--detections", "boxes.txt", "--rate", "2", "-o", "t.txt").stderr
        self.assertIn("nowhere for long enough to be trusted", said)
        self.assertIn("2 frames a second", said)

    def test_identify_stands_from_the_beginning_is_on_the_ground_from_the_first_frame(self):
        self.run_marey("simulate", "people", "-o", "film", "--size", "384", "288", "--height", "44", "--frames", "200", "--rate", "10",
                       "--people", "6", "--situation", "standing", "--seed", "3", "-q")
        told = json.loads(self.run_marey("track", "film/rig.toml", "--ground", "-o", "g.csv", "--json", "-q").stdout)
        self.assertTrue(any("second pass over the video" in note for note in told["notes"]), told["notes"])
        with open(self.folder / "film/positions.csv") as truth, open(self.folder / "g.csv") as tracks:
            places = {(int(row["frame"]), int(row["id"])): (float(row["x"]), float(row["y"])) for row in csv.DictReader(truth)}
            seen = {}
            for row in csv.DictReader(tracks):
                seen.setdefault(int(row["frame"]), []).append((float(row["x"]), float(row["y"])))
        found = {person: sum(any(math.dist(place, places[frame, person]) < 1 for place in seen.get(frame, [])) for frame in range(80))
                 for person in (1, 2, 3)}
        print(f"standing people on the ground, frames of 80 in which they are found: {found}")
        self.assertGreaterEqual(sum(count > 70 for count in found.values()), 2)

    def test_masks_show_the_people(self):
        self.run_marey("simulate", "people", "-o", "film", *SMALL)
        self.run_marey("track", "film/video.mp4", "-o", "t.txt", "--foreground-masks", "seen", "-q")
        names = [f"bin{frame:06}.png" for frame in range(1, 31)]
        self.assertEqual(sorted(p.name for p in (self.folder / "seen").iterdir()), names)
        grey = subprocess.run(["ffmpeg", "-v", "error", "-i", "seen/bin%06d.png", "-f", "rawvideo", "-pix_fmt", "gray", "-"],
                              cwd=self.folder, capture_output=True, timeout=60, check=True).stdout
        self.assertEqual(len(grey), 30 * 320 * 240)
        self.assertLessEqual(set(grey), {0, 255})
        people = [set() for _ in range(30)]
        for line in (self.folder / "film/silhouettes.jsonl").read_text().splitlines():
            row = json.loads(line)
            people[row["frame"]] |= silhouette(row["size"], row["visible"])
        hit = union = 0
        for frame in range(30):
            picture = grey[frame * 320 * 240:(frame + 1) * 320 * 240]
            seen = {(i % 320, i // 320) for i, value in enumerate(picture) if value}
            hit += len(seen & people[frame])
            union += len(seen | people[frame])
        print(f"masks: {hit / union:.2f} of the union with the truth")
        self.assertGreater(hit / union, 0.4)

    def test_masks_are_refused_where_there_is_nothing_to_observe_or_something_to_lose(self):
        (self.folder / "boxes.txt").write_text("1,-1,10,10,20,40,1\n2,-1,11,10,20,40,1\n")
        said = self.run_marey("track", "--detections", "boxes.txt", "--rate", "25", "-o", "t.txt", "--foreground-masks", "seen", code=1).stderr
        self.assertIn("detections are given", said)
        self.run_marey("simulate", "people", "-o", "film", *SMALL)
        self.assertIn("not empty", self.run_marey("track", "film/video.mp4", "-o", "t.txt", "--foreground-masks", "film", code=1).stderr)
        # Before the video is inspected, which may take hours.
        (self.folder / "broken.mp4").write_bytes(b"no video")
        self.assertIn("film: is not empty", self.run_marey("track", "broken.mp4", "--stabilise", "-o", "t.txt", "--foreground-masks", "film", code=1).stderr)
        self.run_marey("track", "film/video.mp4", "--targets", "markers", "-o", "t.txt", "--foreground-masks", "seen", code=2)
        self.run_marey("track", "film/rig.toml", "--ground", "-o", "t.csv", "--foreground-masks", "seen", code=2)
        self.assertFalse((self.folder / "seen").exists() or (self.folder / "t.txt").exists())

    def test_people_identify_have_no_room_are_reported(self):
        apart = ("simulate", "people", "--situation", "apart", "--people", "4", "--frames", "2", "-o", "film")
        self.assertIn("2 of 4 people have room to keep apart in 768 x 576 px", self.run_marey(*apart, "--height", "100").stderr)
        self.assertNotIn("warning", self.run_marey(*apart, "--height", "60").stderr)
        self.assertIn("is of 2 people", self.run_marey("simulate", "people", "--situation", "crossing", "--people", "3", "--frames", "2", "-o", "film").stderr)

    def test_what_cannot_be_is_refused(self):
        said = self.run_marey("simulate", "people", "-o", "film", "--size", "100", "100", "--height", "400", code=1).stderr
        self.assertIn("400 px tall do not fit", said)
        self.assertIn("no_such.png", self.run_marey("simulate", "people", "--background-image", "no_such.png", code=1).stderr)
        for wrong in (["--light", "green"], ["--situation", "dance"], ["--people", "-1"], ["--frames", "0"]):
            self.run_marey("simulate", "people", *wrong, code=2)
        self.assertIn("holds", self.run_marey("experiment", "outlines", "--only", "nothing like it", code=1).stderr)
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_the_experiment_reports_every_method(self):
        said = self.run_marey("experiment", "outlines", "--videos", 1, "--only", "partly hidden, 25", "--json", "--quiet").stdout
        case, = json.loads(said)["cases"]
        self.assertEqual(case["people"], 2)
        self.assertEqual(len(case["methods"]), 4)
        for name, method in case["methods"].items():
            self.assertTrue(0 <= method["iou"] <= 1, name)
            self.assertTrue(0 <= method["lost"] <= 2, name)
        self.assertGreater(case["methods"]["Marey"]["iou"], case["methods"]["published (Arnaut & Costa)"]["iou"])

    def test_the_experiment_with_hypotheses_reports_every_association(self):
        said = self.run_marey("experiment", "hypotheses", "--scenes", 3, "--json", "--quiet").stdout
        told = json.loads(said)
        self.assertEqual(told["scenes"], 3)
        for kind in told["kinds"]:
            switches = {name: method["switches"] for name, method in kind["methods"].items()}
            self.assertLess(switches["mht"], switches["gnn"], kind["meeting"])
        self.assertIn("identity switches", self.run_marey("experiment", "hypotheses", "--scenes", 1).stdout)
        self.run_marey("experiment", "hypotheses", "--scenes", 0, code=2)


if __name__ == "__main__":
    MAREY = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main()
