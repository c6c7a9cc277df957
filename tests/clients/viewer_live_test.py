"""The page of live runs in Chromium: every kind of target is listed, named and fitted, cameras are adjusted and masked, a wand is waved.

    viewer_live_test.py MAREY LIVE_SCENE [FOLDER]      exits 77 (skipped) where Node, the page's packages or Chromium are not here

Screenshots are left in FOLDER.
"""
import json
import pathlib
import re
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


def inspect(script, folder, scenario, address):
    script = pathlib.Path(__file__).with_name(script)
    subprocess.run(["node", script, viewer_test.PAGE, folder, scenario, address], check=True, timeout=300)


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


if __name__ == "__main__":
    viewer_test.skip_where_absent()
    with tempfile.TemporaryDirectory() as temporary:
        chosen = pathlib.Path(sys.argv[3] if len(sys.argv) > 3 else temporary)
        chosen.mkdir(exist_ok=True)
        main(*(pathlib.Path(path).resolve() for path in sys.argv[1:3]), chosen.resolve())
