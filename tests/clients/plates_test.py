"""Force plates of C3D files as ezc3d reads them and as Marey does: types 1 to 4, written by ezc3d with random loads, and real files of type 2.

    plates_test.py PROGRAM      PROGRAM is plate_loads; exits 77 (skipped) where ezc3d is not here
"""
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

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
DATA = pathlib.Path(os.environ.get("MAREY_DATA", ROOT / "../shared/data"))
SEED = 38


def ours(program, path):
    done = subprocess.run([program, str(path)], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    plates = {}
    for line in done.stdout.splitlines():
        cells = line.split()
        row = [float(cell) for cell in cells[1:]] + [np.nan] * (8 - len(cells))
        plates.setdefault(int(cells[0]), []).append(row)
    return [np.array(plates[p]) for p in sorted(plates)]


def corners(random):
    """A rectangle that lies turned on the ground, in mm, C3D's order."""
    turn, middle = random.uniform(-3, 3), random.uniform(-500, 500, 2)
    flat = np.array([[300, -200], [-300, -200], [-300, 200], [300, 200]])
    rotated = flat @ np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]]) + middle
    return np.vstack([rotated.T, np.zeros(4)])


def write(path, kind, random):
    frames, samples = 30, 10
    channels = 8 if kind == 3 else 6
    values = random.normal(0, 40, (channels, frames * samples))
    for channel in [4, 5, 6, 7] if kind == 3 else [2]:
        values[channel] -= 300
    if kind != 3:
        values[3:] *= 20 if kind != 1 else 2
    file = ezc3d.c3d()
    file["parameters"]["POINT"]["RATE"]["value"] = [100]
    file["parameters"]["POINT"]["UNITS"]["value"] = ["mm"]
    file["parameters"]["POINT"]["LABELS"]["value"] = ["A"]
    file["data"]["points"] = np.ones((4, 1, frames))
    file["parameters"]["ANALOG"]["RATE"]["value"] = [100.0 * samples]
    file["parameters"]["ANALOG"]["LABELS"]["value"] = [f"c{i}" for i in range(channels)]
    units = ["N"] * 3 + (["mm", "mm", "Nmm"] if kind == 1 else ["Nmm"] * 3) if kind != 3 else ["N"] * 8
    file["parameters"]["ANALOG"]["UNITS"]["value"] = units
    file["data"]["analogs"] = values[np.newaxis]
    plates = file["parameters"]["FORCE_PLATFORM"]
    plates["USED"]["value"] = np.array([1])
    plates["TYPE"]["value"] = np.array([kind])
    plates["CORNERS"]["value"] = corners(random)[:, :, np.newaxis]
    origin = np.array([[200.0], [150.0], [-40.0]]) if kind == 3 else np.array([[2.0], [-1.0], [-40.0]])
    if kind == 1:
        origin = np.array([[0.0], [0.0], [0.0]])
    plates["ORIGIN"]["value"] = origin
    plates["CHANNEL"]["value"] = np.arange(1, channels + 1).reshape(channels, 1)
    calibration = np.eye(6) + 0.05 * random.normal(0, 1, (6, 6))
    plates["CAL_MATRIX"]["value"] = calibration[:, :, np.newaxis]
    file.write(str(path))


def compare(program, path, name):
    theirs = ezc3d.c3d(str(path), extract_forceplat_data=True)["data"]["platform"]
    own = ours(program, path)
    assert len(own) == len(theirs), (name, len(own), len(theirs))
    worst = np.zeros(3)
    for mine, other in zip(own, theirs):
        pushed = np.abs(other["force"][2]) > 20
        force = np.abs(mine[:, :3] - other["force"].T).max()
        pressure = np.abs(mine[pushed, 3:5] - other["center_of_pressure"].T[pushed, :2]).max() if pushed.any() else 0
        moment = np.abs(np.abs(mine[pushed, 6]) - np.linalg.norm(other["Tz"].T[pushed], axis=1)).max() if pushed.any() else 0
        worst = np.maximum(worst, [force, pressure, moment])
    print(f"{name}: forces {worst[0]:.2g} N, centres {worst[1]:.2g} mm, free moments {worst[2]:.2g} N mm apart at most")
    return worst


def main():
    program = sys.argv[1]
    random = np.random.default_rng(SEED)
    with tempfile.TemporaryDirectory() as folder:
        for kind in (1, 2, 3, 4):
            path = pathlib.Path(folder) / f"type{kind}.c3d"
            write(path, kind, random)
            worst = compare(program, path, f"type {kind} (seed {SEED})")
            assert worst[0] < 1e-3 and worst[1] < 1e-2 and worst[2] < 2, kind
    walks = sorted(DATA.glob("gait_children/*/straight*.c3d"))
    for path in walks:
        worst = compare(program, path, path.name)
        assert worst[0] < 1e-3 and worst[1] < 0.02 and worst[2] < 2, path
    if not walks:
        print(f"{DATA}/gait_children is not here")


main()
