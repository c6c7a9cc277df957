"""`marey gait --report` with a control group and an earlier session, on the children of the test data; folders and files that cannot be used.

Usage: gait_report_test.py MAREY ROOT [unittest options]; exits 77 (skipped) where the recordings are not here.
"""

import csv
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

MAREY = ""
DATA = pathlib.Path()


class GaitReport(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="marey_gait_"))
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        cls.children = sorted(DATA.glob("gait_children/HC*"))
        cls.walk = next(cls.children[0].glob("straight_*.c3d"))
        cls.static = next(cls.children[0].glob("static_*.c3d"))
        for child in cls.children[1:]:
            (cls.folder / "group" / child.name).mkdir(parents=True)
            for name in ("straight_*.c3d", "static_*.c3d"):
                for file in child.glob(name):
                    (cls.folder / "group" / child.name / file.name).symlink_to(file)

    def marey(self, *arguments, code=0):
        done = subprocess.run([MAREY, *map(str, arguments)], capture_output=True, text=True, cwd=self.folder, timeout=600)
        self.assertEqual(done.returncode, code, f"{arguments}\n{done.stdout}\n{done.stderr}")
        return done

    def gait(self, *arguments, code=0):
        return self.marey("gait", self.walk, "--static-trial", self.static, *arguments, code=code)

    def copied(self, name, *children):
        """A folder with the first of the group's people."""
        for child in children or [self.children[1]]:
            (self.folder / name / child.name).mkdir(parents=True)
            for file in (self.folder / "group" / child.name).iterdir():
                shutil.copy(file, self.folder / name / child.name)
        return self.folder / name

    def test_a_control_group_gives_band_and_scores(self):
        said = json.loads(self.gait("--reference", "group", "--report", "all.html", "--json").stdout)
        self.assertEqual(said["reference"]["people"], 5)
        self.assertEqual(said["reference"]["turning_cycles"], 0)
        self.assertEqual(len(said["profile"]["variables"]), 9)
        left = [score["left_deg"] for score in said["profile"]["variables"].values()]
        self.assertAlmostEqual(said["profile"]["left_deg"], (sum(score ** 2 for score in left) / 9) ** 0.5, 9)
        self.assertGreater(said["profile"]["overall_deg"], 2)
        self.assertLess(said["profile"]["overall_deg"], 12)
        self.assertLess(said["reference"]["scores"]["GPS"]["mean_deg"], 12)
        page = (self.folder / "all.html").read_text()
        for text in ("Gait Profile Score of both sides", "control group", "Left side", "Right side", "ground reaction up, % of weight", "hip moment, N m/kg",
                     "EMG L Rect", "± is one standard deviation over the cycles", "Trunk and arms", "Quality"):
            self.assertIn(text, page)
        self.assertNotIn(str(DATA), page)
        self.assertNotIn("http", re.sub(r'xmlns="[^"]*"', "", page))

    def test_scores_are_printed(self):
        printed = self.gait("--reference", "group").stdout
        self.assertRegex(printed, r"Gait Profile Score +\d\.\d +\d\.\d deg, of both \d\.\d")

    def test_an_earlier_session(self):
        before = next(self.children[0].glob("turn_*.c3d"))
        said = json.loads(self.gait("--reference", "group", "--before", before, "--before-static", self.static, "--report", "two.html", "--json").stdout)
        self.assertGreaterEqual(said["before"]["cycles"], 1)
        self.assertIsNotNone(said["before"]["profile"])
        page = (self.folder / "two.html").read_text()
        self.assertIn(f"Before: {before.name}", page)
        self.assertIn("before (dashed)", page)
        self.assertIn("stroke-dasharray", page)
        self.assertIn("--before", self.gait("--before-static", self.static, code=2).stderr)

    def test_without_a_group_there_is_no_score(self):
        said = json.loads(self.gait("--report", "alone.html", "--json").stdout)
        self.assertIsNone(said["profile"])
        self.assertNotIn("Gait Profile Score", (self.folder / "alone.html").read_text())

    def test_joint_moments_of_a_table(self):
        rows = "".join(f"{1.23 + 0.01 * i:.2f}\t{i % 7}\t{i % 5}\n" for i in range(256))
        head = "moments\nversion=1\nnRows=256\nnColumns=3\ninDegrees=no\nendheader\ntime\thip_flexion_l_moment\tknee_angle_r_power\n"
        (self.folder / "moments.sto").write_text(head + rows)
        self.gait("--moments", "moments.sto", "--report", "m.html", "-q")
        page = (self.folder / "m.html").read_text()
        self.assertIn("hip flexion moment, N m/kg", page)
        self.assertNotIn("hip moment, N m/kg", page)
        (self.folder / "other.sto").write_text(head.replace("hip_flexion_l_moment", "a").replace("knee_angle_r_power", "b") + rows)
        self.assertIn("has no column of a leg's moment or power", self.gait("--moments", "other.sto", "--report", "n.html", code=1).stderr)
        (self.folder / "late.sto").write_text(head + re.sub(r"^(\d)", r"9\1", rows, flags=re.M))
        self.assertIn("not of the same walk?", self.gait("--moments", "late.sto", "--report", "n.html", code=1).stderr)
        (self.folder / "uneven.sto").write_text(head + rows.replace("1.30\t", "1.305\t"))
        self.assertIn("its times are not even at row 8", self.gait("--moments", "uneven.sto", "--report", "n.html", code=1).stderr)
        self.assertFalse((self.folder / "n.html").exists())

    def test_folders_that_are_no_group(self):
        self.assertIn("is not a folder", self.gait("--reference", self.static, code=1).stderr)
        self.assertEqual(self.gait("--reference", "nowhere", code=1).returncode, 1)
        (self.folder / "empty/person").mkdir(parents=True)
        self.assertIn("empty: is empty; a folder for each person is wanted", self.gait("--reference", "empty", code=1).stderr)
        (self.folder / "texts").mkdir()
        (self.folder / "texts/notes.txt").write_text("walked well\n")
        said = self.gait("--reference", "texts", code=1).stderr
        self.assertIn("has no walk that can be a reference, of 1 files; the first: ", said)
        self.assertIn("notes.txt: is not one of the files that Marey knows", said)

    def test_one_bad_file_among_good_ones(self):
        group = self.copied("mixed", *self.children[1:4])
        (group / self.children[1].name / "broken.c3d").write_bytes(self.walk.read_bytes()[:3000])
        done = self.gait("--reference", group, "--json")
        said = json.loads(done.stdout)
        self.assertEqual(said["reference"]["people"], 3)
        self.assertEqual(len([warning for warning in said["warnings"] if "omitted of the reference" in warning]), 1)
        self.assertIn("broken.c3d", done.stderr)

    def test_the_walker_in_the_group_is_warned_of(self):
        """In a folder of the group, or as a copy of one of its files; not where another person walks."""
        group = self.copied("with_walker", self.children[1])
        said = self.marey("gait", group / self.children[1].name / next(self.children[1].glob("straight_*.c3d")).name, "--reference", group).stderr
        self.assertIn(f"the walker is {self.children[1].name} of", said)
        copy = self.folder / "renamed.c3d"
        shutil.copy(next(self.children[1].glob("straight_*.c3d")), copy)
        self.assertIn(f"the walker is {self.children[1].name} of", self.marey("gait", copy, "--reference", group).stderr)
        self.assertNotIn("the walker is", self.gait("--reference", group).stderr)

    def test_a_group_of_standing_people(self):
        child = self.children[1]
        (self.folder / "standing_group" / child.name).mkdir(parents=True)
        shutil.copy(next(child.glob("static_*.c3d")), self.folder / "standing_group" / child.name / "still.c3d")
        said = self.gait("--reference", "standing_group", code=1).stderr
        self.assertIn("still.c3d: no steps were found", said)

    def test_one_person_has_no_band(self):
        group = self.copied("single")
        done = self.gait("--reference", group, "--report", "single.html", "--json")
        self.assertIn("is of one person; a band needs two", done.stderr)
        self.assertEqual(json.loads(done.stdout)["reference"]["scores"], {})

    def test_curved_cycles_are_not_in_the_reference(self):
        group = self.copied("turning")
        child = self.children[1]
        for file in child.glob("turn_*.c3d"):
            shutil.copy(file, group / child.name)
        said = json.loads(self.gait("--reference", group, "--json").stdout)
        self.assertGreaterEqual(said["reference"]["turning_cycles"], 1)

    def test_an_impossible_person(self):
        self.assertIn("5 kg at a height of 1.45 m are not a person's (body mass index 2.4)", self.gait("--mass", 5).stderr)
        self.assertNotIn("body mass index", self.gait().stderr)

    def test_a_static_trial_in_a_crouch(self):
        self.gait("--angles", "walk.csv", "-q")
        with (self.folder / "walk.csv").open() as rows:
            bent = [float(row["left_knee_flexion"] or 0) for row in csv.DictReader(rows)]
        frame = 123 + bent.index(max(bent))  # the walk begins at frame 123, from 0
        self.marey("convert", self.walk, "bent.csv", "--frames", f"{frame}:{frame}", "-q")
        said = self.marey("gait", self.walk, "--static-trial", "bent.csv").stderr
        self.assertRegex(said, r"bent.csv: the left knee is bent by [56]\d° in the static trial; does the person stand in a crouch\?")
        self.assertNotIn("crouch", self.gait().stderr)

    def test_a_leg_that_is_missing(self):
        self.marey("convert", self.walk, "both.csv", "-q")
        head, *rows = (self.folder / "both.csv").read_text().splitlines()
        kept = [row for row in rows if not re.search(r",R(TIB|ANK|HEE|TOE|KNE|THI),", row)]
        (self.folder / "left.csv").write_text("\n".join([head, *kept]) + "\n")
        done = self.marey("gait", "left.csv", "--reference", "group", "--report", "left.html", "--json")
        said = json.loads(done.stdout)
        self.assertIn("right", done.stderr)
        self.assertIn("never known: markers are missing", done.stderr)
        self.assertIsNotNone(said["profile"]["left_deg"])
        self.assertIsNone(said["profile"]["right_deg"])
        page = (self.folder / "left.html").read_text()
        self.assertIn("Left side", page)
        self.assertIn("No Gait Profile Score of both sides: a variable is not known", page)


if __name__ == "__main__":
    MAREY, root = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve()
    DATA = pathlib.Path(os.environ.get("MAREY_DATA") or root.parent / "shared" / "data")
    if not (DATA / "gait_children").exists():
        print(f"skipped: {DATA / 'gait_children'} is not here")
        sys.exit(77)
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
