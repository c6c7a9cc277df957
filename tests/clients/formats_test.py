"""What ezc3d and OpenSim read from the C3D and TRC files that `marey convert` writes: the same points to a float's precision.

    formats_test.py PROGRAM      PROGRAM is marey; exits 77 (skipped) where the readers are not installed
"""
import csv
import os
import pathlib
import random
import subprocess
import sys
import tempfile

try:
    import ezc3d
    import numpy as np
    import opensim
except ImportError as missing:
    print(f"skipped: {missing}; script/setup installs it")
    sys.exit(77)

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
DATA = pathlib.Path(os.environ.get("MAREY_DATA", ROOT / "../shared/data")) / "mocap_files"
RATE = 120.0
FLOAT = 2.0 ** -23  # relative step of a 32-bit float


def made_up(path, markers, frames, seed):
    """A tidy CSV of wandering markers with gaps; returns their positions, mm, (3, markers, frames), NaN where missing."""
    dice = random.Random(seed)
    places = np.full((3, markers, frames), np.nan)
    with open(path, "w", newline="") as file:
        rows = csv.writer(file)
        rows.writerow("frame time id label x y z state cameras residual_mm".split())
        for frame in range(frames):
            for marker in range(markers):
                if dice.random() < 0.1 and frame > 0:
                    continue
                place = [dice.uniform(-4, 4), dice.uniform(-3, 3), dice.uniform(0, 2)]
                places[:, marker, frame] = [1000 * value for value in place]
                rows.writerow([frame, f"{frame / RATE:.9f}", marker + 1, f"M{marker + 1}", *(f"{v:.17g}" for v in place), "measured",
                               "0 2", 0.5])
    return places


def convert(program, *arguments):
    subprocess.run([program, "convert", *map(str, arguments), "--quiet"], check=True)


def expect_equal(name, found, wanted):
    assert found.shape == wanted.shape, (name, found.shape, wanted.shape)
    assert (np.isnan(found) == np.isnan(wanted)).all(), f"{name}: other points are missing"
    error = np.nanmax(np.abs(found - wanted) / np.maximum(np.abs(wanted), 1.0), initial=0)
    print(f"{name}: largest relative error {error:.2e}")
    assert error <= FLOAT, (name, error)


def read_ezc3d(path):
    c3d = ezc3d.c3d(str(path))
    return c3d, c3d["data"]["points"][:3]


def fourth_words(path, markers, frames):
    """Behind each point's coordinates, by the user guide of C3D alone; (markers, frames)."""
    data = path.read_bytes()
    begin = (int.from_bytes(data[16:18], "little") - 1) * 512
    values = np.frombuffer(data, "<f4", 4 * markers * frames, begin).reshape(frames, markers, 4)
    return values[:, :, 3].T.astype(int)


def read_opensim(path):
    """Labels, places (mm, NaN where missing), times."""
    if path.suffix == ".c3d":
        adapter = opensim.C3DFileAdapter()
        table = adapter.getMarkersTable(adapter.read(str(path)))
    else:
        table = opensim.TimeSeriesTableVec3(str(path))
    labels = list(table.getColumnLabels())
    places = np.empty((3, len(labels), table.getNumRows()))
    for frame in range(table.getNumRows()):
        row = table.getRowAtIndex(frame)
        places[:, :, frame] = np.array([[row[marker][axis] for marker in range(len(labels))] for axis in range(3)])
    return labels, places, list(table.getIndependentColumn())


def check_made_up(program, folder, markers, frames, seed):
    print(f"{markers} markers, {frames} frames, seed {seed}")
    source = folder / "made_up.csv"
    wanted = made_up(source, markers, frames, seed)
    c3d, trc = folder / "made_up.c3d", folder / "made_up.trc"
    convert(program, source, c3d)
    convert(program, source, trc)
    head, found = read_ezc3d(c3d)
    expect_equal("ezc3d", found, wanted)
    point = head["parameters"]["POINT"]
    names = [name for part in sorted((key for key in point if key.startswith("LABELS")), key=lambda key: int(key[6:] or 1))
             for name in point[part]["value"]]
    assert names == [f"M{marker + 1}" for marker in range(markers)], names[:3]
    assert point["UNITS"]["value"] == ["mm"] and point["RATE"]["value"][0] == RATE and point["SCALE"]["value"][0] < 0
    assert abs(point["SCALE"]["value"][0]) * 32767 >= np.nanmax(np.abs(wanted)), "SCALE leaves no room for the places"
    there = ~np.isnan(wanted[0])
    residuals = head["data"]["meta_points"]["residuals"][0]
    assert (residuals[~there] < 0).all() and (residuals[there] >= 0).all()
    # The user guide puts the residual into the fourth word's lower byte and the cameras into its higher one; ezc3d exchanges them.
    words = fourth_words(c3d, markers, frames)
    assert (words[~there] == -1).all()
    scale = -point["SCALE"]["value"][0]
    assert (np.abs((words[there] & 0xFF) * scale - 0.5) <= scale / 2).all() and (words[there] >> 8 == 0b101).all()
    if hasattr(opensim, "C3DFileAdapter"):  # the package of PyPI is built without it
        labels, found, _ = read_opensim(c3d)
        assert labels == names
        expect_equal("opensim, C3D", found, wanted)
    labels, found, times = read_opensim(trc)
    assert labels == names
    expect_equal("opensim, TRC", found, wanted)
    assert np.allclose(times, np.arange(frames) / RATE, atol=1e-6)


def check_long(program, folder):
    """More frames than 16 bits count."""
    source = folder / "long.csv"
    frames = 70_000
    with open(source, "w") as file:
        file.write("frame,time,label,x,y,z\n")
        file.writelines(f"{frame},{frame / RATE:.9f},a,{frame / 65536:.9f},1,2\n" for frame in range(frames))
    convert(program, source, folder / "long.c3d")
    _, found = read_ezc3d(folder / "long.c3d")
    wanted = np.stack([np.arange(frames) / 65.536, np.full(frames, 1000.0), np.full(frames, 2000.0)])[:, None, :]
    assert found.shape[2] == frames, found.shape
    assert np.abs(found - wanted).max() < 1e-3


def check_real(program, folder):
    """Files of other systems: read by ezc3d as they are, and as we write them."""
    for path in sorted(DATA.rglob("*.c3d")):
        if path.name.startswith("sgi_"):
            continue  # ezc3d does not read them
        head, wanted = read_ezc3d(path)
        unit = {"m": 1000.0}.get((head["parameters"]["POINT"]["UNITS"]["value"] or ["mm"])[0], 1.0)
        convert(program, path, folder / "copy.c3d", "--from-up", "z", "--up", "z")  # the axes as they are, also of a file that declares others
        _, found = read_ezc3d(folder / "copy.c3d")
        expect_equal(path.name, found, wanted * unit)


def main(program):
    opensim.Logger.setLevelString("Error")
    opensim.Logger.removeFileSink()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        check_made_up(program, folder, 12, 200, 1)
        check_made_up(program, folder, 300, 20, 2)
        check_long(program, folder)
        if DATA.exists():
            check_real(program, folder)
        else:
            print(f"{DATA} is not here: files of other systems are not tried")


main(sys.argv[1])
