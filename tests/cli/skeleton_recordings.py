"""What the tests of skeletons share: real recordings by the names that the docs' commands have, and the program.

Skipped (77) where the recordings are not here.
"""

import csv
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

MAREY = ""
ROOT = pathlib.Path()
DATA = pathlib.Path()

FILES = {
    "walk.trc": "opensim_ik/synthetic/subject01_synthetic_marker_data.trc",
    "standing.trc": "opensim_models/gait2354/subject01_static.trc",
    "turn.trc": "opensim_ik/synthetic/subject01_synthetic_marker_data.trc",
    "model.osim": "opensim_ik/synthetic/subject01_simbody.osim",
    "walk.c3d": "gait_children/HC002D/straight_HC002D06.c3d",
    "run.c3d": "gait_children/HC002D/turn_HC002D25.c3d",
    "standing.c3d": "gait_children/HC002D/static_HC002D02.c3d",
    "range.c3d": "gait_children/HC002D/turn_HC002D25.c3d",
    "other_walk.c3d": "gait_children/HC044A/straight_HC044A15.c3d",
    "other.c3d": "gait_children/HC044A/static_HC044A01.c3d",
    "earlier.c3d": "gait_children/HC002D/turn_HC002D25.c3d",
    "earlier_standing.c3d": "gait_children/HC002D/static_HC002D02.c3d",
    "controls/HC030A/straight.c3d": "gait_children/HC030A/straight_HC030A05.c3d",
    "controls/HC031A/straight.c3d": "gait_children/HC031A/straight_HC031A06.c3d",
    "controls/HC033A/straight.c3d": "gait_children/HC033A/straight_HC033A10.c3d",
    "triads.trc": "opensim_models/gait2354/subject01_walk1.trc",
    "triads_standing.trc": "opensim_models/gait2354/subject01_static.trc",
    "punches.c3d": "cmu_02_05/cmu_02_05.c3d",
    "figure.bvh": "bvh_dialects/openmocap/default.bvh",
    "dance.bvh": "bvh_dialects/bvh_toolbox/walk01.bvh",
    "01.asf": "mocap_files/cmu/01.asf",
    "01_01.amc": "mocap_files/cmu/01_01.amc",
    "take.c3d": "vicon_skeleton/nick_freeform_001.c3d",
    "person.vsk": "vicon_skeleton/Nick01.vsk",
}


class OnRecordings(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="marey_skeleton_"))
        self.addCleanup(shutil.rmtree, self.folder)
        for name, source in FILES.items():
            (self.folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(DATA / source, self.folder / name)

    def marey(self, *arguments, code=0):
        done = subprocess.run([MAREY, *map(str, arguments)], capture_output=True, text=True, cwd=self.folder, timeout=600)
        self.assertEqual(done.returncode, code, f"{arguments}\n{done.stdout}\n{done.stderr}")
        return done

    CHILDREN = ("HC002D", "HC030A", "HC031A", "HC033A", "HC038A", "HC044A")

    def child(self, name, kind):
        return next((DATA / "gait_children" / name).glob(kind + "_*.c3d"))

    def column(self, name, column, separator):
        """Of a table whose head is the first line that names the column; nothing if a cell is empty."""
        lines = (self.folder / name).read_text().splitlines()
        begin = next(i for i, line in enumerate(lines) if column in line.split(separator))
        at = lines[begin].split(separator).index(column)
        cells = [line.split(separator)[at].strip() for line in lines[begin + 1:]]
        return [float(cell) if cell else None for cell in cells]

    def points(self, name, *options):
        """m, by frame and label."""
        self.marey("convert", name, "points.csv", *options, "-q")
        with open(self.folder / "points.csv", newline="") as file:
            return {(row["frame"], row["label"]): [float(row[axis]) for axis in "xyz"] for row in csv.DictReader(file)}


def main():
    global MAREY, ROOT, DATA
    MAREY, ROOT = str(pathlib.Path(sys.argv.pop(1)).resolve()), pathlib.Path(sys.argv.pop(1)).resolve()
    DATA = pathlib.Path(os.environ.get("MAREY_DATA", ROOT / "../shared/data"))
    if not (DATA / "gait_children").exists():
        print(f"skipped: {DATA / 'gait_children'} is not here")
        sys.exit(77)
    unittest.main(module="__main__")
