"""`marey calibrate people` as docs/calibrate.md has it, on simulated people's keypoints, and on input that cannot be used.

Usage: calibrate_people_test.py MAREY [unittest options]. Nothing else is needed.
"""

import json
import math
import pathlib
import shutil
import subprocess
import sys
import tempfile
import tomllib
import unittest

MAREY = ""


def centre(camera):
    return [-sum(camera["rotation"][k][i] * camera["translation"][k] for k in range(3)) for i in range(3)]


class CalibratePeople(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="marey_people_rig_"))
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        cls.marey("simulate", "room", "--cameras", 4, "--frames", 300, "--rate", 25, "--keypoints", "--offset", 0.2, "--seed", 2, "-o", "room", "-q")
        cls.truth = tomllib.loads((cls.folder / "room/rig.toml").read_text())["camera"]
        blind = [f'[[camera]]\nname = "{c["name"]}"\nsize = {c["size"]}\nrate = 25\n' for c in cls.truth]
        (cls.folder / "blind.toml").write_text("\n".join(blind))
        cls.sources = [f"{c['name']}=room/keypoints_{c['name']}.json" for c in cls.truth]

    @classmethod
    def marey(cls, *arguments, code=0):
        done = subprocess.run([MAREY, *map(str, arguments)], capture_output=True, text=True, cwd=cls.folder, timeout=600)
        assert done.returncode == code, f"{arguments}\n{done.stdout}\n{done.stderr}"
        return done

    def refused(self, *arguments, code=1):
        said = self.marey("calibrate", "people", *arguments, "-o", "never.toml", code=code).stderr.strip()
        self.assertFalse((self.folder / "never.toml").exists())
        self.assertTrue(said.splitlines()[-1].startswith("marey: "), said)
        return said

    def test_people_give_a_rig_that_reconstructs(self):
        apart = math.dist(centre(self.truth[0]), centre(self.truth[1]))
        said = json.loads(self.marey("calibrate", "people", "blind.toml", *self.sources, "--distance", f"cam1,cam2={apart}", "-o", "rig.toml",
                                     "--json", "-q").stdout)
        self.assertEqual(said["people"], 1)
        self.assertTrue(1.5 < said["height_m"] < 2, said["height_m"])
        found = tomllib.loads((self.folder / "rig.toml").read_text())["camera"]
        for a in range(4):
            self.assertLess(abs(found[a]["focal"][0] / self.truth[a]["focal"][0] - 1), 0.05)
            offset = found[a]["offset_s"] - found[0]["offset_s"] - (self.truth[a]["offset_s"] - self.truth[0]["offset_s"])
            self.assertLess(abs(offset), 0.5 / 25)
            for b in range(a):
                true = math.dist(centre(self.truth[a]), centre(self.truth[b]))
                self.assertLess(abs(math.dist(centre(found[a]), centre(found[b])) / true - 1), 0.04, f"{a} {b}")
        self.marey("reconstruct", "rig.toml", *self.sources, "--targets", "keypoints", "-o", "walk.marey", "-q")

    def test_height_gives_the_scale(self):
        said = self.marey("calibrate", "people", "blind.toml", *self.sources, "--height", 1.75, "-o", "tall.toml").stdout
        self.assertIn("height 1.75 m", said)
        self.assertIn("place ±cm", said)
        said = json.loads(self.marey("calibrate", "people", "blind.toml", *self.sources, "-o", "tall.toml", "--json", "-q").stdout)
        self.assertTrue(any("--height" in note for note in said["notes"]), said["notes"])

    def test_input_that_cannot_be_used(self):
        self.assertIn("--height", self.refused("blind.toml", *self.sources, "--height", 1.8, "--distance", "cam1,cam2=3", code=2))
        self.assertIn("cam9", self.refused("blind.toml", *self.sources, "--distance", "cam1,cam9=3"))
        self.assertIn("two are needed", self.refused(self.sources[0]))
        coco = json.loads((self.folder / "room/keypoints_cam1.json").read_text())
        (self.folder / "empty.json").write_text(json.dumps(coco | {"annotations": []}))
        self.assertIn("no person", self.refused("blind.toml", *self.sources[:3], "cam4=empty.json"))
        # People who stand still, at other places than where the others saw them.
        first = {image["id"] for image in coco["images"][:5]}
        (self.folder / "short.json").write_text(json.dumps(coco | {"annotations": [a for a in coco["annotations"] if a["image_id"] in first]}))
        self.assertIn("cam4", self.refused("blind.toml", *self.sources[:3], "cam4=short.json"))
        # A phone's front camera: left is right, in the image and in the names.
        width, names = self.truth[1]["size"][0], coco["categories"][0]["keypoints"]
        other = [names.index(name.replace("left", "?").replace("right", "left").replace("?", "right")) for name in names]
        second = json.loads((self.folder / "room/keypoints_cam2.json").read_text())
        for one in second["annotations"]:
            points = [one["keypoints"][3 * i : 3 * i + 3] for i in other]
            one["keypoints"] = [value for x, y, seen in points for value in ((width - 1 - x if seen else x), y, seen)]
        (self.folder / "mirrored.json").write_text(json.dumps(second))
        self.assertIn("mirrored", self.refused("blind.toml", self.sources[0], "cam2=mirrored.json", *self.sources[2:]))
        # Cameras in two rooms.
        self.marey("simulate", "room", "--motion", "wave", "--cameras", 4, "--frames", 300, "--rate", 25, "--keypoints", "--seed", 2, "-o", "elsewhere", "-q")
        others = [f"{name}=elsewhere/keypoints_{name}.json" for name in ("cam3", "cam4")]
        self.assertRegex(self.refused("blind.toml", *self.sources[:2], *others), "never show one person|no person is seen by two cameras at the same time")
        self.assertIn("nothing.json", self.refused("blind.toml", *self.sources[:3], "cam4=nothing.json"))


if __name__ == "__main__":
    MAREY = str(pathlib.Path(sys.argv[1]).resolve())
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
