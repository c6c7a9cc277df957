"""`marey calibrate pitch --elements`: a camera from labelled elements, and labels that cannot be used.

Usage: pitch_elements_test.py MAREY [unittest options]. Nothing else is needed.
"""

import json
import math
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

MAREY = ""
PAN, TILT, LOCATION, FOCAL = 35.0, 79.0, (-0.5, 65.0, -14.0), 2300.0

# Straight elements at the right end, in SoccerNet's frame: from the middle, x to the right, y to the near side, z down.
LINES = {
    "Side line right": ((52.5, -34, 0), (52.5, 34, 0)),
    "Side line top": ((-52.5, -34, 0), (52.5, -34, 0)),
    "Big rect. right top": ((36, -20.16, 0), (52.5, -20.16, 0)),
    "Big rect. right main": ((36, -20.16, 0), (36, 20.16, 0)),
    "Big rect. right bottom": ((36, 20.16, 0), (52.5, 20.16, 0)),
    "Small rect. right top": ((47, -9.16, 0), (52.5, -9.16, 0)),
    "Small rect. right main": ((47, -9.16, 0), (47, 9.16, 0)),
    "Goal right post left": ((52.5, -3.66, 0), (52.5, -3.66, -2.44)),
    "Goal right crossbar": ((52.5, -3.66, -2.44), (52.5, 3.66, -2.44)),
}


def fraction(place):
    """Where SoccerNet's code sees a place, as shares of an image of 960x540; nothing outside it."""
    p, t = math.radians(PAN), math.radians(TILT)
    x, y, z = (a - b for a, b in zip(place, LOCATION))
    x, y = math.cos(p) * x + math.sin(p) * y, -math.sin(p) * x + math.cos(p) * y
    y, z = math.cos(t) * y + math.sin(t) * z, -math.sin(t) * y + math.cos(t) * z
    u, v = 479.5 + FOCAL * x / z, 269.5 + FOCAL * y / z
    return {"x": u / 959, "y": v / 539} if z > 0 and 0 <= u <= 959 and 0 <= v <= 539 else None


def labels():
    found = {}
    for name, (a, b) in LINES.items():
        seen = [s for i in range(101) if (s := fraction([p + (q - p) * i / 100 for p, q in zip(a, b)]))]
        if len(seen) > 3:
            found[name] = [seen[0], seen[-1]]
    return found


class PitchElements(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="marey_elements_"))
        cls.addClassCleanup(shutil.rmtree, cls.folder)

    def marey(self, *arguments, code=0):
        done = subprocess.run([MAREY, *arguments], capture_output=True, text=True, cwd=self.folder, timeout=120)
        self.assertEqual(done.returncode, code, f"{arguments}\n{done.stdout}\n{done.stderr}")
        return done

    def write(self, name, what):
        (self.folder / name).write_text(what if isinstance(what, str) else json.dumps(what))
        return name

    def test_camera_is_found_and_written_both_trajectories(self):
        self.assertGreaterEqual(len(labels()), 6, "the scene is as it was meant")
        frame = self.write("00012.json", labels())
        done = self.marey("calibrate", "pitch", "--elements", frame, "-o", "rig.toml", "--soccernet-cameras", "cameras", "--json")
        self.assertEqual(json.loads(done.stdout)["pictures"][0]["verdict"], "found")
        camera = json.loads((self.folder / "cameras/camera_00012.json").read_text())
        self.assertAlmostEqual(camera["pan_degrees"], PAN, delta=1.5)
        self.assertAlmostEqual(camera["tilt_degrees"], TILT, delta=1)
        self.assertAlmostEqual(camera["x_focal_length"] / FOCAL, 1, delta=0.15)
        self.marey("convert", "cameras/camera_00012.json", "again.toml")
        self.assertIn("camera_00012", (self.folder / "again.toml").read_text())
        again = self.marey("calibrate", "pitch", "--elements", frame, "-o", "second.toml", "-q")
        self.assertEqual(again.stdout, "")
        self.assertEqual((self.folder / "rig.toml").read_text(), (self.folder / "second.toml").read_text())

    def test_many_images_in_one_file(self):
        mirrored = {name.replace("right", "left", 1): points for name, points in labels().items()}
        many = self.write("many.json", {"a": labels(), "b": {"Middle line": [{"x": 0.5, "y": 0}]}, "c": mirrored})
        done = self.marey("calibrate", "pitch", "--elements", many, "-o", "many.toml")
        self.assertIn("1 of 3 images have a camera", done.stdout)
        self.assertIn("b: 1 labelled element; at least two are needed", done.stderr)
        self.assertIn("c: the labels fit a mirrored pitch", done.stderr)

    def test_what_cannot_be_used_is_one_message(self):
        def refused(frame, code=1, *more):
            done = self.marey("calibrate", "pitch", "--elements", frame, "-o", "never.toml", *more, code=code)
            self.assertEqual(done.stdout, "")
            self.assertEqual(len(done.stderr.strip().splitlines()), 1, done.stderr)
            self.assertFalse((self.folder / "never.toml").exists())
            return done.stderr

        self.assertIn("is not JSON", refused(self.write("broken.json", "{")))
        self.assertIn("is not an element of a pitch", refused(self.write("other.json", {"Tramline": [{"x": 0, "y": 0}]})))
        self.assertIn("at least two are needed", refused(self.write("one.json", {"Middle line": [{"x": 0.5, "y": 0.5}]})))
        frame = self.write("frame.json", labels())
        self.assertIn("WIDTHxHEIGHT", refused(frame, 2, "--resolution", "960"))
        self.marey("calibrate", "pitch", "--elements", frame, code=2)
        self.marey("calibrate", "pitch", "-o", "never.toml", code=2)


if __name__ == "__main__":
    MAREY = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main()
