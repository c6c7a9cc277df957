"""The page of live runs in Chromium: every kind of target is listed, named and fitted, cameras are adjusted and masked, a wand is
waved, people walk.

    viewer_live_test.py MAREY LIVE_SCENE [FOLDER]      exits 77 (skipped) where Node, the page's packages or Chromium are not here

Screenshots are left in FOLDER.
"""
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import tomllib

import viewer_test


def begun(command, folder):
    """A program that shows a page, and the page's address."""
    shown = subprocess.Popen([str(part) for part in command], cwd=folder, stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    for line in shown.stderr:
        if found := re.search(r"open (http://\S+) in a browser", line):
            return shown, found[1]
    raise AssertionError(f"{command} shows no page: {shown.wait()}")


def inspect(script, folder, scenario, address, timeout_s=300):
    script = pathlib.Path(__file__).with_name(script)
    subprocess.run(["node", script, viewer_test.PAGE, folder, scenario, address], check=True, timeout=timeout_s)


def write_rig(marey, folder):
    """Calibrated cameras round a few markers and two lamps in each image."""
    subprocess.run([marey, "simulate", "room", "--cameras", "4", "--markers", "12", "--frames", "2", "--size", "640", "480", "-o", "room", "-q"], cwd=folder, check=True)
    rig = re.sub(r"source = .*\n", "", (folder / "room/rig.toml").read_text())
    source = "sim://room?cameras=4&markers=12&size=640x480&rate=20&drawn=3&lamps=2&camera={}"
    rig = re.sub(r'name = "cam(\d)"\n', lambda at: at[0] + f'source = "{source.format(at[1])}"\n', rig)
    (folder / "rig.toml").write_text(rig)


def change_cameras(marey, folder):
    write_rig(marey, folder)
    before = tomllib.loads((folder / "rig.toml").read_text())["camera"]
    run_live([marey, "live", "rig.toml"], folder, "list", "cameras_phone", "cameras")
    after = tomllib.loads((folder / "rig.toml").read_text())["camera"]
    assert after[0]["exposure"] == 2 and after[0]["gain"] == 1.5 and len(after[0]["masks"]) >= 2, after[0]
    assert [len(mask) for mask in after[0]["masks"] if len(mask) != 4] == [6], "the triangle that was drawn is kept as its corners"
    assert "threshold" not in after[0], "it was automatic in the end"
    for old, new in zip(before, after):
        kept = {key: value for key, value in new.items() if key not in ("exposure", "gain", "masks")}
        assert kept == old, (old, kept)


def name_markers(marey, folder):
    run_live([marey, "live", "sim://room?cameras=4&markers=6&motion=cloud&rate=30&blobs", "-o", "named.marey"], folder, "names_phone", "names")
    subprocess.run([marey, "convert", "named.marey", "named.trc", "-q"], cwd=folder, check=True)
    assert "left knee" in (folder / "named.trc").read_text().replace("_", " "), "the take does not have the name"


def run_live(command, folder, *scenarios):
    shown, address = begun([*command, "--view", "--port", "0", "--duration", "280"], folder)
    try:
        for scenario in scenarios:
            inspect("viewer_changes.mjs", folder, scenario, address)
    finally:
        shown.send_signal(signal.SIGINT)
        shown.communicate(timeout=60)


def wave(marey, folder, scenario):
    cameras = [f'[[camera]]\nname = "cam{c}"\nsize = [640, 480]\nsource = "sim://room?cameras=4&rate=60&motion=wand&frame&size=640x480&camera={c}"\n' for c in range(1, 5)]
    if scenario == "wand":
        cameras[0] += "masks = [[0, 0, 640, 440]]\n"
    (folder / "start.toml").write_text("\n".join(cameras))
    (folder / "waved.toml").unlink(missing_ok=True)
    command = [marey, "calibrate", "wand", "start.toml", "--wand", "0,0.12,0.30", "-o", "waved.toml", "--view", "--port", "0", "--duration", "120", "--json"]
    shown, address = begun(command, folder)
    try:
        inspect("viewer_wand.mjs", folder, scenario, address)
        told = shown.communicate(timeout=30)[0]  # it ends when the page is closed
    finally:
        shown.kill()
    assert shown.returncode == 0, told
    camera = tomllib.loads((folder / "waved.toml").read_text())["camera"][0]
    assert "rotation" in camera
    if scenario == "wand":
        assert camera["gain"] == 1.2 and [len(mask) for mask in camera["masks"]] == [6], "as it was set on the page"
    print("the wand:", json.loads(told)["grade"])


def walk(marey, folder):
    """A person before three cameras, in small copies of the videos that MAREY_DATA has, over and over."""
    videos = pathlib.Path(os.environ.get("MAREY_DATA", "")) / "markerless"
    models = pathlib.Path(os.environ.get("MAREY_MODELS", viewer_test.ROOT / "build/models"))
    for there, what in ((videos.is_dir(), "MAREY_DATA names no folder with markerless/videos"), ((models / "pose_landmark_full.onnx").exists(), "no network (script/model)"),
                        (shutil.which("ffmpeg") is not None, "ffmpeg is not here")):
        if not there:
            print("people who walk: skipped:", what)
            return
    subprocess.run([marey, "convert", videos / "calibration/Calib.qca.txt", "stands.toml", "-q"], cwd=folder, check=True)
    lenses = {}
    for camera in tomllib.loads((folder / "stands.toml").read_text())["camera"][1:]:
        name, half = camera["name"], [side // 2 for side in camera["size"]]
        subprocess.run(["ffmpeg", "-v", "error", "-y", "-i", videos / f"videos/{name}.mp4", "-vf", f"fps=10,scale={half[0]}:{half[1]}", "-crf", "18", f"{name}.mp4"], cwd=folder, check=True)
        lenses[name] = f'[[camera]]\nname = "{name}"\nsize = {half}\nsource = "play:{folder}/{name}.mp4?loop"\nmodel = "brown"\n' + "".join(
            f"{key} = {[value / 2 for value in camera[key]]}\n" for key in ("focal", "principal")) + f'distortion = {camera["distortion"]}\n'
    (folder / "blind.toml").write_text("\n".join(lenses.values()))
    command = [marey, "calibrate", "people", "blind.toml", "--model", "lite", "-o", "walked.toml", "--view", "--port", "0", "--duration", "120", "--json"]
    shown, address = begun(command, folder)
    try:
        inspect("viewer_people.mjs", folder, "people", address, 800)
        told, why = shown.communicate(timeout=30)  # it ends when the page is closed
    finally:
        shown.kill()
    assert shown.returncode in (0, 1) and (folder / "walked.toml").exists() == (shown.returncode == 0), (told, why)
    if shown.returncode == 0:
        cameras = tomllib.loads((folder / "walked.toml").read_text())["camera"]
        assert all("rotation" in camera and camera["source"].startswith("play:") for camera in cameras), cameras
    assert sorted(path.name for path in (folder / "walked_video").iterdir()) == sorted([f"{name}.mp4" for name in lenses] + ["rig.toml"])
    print("people:", json.loads(told)["cameras"] if told else why.splitlines()[-1])


def show_kinds(marey, live_scene, folder):
    """A page for each kind of target."""
    def run(*arguments):
        subprocess.run([marey, *arguments, "-q"], cwd=folder, check=True)

    run("simulate", "people", "--frames", "100", "--size", "320", "180", "--height", "40", "-o", "street")
    run("simulate", "match", "--cameras", "2", "--layout", "football", "--seconds", "1", "--size", "640", "360", "--render", "-o", "match")
    run("simulate", "room", "--motion", "walk", "--markers", "50", "--frames", "600", "-o", "walk")
    run("reconstruct", "walk/rig.toml", "--observations", "walk/observations.csv", "--labels", "walk/labels.csv", "-o", "walk.marey")
    run("body", "define", "walk/truth.csv", "--markers", "head1,head2,head3", "--name", "head", "-o", "head.toml")
    run("body", "track", "walk.marey", "head.toml", "-o", "bodies.marey")
    match = ["match/rig.toml", "left=play:match/left.mp4?loop", "right=play:match/right.mp4?loop", "--ground"]
    for scenario, *arguments in (
        ("image_markers", "sim://room?cameras=1&rate=20&markers=8&size=320x240&blobs"),
        ("image_people", "play:street/video.mp4?loop", "--targets", "people"),
        ("space_markers", "sim://room?cameras=4&rate=30&markers=8&blobs"),
        ("space_skeleton", "play:walk.marey?loop", "--skeleton", "walk/skeleton.toml"),
        ("ground_pitch", *match, "--size", "105x68"),
        ("ground_anywhere", *match),
    ):
        shown, address = begun([marey, "live", *arguments, "--view", "--port", "0", "--duration", "280"], folder)
        try:
            inspect("viewer_kinds.mjs", folder, scenario, address)
        finally:
            shown.send_signal(signal.SIGINT)
            shown.communicate(timeout=60)
    viewer_test.inspect_at([live_scene, "bodies.marey", "60"], folder, "space_bodies", "viewer_kinds.mjs")


def main(marey, live_scene, folder):
    show_kinds(marey, live_scene, folder)
    change_cameras(marey, folder)
    name_markers(marey, folder)
    wave(marey, folder, "wand")
    wave(marey, folder, "wand_enough_phone")
    walk(marey, folder)


if __name__ == "__main__":
    viewer_test.skip_where_absent()
    with tempfile.TemporaryDirectory() as temporary:
        chosen = pathlib.Path(sys.argv[3] if len(sys.argv) > 3 else temporary)
        chosen.mkdir(exist_ok=True)
        main(*(pathlib.Path(path).resolve() for path in sys.argv[1:3]), chosen.resolve())
