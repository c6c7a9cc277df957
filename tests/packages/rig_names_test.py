"""Skeletons by other programs' bones (`--rig-names`) in Blender: BVH and GLB, where every joint is and how the skeleton stands at rest.

Usage: rig_names_test.py MAREY [unittest options]. The Python of MAREY_BLENDER has bpy (`pip install bpy`, Python 3.11, 370 MB); without it the
test exits 77 (skipped).
"""

import csv
import json
import math
import os
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest

MAREY = ""
PYTHON = os.environ.get("MAREY_BLENDER") or str(pathlib.Path(__file__).resolve().parents[2] / ".blender/bin/python")
FRAMES, RATE = 40, 100
SIDED = ["thigh", "shank", "foot", "clavicle", "arm", "forearm", "hand"]
# What each program calls the segments: pelvis, trunk, head; then those of a side, {} for what names it.
NAMES = {
    "mixamo": (["mixamorig:Hips", "mixamorig:Spine", "mixamorig:Head"],
               ["mixamorig:{}" + name for name in ("UpLeg", "Leg", "Foot", "Shoulder", "Arm", "ForeArm", "Hand")], ("Left", "Right")),
    "unreal": (["pelvis", "spine_01", "head"],
               [name + "_{}" for name in ("thigh", "calf", "foot", "clavicle", "upperarm", "lowerarm", "hand")], ("l", "r")),
    "vrm": (["hips", "spine", "head"],
            ["{}" + name for name in ("UpperLeg", "LowerLeg", "Foot", "Shoulder", "UpperArm", "LowerArm", "Hand")], ("left", "right")),
    "rokoko": (["Hips", "Spine1", "Head"], ["{}" + name for name in ("Thigh", "Shin", "Foot", "Shoulder", "Arm", "ForeArm", "Hand")], ("Left", "Right")),
    "rigify": (["spine", "spine.001", "spine.006"],
               [name + ".{}" for name in ("thigh", "shin", "foot", "shoulder", "upper_arm", "forearm", "hand")], ("L", "R")),
}
BVH = {"mixamo": (0.01, "Y", "Zrotation Yrotation Xrotation"), "unreal": (0.01, "Z", "Zrotation Yrotation Xrotation"),
       "vrm": (1, "Y", "Yrotation Xrotation Zrotation"), "rokoko": (0.01, "Y", "Yrotation Xrotation Zrotation"),
       "rigify": (1, "Z", "Zrotation Yrotation Xrotation")}
# m, z up: the bones' heads by frame, and where they are at rest.
READ = """
import bpy, json, sys
kind, path, frames, rate, unit, up = sys.argv[1], sys.argv[2], int(sys.argv[3]), int(sys.argv[4]), float(sys.argv[5]), sys.argv[6]
bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene
scene.render.fps, scene.render.fps_base = rate, 1
if kind == 'bvh':
    bpy.ops.import_anim.bvh(filepath=path, global_scale=unit, axis_forward='-Z' if up == 'Y' else 'Y', axis_up=up, rotate_mode='NATIVE', update_scene_duration=True)
else:
    bpy.ops.import_scene.gltf(filepath=path)
first = round(min(action.frame_range[0] for action in bpy.data.actions))
body = next(thing for thing in scene.objects if thing.type == 'ARMATURE')
rest = {bone.name: list(body.matrix_world @ bone.head_local) for bone in body.data.bones}
parents = {bone.name: bone.parent.name if bone.parent else None for bone in body.data.bones}
places = []
for frame in range(frames):
    scene.frame_set(first + frame)
    places.append({bone.name: list(body.matrix_world @ bone.head) for bone in body.pose.bones})
print('FOUND ' + json.dumps([places, rest, parents]))
"""
METARIG = """
import bpy, json
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.preferences.addon_enable(module='rigify')
bpy.ops.object.armature_human_metarig_add()
body = bpy.context.object
print('FOUND ' + json.dumps({bone.name: list(body.matrix_world @ bone.head_local) for bone in body.data.bones}))
"""


def names_of(scheme):
    """Marey's segments → the scheme's bones, by the table above."""
    middle, sided, sides = NAMES[scheme]
    names = dict(zip(["pelvis", "chest", "head"], middle))
    for word, side in zip(sides, ("left", "right")):
        names |= {f"{side}_{part}": bone.format(word) for part, bone in zip(SIDED, sided) if part != "clavicle"}  # the simulated body has none
    return names


def direction(rest, from_bone, to_bone):
    along = [b - a for a, b in zip(rest[from_bone], rest[to_bone])]
    length = math.hypot(*along)
    return [value / length for value in along]


def degrees_between(a, b):
    return math.degrees(math.acos(max(-1, min(1, sum(x * y for x, y in zip(a, b))))))


