"""What ezc3d and kineticstoolkit read of a C3D file that Marey writes beside its points: angles, events, forces, EMG, matrices of bodies.

    c3d_test.py PROGRAM      PROGRAM is marey; exits 77 (skipped) where ezc3d or the recordings are not here
"""
import csv
import json
import os
import pathlib
import subprocess
import sys
import tempfile

try:
    import ezc3d
    import numpy as np
except ImportError as missing:
    print(f"skipped: {missing}; script/setup installs it")
    sys.exit(77)
try:
    import kineticstoolkit.lab as ktk
except ImportError:
    ktk = None

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
DATA = pathlib.Path(os.environ.get("MAREY_DATA", ROOT / "../shared/data"))
WALK = DATA / "gait_children/HC002D/straight_HC002D06.c3d"
STANDING = DATA / "gait_children/HC002D/static_HC002D02.c3d"
TRIPLES = {  # of `marey gait --angles`
    "LHipAngles": "left_hip_{}:flexion,adduction,rotation",
    "RKneeAngles": "right_knee_{}:flexion,adduction,rotation",
    "LThoraxAngles": "left_trunk_{}:tilt,obliquity,rotation",
    "RPelvisAngles": "right_pelvis_{}:tilt,obliquity,rotation",
}


def marey(program, *arguments):
    done = subprocess.run([program, *map(str, arguments)], capture_output=True, text=True)
    assert done.returncode == 0, (arguments, done.stderr)
    return done.stdout


def values(c3d, group, name):
    return c3d["parameters"][group][name]["value"]


def expect_points(before, after):
    """Every point that the first has under its name, to a float's precision."""
    labels = list(values(after, "POINT", "LABELS"))
    there = [name for name in values(before, "POINT", "LABELS") if name in labels and not name.endswith("Angles")]
    assert len(there) > 30, there
    for name in there:
        a = before["data"]["points"][:3, list(values(before, "POINT", "LABELS")).index(name)]
        b = after["data"]["points"][:3, labels.index(name)]
        assert np.allclose(a, b, rtol=2e-7, atol=1e-4, equal_nan=True), name
    print(f"{len(there)} points as they were")


def expect_analog(before, after, first=0):
    count = after["data"]["analogs"].shape[2]
    assert (before["data"]["analogs"][:, :, first : first + count] == after["data"]["analogs"]).all()
    for name in ("LABELS", "UNITS"):
        assert list(values(before, "ANALOG", name)) == list(values(after, "ANALOG", name)), name
    for name in ("SCALE", "OFFSET", "GEN_SCALE", "RATE"):
        assert np.array_equal(values(before, "ANALOG", name), values(after, "ANALOG", name)), name
    for name in ("TYPE", "CORNERS", "ORIGIN", "CHANNEL", "ZERO"):
        assert np.array_equal(values(before, "FORCE_PLATFORM", name), values(after, "FORCE_PLATFORM", name)), name
    print(f"{after['data']['analogs'].shape[1]} channels, {count} samples as they were, with their plates")


def expect_plug_in_gaits(before, after):
    """Vicon's own angles stand in the walk under the same names: what bears its name means the same."""
    theirs = [name for key in ("LABELS", "LABELS2") for name in values(before, "POINT", key)]
    ours = list(values(after, "POINT", "LABELS"))
    for joint, most in (("Hip", (0.01, 0.01, 0.01)), ("Knee", (0.01, 0.01, 0.01)), ("Pelvis", (0.2, 0.2, 1.1)), ("Thorax", (0.2, 0.2, 1.1)),
                        ("Ankle", (0.2, 0.02, 0.02)), ("Elbow", (0.01, 0.01, 360))):
        for side in "LR":
            a = before["data"]["points"][:3, theirs.index(f"{side}{joint}Angles")]
            b = after["data"]["points"][:3, ours.index(f"{side}{joint}Angles")]
            rmse = np.sqrt(np.nanmean(((b - a + 180) % 360 - 180) ** 2, axis=1))
            assert (rmse <= most).all(), (side, joint, rmse)
    print("angles are Plug-in Gait's own, where they bear its names")


