"""A skeleton's motion in Blender: BVH and GLB as Marey writes them, and what `script/to-fbx` makes of them, against the true places of the joints.

Usage: fbx_test.py MAREY [unittest options]. The Python of MAREY_BLENDER has bpy; without it script/to-fbx installs one (a network, 370 MB).
"""

import csv
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

MAREY = ""
ROOT = pathlib.Path(__file__).resolve().parents[2]
PYTHON = os.environ.get("MAREY_BLENDER") or str(ROOT / ".blender/bin/python")
FRAMES, RATE = 60, 100
# Where each bone's head is, by frame, m, z up. What is imported sets the scene's first frame and its rate.
READ = """
import bpy, json, sys
kind, path, rate = sys.argv[1], sys.argv[2], float(sys.argv[3])
bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene
scene.render.fps, scene.render.fps_base = round(rate), 1
if kind == 'bvh':
    bpy.ops.import_anim.bvh(filepath=path, global_scale=0.01, axis_forward='-Z', axis_up='Y', rotate_mode='NATIVE', update_scene_duration=True)
elif kind == 'glb':
    bpy.ops.import_scene.gltf(filepath=path)
else:
    bpy.ops.import_scene.fbx(filepath=path)
first = round(min(action.frame_range[0] for action in bpy.data.actions))
body = next(thing for thing in scene.objects if thing.type == 'ARMATURE')
places = []
for frame in range(int(sys.argv[4])):
    scene.frame_set(first + frame)
    places.append({bone.name: list(body.matrix_world @ bone.head) for bone in body.pose.bones})
print('PLACES ' + json.dumps(places))
"""

FIRST = """
import bpy, sys
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.import_scene.fbx(filepath=sys.argv[1])
print('FIRST', min(round(action.frame_range[0], 3) for action in bpy.data.actions))
"""


class InBlender(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="marey_fbx_"))
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        cls.run_in(MAREY, "simulate", "room", "--motion", "walk", "--markers", "60", "--frames", FRAMES, "--rate", RATE, "--cameras", "2", "-o", "walk", "-q")
        cls.run_in(MAREY, "solve", "walk/truth.csv", "--skeleton", "walk/skeleton.toml", "-o", "walk.bvh", "-o", "walk.glb", "-q")
        cls.truth = [{} for _ in range(FRAMES)]
        with (cls.folder / "walk/poses.csv").open() as rows:
            for row in csv.DictReader(rows):
                cls.truth[int(row["frame"])][row["body"]] = [float(row[axis]) for axis in "xyz"]
        cls.run_in(ROOT / "script/to-fbx", "walk.bvh", "first.fbx")  # installs Blender where it is not there

    @classmethod
    def run_in(cls, *words, code=0):
        done = subprocess.run([str(word) for word in words], cwd=cls.folder, capture_output=True, text=True, timeout=900)
        assert done.returncode == code, f"{words}\n{done.stdout}\n{done.stderr}"
        return done

    def farthest(self, path):
        """mm, of any joint in any frame, from where it truly is."""
        told = self.run_in(PYTHON, "-c", READ, pathlib.Path(path).suffix[1:], path, RATE, FRAMES).stdout
        places = json.loads(next(line for line in told.splitlines() if line.startswith("PLACES "))[7:])
        self.assertLessEqual({"pelvis", "left_thigh", "right_hand", "head"}, set(places[0]))
        worst = max((sum((a - b) ** 2 for a, b in zip(places[f][name], self.truth[f][name])) ** 0.5, name, f)
                    for f in range(FRAMES) for name in self.truth[f] if name in places[f])
        print(f"{path}: {1000 * worst[0]:.4f} mm at most ({worst[1]}, frame {worst[2]})")
        return 1000 * worst[0]

    def test_bvh_and_glb_have_the_joints_where_they_are(self):
        for path in ("walk.bvh", "walk.glb"):
            self.assertLess(self.farthest(path), 0.1)

    def test_fbx_has_them_too(self):
        firsts = []
        for path in ("walk.bvh", "walk.glb"):
            said = self.run_in(ROOT / "script/to-fbx", path, "walk.fbx").stderr
            self.assertIn(f"{FRAMES} frames at {RATE} Hz", said)
            self.assertLess(self.farthest("walk.fbx"), 0.1)
            firsts.append(self.run_in(PYTHON, "-c", FIRST, "walk.fbx").stdout.split("FIRST ")[1].split()[0])
        self.assertEqual(firsts, ["1.0", "1.0"], "Blender imports an FBX file's frame 0 as frame 1")

    def test_what_is_no_motion_is_stated(self):
        for name, content, words in (("a.bvh", "HIERARCHY\nROOT a\n{\n}\n", "holds no motion"), ("a.glb", "glTF", "is damaged"), ("b.glb", "x", "is not a GLB file"),
                                     ("b.bvh", "Frame Time: zero\n", "is damaged")):
            (self.folder / name).write_text(content)
            self.assertIn(words, self.run_in(ROOT / "script/to-fbx", name, "x.fbx", code=1).stderr)
        self.assertIn("no such file", self.run_in(ROOT / "script/to-fbx", "c.bvh", code=1).stderr)
        self.run_in(ROOT / "script/to-fbx", "walk.toml", code=2)
        self.assertFalse(list(self.folder.glob("x.fbx*")))


if __name__ == "__main__":
    MAREY = os.path.abspath(sys.argv.pop(1))
    unittest.main()
