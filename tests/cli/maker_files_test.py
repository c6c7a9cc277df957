"""Files as the makers of motion capture write them: Qualisys' TSV and MAT, Motive's and Nexus' CSV, Theia's C3D, OpenSim's TRC, Xsens' BVH.

Usage: maker_files_test.py MAREY ROOT [unittest options]. Texts are written here by the makers' descriptions; Theia's file is a real one, of MAREY_DATA, and its
tests are skipped without it.
"""

import csv
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

MAREY = ""
ROOT = pathlib.Path()
SEEDS = pathlib.Path()
DATA = pathlib.Path()


class WithFolder(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="marey_makers_"))
        self.addCleanup(shutil.rmtree, self.folder)

    def marey(self, *arguments, code=0):
        done = subprocess.run([MAREY, *map(str, arguments)], capture_output=True, text=True, cwd=self.folder, timeout=600)
        self.assertEqual(done.returncode, code, f"{arguments}\n{done.stdout}\n{done.stderr}")
        return done

    def info(self, path):
        return json.loads(self.marey("info", path, "--json").stdout)

    def points(self, path):
        """By frame and label, m."""
        self.marey("convert", path, "points.csv", "-q")
        with (self.folder / "points.csv").open() as rows:
            return {(int(row["frame"]), row["label"]): [float(row[axis]) for axis in "xyz"] for row in csv.DictReader(rows)}

    def poses(self, path):
        self.marey("convert", path, "poses.csv", "--format", "poses", "-q")
        with (self.folder / "poses.csv").open() as rows:
            return [row for row in csv.DictReader(rows)]

    def text(self, name, text):
        (self.folder / name).write_text(text)
        return name


