"""The viewer's page: what is checked in is what its sources give; in Chromium it loads, draws, and every control does something.

    viewer_test.py MAREY LIVE_SCENE [FOLDER]      exits 77 (skipped) where Node, the page's packages or Chromium are not here

Screenshots are left in FOLDER. `npm ci` in apps/viewer/page fetches the packages.
"""
import filecmp
import math
import pathlib
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
PAGE = ROOT / "apps/viewer/page"
FILES = ("index.html", "page.js", "page.css")


def skip_where_absent():
    for there, what in (
        (shutil.which("node"), "Node is not here (Debian's nodejs and npm)"),
        ((PAGE / "node_modules/playwright-core").is_dir(), "the page's packages are not here: npm ci in apps/viewer/page"),
        (pathlib.Path("/usr/bin/chromium").exists(), "/usr/bin/chromium is not here (Debian's chromium)"),
    ):
        if not there:
            print(f"skipped: {what}")
            sys.exit(77)


def check_built(folder):
    subprocess.run(["node", "node_modules/typescript/bin/tsc", "--noEmit"], cwd=PAGE, check=True)
    built = folder / "built"
    subprocess.run(["node", "node_modules/vite/bin/vite.js", "build", "--outDir", built, "--emptyOutDir", "--logLevel", "error"], cwd=PAGE, check=True)
    assert sorted(path.name for path in built.iterdir()) == sorted(FILES), list(built.iterdir())
    for name in FILES:
        assert filecmp.cmp(built / name, PAGE / "built" / name, shallow=False), f"{name} is not what the sources give: npm run build in apps/viewer/page"
    print("the page that is checked in is what its sources give")


def make_recordings(marey, folder):
    def run(*arguments):
        subprocess.run([marey, *arguments, "-q"], cwd=folder, check=True)

    run("simulate", "room", "--motion", "walk", "--markers", "30", "--frames", "360", "--cameras", "8", "--size", "640", "480", "-o", "walk")
    run("reconstruct", "walk/rig.toml", "--observations", "walk/observations.csv", "--labels", "walk/labels.csv", "-o", "walk.marey")
    run("simulate", "room", "--motion", "walk", "--markers", "30", "--frames", "360", "--cameras", "8", "--size", "640", "480", "--gaps", "0.04", "--gap-length", "0.2", "-o", "gaps")
    run("reconstruct", "gaps/rig.toml", "--observations", "gaps/observations.csv", "--labels", "gaps/labels.csv", "--max-gap", "0", "-o", "edit.marey")
    run("simulate", "match", "--cameras", "2", "--seconds", "6", "--boxes", "-o", "match")
    run("track", "match/rig.toml", "--ground", "-o", "match.csv")
    run("simulate", "people", "-o", "street", "--frames", "120")
    run("track", "street/video.mp4", "-o", "street.csv")
    run("track", "street/video.mp4", "-o", "street.marey")


BONES = ("Hips", "lowerback", "LARM", "l_hand", "RARM", "r_hand", "LeftUpLeg", "lfoot", "RightUpLeg", "rfoot")


def make_skeleton(path):
    """One that swings its arms, named as one of several people."""
    def joint(name, offset, children, depth):
        tab = "  " * depth
        inner = "".join(children) or f"{tab}  End Site\n{tab}  {{\n{tab}    OFFSET 0 -20 0\n{tab}  }}\n"
        channels = "6 Xposition Yposition Zposition Zrotation Xrotation Yrotation" if depth == 0 else "3 Zrotation Xrotation Yrotation"
        return f"{tab}{'ROOT' if depth == 0 else 'JOINT'} Anna:{name}\n{tab}{{\n{tab}  OFFSET {offset}\n{tab}  CHANNELS {channels}\n{inner}{tab}}}\n"

    arms = [joint(f"{side}ARM", f"{x} 15 0", [joint(f"{side.lower()}_hand", "0 -30 0", [], 3)], 2) for side, x in (("L", 20), ("R", -20))]
    legs = [joint(f"{side}UpLeg", f"{x} -8 0", [joint(f"{side[0].lower()}foot", "0 -45 0", [], 2)], 1) for side, x in (("Left", 10), ("Right", -10))]
    rows = []
    for frame in range(120):
        swing = 30 * math.sin(frame / 12)
        turns = {"LARM": swing, "RARM": -swing}
        rows.append("0 95 0 " + " ".join(f"0 {turns.get(name, 0):.3f} 0" for name in BONES))
    path.write_text("HIERARCHY\n" + joint("Hips", "0 0 0", [joint("lowerback", "0 30 0", arms, 1), *legs], 0) + f"MOTION\nFrames: {len(rows)}\nFrame Time: 0.0166667\n" + "\n".join(rows) + "\n")


def inspect_at(command, folder, scenario, script="viewer_page.mjs"):
    shown = subprocess.Popen([str(part) for part in command], cwd=folder, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    try:
        address = shown.stdout.readline().strip()
        subprocess.run(["node", pathlib.Path(__file__).with_name(script), PAGE, folder, scenario, address], check=True, timeout=400)
    finally:
        shown.terminate()
        shown.communicate(timeout=10)


def main(marey, live_scene, folder):
    check_built(folder)
    make_recordings(marey, folder)
    view = [marey, "view", "--port", "0", "-q"]
    inspect_at([*view, "walk.marey"], folder, "space")
    inspect_at([*view, "edit.marey", "--edit"], folder, "edit", "viewer_edit.mjs")
    inspect_at([*view, "edit.marey", "--edit"], folder, "edit_phone", "viewer_edit.mjs")
    make_skeleton(pathlib.Path(folder) / "anna.bvh")
    inspect_at([*view, "anna.bvh"], folder, "bones", "viewer_bones.mjs")
    inspect_at([*view, "walk.marey"], folder, "odd", "viewer_odd.mjs")
    inspect_at([*view, "street.csv", "--video", "street/video.mp4"], folder, "image")
    inspect_at([*view, "match.csv"], folder, "ground_phone")
    inspect_at([live_scene, "walk.marey", "60"], folder, "live")
    inspect_at([live_scene, "street.marey", "25"], folder, "live_image")


if __name__ == "__main__":
    skip_where_absent()
    with tempfile.TemporaryDirectory() as temporary:
        chosen = pathlib.Path(sys.argv[3] if len(sys.argv) > 3 else temporary)
        chosen.mkdir(exist_ok=True)
        main(*(str(pathlib.Path(path).resolve()) for path in sys.argv[1:3]), chosen.resolve())