class RigNames(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="marey_rig_names_"))
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        cls.run_in(MAREY, "simulate", "room", "--motion", "walk", "--markers", "60", "--frames", FRAMES, "--rate", RATE, "--cameras", "2", "-o", "walk", "-q")
        cls.truth = [{} for _ in range(FRAMES)]
        with (cls.folder / "walk/poses.csv").open() as rows:
            for row in csv.DictReader(rows):
                cls.truth[int(row["frame"])][row["body"]] = [float(row[axis]) for axis in "xyz"]

    @classmethod
    def run_in(cls, *words, code=0):
        done = subprocess.run([str(word) for word in words], cwd=cls.folder, capture_output=True, text=True, timeout=900)
        assert done.returncode == code, f"{words}\n{done.stdout}\n{done.stderr}"
        return done

    @classmethod
    def found(cls, script, *words):
        told = cls.run_in(PYTHON, "-c", script, *words).stdout
        return json.loads(next(line for line in told.splitlines() if line.startswith("FOUND "))[6:])

    def in_blender(self, scheme, kind):
        path = f"{scheme}.{kind}"
        if not (self.folder / path).exists():
            self.run_in(MAREY, "solve", "walk/truth.csv", "--skeleton", "walk/skeleton.toml", "-o", path, "--rig-names", scheme, "-q")
        unit, up, _ = BVH[scheme]
        return self.found(READ, kind, path, FRAMES, RATE, unit, up)

    def test_every_joint_is_where_it_is(self):
        for scheme in NAMES:
            names = names_of(scheme)
            for kind in ("bvh", "glb"):
                places, _, parents = self.in_blender(scheme, kind)
                with self.subTest(scheme=scheme, kind=kind):
                    self.assertEqual(set(names.values()) - set(places[0]), set())
                    worst = max(math.dist(places[f][names[part]], self.truth[f][part]) for f in range(FRAMES) for part in names)
                    print(f"{scheme}.{kind}: {1000 * worst:.4f} mm at most")
                    self.assertLess(1000 * worst, 0.1)
                    self.assertEqual(parents[names["pelvis"]], "root" if scheme == "unreal" else parents[names["pelvis"]])
                    self.assertEqual(parents[names["left_hand"]], names["left_forearm"])

    def test_at_rest_it_stands_as_the_program_has_it(self):
        down = {"unreal": 45, "rigify": None}
        for scheme in NAMES:
            names = names_of(scheme)
            for kind in ("bvh", "glb"):
                _, rest, _ = self.in_blender(scheme, kind)
                with self.subTest(scheme=scheme, kind=kind):
                    for side, x in (("left", 1), ("right", -1)):
                        arm = direction(rest, names[f"{side}_arm"], names[f"{side}_forearm"])
                        fore = direction(rest, names[f"{side}_forearm"], names[f"{side}_hand"])
                        if scheme != "rigify":
                            angle = math.radians(down.get(scheme, 0))
                            for one in (arm, fore):
                                self.assertLess(degrees_between(one, [x * math.cos(angle), 0, -math.sin(angle)]), 0.01)
                        leg = direction(rest, names[f"{side}_thigh"], names[f"{side}_shank"])
                        self.assertLess(degrees_between(leg, [0, 0, -1]), 10)
                        self.assertGreater(x * rest[names[f"{side}_thigh"]][0], 0.02)  # its left is x: it faces -y

    def test_rigify_has_these_bones_and_this_pose(self):
        metarig = self.found(METARIG)
        names = names_of("rigify")
        self.assertEqual(set(names.values()) - set(metarig), set())
        _, rest, _ = self.in_blender("rigify", "glb")
        for a, b in (("upper_arm.L", "forearm.L"), ("forearm.L", "hand.L"), ("upper_arm.R", "forearm.R"), ("forearm.R", "hand.R")):
            self.assertLess(degrees_between(direction(rest, a, b), direction(metarig, a, b)), 0.1)

    def test_bvh_files_are_as_the_program_writes_them(self):
        for scheme, (_, _, order) in BVH.items():
            self.in_blender(scheme, "bvh")
            channels = [line.split(None, 2)[2] for line in (self.folder / f"{scheme}.bvh").read_text().splitlines() if "CHANNELS" in line]
            self.assertTrue(all(line.endswith(order) for line in channels), scheme)
        self.run_in(MAREY, "solve", "walk/truth.csv", "--skeleton", "walk/skeleton.toml", "-o", "own.bvh", "--rig-names", "rokoko", "--bvh-order", "XYZ", "-q")
        self.assertIn("Xrotation Yrotation Zrotation", (self.folder / "own.bvh").read_text())

    def test_a_vrm_animation_names_its_bones(self):
        self.in_blender("vrm", "glb")
        data = (self.folder / "vrm.glb").read_bytes()
        scene = json.loads(data[20:20 + struct.unpack("<I", data[12:16])[0]])
        bones = scene["extensions"]["VRMC_vrm_animation"]["humanoid"]["humanBones"]
        required = {"hips", "spine", "head"} | {f"{side}{part}" for side in ("left", "right")
                                                for part in ("UpperLeg", "LowerLeg", "Foot", "UpperArm", "LowerArm", "Hand")}
        self.assertEqual(required - set(bones), set())
        for name, bone in bones.items():
            self.assertEqual(scene["nodes"][bone["node"]]["name"], name)

    def test_a_take_is_converted_too(self):
        self.run_in(MAREY, "solve", "walk/truth.csv", "--skeleton", "walk/skeleton.toml", "-o", "walk.marey", "-q")
        self.run_in(MAREY, "convert", "walk.marey", "again.glb", "--rig-names", "mixamo", "-q")
        self.in_blender("mixamo", "glb")
        self.assertEqual((self.folder / "again.glb").read_bytes(), (self.folder / "mixamo.glb").read_bytes())


if __name__ == "__main__":
    MAREY = sys.argv.pop(1)
    if not shutil.which(PYTHON) or subprocess.run([PYTHON, "-c", "import bpy"], capture_output=True).returncode:
        print("skipped: MAREY_BLENDER is not a Python that has bpy")
        sys.exit(77)
    unittest.main(argv=["rig_names_test.py", "-v", *sys.argv[1:]])
