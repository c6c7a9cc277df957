"""`marey gait` on real recordings: steps and cycles, what goes into C3D, what is refused.

Usage: gait_test.py MAREY ROOT [unittest options]; exits 77 (skipped) where the recordings (MAREY_DATA) are not here.
"""

import csv
import json
import subprocess

import skeleton_recordings as recordings
from skeleton_recordings import OnRecordings, main


class Gait(OnRecordings):
    def test_gait_of_a_standing_person_is_refused(self):
        done = self.marey("gait", "standing.c3d", code=1)
        self.assertIn("standing.c3d: no steps were found", done.stderr)
        self.marey("gait", "standing.c3d", "--angles", "angles.csv", "-q")

    def test_gait_finds_the_steps(self):
        said = json.loads(self.marey("gait", "walk.c3d", "--static-trial", "standing.c3d", "-o", "cycles.csv", "--json").stdout)
        self.assertEqual(len([e for e in said["events"] if e["event"] == "strike"]), 6)
        with open(self.folder / "cycles.csv", newline="") as file:
            rows = [row for row in csv.DictReader(file) if row["angle"] == "left_knee_flexion"]
        self.assertEqual([int(row["percent"]) for row in rows], list(range(101)))
        self.assertGreater(max(float(row["mean_deg"]) for row in rows), 45)
        self.assertTrue(any("left shoulder plane" in warning for warning in said["warnings"]), said["warnings"])

    def test_gait_without_walking_is_refused(self):
        done = self.marey("gait", "punches.c3d", "-o", "none.csv", code=1)
        self.assertIn("no steps were found", done.stderr)
        self.assertFalse((self.folder / "none.csv").exists())

    def test_gait_warns_of_another_persons_static_trial(self):
        done = self.marey("gait", "run.c3d", "--static-trial", "other.c3d", "-o", "cycles.csv", "-q")
        self.assertIn("LASI and RASI are 33 mm farther apart", done.stderr)

    def test_gait_into_c3d(self):
        self.marey("gait", "walk.c3d", "--static-trial", "standing.c3d", "--c3d", "a.c3d", "--angles", "walk.csv", "-q")
        info = json.loads(self.marey("info", "a.c3d", "--json").stdout)
        self.assertEqual((info["first_frame"], info["last_frame"], info["events"], info["analog_channels"]), (123, 377, 12, 24))
        # What was written is a walk like any other: its measures are in it, and its markers lead to the same angles.
        self.marey("gait", "a.c3d", "--static-trial", "standing.c3d", "--angles", "again.csv", "-q")
        before, after = ([[float(cell or "nan") for cell in line.split(",")] for line in (self.folder / name).read_text().splitlines()[1:]]
                         for name in ("walk.csv", "again.csv"))
        self.assertEqual(len(before), 255)
        for a, b in zip(before, after):
            for one, other in zip(a, b):
                self.assertTrue(one != one and other != other or abs(one - other) < 2e-4, (one, other))

    def test_forces_go_along_from_c3d_to_c3d_alone(self):
        def channels(name):
            return json.loads(self.marey("info", name, "--json").stdout).get("analog_channels", 0)

        done = self.marey("convert", "walk.c3d", "walk.marey")
        self.assertIn("none of the 24 analog channels (forces, EMG) and 12 events", done.stderr)
        self.marey("convert", "walk.marey", "without.c3d")
        self.marey("convert", "walk.marey", "with.c3d", "--analog", "walk.c3d")
        self.assertEqual([channels(name) for name in ("walk.c3d", "without.c3d", "with.c3d")], [24, 0, 24])
        self.assertIn("120", self.marey("convert", "punches.c3d", "x.c3d", "--analog", "walk.c3d", code=1).stderr)
        self.assertIn("neither", self.marey("convert", "walk.c3d", "x.c3d", "--analog", "without.c3d", code=1).stderr)
        self.assertIn("C3D", self.marey("convert", "walk.c3d", "x.trc", "--analog", "walk.c3d", code=2).stderr)
        self.assertFalse((self.folder / "x.c3d").exists())
        self.marey("solve", "walk.c3d", "--static-trial", "standing.c3d", "-o", "solved.c3d", "-q")
        info = json.loads(self.marey("info", "solved.c3d", "--json").stdout)
        self.assertEqual(info["analog_channels"], 24)
        self.assertIn("left_thigh", [body["name"] for body in info["bodies"]])

    def test_channels_of_another_recording_are_reported(self):
        self.marey("convert", "walk.c3d", "walk.marey")
        self.assertNotIn("recording was made of", self.marey("convert", "walk.marey", "with.c3d", "--analog", "walk.c3d").stderr)
        # run.c3d and other.c3d have other frames than walk.c3d, which has 123 to 377.
        for name in ("run.c3d", "other.c3d", "standing.c3d"):
            info = json.loads(self.marey("info", name, "--json").stdout)
            self.assertEqual((info["analog_channels"], info["rate_hz"]), (24, 100))
            shared = min(info["last_frame"], 377) - max(info["first_frame"], 123) + 1
            with self.subTest(name=name, shared=shared):
                done = subprocess.run([recordings.MAREY, "convert", "walk.marey", "x.c3d", "--analog", name], cwd=self.folder, capture_output=True, text=True)
                self.assertEqual(done.returncode, 0 if shared > 0 else 1, done.stderr)
                self.assertIn(f"has frames {info['first_frame']} to {info['last_frame']}, and walk.marey has 123 to 377", done.stderr)
                self.assertIn(f"{255 - shared} of 255 frames" if shared > 0 else "none is in both", done.stderr)
        # Its own channels give way.
        self.assertIn("its own 24 analog channels and 12 events", self.marey("convert", "walk.c3d", "y.c3d", "--analog", "with.c3d").stderr)


if __name__ == "__main__":
    main()
