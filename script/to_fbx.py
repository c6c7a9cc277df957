"""What script/to-fbx runs within Blender's Python: to_fbx.py MOTION.bvh|MOTION.glb OUT.fbx."""

import json
import os
import pathlib
import struct
import sys


def fail(text):
    print(f"to-fbx: {text}", file=sys.stderr)
    sys.exit(1)


def rate_of_bvh(path):
    for line in path.read_text(errors="replace").splitlines():
        if line.strip().lower().startswith("frame time:"):
            return 1 / float(line.split(":")[1])
    fail(f"{path}: holds no motion")


def rate_of_glb(path):
    """From the times of its first animation."""
    data = path.read_bytes()
    if data[:4] != b"glTF":
        fail(f"{path}: is not a GLB file")
    length, = struct.unpack("<I", data[12:16])
    scene = json.loads(data[20:20 + length])
    if not scene.get("animations"):
        fail(f"{path}: holds no motion")
    times = scene["accessors"][scene["animations"][0]["samplers"][0]["input"]]
    span = times["max"][0] - times["min"][0]
    return (times["count"] - 1) / span if span > 0 else 30


def begin_at_zero(actions):
    """Blender puts the first frame of a BVH file on 1, and a GLB file's time 0 on frame 0."""
    first = min((action.frame_range[0] for action in actions), default=0)
    for action in actions:
        for curve in action.fcurves:
            for key in curve.keyframe_points:
                for point in (key.co, key.handle_left, key.handle_right):
                    point.x -= first


def main():
    source, target = map(pathlib.Path, sys.argv[1:])
    try:
        rate = (rate_of_bvh if source.suffix == ".bvh" else rate_of_glb)(source)
    except (ValueError, KeyError, IndexError, ZeroDivisionError, struct.error, UnicodeDecodeError):
        fail(f"{source}: is damaged")
    import bpy
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.fps = max(1, round(rate))  # whole; the base makes it exact
    scene.render.fps_base = scene.render.fps / rate
    try:
        if source.suffix == ".bvh":
            bpy.ops.import_anim.bvh(filepath=str(source), global_scale=0.01, axis_forward="-Z", axis_up="Y", rotate_mode="NATIVE",
                                    update_scene_fps=False, update_scene_duration=True)
        else:
            bpy.ops.import_scene.gltf(filepath=str(source))
    except RuntimeError as problem:
        fail(f"{source}: Blender does not read it: {str(problem).strip()}")
    begin_at_zero(bpy.data.actions)
    actions = [action.frame_range for action in bpy.data.actions]
    if not actions:
        fail(f"{source}: holds no motion")
    scene.frame_start, scene.frame_end = round(min(a[0] for a in actions)), round(max(a[1] for a in actions))
    unfinished = target.with_name(target.name + ".part.fbx")
    bpy.ops.export_scene.fbx(filepath=str(unfinished), object_types={"ARMATURE", "MESH"}, add_leaf_bones=False, bake_anim=True,
                             bake_anim_use_nla_strips=False, bake_anim_use_all_actions=False, bake_anim_step=1, bake_anim_simplify_factor=0)
    os.replace(unfinished, target)
    print(f"{target}: {scene.frame_end - scene.frame_start + 1} frames at {rate:g} Hz", file=sys.stderr)


if __name__ == "__main__":
    main()
