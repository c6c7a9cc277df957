"""Files made to do harm, and numbers that are wrong by much: the program ends soon, in little memory, with one sentence.

Usage: hostile_test.py MAREY [unittest options].
"""

import pathlib
import resource
import shutil
import sqlite3
import subprocess
import sys
import tempfile
import unittest

MAREY = ""
SECONDS = 30
MEMORY = 6 << 30  # of addresses; the libraries alone map most of one


def limited():
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))


class Hostile(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="marey_hostile_"))
        self.addCleanup(shutil.rmtree, self.folder)

    def run_marey(self, *arguments):
        return subprocess.run([MAREY, *map(str, arguments)], capture_output=True, cwd=self.folder, timeout=SECONDS, preexec_fn=limited)

    def refused(self, *arguments, words=()):
        done = self.run_marey(*arguments)
        said = done.stderr.decode(errors="replace")
        self.assertIn(done.returncode, (1, 2), f"{arguments}\n{said[:2000]}")
        self.assertEqual(len(said.strip().splitlines()), 1, said[:2000])
        self.assertLess(len(said), 2000)
        for word in words:
            self.assertIn(word, said)
        for internal in ("exception", "nelems", "cv::", "OpenCV(", "std::", "terminate"):
            self.assertNotIn(internal, said)
        return said

    def accepted(self, *arguments):
        done = self.run_marey(*arguments)
        self.assertEqual(done.returncode, 0, f"{arguments}\n{done.stderr[:2000]}")
        return done

    def write(self, name, content):
        path = self.folder / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    def take(self, name="a.marey"):
        """Two seconds of two markers."""
        rows = "".join(f"{i},{i / 100:.2f},{m},{i / 100 + k:.3f},0,1\n" for i in range(200) for k, m in enumerate("ab"))
        self.write("points.csv", "frame,time,label,x,y,z\n" + rows)
        self.accepted("convert", "points.csv", name)
        return self.folder / name

    # --- depth ---

    def test_rigs_that_are_nested_too_deep(self):
        many = 200_000
        for name, text in (("a.toml", "a" + ".a" * 50_000 + " = 1\n[[camera]]\n"), ("b.toml", "[[camera]]\nname = " + "[" * many),
                           ("c.yml", "%YAML:1.0\n---\na: " + "[" * many), ("d.yml", "%YAML:1.0\n---\n" + "- " * many),
                           ("e.json", '{"camera_matrix": ' + "[" * many), ("f.xml", '<?xml version="1.0"?>\n<opencv_storage>' + "<a>" * many),
                           ("g.xml", "<calibration><cameras><camera>" + "<a>" * many), ("h.xml", "<Camera><Geometry/>" + "<a>" * many),
                           ("i.toml", "[cam_0]\nmatrix = [1]\ndistortions" + ".a" * many + " = 1\n")):
            with self.subTest(name=name):
                self.write(name, text)
                self.refused("info", name, words=["nested more than"])

    def test_a_takes_rig_that_is_nested_too_deep(self):
        take = self.take()
        with sqlite3.connect(take) as database:
            database.execute("INSERT OR REPLACE INTO take (key, value) VALUES ('rig', ?)", ("a" + ".a" * 50_000 + " = 1",))
        self.refused("info", take, words=["nested more than"])
        self.refused("convert", take, "out.csv", words=["nested more than"])

    def test_a_crossing_that_does_not_fit(self):
        for frames in (2, 3, 5):
            with self.subTest(frames=frames):
                self.refused("simulate", "markers", "crossing", "--frames", frames, "-o", "scene", words=["cross in"])

    # --- one wild number ---

    def test_one_wild_frame_is_named_before_anything_is_followed(self):
        far, words = 999_999_999, ["999999999 are named, of which", "a number must be wrong"]
        self.write("boxes.txt", "".join(f"{i},-1,100,100,20,50,0.9\n" for i in (1, 2, 3, far)))
        self.refused("track", "boxes.txt", "-o", "out.txt", words=words)
        self.write("tracks.txt", "".join(f"{i},1,100,100,20,50,1\n" for i in (1, 2, 3, far)))
        self.refused("evaluate", "--truth", "tracks.txt", "--tracks", "tracks.txt", words=words)
        self.write("points.csv", "frame,time,id,label,x,y,z\n" + "".join(f"{i},{i / 100:.2f},1,a,1,2,3\n" for i in (0, 1, 2, far)))
        self.refused("convert", "points.csv", "out.c3d", words=words)
        self.write("match.csv", "frame,time,id,x,y\n" + "".join(f"{i},{i / 25:.2f},1,2,3\n" for i in (0, 1, 2, far)))
        self.refused("measure", "match.csv", words=words)
        take = self.take()
        with sqlite3.connect(take) as database:
            names = [row[1] for row in database.execute("PRAGMA table_info(frame)")]
            others = ", ".join(names[1:])
            self.assertEqual(names[0], "frame")
            database.execute(f"INSERT INTO frame (frame, {others}) SELECT {far}, {others} FROM frame WHERE frame = 199")
        self.refused("convert", take, "out.csv", words=words)

    def test_a_wild_time_makes_no_wild_rate(self):
        self.write("match.csv", "frame,time,id,x,y\n" + "".join(f"{i},{-5000 if i == 99 else i / 25:.2f},1,2,3\n" for i in range(100)))
        said = self.accepted("info", "match.csv").stdout.decode()
        self.assertIn("25 Hz", said)


if __name__ == "__main__":
    MAREY = sys.argv.pop(1)
    unittest.main()
