"""The command line itself, the same for every subcommand: words, numbers, files, standard output.

Usage: command_line_test.py MAREY [unittest options]
"""

import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

MAREY = ""
NUMBER = re.compile(r"^  (?:-\w,)?(--[a-z-]+) (\S.*? in [\[(][^\])]+[\])])(?: x (\d))?", re.MULTILINE)
COMMANDS = ("track", "evaluate", "measure", "convert", "info", "play", "reconstruct", "simulate markers", "simulate people", "simulate room",
            "simulate match", "calibrate lens", "calibrate wand", "calibrate ground", "calibrate board", "calibrate pitch",
            "experiment trackers", "experiment outlines", "experiment hypotheses")
LOCATIONS = "frame,time,id,x,y\n" + "".join(f"{f},{f / 25:.2f},{i},{10 + i + 0.2 * f:.2f},{20 + i}\n" for f in range(200) for i in (1, 2))


class CommandLine(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.made = pathlib.Path(tempfile.mkdtemp(prefix="marey_cli_"))
        cls.addClassCleanup(shutil.rmtree, cls.made)

        def simulate(*arguments):
            subprocess.run([MAREY, "simulate", *arguments, "-q"], cwd=cls.made, check=True, timeout=300)

        simulate("markers", "plain", "--frames", "12", "-o", "plain")
        simulate("room", "--motion", "ground", "--frames", "20", "--cameras", "5", "-o", "floor")
        simulate("match", "--seconds", "2", "--cameras", "2", "-o", "match")
        (cls.made / "places.csv").write_text(LOCATIONS)
        (cls.made / "boxes.txt").write_text("".join(f"{f},1,{10 + 3 * f},50,20,50,0.9,-1,-1,-1\n" for f in range(1, 61)))

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="marey_cli_"))
        self.addCleanup(shutil.rmtree, self.folder)
        shutil.copytree(self.made, self.folder, dirs_exist_ok=True)

    def marey(self, *arguments, code=0):
        done = subprocess.run([MAREY, *map(str, arguments)], capture_output=True, text=True, cwd=self.folder, timeout=300)
        self.assertEqual(done.returncode, code, f"{arguments}\n{done.stdout}\n{done.stderr}")
        return done

    def content(self):
        return {path: None if path.is_dir() else path.read_bytes() for path in self.folder.rglob("*") if path.exists()}

    def refused(self, *arguments):
        """Exit code 2, one sentence, and no file is touched."""
        before = self.content()
        said = self.marey(*arguments, code=2).stderr.strip()
        self.assertEqual(self.content(), before, f"{arguments}: a file was changed")
        self.assertEqual(len(said.splitlines()), 1, said)
        self.assertTrue(said.startswith("marey: "), said)
        return said

    def test_no_output_is_an_input(self):
        film = "plain/video.mp4"
        (self.folder / "link.txt").symlink_to(film)
        os.link(self.folder / film, self.folder / "hard.csv")
        (self.folder / "link.svg").symlink_to(film)
        (self.folder / "people").mkdir()
        shutil.copy(self.folder / film, self.folder / "people" / "video.mp4")
        shutil.copy(self.folder / "places.csv", self.folder / "run_home.csv")
        shutil.copy(self.folder / "places.csv", self.folder / "run_away.csv")
        for arguments in (
            ("track", film, "-o", film, "--format", "mot"),
            ("track", film, "-o", "link.txt"),
            ("track", film, "-o", "hard.csv"),
            ("track", film, "-o", "t.txt", "--overlay", film),
            ("track", film, "-o", "t.txt", "--overlay", "plain/../plain/video.mp4"),
            ("track", film, "-o", "t.txt", "--plot", "link.svg"),
            ("track", "--detections", "boxes.txt", "--rate", 25, "-o", "boxes.txt"),
            ("track", "match/rig.toml", "--ground", "-o", "match/cam1.txt", "--format", "csv"),
            ("track", "match/rig.toml", "--ground", "-o", "match/rig.toml", "--format", "csv"),
            ("measure", "places.csv", "-o", "places.csv"),
            ("reconstruct", "floor/rig.toml", "--observations", "floor/observations.csv", "-o", "floor/observations.csv"),
            ("convert", "places.csv", "places.csv"),
            ("convert", "run_home.csv", "run_away.csv"),
            ("simulate", "people", "--frames", 2, "--background-image", "people/video.mp4", "-o", "people"),
        ):
            self.assertIn("input", self.refused(*arguments), arguments)

    def test_images_of_a_folder_are_inputs(self):
        (self.folder / "shots").mkdir()
        for i in range(3):
            (self.folder / "shots" / f"p{i}.png").write_bytes(b"an image")
        for source in ("shots", "shots/*.png", "shots/p%d.png"):
            self.assertIn("input", self.refused("track", source, "-o", "shots/p1.png", "--format", "mot"))

    def test_no_two_outputs_are_one_file(self):
        film = "plain/video.mp4"
        self.assertIn("too", self.refused("track", film, "-o", "same.svg", "--format", "mot", "--plot", "same.svg"))
        self.assertIn("too", self.refused("track", film, "-o", "same.svg", "--format", "mot", "--plot", "plain/../same.svg"))
        self.assertIn("standard output", self.refused("track", film, "-o", "-", "--json"))

    def test_a_rig_may_be_rewritten(self):
        ground = ("calibrate", "ground", "floor/rig.toml", "--observations", "floor/observations.csv")
        self.marey(*ground, "-o", "other.toml", "-q")
        self.marey(*ground, "-o", "floor/rig.toml", "-q")
        self.assertEqual((self.folder / "other.toml").read_text().count("[["), (self.folder / "floor/rig.toml").read_text().count("[["))
        (self.folder / "seen.toml").symlink_to("floor/observations.csv")
        self.assertIn("input", self.refused(*ground, "-o", "seen.toml"))

    def test_numbers_are_checked_alike(self):
        checked, before = 0, self.content()
        for command in COMMANDS:
            listed = NUMBER.findall(self.marey(*command.split(), "--help").stdout)
            for i, (option, domain, count) in enumerate(listed):
                checked += 1
                for value in ("nan", "inf", "1e308", "1e-310", "5x", "", "0x1p3")[: None if i == 0 else 1]:
                    said = self.marey(*command.split(), option, *[value] * int(count or 1), code=2).stderr.strip()
                    self.assertRegex(said, f"^marey: {option}: .*; give {re.escape(domain)}$")
        self.assertGreater(checked, 60)
        self.assertEqual(self.content(), before)

    def test_lists_of_numbers(self):
        for arguments in (("measure", "places.csv", "-o", "s.csv", "--zones", "2,nan"),
                          ("measure", "places.csv", "-o", "s.csv", "--zones", "4,2"),
                          ("measure", "places.csv", "-o", "s.csv", "--zones", "2,4,"),
                          ("measure", "places.csv", "-o", "s.csv", "--size", "infx68"),
                          ("measure", "places.csv", "-o", "s.csv", "--size", "105x68x2"),
                          ("simulate", "room", "--wand", "0,nan"), ("simulate", "room", "--bump", "1,1,1e308"),
                          ("simulate", "room", "--bump", "1.5,1,1"),
                          ("calibrate", "ground", "floor/rig.toml", "-o", "g.toml", "--l-frame", "0,0;nan,0;0,1")):
            self.assertIn(arguments[-1].split(";")[-2] if ";" in arguments[-1] else arguments[-1], self.refused(*arguments))

    def test_standard_output_takes_every_byte_or_the_run_failed(self):
        film = "plain/video.mp4"
        for arguments in (("track", film, "--targets", "markers", "-o", "t.csv", "--json"),
                          ("measure", "places.csv", "-o", "s.csv", "--json"), ("measure", "places.csv", "-o", "s.csv"),
                          ("calibrate", "ground", "floor/rig.toml", "--observations", "floor/observations.csv", "-o", "g.toml", "--json"),
                          ("evaluate", "--truth", "boxes.txt", "--tracks", "boxes.txt", "--json"), ("info", "floor/rig.toml"),
                          ("convert", "places.csv", "places.dat", "--json"), ("--help",), ("--version",), ("track", "--help")):
            with open("/dev/full", "w") as full:
                done = subprocess.run([MAREY, *arguments], stdout=full, stderr=subprocess.PIPE, text=True, cwd=self.folder, timeout=300)
            self.assertEqual(done.returncode, 1, f"{arguments}: {done.stderr}")
            self.assertIn("marey: standard output: could not be written to the end", done.stderr.splitlines()[-1])
            self.assertNotIn("cannot write to file", done.stderr)

    def test_help_for_a_newcomer(self):
        self.assertRegex(self.marey("--version").stdout, r"^marey \d+\.\d+\.\d+( \(commit [0-9a-f]{12}(, changed since)?\))?\n$")
        listed = self.marey(code=2).stderr
        for command in COMMANDS:
            self.assertIn(command.split()[0], listed)
            asked = self.marey("help", *command.split()).stdout
            self.assertEqual(asked, self.marey(*command.split(), "--help").stdout)
            self.assertIn("--output" if command not in ("evaluate", "info", "convert", "play", "experiment outlines", "experiment hypotheses")
                          else "--json", asked)
            for option in ("--json", "--quiet"):
                self.assertIn(option, asked, command)
        self.assertEqual(self.marey("help").stdout, self.marey("--help").stdout)
        self.assertIn("pitch", self.marey("calibrate", code=2).stderr)

    def test_wrong_words_name_the_right_one(self):
        for words, right in ((("trak",), "track"), (("help", "evalute"), "evaluate"), (("calibrate", "grond"), "ground"),
                             (("track", "plain/video.mp4", "--overly", "o.mp4"), "--overlay"), (("info", "boxes.txt", "--jsno"), "--json"),
                             (("simulate", "markers", "plain", "--frame=3"), "--frames"), (("reconstruct", "--ouput", "x.marey"), "--output"),
                             (("simulate", "room", "--motion", "wlak"), "walk"), (("track", "a.avi", "--targets", "marker"), "markers")):
            self.assertRegex(self.refused(*words), rf"Did you mean {right}\?$")
        # What is like none of them is not taken for the one that is least unlike.
        for words in (("track", "plain/video.mp4", "--in-step"), ("info", "boxes.txt", "--colour"), ("convert", "a", "b", "--teams")):
            self.assertNotIn("Did you mean", self.refused(*words))
        self.assertIn("-z", self.refused("info", "boxes.txt", "-z"))
        self.refused("info", "boxes.txt", "one", "more")

    def test_options_that_were_called_otherwise(self):
        self.assertIn("--out is called --output now", self.refused("calibrate", "board", "rig.toml", "--out", "b.toml"))
        self.assertIn("--out is called --output now", self.refused("experiment", "trackers", "--out=plots"))
        self.assertIn("--in-step is called --synced now", self.refused("calibrate", "wand", "floor/start.toml", "--in-step"))
        for command in COMMANDS:
            listed = self.marey(*command.split(), "--help").stdout
            self.assertNotRegex(listed, r"--out\b|--in-step")

    def test_endings_report_the_format(self):
        film = "plain/video.mp4"
        for arguments in (("track", film, "-o", "t.xyz"), ("track", film, "-o", "t"), ("track", film, "-o", "t.txt", "--plot", "p.png"),
                          ("track", film, "-o", "t.txt", "--overlay", "o.gif"), ("track", "match/rig.toml", "--ground", "-o", "t.txt"),
                          ("measure", "places.csv", "-o", "s.pdf"), ("convert", "places.csv", "p.odt"),
                          ("reconstruct", "floor/rig.toml", "--observations", "floor/observations.csv", "-o", "walk.fbx"),
                          ("calibrate", "ground", "floor/rig.toml", "--observations", "floor/observations.csv", "-o", "g.json")):
            self.assertIn("end", self.refused(*arguments), arguments)
        self.marey("track", film, "--targets", "markers", "-q", "-o", "/dev/null")

    def test_what_was_made_is_stated(self):
        self.assertRegex(self.marey("convert", "places.csv", "places.dat").stderr, r"places\.dat: \w+, 400 places")
        self.assertNotIn("places.dat:", self.marey("convert", "places.csv", "places.dat", "-q").stderr)
        told = json.loads(self.marey("convert", "floor/rig.toml", "rig.yml", "--json").stdout)
        self.assertEqual((told["to"], told["cameras"]), ("rig.yml", 5))
        for arguments in (("markers", "plain", "--frames", 4), ("people", "--frames", 2, "--size", 320, 240, "--height", 40),
                          ("room", "--frames", 3, "--cameras", 2), ("match", "--seconds", 0.2, "--cameras", 1)):
            told = json.loads(self.marey("simulate", *arguments, "-o", "made", "--json").stdout)
            self.assertIn("seed", told)
            self.assertEqual(self.marey("simulate", *arguments, "-o", "made", "-q").stderr, "")
        self.assertEqual(self.marey("info", "floor/rig.toml", "-q").stdout, "")
        self.assertEqual(self.marey("evaluate", "--truth", "boxes.txt", "--tracks", "boxes.txt", "-q").stdout, "")


if __name__ == "__main__":
    MAREY = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main()
