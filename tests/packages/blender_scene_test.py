"""A recording as a scene for Blender (`marey convert walk.marey scene.py`, and `scene.glb`): cameras, their videos, markers and skeletons are where they are.

Usage: blender_scene_test.py MAREY [unittest options]. The Python of MAREY_BLENDER has bpy (`pip install bpy`, Python 3.11, 370 MB); without it
the test exits 77 (skipped).
"""

import csv
import json
import math
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import tomllib
import unittest

MAREY = ""
PYTHON = os.environ.get("MAREY_BLENDER") or str(pathlib.Path(__file__).resolve().parents[2] / ".blender/bin/python")
FRAMES, RATE = 30, 50
READ = """
import bpy, json, runpy, sys
from bpy_extras.object_utils import world_to_camera_view
from mathutils import Vector
bpy.ops.wm.read_factory_settings(use_empty=True)
module = runpy.run_path(sys.argv[1])
scene = bpy.context.scene
markers = {thing.name: thing for thing in bpy.data.collections['markers'].objects}
bodies = [thing for thing in scene.objects if thing.type == 'ARMATURE']
cameras = [thing for thing in scene.objects if thing.type == 'CAMERA']
places, bones, hidden, images = [], [], [], {camera.name: [] for camera in cameras}
for frame in range(scene.frame_start, scene.frame_end + 1):
    scene.frame_set(frame)
    places.append({name: list(thing.matrix_world.translation) for name, thing in markers.items()})
    hidden.append([name for name, thing in markers.items() if thing.hide_viewport])
    bones.append({bone.name: list(body.matrix_world @ bone.head) for body in bodies for bone in body.pose.bones})
for camera in cameras:
    module['look_through'](camera.name)
    width, height = scene.render.resolution_x, scene.render.resolution_y
    for place in places:
        seen = {name: world_to_camera_view(scene, camera, Vector(at)) for name, at in place.items()}
        images[camera.name].append({name: [v.x * width - 0.5, (1 - v.y) * height - 0.5] for name, v in seen.items() if v.z > 0})
backgrounds = {camera.name: [[list(b.image.size), b.image.source, b.image_user.frame_start, b.image_user.frame_duration] for b in camera.data.background_images]
               for camera in cameras}
print('FOUND ' + json.dumps([places, bones, images, hidden, backgrounds, scene.render.fps / scene.render.fps_base]))
"""

# Where markers lie, how large they are, and where cameras see them; Blender gives the file's frames of 1/50 s by its own rate.
READ_GLB = """
import bpy, json, os, sys
from bpy_extras.object_utils import world_to_camera_view
bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene
scene.render.fps = int(sys.argv[2])
bpy.ops.import_scene.gltf(filepath=sys.argv[1])
scene.render.resolution_x, scene.render.resolution_y = 640, 512
labels = sys.argv[3].split(',')
cameras = [thing for thing in scene.objects if thing.type == 'CAMERA']
places, images = [], []
for frame in range(int(sys.argv[4])):
    scene.frame_set(frame)
    at = {name: scene.objects[name].matrix_world for name in labels}
    places.append({name: [*m.translation, m.to_scale().x] for name, m in at.items()})
    images.append({camera.name: {name: [*world_to_camera_view(scene, camera, m.translation)] for name, m in at.items()} for camera in cameras})
print('FOUND ' + json.dumps([places, images, {camera.name: camera['fx_px'] for camera in cameras}]), flush=True)
os._exit(0)  # Blender as a package can crash when Python ends
"""


