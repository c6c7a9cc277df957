"""`marey evaluate --distance`, `convert`, `info` and `measure` on files of people on the ground: several rates, other tools' files,
and what cannot be used.

Usage: ground_files_test.py MAREY [unittest options]. Nothing else is needed.
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


class GroundFiles(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="marey_ground_"))
        self.addCleanup(shutil.rmtree, self.folder)

    def marey(self, *arguments, code=0):
        done = subprocess.run([MAREY, *map(str, arguments)], capture_output=True, text=True, cwd=self.folder, timeout=120)
        self.assertEqual(done.returncode, code, f"{arguments}\n{done.stdout}\n{done.stderr}")
        return done

    def refused(self, *arguments, code=1):
        """Ends with one sentence and leaves nothing behind."""
        before = sorted(self.folder.rglob("*"))
        said = self.marey(*arguments, code=code).stderr.strip()
        self.assertEqual(sorted(self.folder.rglob("*")), before, "something was left behind")
        self.assertEqual(len(said.splitlines()), 1, said)
        self.assertTrue(said.startswith("marey: "), said)
        return said

    def write_run(self, name, rate, seconds=20, shift=0.0, columns="frame,time,id,team,x,y"):
        """One who runs at 8 m/s to and fro, turning as fast as a person can, one who walks at 1 m/s."""
        ways, self.run_length = [0.0], 0.0
        for k in range(round(seconds * 1000) + 1):
            speed = 8 * max(-1.0, min(1.0, 1.5 * math.sin(2 * math.pi * k / 1000 / 10)))
            ways.append(ways[-1] + speed / 1000)
            self.run_length += abs(speed) / 1000
        with open(self.folder / name, "w") as out:
            out.write(columns + "\n")
            for i in range(round(seconds * rate) + 1):
                time = i / rate
                places = {1: (10 + ways[round(1000 * time)], 20 + shift), 2: (50, 20 + time + shift)}
                for person, (x, y) in places.items():
                    row = {"frame": i, "time": f"{time:.4f}", "id": person, "team": "white" if person == 1 else "blue", "x": f"{x:.3f}",
                           "y": f"{y:.3f}"}
                    out.write(",".join(str(row[column]) for column in columns.split(",")) + "\n")

    def test_rates_make_no_difference(self):
        for rate in (5, 10, 25, 50, 100):
            self.write_run("run.csv", rate)
            self.marey("measure", "run.csv", "-o", "summary.csv", "-q")
            rows = list(csv.DictReader((self.folder / "summary.csv").read_text().splitlines()))
            self.assertAlmostEqual(float(rows[1]["distance_m"]), 20, delta=0.2, msg=f"{rate} Hz")
            self.assertAlmostEqual(float(rows[0]["distance_m"]), self.run_length, delta=8, msg=f"{rate} Hz")
            self.assertAlmostEqual(float(rows[0]["max_mps"]), 8, delta=0.9, msg=f"{rate} Hz")
            self.assertGreaterEqual(int(rows[0]["sprints"]), 2, f"{rate} Hz")

    def test_what_none_can_do_is_reported_and_not_counted(self):
        with open(self.folder / "slid.csv", "w") as out:
            out.write("frame,time,id,x,y,state\n")
            for i in range(251):  # the first goes over to the one who walks beside him; the second is predicted to dash away and back
                time = i / 25
                out.write(f"{i},{time},1,{10 + 1.5 * time:.3f},{20 + 3 * min(1, max(0, (time - 5) * 3)):.3f},observed\n")
                dash = min(1, max(0, (time - 5) / 1.6))
                state = "predicted" if 0 < dash < 1 else "observed"
                out.write(f"{i},{time},2,{10 + 1.5 * time:.3f},{50 + 5 * (1 - math.cos(2 * math.pi * dash)):.3f},{state}\n")
        told = self.marey("measure", "slid.csv", "-o", "slid_figures.csv").stdout
        self.assertRegex(told, r"not counted: #1 from 4\.\d s to 5\.\d s, .*two people")
        self.assertNotIn("not counted: #2", told)
        rows = list(csv.DictReader((self.folder / "slid_figures.csv").read_text().splitlines()))
        self.assertEqual([row["impossible"] for row in rows], ["1", "0"])
        for row in rows:
            self.assertLess(float(row["max_mps"]), 4, row["id"])
            self.assertLess(float(row["seen_s"]), 9.7, row["id"])
            self.assertGreater(float(row["top_sigma_mps"]), 0, row["id"])

    def test_another_tools_file_without_teams(self):
        self.write_run("run.csv", 25, columns="id,frame,x,y,time")
        self.marey("measure", "run.csv", "-o", "summary.csv", "--report", "report", "-q")
        rows = list(csv.DictReader((self.folder / "summary.csv").read_text().splitlines()))
        self.assertEqual([row["team"] for row in rows], ["", ""])
        said = self.marey("convert", "run.csv", "run.dat").stderr
        self.assertIn("no person has a team", said)
        self.marey("measure", "run.dat", "-o", "again.csv", "-q")
        again = list(csv.DictReader((self.folder / "again.csv").read_text().splitlines()))
        self.assertAlmostEqual(float(again[0]["distance_m"]), float(rows[0]["distance_m"]), delta=0.2)

    def test_what_cannot_be_measured_is_refused(self):
        for name, text, sentence in [
            ("empty.csv", "", "empty"),
            ("head.csv", "frame,time,id,x,y\n", "no person"),
            ("still.csv", "frame,time,id,x,y\n0,0,1,2,3\n0,0,2,2,3\n", "no person"),
            ("cut.csv", "frame,time,id,x,y\n0,0,1,2,3\n1,0.04,1,2", "cut.csv:3"),
            ("hostile.csv", "frame,time,id,x,y\n99999999999,0,1,2,3\n", "hostile.csv:2"),
            ("boxes.txt", "1,1,10,10,5,5,1,-1,-1,-1\n", "no world coordinates"),
            ("noise.csv", "\x00\x01\x02\n", "header"),
        ]:
            (self.folder / name).write_text(text)
            self.assertIn(sentence, self.refused("measure", name, "-o", "never.csv"), name)
        self.refused("measure", "missing.csv", "-o", "never.csv")
        self.refused("measure", ".", "-o", "never.csv")

    def test_identify_never_moves_has_no_distance(self):
        (self.folder / "zero.csv").write_text("frame,time,id,x,y\n" + "".join(f"{i},{i / 25},1,2,3\n" for i in range(50)))
        self.marey("measure", "zero.csv", "-o", "summary.csv", "-q")
        row = list(csv.DictReader((self.folder / "summary.csv").read_text().splitlines()))[0]
        self.assertEqual((float(row["distance_m"]), float(row["max_mps"]), row["sprints"]), (0, 0, "0"))

    def evaluated(self, *options):
        return json.loads(self.marey("evaluate", "--truth", "truth.csv", "--tracks", "tracks.csv", "--distance", 1.5, "--json", *options).stdout)

    def test_evaluated_in_metres(self):
        self.write_run("truth.csv", 25)
        self.write_run("tracks.csv", 25, shift=0.4)
        result = self.evaluated()
        self.assertEqual((result["mota"], result["idf1"], result["idsw"], result["tracked_fraction"], result["found"]), (1, 1, 0, 1, 1))
        self.assertAlmostEqual(result["position_rms_m"], 0.4, delta=1e-6)
        self.assertAlmostEqual(result["distance_error"], 0, delta=1e-6)
        self.assertEqual(result["warnings"], [])
        for rate in (5, 12.5, 100):
            self.write_run("tracks.csv", rate, shift=0.4)
            result = self.evaluated()
            self.assertEqual((result["paired_by"], result["mota"]), ("time", 1), rate)
            self.assertIn("every", result["warnings"][0])
        table = self.marey("evaluate", "--truth", "truth.csv", "--tracks", "tracks.csv", "--distance", 1.5).stdout
        self.assertIn("position", table)
        self.marey("evaluate", "--truth", "truth.csv", "--tracks", "tracks.csv", "--distance", 1.5, "--iou", 0.3, code=2)
        self.marey("evaluate", "--truth", "truth.csv", "--tracks", "tracks.csv", "--distance", -1, code=2)

    def test_a_truth_needs_frames_or_times(self):
        self.write_run("tracks.csv", 50)
        for columns in ("frame,id,x,y", "time,id,x,y"):
            self.write_run("truth.csv", 50, columns=columns)
            result = self.evaluated()
            self.assertEqual((result["paired_by"], result["mota"], result["tracked_fraction"]), ("frame", 1, 1), columns)

    def test_none_is_evaluated_with_a_warning(self):
        self.write_run("truth.csv", 25)
        (self.folder / "tracks.csv").write_text("frame,time,id,x,y\n")
        result = self.evaluated()
        self.assertEqual((result["found"], result["mota"], result["position_rms_m"]), (0, 0, None))
        self.assertIn("tracks.csv: no person is in it", result["warnings"])

    def test_frames_of_other_users(self):
        (self.folder / "m.csv").write_text("frame,time,id,team,x,y\n0,0,1,a,-52.5,-34\n0,0,2,b,52.5,34\n1,0.04,1,a,-52.5,-34\n")
        self.marey("convert", "m.csv", "m.dat", "--centred", "--y-down")
        self.assertIn("0:1,1,1,-5250,3400,0.00;0,2,2,5250,-3400,0.00;:", (self.folder / "m.dat").read_text())
        self.marey("convert", "m.dat", "back.csv", "--centred", "--y-down")
        self.assertIn("0,0.0000,1,1,a,-52.500,-34.000", (self.folder / "back.csv").read_text())
        info = json.loads(self.marey("info", "m.xml", "--json").stdout)
        self.assertEqual((info["format"], info["instants"], info["home"]), ("tracab", 2, "a"))
        for rig, y in ((("1, 0, 0", "0, -1, 0", "0, 0, 1"), -3400), (("1, 0, 0", "0, 1, 0", "0, 0, 1"), 3400)):
            rows = ", ".join(f"[{row}]" for row in rig)
            (self.folder / "rig.toml").write_text(f'[world]\nground_from_world = [{rows}]\n[[camera]]\nname = "a"\n')
            self.marey("convert", "m.csv", "m.dat", "--centred", "--rig", "rig.toml")
            self.assertIn(f"0,2,2,5250,{y},0.00", (self.folder / "m.dat").read_text())

    def test_conversions_that_cannot_be_are_refused(self):
        self.write_run("run.csv", 12.5)
        self.assertIn("12.5", self.refused("convert", "run.csv", "run.dat"))
        self.assertIn("read only", self.refused("convert", "run.csv", "run.xml", "--format", "sportec", code=2))
        self.assertIn("ending", self.refused("convert", "run.csv", "run.odt", code=2))
        self.assertIn("no person is of the team", self.refused("convert", "run.csv", "run_home.csv", "--home", "green"))
        self.assertIn("input", self.refused("convert", "run.csv", "run.csv", code=2))
        self.assertIn("--up", self.refused("convert", "run.csv", "run_home.csv", "--up", "y", code=2))
        self.marey("convert", "run.csv", "run_home.csv", "--period", "9-3", code=2)
        self.marey("convert", "run.csv", "run_home.csv", "--format", "nonsense", code=2)
        (self.folder / "alone.dat").write_text("1:1,1,1,0,0,0.00;:0,0,0,0.00,H,Dead;:\n")
        self.assertIn("--metadata", self.refused("convert", "alone.dat", "never.csv"))


if __name__ == "__main__":
    MAREY = sys.argv.pop(1)
    unittest.main()
