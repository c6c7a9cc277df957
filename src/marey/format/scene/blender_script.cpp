#include "marey/format/scene/blender_script.h"

namespace marey::format::scene {

const std::string_view kBlenderScript = R"python(
import math
import pathlib

import bpy
from mathutils import Matrix, Quaternion, Vector

HERE = pathlib.Path(globals().get("__file__", ".")).resolve().parent
SENSOR_MM = 36


def collection(name):
    made = bpy.data.collections.new(name)
    bpy.context.scene.collection.children.link(made)
    return made


def curves_of(thing):
    """Blender 5 has curves in the action's channels."""
    action = thing.animation_data.action
    if hasattr(action, "fcurves"):
        return action.fcurves
    return action.layers[0].strips[0].channelbag(thing.animation_data.action_slot).fcurves


def animate(thing, path, frames, rows, stepped=False, group=None):
    """Sets a property of several numbers, or one, at these frames; all at once, for keyframe by keyframe takes minutes."""
    if not frames:
        return
    owner, prop = (thing.path_resolve(path.rsplit(".", 1)[0]), path.rsplit(".", 1)[1]) if "." in path else (thing, path)
    owner.keyframe_insert(prop, frame=frames[0])
    for curve in [curve for curve in curves_of(thing) if curve.data_path == path]:
        points = curve.keyframe_points
        points.add(len(frames) - len(points))
        values = [row[curve.array_index] if isinstance(row, (list, tuple)) else row for row in rows]
        points.foreach_set("co", [number for pair in zip(frames, values) for number in pair])
        points.foreach_set("interpolation", [0 if stepped else 1] * len(frames))
        curve.update()


def aspect(camera):
    """Blender's pixels, of which one side is 1."""
    x, y = 1 / camera["fx"], 1 / camera["fy"]
    return x / min(x, y), y / min(x, y)


def look_through(name):
    """Makes a camera the scene's: its image size and the shape of its pixels too."""
    camera = next(one for one in CAMERAS if one["name"] == name)
    scene = bpy.context.scene
    scene.camera = bpy.data.objects[name]
    scene.render.resolution_x, scene.render.resolution_y = camera["size"]
    scene.render.resolution_percentage = 100
    scene.render.pixel_aspect_x, scene.render.pixel_aspect_y = aspect(camera)


def add_background(data, camera):
    paths = [pathlib.Path(camera["video"]), HERE / camera["video"], HERE / pathlib.Path(camera["video"]).name]
    path = next((path for path in paths if camera["video"] and path.is_file()), None)
    if path is None:
        if camera["video"]:
            print(f"{camera['name']}: {camera['video']} is not there; the camera has no background")
        return
    image = bpy.data.images.load(str(path))
    if image.source != "MOVIE" and path.suffix.lower() not in (".png", ".jpg", ".jpeg", ".bmp", ".tif", ".tiff"):
        image.source = "MOVIE"
    background = data.background_images.new()
    background.image = image
    background.alpha = 1
    background.frame_method = "STRETCH"
    background.image_user.use_auto_refresh = True
    background.image_user.frame_duration = LAST + 1
    # The video's first frame is at its offset on the rig's clock.
    background.image_user.frame_start = 1 + round(camera["offset_s"] * RATE_HZ)
    data.show_background_images = True


def add_camera(camera, where):
    width, height = camera["size"]
    data = bpy.data.cameras.new(camera["name"])
    data.sensor_fit = "HORIZONTAL"
    data.sensor_width = SENSOR_MM
    data.lens = camera["fx"] * SENSOR_MM / width
    data.shift_x = ((width - 1) / 2 - camera["cx"]) / width
    data.shift_y = (camera["cy"] - (height - 1) / 2) / width * camera["fx"] / camera["fy"]
    data.display_size = 0.2
    thing = bpy.data.objects.new(camera["name"], data)
    thing.matrix_world = Matrix(camera["world_from_camera"]) @ Matrix.Diagonal((1, -1, -1, 1))
    where.objects.link(thing)
    add_background(data, camera)


def add_marker(name, rows, where):
    thing = bpy.data.objects.new(name or "point", None)
    thing.empty_display_type = "SPHERE"
    thing.empty_display_size = MARKER_M
    where.objects.link(thing)
    known = [frame for frame, row in enumerate(rows) if row is not None]
    animate(thing, "location", [FIRST + frame for frame in known], [rows[frame] for frame in known])
    # Hidden where it is not known.
    changes = [frame for frame in range(len(rows)) if frame == 0 or (rows[frame] is None) != (rows[frame - 1] is None)]
    if len(changes) > 1 or not known:
        for path in ("hide_viewport", "hide_render"):
            animate(thing, path, [FIRST + frame for frame in changes], [float(rows[frame] is None) for frame in changes], stepped=True)


def pose_matrix(row):
    return Matrix.Translation(row[:3]) @ Quaternion(row[3:]).to_matrix().to_4x4()


def add_armature(name, bones, where):
    """`bones`: name, number of the parent or None, head and tail at rest (m), then a pose a frame: x y z, quaternion w x y z, or None."""
    data = bpy.data.armatures.new(name)
    data.display_type = "STICK"
    body = bpy.data.objects.new(name, data)
    where.objects.link(body)
    bpy.context.view_layer.objects.active = body
    bpy.ops.object.mode_set(mode="EDIT")
    for bone_name, parent, head, tail, _ in bones:
        bone = data.edit_bones.new(bone_name)
        bone.head, bone.tail = head, tail
        if parent is not None:
            bone.parent = data.edit_bones[parent]
    bpy.ops.object.mode_set(mode="POSE")
    names = [bone.name for bone in data.bones]
    rest = [data.bones[name].matrix_local.copy() for name in names]
    for index, (_, parent, head, _, rows) in enumerate(bones):
        pose_bone = body.pose.bones[names[index]]
        pose_bone.rotation_mode = "QUATERNION"
        local = rest[index].inverted() @ rest[parent] if parent is not None else rest[index].inverted()
        frames, places, turns = [], [], []
        last = Quaternion()
        for frame, row in enumerate(rows):
            above = bones[parent][4][frame] if parent is not None else None
            if row is None or (parent is not None and above is None):
                continue
            own = pose_matrix(row) @ Matrix.Translation(head).inverted() @ rest[index]
            if parent is not None:
                own = (pose_matrix(above) @ Matrix.Translation(bones[parent][2]).inverted() @ rest[parent]).inverted() @ own
            place, turn, _ = (local @ own).decompose()
            if turn.dot(last) < 0:
                turn.negate()
            last = turn
            frames.append(FIRST + frame)
            places.append(list(place))
            turns.append(list(turn))
        path = f'pose.bones["{names[index]}"]'
        animate(body, path + ".location", frames, places)
        animate(body, path + ".rotation_quaternion", frames, turns)
    bpy.ops.object.mode_set(mode="OBJECT")


def build():
    scene = bpy.context.scene
    scene.render.fps = max(1, round(RATE_HZ))
    scene.render.fps_base = scene.render.fps / RATE_HZ
    scene.frame_start, scene.frame_end = FIRST, FIRST + LAST
    scene.unit_settings.system = "METRIC"
    if CAMERAS:
        where = collection("cameras")
        for camera in CAMERAS:
            add_camera(camera, where)
        look_through(CAMERAS[0]["name"])
    if MARKERS:
        where = collection("markers")
        for name, rows in MARKERS:
            add_marker(name, rows, where)
    if SKELETONS:
        where = collection("skeletons")
        for name, bones in SKELETONS:
            add_armature(name, bones, where)
    scene.frame_set(FIRST)


build()
)python";

}  // namespace marey::format::scene