class BlenderScene(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="marey_scene_"))
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        cls.run_in(MAREY, "simulate", "room", "--motion", "walk", "--markers", "50", "--frames", FRAMES, "--rate", RATE, "--cameras", "3", "--size", "640", "512",
                   "--render", "-o", "walk", "-q")
        cls.run_in(MAREY, "solve", "walk/truth.csv", "--skeleton", "walk/skeleton.toml", "-o", "walk.marey", "-q")
        cls.run_in(MAREY, "convert", "walk.marey", "walk/scene.py", "--rig", "walk/rig.toml", "-q")
        told = cls.run_in(PYTHON, "-c", READ, "walk/scene.py").stdout
        (cls.places, cls.bones, cls.images, cls.hidden, cls.backgrounds,
         cls.rate) = json.loads(next(line for line in told.splitlines() if line.startswith("FOUND "))[6:])
        cls.rig = tomllib.loads((cls.folder / "walk/rig.toml").read_text())

    @classmethod
    def run_in(cls, *words, code=0):
        done = subprocess.run([str(word) for word in words], cwd=cls.folder, capture_output=True, text=True, timeout=900)
        assert done.returncode == code, f"{words}\n{done.stdout}\n{done.stderr}"
        return done

    def rows(self, name):
        with (self.folder / "walk" / name).open() as rows:
            return list(csv.DictReader(rows))

    def test_markers_and_bones_are_where_they_are(self):
        self.assertEqual(len(self.places), FRAMES)
        self.assertAlmostEqual(self.rate, RATE, places=6)
        truth = {}
        for row in self.rows("poses.csv"):
            truth[int(row["frame"]), row["body"]] = [float(row[axis]) for axis in "xyz"]
        worst = max(math.dist(self.bones[f][body], at) for (f, body), at in truth.items() if body in self.bones[f])
        print(f"bones: {1000 * worst:.4f} mm at most")
        self.assertLess(1000 * worst, 0.1)
        self.assertLessEqual({"pelvis", "left_thigh", "right_hand"}, set(self.bones[0]))
        marks = self.marks()
        worst = max(math.dist(self.places[f][label], at) for (f, label), at in marks.items())
        print(f"{len(marks)} markers: {1000 * worst:.4f} mm at most")
        self.assertLess(1000 * worst, 0.1)
        self.assertGreater(len(marks), 40 * FRAMES)

    def marks(self):
        self.run_in(MAREY, "convert", "walk.marey", "points.csv", "-q")
        with (self.folder / "points.csv").open() as rows:
            return {(int(row["frame"]), row["label"]): [float(row[axis]) for axis in "xyz"] for row in csv.DictReader(rows)}

    def test_cameras_are_pinholes_of_the_rig(self):
        worst = 0
        for camera in self.rig["camera"]:
            at = self.images[camera["name"]]
            for frame in range(0, FRAMES, 7):
                for label, place in self.places[frame].items():
                    own = [sum(r * p for r, p in zip(row, place)) + t for row, t in zip(camera["rotation"], camera["translation"])]
                    if own[2] <= 0.1:
                        continue
                    pixel = [camera["focal"][i] * own[i] / own[2] + camera["principal"][i] for i in (0, 1)]
                    worst = max(worst, math.dist(pixel, at[frame][label]))
        print(f"cameras: {worst:.4f} px at most")
        self.assertLess(worst, 0.02)

    def test_glb_has_markers_and_cameras_where_they_are(self):
        marks = self.marks()
        labels = sorted({label for _, label in marks})
        self.run_in(MAREY, "convert", "walk.marey", "walk/scene.glb", "--rig", "walk/rig.toml", "-q")
        told = self.run_in(PYTHON, "-c", READ_GLB, "walk/scene.glb", RATE, ",".join(labels), FRAMES).stdout
        places, images, focal = json.loads(next(line for line in told.splitlines() if line.startswith("FOUND "))[6:])
        worst = max(math.dist(places[f][label][:3], at) for (f, label), at in marks.items())
        print(f"glb: {len(marks)} markers: {1000 * worst:.4f} mm at most")
        self.assertLess(1000 * worst, 0.1)
        for f in range(FRAMES):
            for label in labels:
                self.assertAlmostEqual(places[f][label][3], 1 if (f, label) in marks else 0, places=5, msg=f"{label} in frame {f}")
        worst = 0
        for camera in self.rig["camera"]:
            self.assertAlmostEqual(focal[camera["name"]], camera["focal"][0], places=3)
            for (f, label), place in marks.items():
                own = [sum(r * p for r, p in zip(row, place)) + t for row, t in zip(camera["rotation"], camera["translation"])]
                if own[2] <= 0.1:
                    continue
                # The file's cameras are aimed through the middle of the image; Blender makes their pixels square, by the height.
                pixel = [camera["focal"][1] * own[i] / own[2] + (639, 511)[i] / 2 for i in (0, 1)]
                x, y, _ = images[f][camera["name"]][label]
                worst = max(worst, math.dist(pixel, [x * 640 - 0.5, (1 - y) * 512 - 0.5]))
        print(f"glb: cameras: {worst:.4f} px at most")
        self.assertLess(worst, 0.05)

    def test_videos_stand_behind_the_cameras(self):
        for name, found in self.backgrounds.items():
            self.assertEqual([[640, 512], "MOVIE", 1, FRAMES], found[0][:4], name)

    def test_a_scene_reports_missing_files(self):
        (self.folder / "alone").mkdir()
        shutil.copy(self.folder / "walk/rig.toml", self.folder / "alone")  # without its videos
        self.run_in(MAREY, "convert", "walk.marey", "alone/scene.py", "--rig", "alone/rig.toml", "-q")
        said = self.run_in(PYTHON, "alone/scene.py").stdout
        self.assertIn("is not there; the camera has no background", said)
        self.assertIn("--rig-names is for bones", self.run_in(MAREY, "convert", "walk.marey", "x.py", "--rig-names", "mixamo", code=2).stderr)


if __name__ == "__main__":
    MAREY = sys.argv.pop(1)
    if not shutil.which(PYTHON) or subprocess.run([PYTHON, "-c", "import bpy"], capture_output=True).returncode:
        print("skipped: MAREY_BLENDER is not a Python that has bpy")
        sys.exit(77)
    unittest.main(argv=["blender_scene_test.py", "-v", *sys.argv[1:]])
