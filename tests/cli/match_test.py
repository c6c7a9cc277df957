"""`marey simulate match`: its files agree with each other, and what cannot be is refused.

Usage: match_test.py MAREY [unittest options]. Nothing else is needed.
"""

import collections
import csv
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

MAREY = ""


def boxes(path):
    rows = collections.defaultdict(list)
    for line in path.read_text().splitlines():
        fields = [float(f) for f in line.split(",")]
        rows[int(fields[0])].append(fields[1:])
    return rows


def overlap(a, b):
    wide = min(a[1] + a[3], b[1] + b[3]) - max(a[1], b[1])
    high = min(a[2] + a[4], b[2] + b[4]) - max(a[2], b[2])
    shared = max(0, wide) * max(0, high)
    return shared / (a[3] * a[4] + b[3] * b[4] - shared)


class Match(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="marey_match_"))
        self.addCleanup(shutil.rmtree, self.folder)

    def marey(self, *arguments, code=0):
        done = subprocess.run([MAREY, *map(str, arguments)], capture_output=True, text=True, cwd=self.folder, timeout=300)
        self.assertEqual(done.returncode, code, f"{arguments}\n{done.stdout}\n{done.stderr}")
        self.assertNotIn("terminate called", done.stderr)
        return done

    def simulate(self, name, *more):
        self.marey("simulate", "match", "-o", name, "-q", *more)
        return self.folder / name

    def truth(self, folder):
        with open(folder / "truth.csv", newline="") as file:
            return list(csv.DictReader(file))

    def test_boxes_of_six_cameras(self):
        folder = self.simulate("match", "--cameras", 6, "--seconds", 4, "--boxes")
        rows = self.truth(folder)
        self.assertEqual(list(rows[0]), "frame,time,id,label,team,x,y,vx,vy,state,cameras".split(","))
        self.assertEqual(len(rows), 100 * 25)
        self.assertEqual({r["team"] for r in rows}, {"white", "blue", "referee"})
        self.assertEqual({c for r in rows for c in r["cameras"].split()}, {f"cam{i}" for i in range(1, 7)})
        rig = (folder / "rig.toml").read_text()
        self.assertEqual(re.findall(r'detections = "(.*)"', rig), [f"cam{i}.txt" for i in range(1, 7)])
        found = people = 0
        for camera in range(1, 7):
            truth, seen = boxes(folder / f"cam{camera}_truth.txt"), boxes(folder / f"cam{camera}.txt")
            for frame, true in truth.items():
                plain = [t for t in true if t[7] > 0.9]
                people += len(plain)
                found += sum(any(overlap(t, s) > 0.5 for s in seen[frame]) for t in plain)
        self.assertGreater(people, 6 * 100 * 12)
        self.assertAlmostEqual(found / people, 0.9, delta=0.02)

    def test_velocities_are_those_of_the_positions(self):
        rows = self.truth(self.simulate("match", "--cameras", 1, "--seconds", 3, "--rate", 50))
        ways = collections.defaultdict(list)
        for r in rows:
            ways[r["id"]].append([float(r[k]) for k in ("x", "y", "vx", "vy")])
        for way in ways.values():
            for before, now, after in zip(way, way[1:], way[2:]):
                for axis in (0, 1):
                    self.assertAlmostEqual((after[axis] - before[axis]) * 25, now[2 + axis], delta=0.35)

    def test_rates_agree_and_seeds_differ(self):
        def locations(name, *more):
            return {(r["time"], r["id"]): (r["x"], r["y"]) for r in self.truth(self.simulate(name, "--cameras", 1, "--seconds", 2, *more))}

        fast, slow, other = locations("a", "--rate", 50), locations("b", "--rate", 10), locations("c", "--rate", 10, "--seed", 2)
        self.assertEqual(len(slow), 20 * 25)
        for key, place in slow.items():
            self.assertEqual(place, fast[key])
        self.assertNotEqual(slow, other)

    def test_the_same_bytes_from_the_same_seed(self):
        folders = [self.simulate(n, "--cameras", 2, "--seconds", 1, "--offset", 0.2, "--seed", 9) for n in ("a", "b")]
        names = sorted(p.name for p in folders[0].iterdir())
        self.assertEqual(names, ["cam1.txt", "cam1_truth.txt", "cam2.txt", "cam2_truth.txt", "rig.toml", "truth.csv"])
        for name in names:
            self.assertEqual((folders[0] / name).read_bytes(), (folders[1] / name).read_bytes(), name)

    def test_offsets_can_be_hidden(self):
        folder = self.simulate("match", "--cameras", 3, "--seconds", 1, "--offset", 0.4, "--hide-offsets")
        told = re.findall(r"offset_s = (\S+)", (folder / "rig.toml").read_text())
        true = re.findall(r"offset_s = (\S+)", (folder / "true_rig.toml").read_text())
        self.assertEqual(told, [])
        self.assertEqual(float(true[0]), 0)
        self.assertTrue(all(0 < abs(float(t)) <= 0.4 for t in true[1:]), true)

    def test_two_cameras_on_one_stand(self):
        folder = self.simulate("match", "--layout", "football", "--seconds", 1)
        rig = (folder / "rig.toml").read_text()
        self.assertEqual(re.findall(r'name = "(.*)"', rig), ["left", "right"])
        self.assertIn("ground_from_world", rig)
        for row in self.truth(folder):
            self.assertTrue(-3 < float(row["y"]) < 71, row)

    def test_what_cannot_be_is_refused(self):
        for more in (["--cameras", 0], ["--cameras", 65], ["--seconds", -1], ["--rate", 0], ["--miss-rate", 2], ["--layout", "roof"]):
            self.marey("simulate", "match", "-o", "match", *more, code=2)
        self.assertIn("--output", self.marey("simulate", "match", "--cameras", 2, code=2).stderr)
        self.marey("simulate", "match", "-o", "match", "--pitch", "20x10", code=2)
        (self.folder / "file").write_text("")
        said = self.marey("simulate", "match", "-o", "file/below", "--seconds", 1, code=1).stderr
        self.assertIn("the folder cannot be made", said)


if __name__ == "__main__":
    MAREY = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main()