class MakerFiles(WithFolder):
    def test_qualisys_tsv(self):
        path = SEEDS / "points_text_fuzz/qualisys_3d.tsv"
        info = self.info(path)
        self.assertEqual((info["format"], info["made_by"], info["rate_hz"]), ("qualisys-tsv", "Qualisys Track Manager", 100))
        points = self.points(path)
        self.assertEqual(points[0, "LHEE"], [0.1005, 0.2, 1])
        self.assertNotIn((0, "RHEE"), points)  # three zeros
        self.assertEqual(points[1, "RHEE"], [0.001, 0.002, 0.003])

    def test_qualisys_tsv_with_frame_and_time(self):
        head = (SEEDS / "points_text_fuzz/qualisys_3d.tsv").read_text().split("TRAJECTORY_TYPES")[0]
        path = self.text("a.tsv", head + "Frame\tTime\tLHEE X\tLHEE Y\tLHEE Z\tRHEE X\tRHEE Y\tRHEE Z\n11\t0.10000\t1000\t2\t3\t\t\t\n12\t0.11000\t4\t5\t6\t7\t8\t9\n")
        points = self.points(path)
        self.assertEqual(sorted(points), [(10, "LHEE"), (11, "LHEE"), (11, "RHEE")])
        self.assertEqual(points[10, "LHEE"], [1, 0.002, 0.003])

    def test_qualisys_6d(self):
        pose, = self.poses(SEEDS / "points_text_fuzz/qualisys_6d.tsv")
        self.assertEqual(pose["body"], "racket")
        self.assertEqual([float(pose[key]) for key in "xyz"], [0.01, 0.02, 0.5])
        self.assertAlmostEqual(float(pose["qz"]), 0.5 ** 0.5, 6)  # x becomes y: the matrix is written column by column
        self.assertAlmostEqual(float(pose["qw"]), 0.5 ** 0.5, 6)

    def test_qualisys_tsv_that_is_damaged(self):
        head = "NO_OF_FRAMES\t1\nFREQUENCY\t100\n"
        self.assertIn("neither MARKER_NAMES nor BODY_NAMES", self.marey("info", self.text("a.tsv", head + "1\t2\t3\n"), code=1).stderr)
        self.assertIn("FREQUENCY", self.marey("info", self.text("b.tsv", "NO_OF_FRAMES\t1\nMARKER_NAMES\ta\n1\t2\t3\n"), code=1).stderr)
        self.assertIn("no number", self.marey("info", self.text("c.tsv", head + "MARKER_NAMES\ta\n1\tx\t3\n"), code=1).stderr)
        self.assertIn("cut off", self.marey("info", self.text("d.tsv", head + "MARKER_NAMES\ta\tb\n1\t2\t3\t4"), code=1).stderr)

    def test_qualisys_mat(self):
        info = self.info(SEEDS / "qualisys_mat_fuzz/markers.mat")
        self.assertEqual((info["format"], info["made_by"], info["rate_hz"], info["frames"]), ("qualisys-mat", "Qualisys Track Manager", 100, 4))
        points = self.points(SEEDS / "qualisys_mat_fuzz/bodies_compressed.mat")
        self.assertEqual(points[3, "RHEE"], [0.103, 0.21, 1.003])
        self.assertNotIn((2, "RHEE"), points)
        poses = self.poses(SEEDS / "qualisys_mat_fuzz/bodies_compressed.mat")
        self.assertEqual([row["body"] for row in poses], ["racket"] * 3)
        self.assertAlmostEqual(float(poses[2]["qz"]), 0.0998334, 6)  # sin(0.1)
        self.assertAlmostEqual(float(poses[2]["x"]), 0.02, 9)

    def test_mat_files_that_are_something_else(self):
        self.assertIn("without a measurement of Qualisys", self.marey("info", SEEDS / "qualisys_mat_fuzz/other.mat", code=1).stderr)
        whole = (SEEDS / "qualisys_mat_fuzz/bodies_compressed.mat").read_bytes()
        (self.folder / "cut.mat").write_bytes(whole[:400])
        self.assertIn("cut off", self.marey("info", "cut.mat", code=1).stderr)
        (self.folder / "flipped.mat").write_bytes(whole[:200] + bytes([whole[200] ^ 255]) + whole[201:])
        self.assertIn("damaged", self.marey("info", "flipped.mat", code=1).stderr)
        (self.folder / "new.mat").write_bytes(b"MATLAB 7.3 MAT-file, Platform: PCWIN64" + b" " * 474 + b"\x89HDF\r\n\x1a\n")
        self.assertIn("version 7.3 (HDF5); save it as version 7", self.marey("info", "new.mat", code=1).stderr)

    def test_motive_with_rigid_bodies(self):
        path = SEEDS / "points_text_fuzz/motive_bodies.csv"
        info = self.info(path)
        self.assertEqual((info["format"], info["made_by"]), ("motive", "Motive"))
        self.assertEqual(sorted(label for _, label in self.points(path)), ["a"])
        pose, = self.poses(path)
        self.assertEqual((pose["frame"], pose["body"]), ("0", "B"))
        self.assertAlmostEqual(float(pose["qw"]), 0.8, 9)
        self.assertAlmostEqual(float(pose["qy"]), 0.6, 9)

    def test_motive_without_measured_markers(self):
        path = self.text("a.csv", (SEEDS / "points_text_fuzz/motive_bodies.csv").read_text().replace(",Marker,Marker,Marker\n", ",Bone,Bone,Bone\n"))
        self.assertEqual({label for _, label in self.points(path)}, {"B:Marker1"})
        self.assertIn("no measured markers", self.marey("info", path).stderr)

    def test_motive_with_rotations_as_angles(self):
        text = (SEEDS / "points_text_fuzz/motive_bodies.csv").read_text().replace("X,Y,Z,W,X,Y,Z,,X", "X,Y,Z,,X,Y,Z,,X")
        self.assertIn("export with the rotation type Quaternion", self.marey("info", self.text("a.csv", text)).stderr)

    def test_nexus_with_other_parts_before(self):
        path = self.text("a.csv", "Devices\n1000\n,,Force\nFrame,Sub Frame,Fx\n,,N\n1,0,5\n1,1,6\n\nTrajectories\n100\n,,Ann:LASI,,,Ann:RASI,,\n"
                         "Frame,Sub Frame,X,Y,Z,X,Y,Z\n,,mm,mm,mm,mm,mm,mm\n1,0,1,2,3,,,\n2,0,1,2,3,4,5,6\n")
        info = self.info(path)
        self.assertEqual((info["format"], info["made_by"], info["rate_hz"]), ("nexus", "Nexus", 100))
        self.assertEqual(self.points(path)[1, "Ann:RASI"], [0.004, 0.005, 0.006])

    def test_trc_in_metres_and_millimetres(self):
        def trc(units, scale):
            return self.text(f"{units}.trc", "PathFileType\t4\t(X/Y/Z)\ta.trc\nDataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\n"
                             f"100\t100\t1\t1\t{units}\nFrame#\tTime\ta\t\t\n\t\tX1\tY1\tZ1\n\n1\t0\t{1 * scale}\t{2 * scale}\t{3 * scale}\n")
        for units, scale in (("m", 1), ("mm", 1000), ("cm", 100), ("meters", 1)):
            self.assertEqual(self.points(trc(units, scale))[0, "a"], [1, 2, 3], units)

    def test_amc_finds_its_asf(self):
        asf = "# c\n:version 1.10\n:name person\n:units\n mass 1.0\n length 1.0\n angle deg\n:root\n order TX TY TZ RX RY RZ\n axis XYZ\n position 0 0 0\n orientation 0 0 0\n:bonedata\n" \
              " begin\n id 1\n name leg\n direction 0 -1 0\n length 10\n axis 0 0 0 XYZ\n dof rx\n limits (-90 90)\n end\n:hierarchy\n begin\n root leg\n end\n"
        amc = ":FULLY-SPECIFIED\n:DEGREES\n1\nroot 0 0 0 0 0 0\nleg 10\n2\nroot 0 0 0 0 0 0\nleg 20\n"
        self.text("07_01.amc", amc)
        self.assertIn("there is none", self.marey("info", "07_01.amc", code=1).stderr)
        self.text("07.asf", asf)
        self.text("08.asf", asf.replace("leg", "arm"))
        self.assertEqual(self.info("07_01.amc")["frames"], 2)
        self.text("walk.amc", amc)
        self.assertIn("not clear which beside it; name it with --metadata", " ".join(self.marey("info", "walk.amc", code=1).stderr.split()))
        self.assertEqual(json.loads(self.marey("info", "walk.amc", "--metadata", "07.asf", "--json").stdout)["frames"], 2)

    def test_xsens_bvh_gets_other_programs_bones(self):
        def joint(name, offset, inner):
            return f"JOINT {name}\n{{\nOFFSET {offset}\nCHANNELS 3 Yrotation Xrotation Zrotation\n{inner}}}\n"
        end = "End Site\n{\nOFFSET 0 -5 0\n}\n"
        arm = lambda side, sign: joint(f"{side}Collar", f"{3 * sign} 20 0", joint(f"{side}Shoulder", f"{14 * sign} 0 0", joint(f"{side}Elbow", f"{28 * sign} 0 0", joint(f"{side}Wrist", f"{25 * sign} 0 0", end))))
        leg = lambda side, sign: joint(f"{side}Hip", f"{9 * sign} 0 0", joint(f"{side}Knee", "0 -42 0", joint(f"{side}Ankle", "0 -40 0", joint(f"{side}Toe", "0 -8 14", end))))
        bvh = "HIERARCHY\nROOT Hips\n{\nOFFSET 0 95 0\nCHANNELS 6 Xposition Yposition Zposition Yrotation Xrotation Zrotation\n" \
              + joint("Chest", "0 10 0", joint("Neck", "0 40 0", joint("Head", "0 10 0", end)) + arm("Right", -1) + arm("Left", 1)) + leg("Right", -1) + leg("Left", 1) + "}\n"
        joints = bvh.count("JOINT") + 1
        bvh += "MOTION\nFrames: 2\nFrame Time: 0.016667\n" + ("0 95 0 " + "0 " * 3 * joints + "\n") * 2
        self.text("xsens.bvh", bvh)
        self.marey("convert", "xsens.bvh", "mixamo.bvh", "--rig-names", "mixamo")
        text = (self.folder / "mixamo.bvh").read_text()
        for bone in ("Hips", "LeftShoulder", "LeftArm", "LeftForeArm", "LeftHand", "RightUpLeg", "RightLeg", "RightFoot", "RightToeBase"):
            self.assertIn(f"mixamorig:{bone}\n", text)
        self.assertNotIn("Elbow", text)


