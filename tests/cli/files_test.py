"""`marey convert` and `marey info` as their user sees them: good files, and files that cannot be used.

Usage: files_test.py MAREY [unittest options]
"""

import json
import pathlib
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import unittest

MAREY = ""
ROWS = "frame,time,id,label,x,y,z\n" + "".join(f"{f},{f / 100:.6f},{m},M{m},{0.1 * m},{f / 64},1.5\n" for f in range(50) for m in (1, 2, 3))


class Files(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="marey_cli_"))
        self.addCleanup(shutil.rmtree, self.folder)
        self.csv = self.folder / "walk.csv"
        self.csv.write_text(ROWS)

    def run_marey(self, *arguments, code=0):
        done = subprocess.run([MAREY, *map(str, arguments)], capture_output=True, text=True, cwd=self.folder, timeout=60)
        self.assertEqual(done.returncode, code, f"{arguments}\n{done.stdout}\n{done.stderr}")
        return done

    def refused(self, *arguments, code=1):
        """Ends with `code` and one sentence, and leaves nothing behind."""
        before = sorted(self.folder.rglob("*"))
        said = self.run_marey(*arguments, code=code).stderr
        self.assertEqual(sorted(self.folder.rglob("*")), before, "something was left behind")
        if code == 1:
            self.assertEqual(len(said.strip().splitlines()), 1, said)
        return said

    def test_round_through_every_format(self):
        at = self.csv
        for name in ("a.c3d", "b.marey", "c.trc", "d.csv"):
            self.run_marey("convert", at, name)
            at = self.folder / name
            told = json.loads(self.run_marey("info", name, "--json").stdout)
            self.assertEqual((told["frames"], told["points"], told["rate_hz"]), (50, 150, 100.0), told)
            self.assertEqual([track["label"] for track in told["tracks"]], ["M1", "M2", "M3"])
            self.assertIn("50 frames at 100 Hz", self.run_marey("info", name).stdout)
        rows = [line.split(",") for line in at.read_text().splitlines()]
        self.assertEqual(rows[0][:7], "frame,time,id,label,x,y,z".split(","))
        self.assertEqual([float(value) for value in rows[-1][4:7]], [0.3, 49 / 64, 1.5])
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()), ["a.c3d", "b.marey", "c.trc", "d.csv", "walk.csv"])

    def test_axis_that_is_up(self):
        self.run_marey("convert", self.csv, "y.trc", "--up", "y")
        row = (self.folder / "y.trc").read_text().splitlines()[-1].split("\t")
        self.assertEqual([float(value) for value in row[2:5]], [100.0, 1500.0, -49 / 64 * 1000])
        self.run_marey("convert", "y.trc", "back.marey", "--up", "y")
        self.run_marey("convert", "back.marey", "back.csv")
        row = (self.folder / "back.csv").read_text().splitlines()[-1].split(",")
        self.assertEqual([float(value) for value in row[4:7]], [0.3, 49 / 64, 1.5])

    def test_a_part_keeps_its_numbers_and_times(self):
        self.run_marey("convert", self.csv, "whole.marey")
        whole = self.csv.read_text().splitlines()
        for source in (self.csv, "whole.marey"):
            for name in ("part.c3d", "part.trc", "part.marey", "part.csv"):
                self.run_marey("convert", source, name, "--frames", "10:29")
                self.run_marey("convert", name, "back.csv")
                rows = [line.split(",") for line in (self.folder / "back.csv").read_text().splitlines()[1:]]
                self.assertEqual([int(row[0]) for row in rows], [frame for frame in range(10, 30) for _ in range(3)], (source, name))
                self.assertEqual((float(rows[0][1]), float(rows[0][5])), (0.1, 10 / 64), (source, name))
        self.run_marey("convert", self.csv, "end.csv", "--frames", "48:")
        self.assertEqual(len((self.folder / "end.csv").read_text().splitlines()), 1 + 2 * 3)
        self.assertEqual(len(whole), 151)
        self.assertIn("walk.csv: has none of the frames 70:80", self.refused("convert", self.csv, "none.c3d", "--frames", "70:80"))
        self.assertFalse((self.folder / "none.c3d").exists())
        for wrong in ("80:70", "12", "a:b", "-4:5"):
            self.assertIn("not frames; write FIRST:LAST", self.refused("convert", self.csv, "none.c3d", f"--frames={wrong}", code=2))

    def test_a_part_of_a_match_and_of_tracks(self):
        (self.folder / "match.csv").write_text("frame,id,x,y,team\n" + "".join(f"{f},{p},{5 * p},{3 * p},red\n" for f in range(40) for p in range(1, 4)))
        self.run_marey("convert", "match.csv", "part.csv", "--frames", "5:9")
        self.assertEqual([int(line.split(",")[0]) for line in (self.folder / "part.csv").read_text().splitlines()[1:]], [f for f in range(5, 10) for _ in range(3)])
        (self.folder / "tracks.txt").write_text("".join(f"{f},1,{10 + f},20,30,60,1,-1,-1,-1\n" for f in range(1, 41)))
        self.run_marey("convert", "tracks.txt", "part.txt", "--rate", "25", "--frames", ":4")
        self.assertEqual([int(line.split(",")[0]) for line in (self.folder / "part.txt").read_text().splitlines()], [1, 2, 3, 4, 5])

    def test_the_axis_that_a_c3d_file_states_is_up(self):
        self.run_marey("convert", self.csv, "y.c3d", "--up", "y")
        said = self.run_marey("convert", "y.c3d", "back.csv").stderr
        self.assertIn("y.c3d: its y is taken for up, as the file says; if z is up in it, say --up z (`marey convert`: --from-up z)", said)
        row = (self.folder / "back.csv").read_text().splitlines()[-1].split(",")
        self.assertEqual([round(float(value), 6) for value in row[4:7]], [0.3, round(49 / 64, 6), 1.5])
        self.assertNotIn("taken for up", self.run_marey("convert", "y.c3d", "as_it_stands.csv", "--from-up", "z").stderr)
        row = (self.folder / "as_it_stands.csv").read_text().splitlines()[-1].split(",")
        self.assertEqual([round(float(value), 6) for value in row[4:7]], [0.3, 1.5, round(-49 / 64, 6)])
        self.run_marey("convert", "y.c3d", "again.c3d", "--up", "y")
        self.assertEqual((self.folder / "again.c3d").read_bytes()[512:], (self.folder / "y.c3d").read_bytes()[512:])

    def test_files_that_are_cut_off(self):
        for name in ("a.c3d", "a.marey"):
            self.run_marey("convert", self.csv, name)
            if name == "a.c3d":
                self.run_marey("convert", name, "whole.csv")
            data = (self.folder / name).read_bytes()
            for share in (0.001, 0.3, 0.9):
                (self.folder / name).write_bytes(data[: int(len(data) * share)])
                if (name, share) != ("a.c3d", 0.9):
                    self.assertIn(name, self.refused("convert", name, "out.csv"))
                    continue
                said = self.run_marey("convert", name, "part.csv").stderr  # frames that are there are read
                self.assertIn("a.c3d: is cut off: it names 50 frames and holds ", said)
                rows = (self.folder / "part.csv").read_text().splitlines()
                self.assertEqual(rows, (self.folder / "whole.csv").read_text().splitlines()[: len(rows)])
                self.assertGreater(len(rows), 30)

    def test_frames_beyond_what_is_there(self):
        self.run_marey("convert", self.csv, "a.c3d")
        data = bytearray((self.folder / "a.c3d").read_bytes())
        at = data.index(b"ACTUAL_END_FIELD") + len(b"ACTUAL_END_FIELD") + 5
        struct.pack_into("<HH", data, at, 0xFFFF, 0x7FFF)
        (self.folder / "a.c3d").write_bytes(data)
        said = self.run_marey("info", "a.c3d")
        self.assertIn("50 frames", said.stdout)
        self.assertIn("but holds 50", said.stderr)

    def test_what_cannot_be_used(self):
        self.assertIn("no such file", self.refused("info", "none.c3d"))
        (self.folder / "notes.txt").write_text("hello\n")
        self.assertIn("not one of the files", self.refused("info", "notes.txt"))
        self.assertIn("not one of the files", self.refused("convert", "notes.txt", "out.c3d"))
        self.assertIn("unknown ending; these can be written: ", self.refused("convert", self.csv, "out.xyz", code=2))
        self.assertIn("is an input too", self.refused("convert", self.csv, self.csv, code=2))
        self.assertIn("is not a take", self.refused("convert", self.csv, "notes.txt", "--format", "take"))
        self.refused("convert", self.csv, "out.c3d", "--up", "x", code=2)
        self.assertIn("cannot be written", self.refused("convert", self.csv, "/dev/full", "--format", "c3d"))
        self.assertIn("read only", self.refused("convert", self.csv, "out.csv", "--format", "nexus", code=2))

    def test_killed_while_it_writes_a_take(self):
        with open(self.csv, "w") as file:
            file.write("frame,time,id,label,x,y,z\n")
            file.writelines(f"{f},{f / 100:.6f},{m},M{m},0.5,1,1.5\n" for f in range(20_000) for m in range(1, 41))
        writing = subprocess.Popen([MAREY, "convert", self.csv, self.folder / "a.marey", "--quiet"])
        while not (self.folder / "a.marey").exists() and writing.poll() is None:
            pass
        try:
            writing.wait(1.2)
        except subprocess.TimeoutExpired:
            writing.send_signal(signal.SIGKILL)
            writing.wait()
        told = json.loads(self.run_marey("info", "a.marey", "--json").stdout)
        self.assertEqual(told["points"], 40 * told["frames"])
        self.run_marey("convert", "a.marey", "a.c3d")
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()), ["a.c3d", "a.marey", "walk.csv"])


if __name__ == "__main__":
    MAREY = sys.argv.pop(1)
    unittest.main()
