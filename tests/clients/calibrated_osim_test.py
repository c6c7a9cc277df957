"""A model that `marey solve --calibrate --write-skeleton person.osim` writes, opened by OpenSim: markers where Marey has them, masses, and the same
angles by OpenSim's own inverse kinematics.

    calibrated_osim_test.py PROGRAM      PROGRAM is marey; exits 77 (skipped) where OpenSim or its models are not here
"""
import os
import pathlib
import subprocess
import sys
import tempfile

try:
    import numpy as np
    import opensim
except ImportError as missing:
    print(f"skipped: {missing}; script/setup installs it")
    sys.exit(77)

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
DATA = pathlib.Path(os.environ.get("MAREY_DATA", ROOT / "../shared/data"))
GAIT = DATA / "opensim_models/gait2354"
ARNOLD = DATA / "arnold_synthetic"
CENTRES = [side + joint for side in "RL" for joint in ("HJC", "KJC", "AJC", "SJC", "EJC")]  # joints that no camera sees
MASS = 72.6


def read(path):
    lines = path.read_text().splitlines()
    head = lines.index("endheader")
    columns = lines[head + 1].split()
    values = np.array([[float(cell) for cell in line.split()] for line in lines[head + 2 :] if line.strip()])
    return {name: values[:, i] for i, name in enumerate(columns)}


def solve(program, recording, model, folder, *more):
    done = subprocess.run([program, "solve", str(recording), "--skeleton", str(model), "-o", str(folder / "ours.mot"), "-q", *map(str, more)], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return read(folder / "ours.mot")


def opensim_angles(model_path, recording, folder, excluded):
    """OpenSim's inverse kinematics with all markers alike."""
    tool = opensim.InverseKinematicsTool()
    model = opensim.Model(str(model_path))
    model.initSystem()
    tool.setModel(model)
    tool.setMarkerDataFileName(str(recording))
    tasks = tool.upd_IKTaskSet()
    recorded = set(recording.read_text().splitlines()[3].split()[2:]) - set(excluded)
    for marker in model.getMarkerSet():
        if marker.getName() in recorded:
            task = opensim.IKMarkerTask()
            task.setName(marker.getName())
            task.setWeight(1)
            tasks.cloneAndAppend(task)
    data = opensim.MarkerData(str(recording))
    tool.setStartTime(data.getStartFrameTime())
    tool.setEndTime(data.getLastFrameTime())
    tool.set_accuracy(1e-9)
    tool.setOutputMotionFileName(str(folder / "theirs.mot"))
    tool.setResultsDir(str(folder))
    assert tool.run()
    return read(folder / "theirs.mot")


def with_markers(folder):
    """gait2354 with the marker set of its scaling."""
    model = opensim.Model(str(GAIT / "gait2354_simbody.osim"))
    model.updateMarkerSet(opensim.MarkerSet(str(GAIT / "gait2354_Scale_MarkerSet.xml")))
    model.finalizeConnections()
    model.printToXML(str(folder / "generic.osim"))
    return folder / "generic.osim"


def expect_same_angles(program, name, recording, generic, folder, excluded=()):
    exclude = [word for label in excluded for word in ("--exclude", label)]
    solve(program, recording, generic, folder, "--calibrate", "--write-skeleton", folder / "person.osim", "--mass", MASS, *exclude)
    ours = solve(program, recording, folder / "person.osim", folder, *exclude)
    theirs = opensim_angles(folder / "person.osim", recording, folder, excluded)
    model = opensim.Model(str(folder / "person.osim"))
    mass = model.getTotalMass(model.initSystem())
    assert abs(mass - MASS) < 1e-6, mass
    worst, where = 0, ""
    squares, count = 0, 0
    for coordinate in model.getCoordinateSet():
        n = coordinate.getName()
        if coordinate.getMotionType() != opensim.Coordinate.Rotational or n not in ours:
            continue
        apart = np.abs(ours[n] - np.interp(ours["time"], theirs["time"], theirs[n]))
        squares, count = squares + (apart**2).sum(), count + apart.size
        if apart.max() > worst:
            worst, where = apart.max(), n
    print(f"{name}: OpenSim's angles of the saved model {np.sqrt(squares / count):.4f}° RMS from ours, {worst:.3f}° at most ({where}); {mass:.1f} kg")
    return np.sqrt(squares / count)


def main():
    program = sys.argv[1]
    if not GAIT.exists():
        print(f"skipped: {GAIT} is not here")
        sys.exit(77)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        assert expect_same_angles(program, "gait2354", GAIT / "subject01_walk1.trc", with_markers(folder), folder) < 0.1
        if ARNOLD.exists():
            assert expect_same_angles(program, "Arnold 01", ARNOLD / "subject01/markers.trc", ARNOLD / "unscaled_generic.osim", folder, CENTRES) < 0.1


main()
