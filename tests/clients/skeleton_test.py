"""What OpenSim makes of our .mot: its own model, posed by our angles, has its markers where they were recorded.

    skeleton_test.py PROGRAM      PROGRAM is marey; exits 77 (skipped) where OpenSim or the recordings are not here
"""
import os
import pathlib
import subprocess
import sys
import tempfile

try:
    import opensim
except ImportError as missing:
    print(f"skipped: {missing}; script/setup installs it")
    sys.exit(77)

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
DATA = pathlib.Path(os.environ.get("MAREY_DATA", ROOT / "../shared/data")) / "opensim_ik/synthetic"


def main(program):
    if not DATA.exists():
        print(f"skipped: {DATA} is not here")
        return 77
    opensim.Logger.removeFileSink()  # its log would lie beside the model
    with tempfile.TemporaryDirectory() as folder:
        motion = pathlib.Path(folder) / "walk.mot"
        markers, model_file = DATA / "subject01_synthetic_marker_data.trc", DATA / "subject01_simbody.osim"
        subprocess.run([program, "solve", markers, "--skeleton", model_file, "-o", motion, "-q"], check=True)
        model = opensim.Model(str(model_file))
        state = model.initSystem()
        angles = opensim.TimeSeriesTable(str(motion))
        model.getSimbodyEngine().convertDegreesToRadians(angles)
        seen = opensim.TimeSeriesTableVec3(str(markers))
        labels = list(seen.getColumnLabels())
        worst = 0.0
        for row in range(0, angles.getNumRows(), 6):
            values = angles.getRowAtIndex(row)
            for column, name in enumerate(angles.getColumnLabels()):
                model.updCoordinateSet().get(name).setValue(state, values[column], False)
            model.realizePosition(state)
            places = seen.getRowAtIndex(row)
            for column, label in enumerate(labels):
                if model.getMarkerSet().contains(label):
                    there = model.getMarkerSet().get(label).getLocationInGround(state)
                    worst = max(worst, sum((there[k] - places[column][k]) ** 2 for k in range(3)) ** 0.5)
        print(f"markers of OpenSim's model, posed by our angles, lie {1000 * worst:.3f} mm at worst from where they were recorded")
        assert worst < 0.0005, worst
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
