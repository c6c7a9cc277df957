"""`marey calibrate pitch` and `marey measure` as docs/football.md tells them, and on input that cannot be used.

Usage: football_test.py MAREY [unittest options]. Nothing else is needed.
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

RIG = """[[camera]]
name = "stand"
size = [1920, 1080]
[[camera]]
name = "other"
size = [1920, 1080]
"""


def pixel(x, y):
    """A pinhole camera over (52.5, 80), 8 m up, looking at (40, 30) of a pitch whose y grows towards it."""
    eye, at = (52.5, -80.0, 8.0), (40.0, -30.0, 0.0)
    ahead = [a - e for a, e in zip(at, eye)]
    norm = math.sqrt(sum(a * a for a in ahead))
    ahead = [a / norm for a in ahead]
    right = [ahead[1], -ahead[0], 0.0]
    norm = math.hypot(*right)
    right = [r / norm for r in right]
    down = [ahead[1] * right[2] - ahead[2] * right[1], ahead[2] * right[0] - ahead[0] * right[2], ahead[0] * right[1] - ahead[1] * right[0]]
    point = (x - eye[0], -y - eye[1], -eye[2])
    dot = lambda a: sum(p * q for p, q in zip(a, point))
    return 959.5 + 1300 * dot(right) / dot(ahead), 539.5 + 1300 * dot(down) / dot(ahead)


class Football(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="marey_football_"))
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        (cls.folder / "rig.toml").write_text(RIG)
        cls.points = [(x, y, *pixel(x, y)) for x in (0, 5.5, 11, 16.5, 52.5) for y in (0, 13.84, 24.84, 34, 43.16, 54.16, 68)]
        cls.points = [p for p in cls.points if 0 <= p[2] < 1919 and 0 <= p[3] < 1079]

    def write_clicks(self, name, points):
        (self.folder / name).write_text("x,y,u,v\n" + "".join("{},{},{:.2f},{:.2f}\n".format(*p) for p in points))
        return name

    def marey(self, *arguments, code=0):
        done = subprocess.run([MAREY, *map(str, arguments)], capture_output=True, text=True, cwd=self.folder, timeout=300)
        self.assertEqual(done.returncode, code, f"{arguments}\n{done.stdout}\n{done.stderr}")
        return done

    def refused(self, *arguments):
        said = self.marey(*arguments, code=1).stderr.strip()
        self.assertEqual(len(said.splitlines()), 1, said)
        self.assertTrue(said.startswith("marey: "), said)
        return said

    def test_clicks_make_a_camera_and_wrong_ones_are_named(self):
        wrong = [list(p) for p in self.points]
        wrong[4][2] += 90
        clicks = self.write_clicks("clicks.csv", wrong)
        pitch = ("calibrate", "pitch", "rig.toml", "--points", f"stand={clicks}", "-o", "pitch.toml", "--plots", "pictures")
        report = json.loads(self.marey(*pitch, "--json").stdout)
        camera = report["cameras"]["stand"]
        self.assertEqual(camera["observations"], len(wrong))
        self.assertEqual([i for i, p in enumerate(camera["points"]) if not p["used"]], [4])
        self.assertLess(camera["rms_px"], 1)
        self.assertTrue((self.folder / "pictures" / "stand_accuracy.svg").exists())
        self.assertIn("the click on", self.marey(*pitch).stdout)
        self.assertIn("ground_from_world", (self.folder / "pitch.toml").read_text(), "these clicks are left-handed")
        self.assertNotIn("is found on the pitch", self.marey(*pitch).stderr)
        self.write_clicks("clicks.csv", [(x, y - 20, u, v) for x, y, u, v in self.points])
        self.assertIn('camera "stand" is found on the pitch, at (52.5, 60.0), 8.0 m up', self.marey(*pitch).stderr)

    def test_clicks_that_decide_nothing_are_refused(self):
        def pitch(camera, clicks):
            return self.refused("calibrate", "pitch", "rig.toml", "--points", f"{camera}={clicks}", "-o", "never.toml")

        self.assertIn("at least 4", pitch("stand", self.write_clicks("three.csv", self.points[:3])))
        self.assertIn("one line", pitch("stand", self.write_clicks("line.csv", [p for p in self.points if p[0] == 0])))
        self.assertIn("nobody", pitch("nobody", self.write_clicks("all.csv", self.points)))
        self.assertIn("missing.csv", pitch("stand", "missing.csv"))
        (self.folder / "foreign.csv").write_bytes(b"\x00\x01\xff\n\n")
        self.assertIn("foreign.csv", pitch("stand", "foreign.csv"))
        (self.folder / "cut.xml").write_text('<annotations><image><points label="(0,0)"')
        self.assertIn("cut.xml", pitch("stand", "cut.xml"))
        left = self.write_clicks("left.csv", self.points)
        mirrored = self.write_clicks("mirrored.csv", [(105 - x, y, u, v) for x, y, u, v in self.points])
        both = ("calibrate", "pitch", "rig.toml", "--points", f"stand={left}", "--points", f"other={mirrored}", "-o", "never.toml")
        self.assertIn("mirrored", self.refused(*both))
        self.assertFalse((self.folder / "never.toml").exists())

    def test_images_are_not_drawn_over_those_of_the_cameras(self):
        clicks = self.write_clicks("own.csv", self.points)
        (self.folder / "own").mkdir()
        picture = self.folder / "own" / "stand.jpg"
        picture.write_bytes(b"taken by the camera")
        (self.folder / "own.toml").write_text('[[camera]]\nname = "stand"\nsource = "own/stand.jpg"\nsize = [1920, 1080]\n')
        pitch = ("calibrate", "pitch", "own.toml", "--points", f"stand={clicks}", "-o", "never.toml", "--plots", "own")
        self.assertIn("is an input too", self.marey(*pitch, code=2).stderr)
        self.assertEqual(picture.read_bytes(), b"taken by the camera")
        self.assertFalse((self.folder / "never.toml").exists())

    def write_people(self, name, ways):
        """Boxes, 40 px high, of people whose feet go these ways (px at 25 Hz): functions of s."""
        with open(self.folder / name, "w") as out:
            for frame in range(250):
                for x, y in (way(frame / 25) for way in ways):
                    out.write(f"{frame + 1},-1,{x - 8:.2f},{y - 39:.2f},16,40,1,-1,-1,-1\n")

    def test_cameras_known_by_their_ground_and_another_programs_detections(self):
        homography = "[[0.1, 0, {}], [0, 0.1, 0], [0, 0, 1]]"
        rig = "".join(
            f'[[camera]]\nname = "{name}"\ndetections = "{name}.txt"\nrate = 25\nsize = [640, 480]\n'
            f"ground_from_image = {homography.format(at)}\n"
            for name, at in (("a", 0), ("b", 0), ("far", 300))
        )
        (self.folder / "ground.toml").write_text(rig)
        ways = [
            lambda t, i=i: (300 + 120 * math.sin(0.7 * t + i) + 40 * math.sin(2.1 * t + 2 * i), 60 + 60 * i + 30 * math.cos(1.3 * t + i))
            for i in range(6)
        ]
        late = [lambda t, way=way: way(t + 0.6) for way in ways]
        self.write_people("a.txt", ways)
        self.write_people("b.txt", late)
        self.write_people("far.txt", ways)
        self.assertIn("ground known, offset not known, ", self.marey("info", "ground.toml").stdout)
        track = ("track", "ground.toml", "--ground", "-o", "ground.csv", "--json")
        told = json.loads(self.marey(*track).stdout)
        self.assertEqual([n for n in told["notes"] if '"b" was started 0.60' in n or '"b" was started 0.59' in n], told["notes"])
        self.assertEqual(len(told["notes"]), 1)
        self.assertTrue(any('"far"' in w and "in common" in w for w in told["warnings"]), told["warnings"])
        # What is given is trusted, and contradicted.
        given = rig.replace('name = "b"', 'name = "b"\noffset_s = 0.0').replace('name = "far"', 'name = "far"\noffset_s = 0.0')
        (self.folder / "ground.toml").write_text(given)
        told = json.loads(self.marey(*track).stdout)
        self.assertEqual(told["notes"], [])
        self.assertTrue(any('"b": its offset_s is given as 0' in w for w in told["warnings"]), told["warnings"])
        # Cameras of one clock keep 0 to the bit.
        (self.folder / "ground.toml").write_text(rig)
        self.write_people("b.txt", ways)
        self.marey(*track)
        alone = (self.folder / "ground.csv").read_text()
        (self.folder / "ground.toml").write_text(given)
        self.marey(*track)
        self.assertEqual((self.folder / "ground.csv").read_text(), alone)

    def test_measured_runs(self):
        with open(self.folder / "match.csv", "w") as out:
            out.write("frame,time,id,team,x,y\n")
            for i in range(251):
                out.write(f"{i},{i / 25},1,white,{10 + 8 * i / 25:.3f},20\n{i},{i / 25},2,blue,50,{20 + i / 25:.3f}\n")
        self.marey("measure", "match.csv", "-o", "summary.csv", "--report", "report", "-q")
        rows = list(csv.DictReader((self.folder / "summary.csv").read_text().splitlines()))
        self.assertEqual(list(rows[0])[:7], ["id", "label", "team", "distance_m", "mean_mps", "max_mps", "sprints"])
        self.assertAlmostEqual(float(rows[0]["distance_m"]), 80, delta=0.5)
        self.assertEqual((rows[0]["sprints"], rows[1]["sprints"]), ("1", "0"))
        self.assertAlmostEqual(float(rows[1]["max_mps"]), 1, delta=0.05)
        page = (self.folder / "report" / "report.html").read_text()
        self.assertIn("</html>", page)
        self.assertIn("white", page)

    def test_what_cannot_be_measured_is_refused(self):
        for name, text, sentence in [
            ("empty.csv", "", "empty"),
            ("nobody.csv", "frame,time,id,x,y\n", "no person"),
            ("short.csv", "frame,time,id,x,y\n0,0,1,2,3\n", "no person"),
            ("nan.csv", "frame,time,id,x,y\n0,0,1,nan,3\n", "nan.csv:2"),
            ("foreign.csv", "a,b\n1,2\n", "header"),
        ]:
            (self.folder / name).write_text(text)
            self.assertIn(sentence, self.refused("measure", name, "-o", "never.csv"))
            self.assertFalse((self.folder / "never.csv").exists())
        self.marey("measure", "match.csv", "-o", "s.csv", "--zones", "4,2", code=2)


if __name__ == "__main__":
    MAREY = sys.argv.pop(1)
    unittest.main()
