"""Game states evaluated, cameras planned, faces blurred, bones named: from the command line, as users do it.

Usage: reach_test.py MAREY [unittest options]
"""

import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

MAREY = ""
ROOM = """points = "free"
[volume]
from = [-2, -2, 0]
to = [2, 2, 2]
[mounts]
from = [-4, -4, 1.5]
to = [4, 4, 2.6]
[cameras]
count = 6
size = [1280, 1024]
noise_px = 0.1
"""


def person(image, track, x, role="player", team="left", jersey="7"):
    return {"id": "1", "image_id": image, "track_id": track, "supercategory": "object", "category_id": 1,
            "attributes": {"role": role, "team": team, "jersey": jersey}, "bbox_pitch": {"x_bottom_middle": x, "y_bottom_middle": 0}}


class Reach(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="marey_reach_"))
        self.addCleanup(shutil.rmtree, self.folder)

    def marey(self, *words, code=0):
        done = subprocess.run([MAREY, *map(str, words)], cwd=self.folder, capture_output=True, text=True, timeout=600)
        self.assertEqual(done.returncode, code, f"{words}\n{done.stdout}\n{done.stderr}")
        return done

    def write(self, name, content):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(content if isinstance(content, str) else json.dumps(content))

    def truth(self, people):
        images = sorted({one["image_id"] for one in people})
        return {"info": {"im_ext": ".jpg", "seq_length": len(images)}, "annotations": people,
                "images": [{"image_id": image, "has_labeled_person": True, "has_labeled_pitch": True, "has_labeled_camera": True} for image in images]}

    def test_game_states(self):
        images = [f"2021{i:06d}" for i in range(1, 11)]
        people = [person(image, track, 10 * track, jersey=str(track)) for image in images for track in (1, 2)]
        self.write("valid/SNGS-021/Labels-GameState.json", self.truth(people))
        self.write("found/SNGS-021.json", {"predictions": people})
        same = json.loads(self.marey("evaluate", "--truth", "valid/SNGS-021/Labels-GameState.json", "--tracks", "found/SNGS-021.json", "--json").stdout)
        self.assertAlmostEqual(same["gs_hota"], 1, delta=1e-12)
        # One of two has a number that is not his: DetA = 10 / 30.
        wrong = [person(image, track, 10 * track, jersey=str(min(track, 1))) for image in images for track in (1, 2)]
        self.write("found/SNGS-021.json", {"predictions": wrong})
        done = self.marey("evaluate", "--truth", "valid", "--tracks", "found", "--json")
        found = json.loads(done.stdout)
        self.assertAlmostEqual(found["gs_hota"], (1 / 3) ** 0.5, delta=1e-12)
        self.assertAlmostEqual(found["hota_of"]["teams"], 1, delta=1e-12)
        self.assertEqual(found["clips"][0]["clip"], "SNGS-021")
        self.assertIn("2 people of the team left have the number 1", done.stderr)
        self.assertIn("GS-HOTA      57.7 %", self.marey("evaluate", "--truth", "valid", "--tracks", "found").stdout)
        self.write("found/SNGS-021.json", {"predictions": [person(images[0], 1, 0, role="coach")]})
        self.assertIn('person 1 of the list has the role "coach"', self.marey("evaluate", "--truth", "valid", "--tracks", "found", code=1).stderr)
        self.assertIn("has no SNGS-021.json", self.marey("evaluate", "--truth", "valid", "--tracks", "valid", code=1).stderr)

    def test_a_match_becomes_a_game_state(self):
        rows = "".join(f"{frame},{frame / 25},{track},{label},{team},{50 + track},30\n" for frame in range(10)
                       for track, label, team in ((1, "7", "red"), (2, "1 keeper", "red"), (3, "7", "blue"), (4, "7", "blue")))
        self.write("match.csv", "frame,time,id,label,team,x,y\n" + rows)
        (self.folder / "out/SoccerNetGS-valid").mkdir(parents=True)
        self.marey("convert", "match.csv", "out/SoccerNetGS-valid/SNGS-021.json", "--format", "soccernet", "-q")
        state = json.loads((self.folder / "out/SoccerNetGS-valid/SNGS-021.json").read_text())
        self.assertEqual(state["predictions"][0]["image_id"], "2021000001")
        roles = {one["track_id"]: (one["attributes"]["role"], one["attributes"]["jersey"]) for one in state["predictions"]}
        self.assertEqual(roles, {1: ("player", "7"), 2: ("goalkeeper", "1"), 3: ("player", "7"), 4: ("player", "7")})
        self.marey("convert", "match.csv", "plain.json", "--format", "soccernet", "-q")
        self.assertEqual(json.loads((self.folder / "plain.json").read_text())["predictions"][0]["image_id"], "1000000001")

    def test_a_room_is_planned(self):
        self.write("room.toml", ROOM)
        done = json.loads(self.marey("plan", "room.toml", "--plot", "plan.svg", "-o", "planned.toml", "--json").stdout)
        self.assertEqual(len(done["cameras"]), 6)
        self.assertGreater(done["planned"]["covered"], 0.95)
        self.assertIn("<svg", (self.folder / "plan.svg").read_text())
        self.assertEqual((self.folder / "planned.toml").read_text().count("[[camera]]"), 6)
        more = json.loads(self.marey("plan", "room.toml", "--count", 10, "--json").stdout)
        self.assertLess(more["planned"]["median_mm"], done["planned"]["median_mm"])
        # Of a rig that is there, with the noise that the room says: the expected error is reached.
        self.marey("simulate", "room", "--markers", 30, "--frames", 60, "--cameras", 6, "--noise", 0.1, "-o", "sim", "-q")
        self.marey("reconstruct", "sim/rig.toml", "--observations", "sim/observations.csv", "-o", "walk.marey", "-q")
        found = json.loads(self.marey("plan", "room.toml", "--rig", "sim/rig.toml", "--recording", "walk.marey", "--json").stdout)
        self.assertGreater(found["rig"]["covered"], 0.5)
        self.assertGreater(found["reached"]["points"], 1000)
        self.assertLess(abs(found["reached"]["noise_px"] - 0.1), 0.05)
        self.write("bad.toml", ROOM.replace("count = 6", "count = 1").replace("[volume]", "[volumes]"))
        said = self.marey("plan", "bad.toml", code=1).stderr
        for part in ("count must be 2 to 64", '"volumes" is not known', "has no [volume]"):
            self.assertIn(part, said)
        self.assertIn("give --rig too", self.marey("plan", "room.toml", "--recording", "walk.marey", code=1).stderr)

    def test_faces_are_blurred_in_overlay_and_copy(self):
        self.marey("simulate", "people", "--situation", "crowd", "--people", 3, "--frames", 30, "-o", "people", "-q")
        said = json.loads(self.marey("track", "people/video.mp4", "-o", "t.csv", "--blur", "faces", "--copy", "copy.mp4", "--overlay", "over.mp4", "--json").stdout)
        self.assertEqual(said["copy"], "copy.mp4")
        self.marey("track", "copy.mp4", "-o", "again.csv", "-q")  # a video of as many frames, in which people are still found
        before, after = ({line.split(",")[0] for line in (self.folder / name).read_text().splitlines()[1:]} for name in ("t.csv", "again.csv"))
        self.assertGreater(len(after), 0.7 * len(before))
        self.assertIn("give one of them", self.marey("track", "people/video.mp4", "-o", "t.csv", "--blur", "faces", code=2).stderr)
        self.assertIn("--blur", self.marey("track", "people/video.mp4", "-o", "t.csv", "--copy", "c.mp4", code=2).stderr)

    def test_the_old_name_of_bones_is_refused_with_the_new_one(self):
        self.assertIn("--bvh-names is called --rig-names now", self.marey("solve", "x.c3d", "-o", "x.bvh", "--bvh-names", "mixamo", code=2).stderr)
        self.assertIn("bones are known of mixamo, unreal, vrm, rokoko, rigify", self.marey("solve", "x.c3d", "-o", "x.bvh", "--rig-names", "maya", code=2).stderr)


if __name__ == "__main__":
    MAREY = sys.argv.pop(1)
    unittest.main(argv=["reach_test.py", *sys.argv[1:]])
