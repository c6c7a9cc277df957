"""Files made to do harm, and numbers that are wrong by much: the program ends soon, in little memory, with one sentence.

A program with sanitizers (MAREY_SANITIZE names them) reserves terabytes of addresses and is slower: its memory is not bounded, its time is longer.

Usage: hostile_test.py MAREY [unittest options].
"""

import json
import os
import pathlib
import resource
import shutil
import sqlite3
import struct
import subprocess
import sys
import tempfile
import unittest
import xml.dom.minidom
import zlib

MAREY = ""
SANITIZED = bool(os.environ.get("MAREY_SANITIZE"))
SECONDS = 120 if SANITIZED else 30
MEMORY = 6 << 30  # of addresses; the libraries alone map most of one


def limited():
    if not SANITIZED:
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

    def test_one_wild_frame_is_named_before_anything_is_tracked(self):
        far, words = 999_999_999, ["999999999 are named, of which", "a number must be wrong"]
        self.write("boxes.txt", "".join(f"{i},-1,100,100,20,50,0.9\n" for i in (1, 2, 3, far)))
        self.refused("track", "--detections", "boxes.txt", "--rate", "25", "-o", "out.txt", words=words)
        self.write("tracks.txt", "".join(f"{i},1,100,100,20,50,1\n" for i in (1, 2, 3, far)))
        self.refused("evaluate", "--truth", "tracks.txt", "--tracks", "tracks.txt", words=words)
        self.write("points.csv", "frame,time,id,label,x,y,z\n" + "".join(f"{i},{i / 100:.2f},1,a,1,2,3\n" for i in (0, 1, 2, far)))
        self.refused("convert", "points.csv", "out.c3d", words=words)
        self.write("match.csv", "frame,time,id,x,y\n" + "".join(f"{i},{min(i, 3) / 25:.2f},1,2,3\n" for i in (0, 1, 2, far)))
        self.refused("measure", "match.csv", "-o", "measured.csv", words=words)
        take = self.take()
        with sqlite3.connect(take) as database:
            first, last, indices = database.execute("SELECT first_index, last_index, indices FROM chunk").fetchone()
            self.assertEqual((first, last), (0, 199))
            others = "instants, NULL, times"
            database.execute(f"INSERT INTO chunk (id, first_index, last_index, instants, indices, times) "
                             f"SELECT id + 1, {far}, {far} + instants - 1, {others} FROM chunk")
        self.refused("convert", take, "out.csv", words=["are named, of which", words[1]])

    def test_a_wild_time_makes_no_wild_rate(self):
        self.write("match.csv", "frame,time,id,x,y\n" + "".join(f"{i},{-5000 if i == 99 else i / 25:.2f},1,2,3\n" for i in range(100)))
        said = self.accepted("info", "match.csv").stdout.decode()
        self.assertIn("25 Hz", said)

    # --- foreign bytes ---

    def test_foreign_bytes_in_names(self):
        head = b"frame,time,id,label,team,x,y\n"
        row = b"%d,%.2f,%d,a\x01\xff<&,=1+1,%.1f,3\n"
        self.write("match.csv", head + b"".join(row % (i, i / 25, k, i / 10 + k) for i in range(60) for k in (1, 2)))
        said = self.accepted("measure", "match.csv", "-o", "measured.csv", "--json").stdout
        json.loads(said.decode())
        for name in ("out.csv", "out.txt"):
            self.accepted("convert", "match.csv", name)
        csv = (self.folder / "out.csv").read_bytes().decode()
        self.assertIn(",'=1+1,", csv)
        self.assertNotIn("\x01", csv)

    def test_a_video_with_a_foreign_byte_in_its_name(self):
        name = os.fsencode(self.folder) + b"/f\xff<m>.txt"
        with open(name, "wb") as file:
            file.write(b"".join(b"%d,-1,%d,100,20,50,0.9\n" % (i, 100 + 2 * i) for i in range(1, 60)))
        done = subprocess.run([MAREY, "track", "--detections", name, "--rate", "25", "-o", "out.txt", "--plot", "out.svg"], capture_output=True, cwd=self.folder, timeout=SECONDS)
        self.assertEqual(done.returncode, 0, done.stderr)
        xml.dom.minidom.parse(str(self.folder / "out.svg"))

    def test_takes_of_untrusted_write_no_control_characters(self):
        evil = "A\x1b]0;evil\x07\n\x01"
        take = self.take()
        self.accepted("edit", take, "rename a knee")
        with sqlite3.connect(take) as database:
            for key in ("name", "program", "recorded_at"):
                database.execute("INSERT OR REPLACE INTO take VALUES (?, ?)", (key, evil))
            database.execute("INSERT INTO option VALUES (?, ?)", (evil, evil))
            database.execute("INSERT INTO input (name, hash) VALUES (?, ?)", (evil, evil))
            database.execute("UPDATE track SET label = ? || id, team = ?", (evil, evil))
            head = database.execute("SELECT max(id) FROM edit").fetchone()[0]
            database.execute("UPDATE edit SET payload = replace(payload, 'knee', ?)", ("\\u001b[31mknee",))
            database.execute("INSERT INTO edit VALUES (90, ?, ?, ?)", (head, evil, evil))
            database.execute("INSERT OR REPLACE INTO take VALUES ('head', 90)")
        for arguments in (("info", take), ("edit", take, "--list"), ("edit", take, "swap #1 #2 5:6"), ("convert", take, "out.csv"),
                          ("play", take, "--stream", "osc", "--speed", "100"), ("convert", take, "out.trc")):
            with self.subTest(arguments=arguments):
                done = self.accepted(*arguments)
                self.assertNotRegex(done.stdout + done.stderr, rb"[\x00-\x08\x0b-\x1f\x7f]")
        self.assertNotRegex((self.folder / "out.csv").read_bytes(), rb"[\x00-\x09\x0b-\x1f\x7f]")
        long = "x" * 5000
        self.write("edits.txt", f"rename #1 {long}\n")
        self.refused("edit", take, "--script", "edits.txt", words=["5000 bytes", "the limit label_bytes"])

    # --- size ---

    def test_labels_and_tracks_without_end(self):
        take = self.take()
        with sqlite3.connect(take) as database:
            database.execute("UPDATE track SET label = ?", ("x" * 20_000_000,))
        self.refused("info", take, words=["20000000 bytes", "label_bytes"])
        take = self.take("b.marey")
        with sqlite3.connect(take) as database:
            names = [row[1] for row in database.execute("PRAGMA table_info(track)")]
            values = ", ".join("n" if name == "id" else "''" if name in ("label", "team", "kind") else "0" for name in names)
            database.execute(f"WITH RECURSIVE many(n) AS (SELECT 10 UNION ALL SELECT n + 1 FROM many LIMIT 200000) "
                             f"INSERT INTO track ({', '.join(names)}) SELECT {values} FROM many")
        self.refused("info", take, words=["100000 tracks"])

    def test_a_crowd_beyond_reason(self):
        self.write("tracks.txt", "".join(f"1,{i},{i % 100},{i // 100},20,50,1\n" for i in range(8000)))
        self.refused("evaluate", "--truth", "tracks.txt", "--tracks", "tracks.txt", words=["pairs_a_frame"])

    def test_more_blobs_than_any_person_has(self):
        self.accepted("simulate", "room", "--motion", "ground", "--frames", "2", "--cameras", "8", "-o", "room")
        seen = [row.split(",") for row in (self.folder / "room" / "blobs.csv").read_text().splitlines()]
        head = seen[0]
        names = sorted({row[head.index("camera")] for row in seen[1:]})
        self.assertEqual(len(names), 8)

        def crowd(each):
            values = {"frame": "0", "time": "0"}
            rows = [",".join(head)]
            for camera in names:
                for i in range(each):
                    values.update(camera=camera, x=f"{i % 97 * 13.1:.1f}", y=f"{i // 97 * 11.3:.1f}")
                    rows.append(",".join(values.get(column, "") for column in head))
            return self.write("crowd.csv", "\n".join(rows) + "\n")

        command = ("reconstruct", "room/rig.toml", "--observations", "crowd.csv", "-o", "out.marey")
        crowd(6000)
        self.refused(*command, words=["48000", "the limit observations"])
        crowd(100)
        self.refused(*command, "--limit", "observations=700", words=["800 blobs", "at most 700"])
        self.accepted(*command, "--limit", "observations=800")

    def test_two_million_people(self):
        self.write("match.csv", "frame,time,id,x,y\n" + "".join(f"0,0,{i},1,2\n" for i in range(1, 2_000_001)))
        self.refused("measure", "match.csv", "-o", "out.csv", words=["100000", "the limit tracks"])

    def test_an_option_raises_each_limit(self):
        take = self.take()
        with sqlite3.connect(take) as database:
            database.execute("UPDATE track SET label = ?", ("x" * 5000,))
        self.refused("info", take, words=["5000 bytes", "label_bytes"])
        self.accepted("info", take, "--limit", "label_bytes=5000")
        self.refused("info", take, "--limit", "label_bytes=5000,tracks=1", words=["the limit tracks"])
        self.write("tracks.txt", "".join(f"1,{i},{9 * i},50,20,50,1\n" for i in range(1, 11)))
        both = ("evaluate", "--truth", "tracks.txt", "--tracks", "tracks.txt")
        self.refused(*both, "--limit", "pairs_a_frame=99", words=["pairs_a_frame"])
        self.accepted(*both, "--limit", "pairs_a_frame=100")
        for wrong in ("tracks", "tracks=", "tracks=0", "tracks=-1", "tracks=nan", "trakcs=5", "tracks=5,", "=5", ""):
            with self.subTest(wrong=wrong):
                self.refused("info", take, "--limit", wrong, words=["--limit"])
        self.accepted("simulate", "markers", "plain", "--frames", "12", "-o", "plain")
        self.refused("track", "plain/video.mp4", "-o", "out.txt", "--limit", "picture_px=1000", words=["picture_px"])

    def test_texts_that_never_end(self):
        take = self.take()
        self.accepted("simulate", "room", "--motion", "ground", "--frames", "2", "--cameras", "3", "-o", "room")
        for arguments in (("track", "--detections", "/dev/zero", "-o", "out.csv"), ("edit", take, "--script", "/dev/zero"),
                          ("calibrate", "ground", "room/rig.toml", "--observations", "/dev/zero", "-o", "out.toml"),
                          ("live", "sim://room?cameras=2", "--labels", "/dev/zero", "--duration", "1"),
                          ("batch", "plan", "/dev/zero", "-o", "out.tsv"), ("batch", "run", "/dev/zero")):
            with self.subTest(arguments=arguments):
                self.refused(*arguments, words=["a line has more than 16777216 bytes"])
        with open(self.folder / "zeros.txt", "wb") as file:  # a file, too, and it ends
            file.truncate(200_000_000)
        self.refused("track", "--detections", "zeros.txt", "-o", "out.csv", words=["a line has more than"])

    def test_a_skeleton_beyond_reason(self):
        segment = '[[segment]]\nname = "s{0}"\nparent = "s{1}"\nat = [0, 0, 1]\njoint = "hinge"\naxes = ["y"]\ncoordinates = ["c{0}"]\n'
        markers = "".join(f'[[marker]]\nname = "{name}"\non = "s2000"\nat = [0, {i}, {i * i}]\n' for i, name in enumerate("ab"))
        self.write("long.toml", '[[segment]]\nname = "s0"\n' + "".join(segment.format(i, i - 1) for i in range(1, 2001)) + markers)
        command = ("solve", self.take(), "--skeleton", "long.toml", "-o", "out.mot")
        self.refused(*command, words=["2006 coordinates", "at most 1000"])

    def test_motions_of_skeletons_beyond_reason(self):
        joints = "".join(f"JOINT b{i}\n{{\nOFFSET 1 0 0\n}}\n" for i in range(9000))
        self.write("a.bvh", "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 1 Xposition\n" + joints + "}\nMOTION\nFrames: 500000\nFrame Time: 0.01\n" + "0\n" * 500_000)
        self.refused("convert", "a.bvh", "a.csv", words=["9001 joints that 1 numbers a frame move"])
        bones = "".join(f"begin\nname b{i}\ndirection 0 1 0\nlength 1\naxis 0 0 0 XYZ\ndof rx ry rz\nend\n" for i in range(300))
        self.write("b.asf", ":root\norder TX TY TZ RX RY RZ\n:bonedata\n" + bones + ":hierarchy\nbegin\n" + "".join(f"root b{i}\n" for i in range(300)) + "end\n")
        self.write("b.amc", ":FULLY-SPECIFIED\n:DEGREES\n" + "1\n" * 3_000_000)
        self.refused("info", "b.amc", words=["frames without their bones"])
        self.write("c.vsk", "<KinematicModel><Skeleton>" + "<Segment>" * 200_000)
        self.write("points.csv", "frame,time,label,x,y,z\n0,0,a,1,2,3\n")
        self.refused("solve", "points.csv", "--skeleton", "c.vsk", "-o", "c.mot", words=["nested more than"])
        self.write("d.glb", b"glTF" + struct.pack("<III", 2, 0, 200_000) + b"JSON" + b"[" * 200_000)
        self.refused("info", "d.glb", words=["nested more than"])

    def test_analog_counts_that_no_file_holds(self):
        def parameter(group, name, kind, data, *sizes):
            body = struct.pack("<bB", kind, len(sizes)) + bytes(sizes) + data + b"\0"
            return struct.pack("<bb", len(name), group) + name + struct.pack("<h", 2 + len(body)) + body

        def c3d(words, samples, used, rate, bodies=0):
            groups = b"".join(struct.pack("<bb", len(name), -i) + name + struct.pack("<hB", 3, 0)
                              for i, name in ((1, b"POINT"), (2, b"ANALOG"), (3, b"ROTATION")))
            section = groups + b"".join((
                parameter(1, b"USED", 2, struct.pack("<h", 0)), parameter(1, b"SCALE", 4, struct.pack("<f", -1)), parameter(1, b"RATE", 4, struct.pack("<f", 1)),
                parameter(1, b"UNITS", -1, b"mm", 2), parameter(2, b"USED", 2, struct.pack("<h", used)), parameter(2, b"RATE", 4, struct.pack("<f", rate)),
                parameter(3, b"USED", 2, struct.pack("<h", bodies)), parameter(3, b"DATA_START", 2, struct.pack("<h", 3))))
            head = struct.pack("<BBHHHHHfHHf", 2, 0x50, 0, words, 1, 10, 0, -1.0, 3, samples, 1.0)
            return head.ljust(512, b"\0") + (b"\x01\x50\x01\x54" + section).ljust(512, b"\0") + b"\0" * 1024

        self.write("a.c3d", c3d(65535, 1, -1, 1))
        self.refused("convert", "a.c3d", "b.c3d", words=["is cut off: it names 10 frames and holds 0"])
        self.write("a.c3d", c3d(30_000 * 30_000 % 65536, 1, 30_000, 30_000))  # a count beyond 16 bits, as the parameters have it
        self.refused("convert", "a.c3d", "b.c3d", words=["is cut off"])
        self.write("a.c3d", c3d(0, 0, 0, 0, bodies=-1))
        self.refused("convert", "a.c3d", "b.c3d", words=["is cut off"])
        self.write("a.c3d", c3d(20, 3, 7, 1))  # 20 values a frame, of 7 channels or of 3 samples
        self.assertIn("they are skipped", self.accepted("convert", "a.c3d", "b.c3d").stderr.decode())

    @unittest.skipIf(SANITIZED, "sanitizers reserve more than any bound")
    def test_memory_that_is_not_enough_is_a_message(self):
        rows = "".join(f"{i},{i / 100:.2f},{m},{i},0,1\n" for i in range(200_000) for m in "ab")
        self.write("points.csv", "frame,time,label,x,y,z\n" + rows)
        seen = set()
        for megabytes in range(150, 700, 25):
            bound = megabytes << 20
            done = subprocess.run([MAREY, "convert", "points.csv", "out.c3d"], capture_output=True, cwd=self.folder, timeout=SECONDS,
                                  preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (bound, bound)))
            said = done.stderr.decode(errors="replace")
            self.assertNotIn("bad_alloc", said)
            seen.add(done.returncode)
        self.assertIn(0, seen)

    def test_a_image_beyond_reason(self):
        def chunk(kind, data):
            return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

        side = 30_000
        body = zlib.compressobj(9)
        rows = b"".join(body.compress(bytes(side + 1) * 100) for _ in range(side // 100)) + body.flush()
        png = b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", side, side, 8, 0, 0, 0, 0)) + chunk(b"IDAT", rows) + chunk(b"IEND", b"")
        pictures = self.folder / "pictures"
        pictures.mkdir()
        for i in range(2):
            (pictures / f"{i:03}.png").write_bytes(png)
        self.refused("track", pictures, "-o", "out.txt", words=["picture_px"])


if __name__ == "__main__":
    MAREY = sys.argv.pop(1)
    unittest.main()
