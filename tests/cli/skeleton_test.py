"""docs/skeleton.md, each command run as it is written there, on real recordings; what cannot be is refused.

Usage: skeleton_test.py MAREY ROOT [unittest options]; exits 77 (skipped) where the recordings (MAREY_DATA) are not here.
"""

import csv
import json
import re
import shlex

import skeleton_recordings as recordings
from skeleton_recordings import OnRecordings, main


def commands(page):
    blocks = [block for language, block in re.findall(r"^```(\w*)\n(.*?)^```$", page.read_text(), re.M | re.S) if not language]
    return [line for block in blocks for line in block.splitlines() if line.startswith("marey ")]


class Skeleton(OnRecordings):
    def test_the_pages_as_they_are_written(self):
        for page, least in (("skeleton.md", 5), ("reference/skeleton_fitting.md", 2), ("reference/skeleton_files.md", 3), ("reference/animation.md", 2), ("gait.md", 2)):
            lines = commands(recordings.ROOT / "docs" / page)
            self.assertGreaterEqual(len(lines), least)
            for line in lines:
                with self.subTest(line=line):
                    self.marey(*shlex.split(line)[1:])
        for name in ("walk.mot", "walk.bvh", "run.bvh", "person.toml", "cycles.csv", "angles.csv", "gait.html", "walk_angles.c3d"):
            self.assertGreater((self.folder / name).stat().st_size, 1000, name)

    def test_the_summary_states_what_fits_and_what_is_not_observed(self):
        done = self.marey("solve", "walk.trc", "--skeleton", "model.osim", "-o", "walk.mot")
        self.assertIn("walk.trc: the skeleton subject01, solved from 31 markers in 73 frames", done.stderr)
        self.assertIn("mm RMS", done.stderr)
        self.assertIn("not observed, no marker shows them to 10°: mtp_angle_r, mtp_angle_l", done.stderr)
        self.assertIn("of the model, without effect on the pose: 54 muscles", done.stderr)
        summary = json.loads(self.marey("solve", "walk.trc", "--skeleton", "model.osim", "-o", "walk.mot", "--json").stdout)
        self.assertEqual(summary["frames"], 73)
        self.assertIn("54 muscles", summary["unused"])
        self.assertLess(summary["rms_mm"], 0.05)

    def test_a_static_trial_of_another_person_is_not_used(self):
        self.marey("convert", "standing.trc", "standing.csv", "-q")
        head, *rows = (self.folder / "standing.csv").read_text().splitlines()
        at = [head.split(",").index(name) for name in "xyz"]

        def scaled(row):
            cells = row.split(",")
            for i in at:
                cells[i] = str(1.3 * float(cells[i])) if cells[i] else ""
            return ",".join(cells)

        (self.folder / "taller.csv").write_text("\n".join([head, *map(scaled, rows)]) + "\n")
        calibrate = ("solve", "walk.trc", "--skeleton", "model.osim", "--calibrate")
        taller = self.marey(*calibrate, "--static-trial", "taller.csv", "-o", "taller.mot").stderr
        self.assertRegex(taller, r"taller\.csv: .* mm farther apart than in walk\.trc: another person's static trial\? It is not used")
        self.marey(*calibrate, "-o", "alone.mot", "-q")
        without_head = lambda name: (self.folder / name).read_text().split("endheader")[1]
        self.assertEqual(without_head("taller.mot"), without_head("alone.mot"))
        self.assertIn("moves by", self.marey(*calibrate, "--static-trial", "turn.trc", "-o", "x.mot", code=1).stderr.replace("markers move by", "moves by"))

    def test_the_same_bytes_again(self):
        for name in ("a", "b"):
            self.marey("solve", "walk.c3d", "--static-trial", "standing.c3d", "-o", f"{name}.mot", "-o", f"{name}.bvh", "-o", f"{name}.glb", "-q")
        for ending in ("mot", "bvh", "glb"):
            self.assertEqual((self.folder / f"a.{ending}").read_bytes(), (self.folder / f"b.{ending}").read_bytes())

    def test_the_motion_states_where_joints_are(self):
        arguments = ("solve", "walk.c3d", "--static-trial", "standing.c3d", "--rom-trial", "range.c3d", "-o", "walk.mot")
        told = json.loads(self.marey(*arguments, "--json").stdout)["joints"]
        self.assertEqual([joint["name"] for joint in told],
                         ["left hip", "right hip", "left knee", "left elbow", "right knee", "right elbow"])
        for joint in told:
            self.assertEqual(joint["by_motion"], "stays" not in joint["said"], joint)
        self.assertFalse(told[3]["by_motion"])  # its upper arm has one marker
        said = self.marey(*arguments).stderr
        self.assertIn("left hip: ", said)
        other = self.marey("solve", "walk.c3d", "--static-trial", "standing.c3d", "--rom-trial", "other_walk.c3d", "-o", "walk.mot", "-q")
        self.assertIn("other_walk.c3d is of another person than standing.c3d", other.stderr)
        self.assertIn("--static-trial", self.marey("solve", "walk.c3d", "--skeleton", "model.osim", "--rom-trial", "range.c3d", "-o", "x.mot", code=2).stderr)
        self.assertIn("one of the two", self.marey("solve", "walk.c3d", "--skeleton", "model.osim", "--static-trial", "standing.c3d", "-o", "x.mot", code=2).stderr)

    def standing_puncher(self, *without):
        """CMU's man stands still for a third of a second near the end."""
        self.marey("convert", "punches.c3d", "punches.csv", "-q")
        head, *rows = (self.folder / "punches.csv").read_text().splitlines()
        frame = head.split(",").index("frame")
        kept = [row for row in rows if 1765 <= int(row.split(",")[frame]) < 1800 and not any(label in row for label in without)]
        (self.folder / "standing.csv").write_text("\n".join([head, *kept]) + "\n")

    def test_marker_sets_are_known_by_their_labels(self):
        self.standing_puncher()
        told = json.loads(self.marey("solve", "punches.c3d", "--static-trial", "standing.csv", "-o", "punches.bvh", "-o", "punches.mot", "--json").stdout)
        self.assertEqual(told["marker_set"], "CMU's 41 markers")
        self.assertEqual((len(told["markers"]), told["not_recorded"], told["not_known"]), (41, [], []))
        self.assertLess(told["rms_mm"], 20)
        triads = ("solve", "triads.trc", "--static-trial", "triads_standing.trc", "--up", "y", "-o", "walk.mot")
        told = json.loads(self.marey(*triads, "--json").stdout)
        self.assertEqual(told["marker_set"], "Cleveland Clinic")
        self.assertLess(told["rms_mm"], 10)
        few = json.loads(self.marey(*triads, "--marker-set", "helen-hayes", "--json").stdout)
        self.assertEqual(few["marker_set"], "Helen Hayes")
        self.assertLess(len(few["markers"]), len(told["markers"]))

    def test_what_lacks_of_a_marker_set_is_stated(self):
        self.standing_puncher("LSHN", "RKNE")
        done = self.marey("solve", "punches.c3d", "--static-trial", "standing.csv", "-o", "x.mot", code=1)
        self.assertIn("standing.csv: its labels are not a whole marker set that Marey knows; CMU's 41 markers is nearest, and lacks RKNE, LSHN", done.stderr)
        done = self.marey("solve", "walk.c3d", "--static-trial", "standing.c3d", "--marker-set", "cmu-41", "-o", "x.mot", code=1)
        self.assertIn("of CMU's 41 markers it lacks LFWT, RFWT", done.stderr)
        self.assertIn("cleveland-clinic", self.marey("solve", "walk.c3d", "--static-trial", "standing.c3d", "--marker-set", "golem", "-o", "x.mot", code=2).stderr)
        self.marey("solve", "walk.c3d", "--skeleton", "model.osim", "--marker-set", "cmu-41", "-o", "x.mot", code=2)
        self.assertFalse((self.folder / "x.mot").exists())

    def test_elbows_bend_as_the_conventional_model_has_them(self):
        # Shoulders stand otherwise when children walk than when they stand: by 30 mm with HC031A.
        for name in self.CHILDREN:
            static, walk = self.child(name, "static"), self.child(name, "straight")
            told = json.loads(self.marey("solve", walk, "--static-trial", static, "-o", "walk.mot", "--json").stdout)
            self.marey("gait", walk, "--static-trial", static, "--angles", "angles.csv", "-q")
            shoulder = max(marker["rms_mm"] for marker in told["markers"] if marker["label"] in ("LSHO", "RSHO"))
            offs = {}
            for side in ("left", "right"):
                solved = self.column("walk.mot", f"{side}_elbow_flexion", "\t")
                model = self.column("angles.csv", f"{side}_elbow_flexion", ",")
                pairs = [(a, b) for a, b in zip(solved, model) if b is not None]
                offs[side] = (sum((a - b) ** 2 for a, b in pairs) / len(pairs)) ** 0.5
            print(f"{name}: elbows off by {offs['left']:.1f} and {offs['right']:.1f} deg RMS, shoulders' markers {shoulder:.1f} mm, all {told['rms_mm']:.1f} mm")
            self.assertLess(max(offs.values()), 8, name)
            self.assertLess(shoulder, 20, name)

    def test_from_the_motion_alone(self):
        """Against the skeleton of the child's static trial: knees bend alike, and the person is as large."""
        for name in self.CHILDREN[:2]:
            static, walk = self.child(name, "static"), self.child(name, "straight")
            done = self.marey("solve", walk, "-o", "alone.mot", "-o", "alone.bvh", "--json")
            self.assertIn("without --static-trial the skeleton is calibrated from this motion alone, by the posture at", done.stderr)
            told = json.loads(done.stdout)
            known = json.loads(self.marey("solve", walk, "--static-trial", static, "-o", "known.mot", "--json").stdout)
            offs = {}
            for joint in ("left_knee_flexion", "right_knee_flexion", "left_hip_flexion", "right_hip_flexion"):
                pairs = list(zip(self.column("alone.mot", joint, "\t"), self.column("known.mot", joint, "\t")))
                mean = sum(a - b for a, b in pairs) / len(pairs)
                offs[joint] = (mean, (sum((a - b - mean) ** 2 for a, b in pairs) / len(pairs)) ** 0.5)
            print(f"{name}: {told['rms_mm']:.1f} mm (static trial: {known['rms_mm']:.1f} mm); angles off by " +
                  ", ".join(f"{joint} {mean:.1f} ± {rms:.1f} deg" for joint, (mean, rms) in offs.items()))
            self.assertLess(told["rms_mm"], 15, name)
            self.assertLess(max(abs(mean) for mean, _ in offs.values()), 10, name)
            self.assertLess(max(rms for _, rms in offs.values()), 5, name)

    def test_bones_have_ends(self):
        self.marey("solve", "walk.c3d", "--static-trial", "standing.c3d", "-o", "walk.bvh", "-q")
        joint, ends = "", {}
        for line in (self.folder / "walk.bvh").read_text().splitlines():
            words = line.split()
            if words[:1] in (["JOINT"], ["recordings.ROOT"]):
                joint = words[1]
            elif words[:1] == ["End"]:
                joint += ".end"
            elif words[:1] == ["OFFSET"] and joint.endswith(".end"):
                ends[joint] = sum(float(word) ** 2 for word in words[1:]) ** 0.5
        self.assertEqual(set(ends), {"head.end", "left_foot.end", "right_foot.end", "left_hand.end", "right_hand.end"})
        for name, cm in ends.items():  # of a child of 1.3 m
            self.assertTrue((4 if "hand" in name else 10) < cm < 30, (name, cm))

    def test_few_markers_are_not_called_good(self):
        self.marey("solve", "walk.c3d", "--static-trial", "standing.c3d", "--write-skeleton", "person.toml", "-o", "x.mot", "-q")
        self.marey("convert", "walk.c3d", "walk.csv", "-q")
        head, *rows = (self.folder / "walk.csv").read_text().splitlines()
        label = head.split(",").index("label")
        for kept, words in (({"LASI"}, "says nothing, 1 of the skeleton's"),
                            ({"LASI", "RASI", "SACR", "LTHI", "LKNE", "LTIB", "LANK", "RTHI", "RKNE", "RTIB", "RANK", "LTOE", "RTOE"}, "13 of the skeleton's")):
            (self.folder / "few.csv").write_text("\n".join([head, *(row for row in rows if row.split(",")[label] in kept)]) + "\n")
            self.assertIn(words, self.marey("solve", "few.csv", "--skeleton", "person.toml", "-o", "x.mot").stderr)

    def test_the_upward_axis_is_requested(self):
        triads = ("solve", "triads.trc", "--static-trial", "triads_standing.trc", "-o", "walk.mot")
        self.assertIn("triads.trc: z was taken for up", self.marey(*triads).stderr)
        self.assertNotIn("taken for up", self.marey(*triads, "--up", "y").stderr)
        self.assertNotIn("taken for up", self.marey("solve", "walk.c3d", "--static-trial", "standing.c3d", "-o", "walk.mot").stderr)
        self.marey("convert", "walk.c3d", "walk_y.trc", "--up", "y", "-q")
        self.assertIn("walk_y.trc: z was taken for up, and the person's up is along y: give --up y", self.marey("gait", "walk_y.trc", code=1).stderr)
        self.assertNotIn("does it lie down", self.marey("gait", "walk_y.trc", "--up", "y", "-q").stderr)
        self.assertIn("by the --up that was given: is that right?", self.marey("gait", "walk_y.trc", "--up", "z", code=1).stderr)
        said = self.marey("solve", "walk.c3d", "--static-trial", "standing.c3d", "--up", "y", "-o", "walk.mot").stderr
        self.assertIn("--up y was given, and the skeleton's up is along z: does the person lie down?", said)
        self.assertNotIn("how wide", said)  # standing.c3d tells it
        self.marey("convert", "standing.c3d", "standing.trc", "-q")
        self.assertIn("standing.trc: how wide knees and ankles are is not known", self.marey("solve", "walk.c3d", "--static-trial", "standing.trc", "-o", "walk.mot").stderr)

    def test_the_static_trials_person_and_what_it_lacks(self):
        other = self.marey("solve", "walk.c3d", "--static-trial", "other.c3d", "-o", "x.mot", "-q").stderr
        self.assertIn("another person's static trial than walk.c3d", other)
        own = self.marey("solve", "walk.c3d", "--static-trial", "standing.c3d", "-o", "x.mot", "-q").stderr
        self.assertNotIn("another person", own)
        self.marey("convert", "standing.c3d", "standing.csv", "-q")
        kept = [row for row in (self.folder / "standing.csv").read_text().splitlines() if not any(f",{label}," in row for label in ("SACR", "LPSI", "RPSI"))]
        (self.folder / "standing.csv").write_text("\n".join(kept) + "\n")
        done = self.marey("solve", "walk.c3d", "--static-trial", "standing.csv", "-o", "y.mot", code=1)
        self.assertIn("standing.csv: the pelvis is not known", done.stderr)
        self.assertIn("SACR, LPSI, RPSI are not seen", done.stderr)

    def test_the_second_pass_states_its_own_rms_and_what_was_hidden(self):
        self.marey("solve", "walk.c3d", "--static-trial", "standing.c3d", "--write-skeleton", "person.toml", "-o", "x.mot", "-q")
        self.marey("convert", "walk.c3d", "walk.csv", "-q")
        head, *rows = (self.folder / "walk.csv").read_text().splitlines()
        frame, label = head.split(",").index("frame"), head.split(",").index("label")
        hidden = {"LFRM", "LWRA", "LWRB", "LFIN", "RTIB", "RTHI", "RHEE"}
        kept = [row for row in rows if not (row.split(",")[label] in hidden and 200 <= int(row.split(",")[frame]) < 250)]
        (self.folder / "hidden.csv").write_text("\n".join([head, *kept]) + "\n")
        told, angles = {}, {}
        for way in ([], ["--smooth"]):
            solve = ("solve", "hidden.csv", "--skeleton", "person.toml", *way, "-o", "hidden.marey", "-o", "hidden.mot")
            summary = json.loads(self.marey(*solve, "--json").stdout)
            told[bool(way)] = summary["rms_mm"]
            markers = {marker["label"] for marker in summary["markers"]}
            seen = {}
            for row in kept:
                if row.split(",")[label] in markers:
                    seen[int(row.split(",")[frame])] = seen.get(int(row.split(",")[frame]), 0) + 1
            self.marey("convert", "hidden.marey", "poses.csv", "--format", "poses", "-q")
            with open(self.folder / "poses.csv", newline="") as file:
                residuals = {int(row["frame"]): float(row["residual_mm"]) for row in csv.DictReader(file)}
            by_frames = (sum(residual ** 2 * seen[at] for at, residual in residuals.items()) / sum(seen[at] for at in residuals)) ** 0.5
            self.assertAlmostEqual(summary["rms_mm"], by_frames, delta=0.002 * by_frames, msg=way)
            angles[bool(way)] = self.column("hidden.mot", "left_elbow_flexion", "\t")
        self.assertNotEqual(told[False], told[True])
        steps = [abs(b - a) for a, b in zip(angles[True], angles[True][1:])]
        self.assertLess(max(steps), 10)
        self.assertIn("at times no marker shows these to 10°: ", self.marey(*solve).stderr)

    def test_two_people_in_one_calibration_are_named(self):
        """Subjects 01 and 02 are within 13 mm of each other in every segment, and are not distinguished; 04 is 40 mm off."""
        models = recordings.DATA / "arnold_synthetic"
        solve = ("solve", models / "subject01/markers.trc", "--up", "y", "--skeleton", models / "unscaled_generic.osim", "--calibrate", "-o", "a.mot", "-q")
        other = self.marey(*solve, "--calibration-take", models / "subject04/markers.trc").stderr
        self.assertIn("another person, or markers that were put on again? A calibration is of one", other)
        self.assertNotIn("another person", self.marey(*solve, "--calibration-take", models / "subject01/markers.trc").stderr)

    def test_a_mass_that_is_no_persons(self):
        models = recordings.DATA / "arnold_synthetic"
        solve = ("solve", models / "subject01/markers.trc", "--up", "y", "--skeleton", models / "unscaled_generic.osim", "--calibrate", "--write-skeleton", "p.osim", "-o", "a.mot", "-q")
        self.assertIn("is it in kilograms?", self.marey(*solve, "--mass", 17).stderr)
        self.assertNotIn("is it in kilograms?", self.marey(*solve, "--mass", 72.8).stderr)

    def test_a_skeletons_motion_is_a_recording(self):
        for source, frames, rate in (("dance.bvh", 101, 24), ("01_01.amc", 2751, 120), ("01.asf", 1, 30), ("figure.bvh", 1, 30)):
            info = json.loads(self.marey("info", source, "--json").stdout)
            self.assertEqual((info["frames"], round(info["rate_hz"])), (frames, rate), source)
            self.assertGreater(len(info["bodies"]), 15)
            self.assertGreater(len(info["tracks"]), len(info["bodies"]))
        for name in ("dance.trc", "dance.c3d", "dance.marey", "dance.csv", "dance.glb", "copy.bvh"):
            self.marey("convert", "dance.bvh", name, "-q")
        self.assertEqual(json.loads(self.marey("info", "dance.glb", "--json").stdout)["animations"], 1)
        points = {name: self.points(name) for name in ("dance.bvh", "dance.trc", "dance.c3d", "dance.marey", "copy.bvh")}
        for name, there in points.items():
            self.assertEqual(there.keys(), points["dance.bvh"].keys(), name)
            worst = max(abs(a - b) for key, place in there.items() for a, b in zip(place, points["dance.bvh"][key]))
            self.assertLess(worst, 2e-6, name)
        self.assertGreater(max(place[2] for place in points["dance.bvh"].values()), 1.4)  # it stands: z is up
        inches = self.points("dance.bvh", "--unit", "0.0254", "--from-up", "z")
        self.assertAlmostEqual(inches[("0", "Head")][1] / points["dance.bvh"][("0", "Head")][2], 2.54, places=6)

    def test_a_marker_a_joint(self):
        # OpenMoCap's semantics: a marker bears the name of the joint that it sits on.
        self.marey("convert", "dance.bvh", "joints.c3d", "-q")
        said = json.loads(self.marey("solve", "joints.c3d", "--skeleton", "dance.bvh", "-o", "again.bvh", "-o", "again.mot", "--json").stdout)
        self.assertLess(said["rms_mm"], 2)
        self.assertEqual((said["not_recorded"], said["not_known"]), ([], []))
        self.assertTrue(any("one is taken to sit on each joint" in warning for warning in said["warnings"]), said["warnings"])
        self.assertTrue(any(coordinate["observed"] < 0.5 for coordinate in said["coordinates"]), "no marker shows how a bone turns about itself")

    def test_skeletons_motions_that_cannot_be_are_refused(self):
        (self.folder / "01.asf").rename(self.folder / "bones.txt")
        self.assertIn("--metadata", self.marey("info", "01_01.amc", code=1).stderr)
        self.marey("info", "01_01.amc", "--metadata", "bones.txt", "-q")
        (self.folder / "cut.bvh").write_bytes((self.folder / "dance.bvh").read_bytes()[:500])
        self.assertIn("cut.bvh:", self.marey("convert", "cut.bvh", "x.c3d", code=1).stderr)
        self.assertIn("no skeleton", self.marey("convert", "walk.trc", "x.bvh", code=1).stderr)
        self.assertFalse((self.folder / "x.c3d").exists() or (self.folder / "x.bvh").exists())

    def test_a_vicon_skeleton(self):
        said = json.loads(self.marey("solve", "take.c3d", "--up", "y", "--skeleton", "person.vsk", "-o", "x.mot", "--json").stdout)
        self.assertEqual((said["frames"], said["not_recorded"]), (1101, []))
        errors = sorted(marker["rms_mm"] for marker in said["markers"])
        self.assertEqual(len(errors), 52)  # the 53rd, CLAV, is never seen
        self.assertLess(errors[26], 15)  # a few labels are wrong in it at times: RTOE
        (self.folder / "bad.vsk").write_text((self.folder / "person.vsk").read_text().replace("JointHinge", "JointSpring"))
        self.assertIn("no joint that Marey knows",
                      self.marey("solve", "take.c3d", "--skeleton", "bad.vsk", "-o", "y.mot", code=1).stderr)

    def test_what_cannot_be_is_refused(self):
        def states(code, words, *arguments):
            done = self.marey("solve", *arguments, code=code)
            self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
            for word in words:
                self.assertIn(word, done.stderr)

        states(1, ["figure.bvh", "none of its labels is a marker of the skeleton"], "walk.trc", "--skeleton", "figure.bvh", "-o", "x.mot")
        states(1, ["not a whole marker set", "skeleton is wanted"], "walk.trc", "-o", "x.mot")
        states(1, ["stands still"], "walk.c3d", "--static-trial", "walk.c3d", "-o", "x.mot")
        states(2, ["x.png"], "walk.trc", "--skeleton", "model.osim", "-o", "x.png")
        states(1, ["not a skeleton that Marey knows"], "walk.trc", "--skeleton", "walk.trc", "-o", "x.mot")
        self.assertFalse((self.folder / "x.mot").exists())


if __name__ == "__main__":
    main()
