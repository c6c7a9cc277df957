"""docs/bodies.md and docs/labels.md, each command run as it is written there; what comes out against the simulation's truth; what cannot be.

Usage: bodies_labels_test.py MAREY ROOT [unittest options]
"""

import csv
import json
import pathlib
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
        done = self.marey("label", "computed.csv", "--set", "set.toml", "-o", "named.csv", code=1)
        self.assertIn("name the markers alone", done.stderr)
        self.marey("label", "learn", "walk/truth.csv", "-o", "set.toml", "-q")
        done = self.marey("label", "computed.csv", "--set", "set.toml", "-o", "named.csv", code=1)
        self.assertIn("200 points stand in a frame", done.stderr)
        self.assertNotIn("in metres?", done.stderr)

    def test_bodies_as_the_page_says(self):
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

    def test_labels_as_the_page_says(self):
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

    def test_what_cannot_be_is_said(self):
        self.marey("simulate", "room", "--motion", "walk", "--markers", "40", "--frames", "60", "-o", "walk", "-q")
        two = self.marey("body", "define", "walk/truth.csv", "--markers", "head1,head2", "-o", "b.toml", code=2)
        self.assertIn("three markers", two.stderr)
        missing = self.marey("body", "define", "walk/truth.csv", "--markers", "head1,head2,nose", "-o", "b.toml", code=1)
        self.assertIn('no marker "nose"', missing.stderr)
        (self.folder / "b.toml").write_text('[[body]]\nname = "a"\n')
        broken = self.marey("body", "follow", "walk/truth.csv", "b.toml", "-o", "out.marey", code=1)
        self.assertIn("b.toml:1", broken.stderr)
        self.assertIn("--set", self.marey("label", "walk/truth.csv", "-o", "out.marey", code=2).stderr)
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
