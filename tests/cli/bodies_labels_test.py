"""docs/bodies.md and docs/labels.md, each command run as it is written there; what comes out against the simulation's truth; what cannot be.

Usage: bodies_labels_test.py MAREY ROOT [unittest options]
"""

import csv
import json
import math
import pathlib
import re
import shlex
import shutil
import sqlite3
import subprocess
import sys
import tempfile
import unittest

MAREY = ""
ROOT = pathlib.Path()


def commands(page):
    """The lines of the page's blocks that call the program, in order."""
    lines, inside = [], None  # within which kind of block
    for line in page.read_text().splitlines():
        if line.startswith("```"):
            inside = line[3:] if inside is None else None
        elif inside == "" and line.startswith("marey "):
            lines.append(line)
    return lines


class BodiesAndLabels(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="marey_bodies_"))
        self.addCleanup(shutil.rmtree, self.folder)

    def marey(self, *arguments, code=0):
        done = subprocess.run([MAREY, *map(str, arguments)], capture_output=True, text=True, cwd=self.folder, timeout=600)
        self.assertEqual(done.returncode, code, f"{arguments}\n{done.stdout}\n{done.stderr}")
        return done

    def rows(self, name):
        with open(self.folder / name, newline="") as file:
            return list(csv.DictReader(file))

    def run_page(self, name):
        lines = commands(ROOT / "docs" / name)
        self.assertGreaterEqual(len(lines), 4)
        for line in lines:
            self.marey(*shlex.split(line)[1:])

    def test_marker_sets_of_the_field_are_known_by_name(self):
        labels = ("LASI", "RASI", "SACR", "LTHI", "LKNE", "RKNE", "C7", "STRN", "LHJC", "plate1")
        with open(self.folder / "standing.csv", "w") as file:
            file.write("frame,time,id,label,x,y,z\n")
            file.writelines(f"{frame},{frame / 100},{m + 1},{label},{0.13 * m},{0.05 * (m * m % 7)},{0.9 - 0.07 * (m * 3 % 8) + 0.0001 * frame}\n" for frame in range(30) for m, label in enumerate(labels))
        for name, wanted in (("plug-in-gait", labels[:8]), ("plug-in-gait-lower", labels[:6]), ("LASI,RASI,SACR,LHJC", ("LASI", "RASI", "SACR", "LHJC"))):
            told = json.loads(self.marey("label", "learn", "standing.csv", "--markers", name, "-o", "set.toml", "--json").stdout)
            self.assertEqual(sorted(told["labels"]), sorted(wanted), name)
        for name in ("plugin-gait", "LASI"):
            self.assertIn(f"{name}: no marker set that Marey knows; there are plug-in-gait, plug-in-gait-lower, cmu-41", self.marey("label", "learn", "standing.csv", "--markers", name, "-o", "set.toml", code=1).stderr)
        self.assertIn("has no marker T10", self.marey("label", "learn", "standing.csv", "--markers", "LASI,RASI,SACR,T10", "-o", "set.toml", code=1).stderr)

    def test_suggestions_are_accepted(self):
        self.marey("simulate", "room", "--motion", "walk", "--markers", 40, "--frames", 120, "-o", "walk", "-q")
        self.marey("reconstruct", "walk/rig.toml", "--observations", "walk/observations.csv", "-o", "walk.marey", "-q")
        self.marey("label", "learn", "walk/truth.csv", "-o", "set.toml", "-q")
        # This much better than the next that barely any name is: most stay suggestions.
        strict = ("label", "walk.marey", "--marker-set", "set.toml", "--min-margin", 90, "-o", "named.marey")
        before, after = (json.loads(self.marey(*strict, *more, "--json").stdout) for more in ((), ("--accept", "all")))
        self.assertEqual(before["accepted"], 0)
        self.assertGreater(len(before["unnamed"]), 0)
        self.assertGreater(after["accepted"], 0)
        self.assertGreater(after["named"], before["named"])
        self.assertEqual(len(after["unnamed"]), len(before["unnamed"]) - after["accepted"])
        self.assertIn("--accept all", self.marey(*strict).stderr)
        one = next(piece["best"] for piece in before["unnamed"] if piece["best"])
        some = json.loads(self.marey(*strict, "--accept", one, "--json").stdout)
        self.assertTrue(0 < some["accepted"] <= after["accepted"])
        self.assertIn("set.toml: has no marker nose", self.marey(*strict, "--accept", "nose", code=1).stderr)

    def test_computed_points_are_named_as_what_they_are(self):
        self.marey("simulate", "room", "--motion", "walk", "--markers", 40, "--frames", 100, "-o", "walk", "-q")
        with open(self.folder / "walk" / "truth.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        # Four points beside each marker, as joints' centres and axes' ends stand in files of other systems.
        ids = {label: id for id, label in enumerate(dict.fromkeys(row["label"] for row in rows), 1)}
        with open(self.folder / "computed.csv", "w") as file:
            file.write("frame,time,id,label,x,y,z\n")
            for row in rows:
                for copy in range(5):
                    file.write(f"{row['frame']},{row['time']},{ids[row['label']] + 100 * copy},{row['label']}{'_' * copy},{float(row['x']) + 0.002 * copy},{row['y']},{row['z']}\n")
        told = json.loads(self.marey("label", "learn", "computed.csv", "-o", "set.toml", "--json").stdout)
        self.assertIn("200 of the set's 200 points", told["warnings"][0])
        done = self.marey("label", "computed.csv", "--marker-set", "set.toml", "-o", "named.csv", code=1)
        self.assertIn("name the markers alone", done.stderr)
        self.marey("label", "learn", "walk/truth.csv", "-o", "set.toml", "-q")
        done = self.marey("label", "computed.csv", "--marker-set", "set.toml", "-o", "named.csv", code=1)
        self.assertIn("200 points stand in a frame", done.stderr)
        self.assertNotIn("in metres?", done.stderr)

    def test_bodies_as_the_page_states(self):
        self.run_page("bodies.md")
        database = sqlite3.connect(self.folder / "bodies.marey")
        labels = [label for (label,) in database.execute("SELECT label FROM body ORDER BY id")]
        self.assertEqual(labels, ["head", "chest"])
        for body in (1, 2):
            (count,) = database.execute("SELECT sum(rows) FROM poses WHERE id & 0xffffffff = ?", [body]).fetchone()
            self.assertGreater(count, 0.9 * 600, labels[body - 1])
        database.close()
        self.assertIn("bodies        2: head, chest", self.marey("info", "bodies.marey").stdout)
        # Poses leave the take as a table, and other tables say that they hold none.
        self.marey("convert", "bodies.marey", "poses.csv", "--format", "poses")
        poses = self.rows("poses.csv")
        self.assertEqual({row["body"] for row in poses}, {"head", "chest"})
        for row in poses[::50]:
            turn = [float(row[name]) for name in ("qw", "qx", "qy", "qz")]
            self.assertAlmostEqual(sum(part * part for part in turn), 1, places=7)
            self.assertTrue(0 < float(row["z"]) < 3, row)
        self.assertIn("holds points alone, not the poses of the 2 bodies", self.marey("convert", "bodies.marey", "points.csv").stderr)
        bent = self.marey("body", "define", "walk/truth.csv", "--markers", "head1,left_hand1,right_foot1", "--name", "bent", "-o", "bent.toml")
        self.assertIn("is this one rigid thing?", bent.stderr)
        self.assertIn("holds no bodies", self.marey("convert", "walk.marey", "none.csv", "--format", "poses", code=1).stderr)
        self.assertFalse((self.folder / "none.csv").exists())

    def test_a_symmetric_body_that_may_be_rotated(self):
        # It wobbles about its axis of symmetry, and is hidden for a second every three; from the markers alone it is unknown how it comes back.
        markers = {"a": (-0.1, 0, 0), "b": (0.1, 0, 0), "c": (0, 0, 0.2), "d": (0, 0, -0.15)}
        with open(self.folder / "table.csv", "w") as file:
            file.write("label,x,y,z\n" + "".join(f"{label},{x},{y},{z}\n" for label, (x, y, z) in markers.items()))
        with open(self.folder / "points.csv", "w") as file:
            file.write("frame,time,id,x,y,z\n")
            for frame in range(1200):
                time = frame / 100
                angle = 4 * math.sin(2 * math.pi * 0.23 * time) + 1.5 * math.sin(2 * math.pi * 0.61 * time + 1)
                if frame % 300 >= 200:
                    continue
                for number, (x, y, z) in enumerate(markers.values(), 1):
                    place = (x * math.cos(angle) - y * math.sin(angle), x * math.sin(angle) + y * math.cos(angle), z + 1)
                    file.write(f"{frame},{time},{number + 4 * frame}," + ",".join(f"{c:.5f}" for c in place) + "\n")
        done = self.marey("body", "track", "points.csv", "table.csv", "-o", "racket.marey")
        self.assertRegex(done.stderr, r'in question: from frame \d+ on \(\d+\.\d\d s\) table may be turned 180° about its z axis \(\d+ %\); if so: marey edit racket.marey "turn table \d+:"')
        other = self.marey("body", "track", "points.csv", "table.csv", "-o", "racket.csv", "--format", "poses")
        self.assertIn("if so: write a take (-o NAME.marey), which keeps both poses", other.stderr)
        (self.folder / "my racket.csv").write_text((self.folder / "table.csv").read_text())
        named = self.marey("body", "track", "points.csv", "my racket.csv", "-o", "named.marey")
        turn = shlex.split(re.search(r"if so: marey (edit .*)", named.stderr).group(1))
        self.marey(*turn)
        first = json.loads(self.marey("body", "track", "points.csv", "table.csv", "-o", "racket.marey", "--json").stdout)["in_question"][0]
        self.assertIn(first["frame"], (300, 600, 900))
        self.assertTrue(0.02 <= first["probability"] <= 0.98)

        def axes():
            self.marey("convert", "racket.marey", "poses.csv", "--format", "poses")
            return {int(row["frame"]): 2 * math.degrees(math.atan2(float(row["qz"]), float(row["qw"]))) for row in self.rows("poses.csv")}

        before = axes()
        self.marey("edit", "racket.marey", f"turn table {first['frame']}:")
        after = axes()
        for frame, angle in before.items():
            turned = (after[frame] - angle) % 360
            self.assertAlmostEqual(turned if frame >= first["frame"] else turned + 180, 180, delta=0.1, msg=frame)
        self.assertIn("turn table, from frame", self.marey("edit", "racket.marey", "--list").stdout)
        self.assertIn("there is no body called \"bat\"", self.marey("edit", "racket.marey", "turn bat", code=1).stderr)
        self.assertIn("has no other pose in question", self.marey("edit", "racket.marey", "turn table :100", code=1).stderr)
        self.marey("edit", "racket.marey", "--undo")
        self.assertEqual(axes(), before)

    def test_labels_as_the_page_states(self):
        self.run_page("labels.md")
        self.marey("convert", "named.marey", "named.csv")
        truth = {(row["frame"], row["label"]): [float(row[axis]) for axis in "xyz"] for row in self.rows("walk/truth.csv")}
        right = wrong = 0
        for row in self.rows("named.csv"):
            if not row["label"]:
                continue
            true = truth[row["frame"], row["label"]]
            near = sum((float(row[axis]) - at) ** 2 for axis, at in zip("xyz", true)) < 0.02 ** 2
            right, wrong = right + near, wrong + (not near)
        self.assertGreater(right, 0.95 * len(truth))
        self.assertLess(wrong, 0.01 * len(truth))

    def named_fraction(self, name):
        """Of the points of a table those whose label is the truth's, those with another, and all."""
        truth = {(row["frame"], row["label"]): [float(row[axis]) for axis in "xyz"] for row in self.rows("walk/truth.csv")}
        right = wrong = points = 0
        for row in self.rows(name):
            points += 1
            if row["label"]:
                near = sum((float(row[axis]) - at) ** 2 for axis, at in zip("xyz", truth[row["frame"], row["label"]])) < 0.02 ** 2
                right, wrong = right + near, wrong + (not near)
        return right, wrong, points

    def test_names_within_the_frame(self):
        self.marey("simulate", "room", "--motion", "walk", "--markers", 40, "--frames", 360, "-o", "walk", "-q")
        self.marey("label", "learn", "walk/truth.csv", "-o", "set.toml", "-q")
        files = ["walk/rig.toml", "--observations", "walk/observations.csv"]
        told = []
        for take in ("one.marey", "two.marey"):
            done = self.marey("reconstruct", *files, "--live", "--marker-set", "set.toml", "--skeleton", "walk/skeleton.toml", "-o", take, "--json")
            told.append(json.loads(done.stdout))
        self.assertEqual(told[0]["set"]["named"], told[1]["set"]["named"])
        self.assertAlmostEqual(told[0]["set"]["found_at_s"], 1.0, delta=0.2)
        self.assertGreater(told[0]["set"]["named"], 0.99 * told[0]["set"]["points"])
        self.assertLess(told[0]["skeleton"]["rms_mm"], 2)
        self.marey("convert", "one.marey", "one.csv", "-q")
        right, wrong, points = self.named_fraction("one.csv")  # a track bears its name over its whole life
        self.assertGreater(right, 0.99 * points)
        self.assertLess(wrong, 0.003 * points)
        self.assertEqual(len({row["id"] for row in self.rows("one.csv") if row["label"]}), 40, "each name is one track")

    def test_sets_that_do_not_fit_are_stated(self):
        self.marey("simulate", "room", "--motion", "walk", "--markers", 40, "--frames", 240, "-o", "walk", "-q")
        self.marey("label", "learn", "walk/truth.csv", "-o", "set.toml", "-q")
        files = ["reconstruct", "walk/rig.toml", "--observations", "walk/observations.csv", "--live"]
        (self.folder / "empty.toml").write_text("labels = []\nmoves = true\nscaled = false\nplaces = []\ndistances = []\n")
        self.assertIn("4 to 2000 names", self.marey(*files, "--marker-set", "empty.toml", "-o", "x.marey", code=1).stderr)
        text = (self.folder / "set.toml").read_text()
        (self.folder / "renamed.toml").write_text(re.sub(r'"([a-z_]+[0-9]+)"', r'"X\1"', text))
        refused = self.marey(*files, "--marker-set", "renamed.toml", "--skeleton", "walk/skeleton.toml", "-o", "x.marey", "-q", code=1).stderr
        self.assertIn("none of its names is a marker of the skeleton", refused)
        self.assertEqual(refused.count("\n"), 1, refused)
        self.assertFalse((self.folder / "x.marey").exists())
        refused = self.marey("live", "sim://people", "--targets", "people", "--marker-set", "set.toml", "--duration", 1, "-q", code=1).stderr
        self.assertIn("two calibrated cameras", refused)
        self.marey("simulate", "room", "--motion", "wand", "--frames", 240, "-o", "wand", "-q")
        few = self.marey("reconstruct", "wand/rig.toml", "--observations", "wand/observations.csv", "--live", "--marker-set", "set.toml", "-o", "few.marey").stderr
        self.assertIn("never more than 3 markers were seen at once, of the set's 40", few)

    def test_points_are_excluded_by_name(self):
        self.marey("simulate", "room", "--motion", "walk", "--markers", 40, "--frames", 100, "-o", "walk", "-q")
        self.marey("label", "learn", "walk/truth.csv", "--exclude", "head*,chest1", "-o", "set.toml", "-q")
        labels = {row["label"] for row in self.rows("walk/truth.csv")}
        left = {label for label in labels if label.startswith("head") or label == "chest1"}
        told = json.loads(self.marey("label", "walk/truth.csv", "--marker-set", "set.toml", "--exclude", "head*", "--exclude", "chest1", "-o", "named.csv", "--json").stdout)
        self.assertEqual({marker["label"] for marker in told["markers"]}, labels - left)
        self.assertEqual({row["label"] for row in self.rows("named.csv")}, labels)
        self.assertIn("no point is called LHJC", self.marey("label", "learn", "walk/truth.csv", "--exclude", "LHJC", "-o", "x.toml", code=1).stderr)

    def test_sets_of_which_nothing_comes_are_refused(self):
        def learn(name, frames, place, code):
            with open(self.folder / name, "w") as file:
                file.write("frame,time,id,label,x,y,z\n")
                for frame in range(frames):
                    for marker in range(5):
                        x, y, z = place(frame, marker)
                        file.write(f"{frame},{frame / 100},{marker + 1},m{marker},{x},{y},{z}\n")
            done = self.marey("label", "learn", name, "-o", "set.toml", code=code)
            self.assertEqual((self.folder / "set.toml").exists(), code == 0)
            return done.stderr
        self.assertIn("in one line", learn("line.csv", 50, lambda frame, marker: (0.1 * marker, frame / 100, 1), 1))
        spread = [(0, 0, 0), (0.3, 0, 0), (0, 0.4, 0), (0.2, 0.1, 0.5), (0.5, 0.5, 0.2)]
        self.assertIn("learned from 1 frame", learn("one.csv", 1, lambda frame, marker: spread[marker], 0))
        self.assertIn("in one plane", learn("flat.csv", 50, lambda frame, marker: (spread[marker][0], spread[marker][1], 1), 0))

    def test_what_cannot_be_is_stated(self):
        self.marey("simulate", "room", "--motion", "walk", "--markers", "40", "--frames", "60", "-o", "walk", "-q")
        two = self.marey("body", "define", "walk/truth.csv", "--markers", "head1,head2", "-o", "b.toml", code=2)
        self.assertIn("three markers", two.stderr)
        missing = self.marey("body", "define", "walk/truth.csv", "--markers", "head1,head2,nose", "-o", "b.toml", code=1)
        self.assertIn('no marker "nose"', missing.stderr)
        (self.folder / "b.toml").write_text('[[body]]\nname = "a"\n')
        broken = self.marey("body", "track", "walk/truth.csv", "b.toml", "-o", "out.marey", code=1)
        self.assertIn("b.toml:1", broken.stderr)
        self.assertIn("--marker-set", self.marey("label", "walk/truth.csv", "-o", "out.marey", code=2).stderr)
        self.marey("label", "learn", "walk/truth.csv", "-o", "set.toml")
        self.assertEqual(json.loads(self.marey("info", "set.toml", "--json").stdout)["format"], "label set")
        self.assertFalse((self.folder / "out.marey").exists())
        names = "head1\nhead2\nhead3\nhead4\n"
        (self.folder / "names.txt").write_text(names)
        self.assertIn("is an input too", self.marey("label", "learn", "walk/truth.csv", "--markers", "names.txt", "-o", "names.txt", code=2).stderr)
        self.assertEqual((self.folder / "names.txt").read_text(), names)


if __name__ == "__main__":
    MAREY, ROOT = sys.argv[1], pathlib.Path(sys.argv[2])
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
