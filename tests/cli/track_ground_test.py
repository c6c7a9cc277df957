"""`marey track RIG --ground`: one identity across cameras, in the user's coordinates; videos synchronised with the videos; and a sentence for
what cannot be tracked.

Usage: track_ground_test.py MAREY [unittest options]. Nothing else is needed.
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
HEADER = "frame,time,id,label,team,x,y,vx,vy,state,cameras,xx,xy,yy".split(",")


def rows_of(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


class TrackGround(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.made = pathlib.Path(tempfile.mkdtemp(prefix="marey_track_ground_"))
        cls.addClassCleanup(shutil.rmtree, cls.made)
        cls.match("boxes", "--cameras", 4, "--seconds", 8, "--seed", 3)
        cls.match("films", "--cameras", 2, "--seconds", 2, "--render", "--size", 640, 360)

    @classmethod
    def match(cls, name, *more):
        subprocess.run([MAREY, "simulate", "match", "-o", name, "-q", *map(str, more)], cwd=cls.made, check=True, timeout=120)

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="marey_track_ground_"))
        self.addCleanup(shutil.rmtree, self.folder)

    def marey(self, *arguments, code=0):
        done = subprocess.run([MAREY, *map(str, arguments)], capture_output=True, text=True, cwd=self.folder, timeout=120)
        self.assertEqual(done.returncode, code, f"{arguments}\n{done.stdout}\n{done.stderr}")
        return done

    def track(self, rig, *more, code=0):
        return self.marey("track", rig, "--targets", "people", "--ground", *more, code=code)

    def refused(self, *arguments, code=1):
        """Ends with one sentence and leaves nothing behind."""
        said = self.marey("track", *arguments, code=code).stderr.strip()
        self.assertEqual(len(said.splitlines()), 1, said)
        self.assertFalse((self.folder / "match.csv").exists())
        return said

    def edited(self, name, change):
        """The rig of boxes with another text, beside its files."""
        text = change((self.made / "boxes" / "rig.toml").read_text())
        path = self.made / "boxes" / name
        path.write_text(text)
        self.addCleanup(path.unlink)
        return path

    def evaluated(self, tracks):
        told = self.marey("evaluate", "--truth", self.made / "boxes" / "truth.csv", "--tracks", tracks, "--distance", 1.5, "--json")
        return json.loads(told.stdout)

    def test_all_is_found_once_under_one_name(self):
        self.track(self.made / "boxes" / "rig.toml", "-o", "match.csv", "--size", "105x68")
        rows = rows_of(self.folder / "match.csv")
        self.assertEqual(list(rows[0]), HEADER)
        self.assertEqual(len({(r["frame"], r["id"]) for r in rows}), len(rows))
        self.assertEqual({c for r in rows for c in r["cameras"].split()}, {"cam1", "cam2", "cam3", "cam4"})
        self.assertTrue(all(-2 <= float(r["x"]) <= 107 and -2 <= float(r["y"]) <= 70 for r in rows))
        self.assertGreater(self.evaluated("match.csv")["idf1"], 0.9)

    def test_people_of_an_open_square_come_and_leave(self):
        subprocess.run([MAREY, "simulate", "square", "-o", "square", "-q", "--seconds", "30"], cwd=self.folder, check=True, timeout=120)
        rig, truth = "square/rig.toml", "square/truth.csv"
        self.track(rig, "-o", "whole.csv", "--size", "36x12", "-q")
        told = self.marey("evaluate", "--truth", truth, "--tracks", "whole.csv", "--distance", 1, "--json")
        self.assertGreater(json.loads(told.stdout)["idf1"], 0.6)
        self.track(rig, "-o", "corner.csv", "--area", "0,0 12,0 0,12", "--margin", "0", "-q")
        rows = rows_of(self.folder / "corner.csv")
        self.assertTrue(rows)
        self.assertTrue(all(float(r["x"]) + float(r["y"]) < 12.01 for r in rows))
        self.assertIn("three or more", self.refused(rig, "--targets", "people", "--ground", "--area", "0,0 1,1", "-o", "match.csv", code=2))

    def test_the_same_bytes_each_time(self):
        for name in ("a.csv", "b.csv"):
            self.track(self.made / "boxes" / "rig.toml", "-o", name, "-q")
        self.assertEqual((self.folder / "a.csv").read_bytes(), (self.folder / "b.csv").read_bytes())

    def test_live_writes_what_it_knows(self):
        for associate in ("gnn", "jpda", "mht"):
            told = self.track(self.made / "boxes" / "rig.toml", "-o", "live.csv", "--live", "--association", associate, "--json")
            self.assertGreater(self.evaluated("live.csv")["idf1"], 0.8, associate)
            self.assertEqual(json.loads(told.stdout)["rows"], len(rows_of(self.folder / "live.csv")))

    def test_coordinates_are_the_users(self):
        mirror = "[world]\nground_from_world = [[1, 0, 0], [0, -1, 68], [0, 0, 1]]\n"
        plain = self.edited("plain.toml", lambda text: text)
        turned = self.edited("turned.toml", lambda text: text.replace("[world]\n", mirror))
        self.track(plain, "-o", "plain.csv", "-q")
        self.track(turned, "-o", "turned.csv", "-q")
        pairs = list(zip(rows_of(self.folder / "plain.csv"), rows_of(self.folder / "turned.csv")))
        self.assertGreater(len(pairs), 1000)
        for one, other in pairs:
            self.assertAlmostEqual(float(one["y"]), 68 - float(other["y"]), delta=0.0015)
            self.assertAlmostEqual(float(one["vy"]), -float(other["vy"]), delta=0.0015)
            self.assertEqual(one["x"], other["x"])

    def test_videos_are_in_step_with_the_videos(self):
        self.track(self.made / "films" / "rig.toml", "-o", "match.csv", "--overlay", "overlays", "--pitch-view", "above.mp4")
        films = [self.made / "films" / "cam1.mp4", "overlays/cam1.mp4", "overlays/cam2.mp4", "above.mp4"]
        told = [json.loads(self.marey("track", film, "-o", "film.txt", "--json").stdout) for film in films]
        self.assertEqual([film["frames"] for film in told], [50] * 4)
        self.assertEqual([round(film["seconds"], 3) for film in told], [1.96] * 4)

    def test_every_format_of_people_on_the_ground_is_written(self):
        rig = self.made / "boxes" / "rig.toml"
        self.track(rig, "-o", "match.marey", "-q")
        for name, format_name in (("match.dat", "tracab"), ("match.json", "soccernet"), ("match.mcap", "mcap")):
            self.track(rig, "-o", name, "-q")
            said = json.loads(self.marey("info", name, "--json").stdout)
            self.assertEqual(said["format"], format_name)
            self.marey("convert", "match.marey", "converted_" + name, "-q")
            if format_name != "mcap":  # which holds when it was written
                self.assertEqual((self.folder / name).read_bytes(), (self.folder / ("converted_" + name)).read_bytes(), name)
        self.track(rig, "-o", "other.txt", "--format", "tracab", "-q")
        self.assertEqual([path.name for path in self.folder.glob("*.part.marey")], [])
        said = self.refused(rig, "--ground", "-o", "match.c3d", code=2)
        self.assertIn("people on the ground", said)
        self.assertIn("tracab", self.refused(rig, "--ground", "-o", "match.csv", "--format", "c3d", code=2))

    def test_one_cameras_boxes(self):
        rig = self.made / "boxes" / "rig.toml"
        self.track(rig, "-o", "cam2.txt", "--format", "mot", "--camera", "cam2", "-q")
        told = self.marey("evaluate", "--truth", self.made / "boxes" / "cam2_truth.txt", "--tracks", "cam2.txt", "--json")
        self.assertGreater(json.loads(told.stdout)["idf1"], 0.8)
        self.assertIn("--camera", self.refused(rig, "--ground", "-o", "match.csv", "--format", "mot", code=2))
        said = self.refused(rig, "--ground", "-o", "match.csv", "--format", "mot", "--camera", "cam9")
        self.assertIn("cam9", said)
        self.assertIn("cam1", said)

    def test_images_next_to_detections(self):
        self.track(self.made / "films" / "rig.toml", f"cam2={self.made / 'films' / 'cam2.txt'}", "-o", "match.csv", "--size", "105x68")
        self.assertEqual({c for r in rows_of(self.folder / "match.csv") for c in r["cameras"].split()}, {"cam1", "cam2"})

    def test_bramble_tracks_two_without_detections(self):
        self.marey("simulate", "people", "--people", 2, "--frames", 250, "--seed", 1, "-o", "two", "-q")
        self.track("two/rig.toml", "--association", "bramble", "-o", "a.csv", "-q")
        places = {(row["frame"], float(row["x"]), float(row["y"])) for row in rows_of(self.folder / "a.csv")}
        truth = rows_of(self.folder / "two/positions.csv")
        found = sum(any(frame == one["frame"] and math.hypot(x - float(one["x"]), y - float(one["y"])) < 1 for frame, x, y in places)
                    for one in truth)
        self.assertGreater(found, 0.9 * len(truth))
        self.assertLess(len(places), 1.1 * len(truth))

    def test_bramble_reports_the_same_twice(self):
        self.marey("simulate", "people", "--people", 2, "--frames", 60, "--seed", 1, "-o", "two", "-q")
        for name in ("a.csv", "b.csv"):
            self.track("two/rig.toml", "--association", "bramble", "-o", name, "-q")
        self.assertGreater(len(rows_of(self.folder / "a.csv")), 40)
        self.assertEqual((self.folder / "a.csv").read_bytes(), (self.folder / "b.csv").read_bytes())

    def test_bramble_needs_images_and_nothing_next_to(self):
        said = self.refused(self.made / "boxes/rig.toml", "--targets", "people", "--ground", "--association", "bramble", "-o", "match.csv")
        self.assertIn("bramble looks at images", said)
        said = self.refused(self.made / "films/rig.toml", "--targets", "people", "--ground", "--association", "bramble", "--teams", "white,blue",
                            "-o", "match.csv", code=2)
        self.assertIn("--teams", said)

    def test_rig_and_ground_go_together(self):
        rig = self.made / "boxes" / "rig.toml"
        self.assertIn("--ground", self.refused(rig, "-o", "match.csv", code=2))
        self.refused(self.made / "films" / "cam1.mp4", "--ground", "-o", "match.csv")
        self.assertIn("--pitch-view", self.refused(rig, "--ground", "--plot", "ways.svg", "-o", "match.csv", code=2))
        self.assertIn("people", self.refused(rig, "--ground", "--targets", "markers", "-o", "match.csv", code=2))

    def test_what_is_missing_is_named_with_its_camera(self):
        gone = self.edited("gone.toml", lambda text: text.replace('"cam3.txt"', '"nothing.txt"'))
        said = self.refused(gone, "--ground", "-o", "match.csv")
        self.assertIn('"cam3"', said)
        self.assertIn("nothing.txt", said)
        said = self.refused(self.made / "films" / "rig.toml", "cam1=nothing.mp4", "--ground", "-o", "match.csv")
        self.assertIn('"cam1"', said)

    def test_empty_detections(self):
        (self.folder / "empty.txt").write_text("")
        said = self.refused(self.made / "boxes" / "rig.toml", "cam1=empty.txt", "--ground", "-o", "match.csv")
        self.assertIn('"cam1"', said)
        self.assertIn("empty.txt", said)

    def test_detections_that_break_off(self):
        whole = (self.made / "boxes" / "cam2.txt").read_bytes()
        middle = whole.index(b"\n", len(whole) // 2)
        (self.folder / "cut.txt").write_bytes(whole[: middle + 5])
        said = self.refused(self.made / "boxes" / "rig.toml", "cam2=cut.txt", "--ground", "-o", "match.csv")
        self.assertIn("cut.txt:", said)

    def test_what_cannot_be_requested_for(self):
        rig = self.made / "boxes" / "rig.toml"
        said = self.refused(rig, "--ground", "--format", "mot", "--camera", "nobody", "-o", "boxes.txt")
        self.assertIn("cam1, cam2", said)
        self.assertIn("images", self.refused(rig, "--ground", "--overlay", "films", "-o", "match.csv"))

    def test_uncalibrated_cameras(self):
        (self.folder / "rig.toml").write_text(
            f'[[camera]]\nname = "cam1"\nsource = "{self.made / "films" / "cam1.mp4"}"\n')
        self.assertIn("calibrate", self.refused("rig.toml", "--ground", "-o", "match.csv"))

    def test_a_margin_needs_a_pitch(self):
        self.assertIn("--size", self.refused(self.made / "boxes" / "rig.toml", "--ground", "--margin", 3, "-o", "match.csv", code=2))


if __name__ == "__main__":
    MAREY = sys.argv.pop(1)
    unittest.main()