def check_gait(program, folder):
    """Frames begin at 124; events count from frame 1 all the same."""
    said = marey(program, "gait", WALK, "--static-trial", STANDING, "--c3d", folder / "angles.c3d", "--angles", folder / "angles.csv", "--json")
    before, after = ezc3d.c3d(str(WALK)), ezc3d.c3d(str(folder / "angles.c3d"))
    assert after["header"]["points"]["first_frame"] == before["header"]["points"]["first_frame"] == 123
    expect_points(before, after)
    expect_analog(before, after)
    with open(folder / "angles.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    labels = list(values(after, "POINT", "LABELS"))
    for label, columns in TRIPLES.items():
        assert label in values(after, "POINT", "ANGLES"), label
        stem, names = columns.split(":")
        written = after["data"]["points"][:3, labels.index(label)]
        for axis, name in enumerate(names.split(",")):
            wanted = np.array([float(row[stem.format(name)] or "nan") for row in rows])
            assert np.nanmax(np.abs(written[axis] - wanted)) < 1e-4, label
            assert (np.isnan(written[axis]) == np.isnan(wanted)).all(), label
    assert list(values(after, "POINT", "ANGLE_UNITS")) == ["deg"]
    expect_plug_in_gaits(before, after)
    wanted = sorted((e["time_s"], e["side"], e["event"]) for e in json.loads(said)["events"])
    times = values(after, "EVENT", "TIMES")
    found = sorted(zip(60 * times[0] + times[1], values(after, "EVENT", "CONTEXTS"), values(after, "EVENT", "LABELS")))
    assert values(after, "EVENT", "USED")[0] == len(found) == len(wanted) == 12
    for (at, side, what), (time, context, label) in zip(wanted, found):
        assert abs(at - time) < 1e-4 and context.lower() == side and label == {"strike": "Foot Strike", "off": "Foot Off"}[what]
    theirs = values(before, "EVENT", "TIMES")
    offs = [min(abs(time - mark) for mark in 60 * theirs[0] + theirs[1]) for time, _, _ in found]
    assert max(offs) < 0.05, offs  # those that people marked in the same file
    print(f"{len(found)} events, {1000 * max(offs):.0f} ms at most from those that people marked")
    if ktk is not None:
        read = ktk.read_c3d(str(folder / "angles.c3d"))
        marks = sorted(event.time for event in read["Points"].events)
        assert np.allclose(marks, [time for time, _, _ in found], atol=1e-4), marks
        print("kineticstoolkit has them too")


def check_convert(program, folder):
    marey(program, "convert", WALK, folder / "copy.c3d")
    before, after = ezc3d.c3d(str(WALK)), ezc3d.c3d(str(folder / "copy.c3d"))
    expect_points(before, after)
    expect_analog(before, after)
    assert np.array_equal(values(before, "EVENT", "TIMES"), values(after, "EVENT", "TIMES"))
    # By way of a take, whose own file holds no forces.
    marey(program, "convert", WALK, folder / "walk.marey")
    marey(program, "edit", folder / "walk.marey", "delete LKNE")
    marey(program, "convert", folder / "walk.marey", folder / "edited.c3d", "--analog", WALK)
    edited = ezc3d.c3d(str(folder / "edited.c3d"))
    expect_analog(before, edited)
    assert "LKNE" not in values(edited, "POINT", "LABELS")


def check_bodies(program, folder):
    theirs = DATA / "c3d_kinds/C3DRotationExample.c3d"
    marey(program, "convert", theirs, folder / "bodies.c3d")
    before, after = ezc3d.c3d(str(theirs))["data"]["rotations"], ezc3d.c3d(str(folder / "bodies.c3d"))
    found = after["data"]["rotations"]
    there = ~np.isnan(before).any(axis=(0, 1))
    assert found.shape == before.shape == (4, 4, 21, 340)
    assert np.abs(found[:, :, there] - before[:, :, there]).max() < 1e-3  # mm; turns to 1e-6
    assert np.abs(found[:3, :3][:, :, there] - before[:3, :3][:, :, there]).max() < 1e-6
    assert list(values(after, "ROTATION", "LABELS"))[1] == "pelvis_4X4"
    print(f"{there.sum()} matrices of 21 bodies as they were")


def check_analog_without_scales(program, folder):
    """A file that says nothing of scales: what is written says them, for ezc3d takes them to be there, and crashed (a process of its own)."""
    theirs = DATA / "c3d_kinds/many_analogs.c3d"
    marey(program, "convert", theirs, folder / "scales.c3d")
    script = "import ezc3d, sys; c = ezc3d.c3d(sys.argv[1]); p = c['parameters']['ANALOG']; " \
             "print(c['data']['analogs'].shape[1], *(sorted(set(p[n]['value'])) for n in ('SCALE', 'GEN_SCALE', 'OFFSET')))"
    done = subprocess.run([sys.executable, "-c", script, str(folder / "scales.c3d")], capture_output=True, text=True)
    assert done.returncode == 0, (done.returncode, done.stderr)
    before, after = ezc3d.c3d(str(theirs)), ezc3d.c3d(str(folder / "scales.c3d"))
    assert np.array_equal(before["data"]["analogs"], after["data"]["analogs"], equal_nan=True)
    print(f"{done.stdout.strip()}: analog channels, scales, of a file that had none")


def main(program):
    if not WALK.exists():
        print(f"skipped: {WALK} is not here")
        return 77
    with tempfile.TemporaryDirectory() as name:
        for check in (check_gait, check_convert, check_bodies, check_analog_without_scales):
            check(program, pathlib.Path(name))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