class Theia(WithFolder):
    def setUp(self):
        super().setUp()
        self.path = DATA / "c3d_kinds/C3DRotationExample.c3d"
        if not self.path.exists():
            self.skipTest(f"{self.path} is not here")

    def test_it_is_a_skeleton(self):
        info = self.info(self.path)
        self.assertEqual(info["made_by"], "THEIA_MARKERLESS THEIA3D")
        self.assertEqual(len([body for body in info["bodies"] if body.get("skeleton")]), 20)

    def test_bones_as_bvh_have_the_joints_where_they_are(self):
        poses = {(row["frame"], row["body"]): [float(row[axis]) for axis in "xyz"] for row in self.poses(self.path)}
        self.marey("convert", self.path, "theia.bvh", "-q")
        self.marey("convert", "theia.bvh", "joints.csv", "-q")
        farthest, count = 0, 0
        with (self.folder / "joints.csv").open() as rows:
            for row in csv.DictReader(rows):
                place = poses.get((row["frame"], row["label"]))
                if place is None or (row["frame"], "pelvis") not in poses:  # a bone rests where what it hangs on is not known
                    continue
                count += 1
                farthest = max(farthest, *(abs(float(row[axis]) - value) for axis, value in zip("xyz", place)))
        self.assertGreater(count, 3000)
        self.assertLess(farthest, 1e-5)
        self.marey("convert", self.path, "theia.glb", "--rig-names", "unreal", "-q")
        self.assertIn(b'"upperarm_l"', (self.folder / "theia.glb").read_bytes())


if __name__ == "__main__":
    MAREY, ROOT = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve()
    SEEDS = ROOT / "tests/fuzz"
    DATA = pathlib.Path(os.environ.get("MAREY_DATA") or ROOT.parent / "shared" / "data")
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
