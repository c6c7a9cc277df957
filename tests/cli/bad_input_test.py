"""What the program does with input it cannot use, as its user sees it: exit code, what is said, what is left behind.

Usage: bad_input_test.py MAREY [unittest options]. Input is made with ffmpeg; nothing else is needed.
"""

import json
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile
import unittest

MAREY = ""


def ffmpeg(*arguments):
    subprocess.run(["ffmpeg", "-nostdin", "-v", "error", "-y", *map(str, arguments)], check=True)


def video(path, seconds=4, size="320x240", codec=("-c:v", "mpeg4", "-q:v", "4")):
    """Two dark figures who cross a lawn."""
    lawn = f"color=0x90a080:size={size}:rate=10"
    person = "color=0x303040:size=16x44:rate=10"
    walk = "[0][1]overlay=x='-20+60*t':y=60[a];[a][2]overlay=x='330-60*t':y=150,noise=alls=4:allf=t:all_seed=7"
    ffmpeg("-f", "lavfi", "-i", lawn, "-f", "lavfi", "-i", person, "-f", "lavfi", "-i", person, "-filter_complex", walk,
           "-t", seconds, *codec, path)


def cut(path, share):
    data = path.read_bytes()
    path.write_bytes(data[: int(len(data) * share)])


class BadInput(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="marey_cli_"))
        self.out = self.folder / "out.txt"
        self.addCleanup(shutil.rmtree, self.folder)

    def run_marey(self, *arguments, code, cwd=None):
        done = subprocess.run([MAREY, *map(str, arguments)], capture_output=True, text=True, cwd=cwd or self.folder, timeout=300)
        self.assertEqual(done.returncode, code, f"{arguments}\n{done.stdout}\n{done.stderr}")
        self.assertNotIn("terminate called", done.stderr)
        self.assertNotIn("runtime error", done.stderr)
        return done

    def refused(self, *arguments, code=1):
        """Ends with `code` and one sentence, and leaves nothing behind."""
        before = sorted(self.folder.rglob("*"))
        said = self.run_marey(*arguments, code=code).stderr
        self.assertEqual(sorted(self.folder.rglob("*")), before, "something was left behind")
        if code == 1:
            self.assertEqual(len(said.strip().splitlines()), 1, said)
            self.assertTrue(said.startswith("marey: "), said)
        return said

    def track(self, source, *more, code=0):
        done = self.run_marey("track", source, "-o", self.out, *more, code=code)
        for line in self.out.read_text().splitlines():
            self.assertEqual(len(line.split(",")), 10, line)
        return done.stderr

    def test_detections_none_of_which_is_confident(self):
        boxes = self.folder / "boxes.txt"
        boxes.write_text("".join(f"{f},-1,{10 + 3 * f},50,20,50,{0.2 + 0.01 * (f % 3):.2f}\n" for f in range(1, 31)))
        said = self.run_marey("track", "--detections", boxes, "--rate", 25, "-o", self.out, code=0).stderr
        self.assertIn("no score reaches 0.5", said)
        self.assertEqual(len(self.out.read_text().splitlines()), 30)

    def test_missing_file(self):
        self.assertIn("no_such.avi: no such file", self.refused("track", "no_such.avi"))

    def test_folder_without_images(self):
        (self.folder / "empty").mkdir()
        self.assertIn("no images found", self.refused("track", "empty"))
        (self.folder / "empty" / "notes.txt").write_text("hello")
        self.assertIn("no images found", self.refused("track", "empty"))

    def test_pattern_that_matches_nothing(self):
        self.assertIn("no images found", self.refused("track", "shot_%04d.png"))

    def test_text_named_avi(self):
        (self.folder / "letter.avi").write_text("Dear camera,\n" * 100)
        self.assertIn("letter.avi: cannot be read as a video", self.refused("track", "letter.avi"))

    def test_file_of_no_length(self):
        (self.folder / "empty.mp4").touch()
        self.assertIn("empty.mp4: the file is empty", self.refused("track", "empty.mp4"))

    def test_truncated_avi(self):
        source = self.folder / "cut.avi"
        video(source)
        cut(source, 0.6)
        self.assertRegex(self.track(source), r"breaks off after \d+ frames of 40")

    def test_truncated_mp4(self):
        source = self.folder / "cut.mp4"
        video(source, codec=("-c:v", "libx264", "-pix_fmt", "yuv420p", "-g", "10", "-movflags", "+faststart"))
        cut(source, 0.6)
        self.assertRegex(self.track(source), r"breaks off after \d+ frames of 40")

    def test_mp4_cut_off_before_its_index(self):
        source = self.folder / "cut.mp4"
        video(source, codec=("-c:v", "libx264", "-pix_fmt", "yuv420p"))
        cut(source, 0.6)
        self.assertIn("cut off before its index", self.refused("track", source))

    def test_video_of_one_pixel(self):
        raw = self.folder / "dot.raw"
        raw.write_bytes(bytes(range(0, 200, 10)))
        source = self.folder / "dot.mkv"
        ffmpeg("-f", "rawvideo", "-pixel_format", "gray", "-video_size", "1x1", "-framerate", "5", "-i", raw, "-c:v", "ffv1", source)
        self.track(source, "--overlay", self.folder / "dot.mp4")

    def test_video_that_changes_size(self):
        parts = []
        for size in ("320x240", "160x120", "640x480"):
            part = self.folder / f"{size}.h264"
            video(part, seconds=2, size=size, codec=("-c:v", "libx264", "-pix_fmt", "yuv420p"))
            parts.append(part.read_bytes())
        source = self.folder / "sizes.h264"
        source.write_bytes(b"".join(parts))
        self.assertIn("scaled to the size of the first: 40", self.track(source, "--overlay", self.folder / "sizes.mp4"))

    def test_images_that_change_size(self):
        for i, size in enumerate(("64x48", "64x48", "32x32", "64x48")):
            ffmpeg("-f", "lavfi", "-i", f"color=gray:size={size}", "-frames:v", "1", self.folder / f"p{i}.png")
        self.assertIn("1 of 4 images omitted; the first: p2.png has another size", self.track(self.folder / "p%d.png", "--rate", 5))

    def test_corrupted_avi(self):
        source = self.folder / "film.avi"
        video(source)
        whole = source.read_bytes()
        for seed in range(6):
            dice = random.Random(seed)
            data = bytearray(whole)
            # The first 2 KiB are headers: half of the videos are damaged there too.
            for _ in range(60):
                data[dice.randrange(0 if seed % 2 else 2048, len(data))] = dice.randrange(256)
            damaged = self.folder / f"damaged_{seed}.avi"
            damaged.write_bytes(data)
            done = subprocess.run([MAREY, "track", damaged, "-o", self.out], capture_output=True, text=True, timeout=300)
            self.assertIn(done.returncode, (0, 1), f"seed {seed}: {done.stderr}")

    def test_fuzzed_detections(self):
        lines = [f"{f},-1,{20 + 3 * f},{40 + 90 * p},30,80,0.9" for f in range(1, 60) for p in range(3)]
        whole = "\n".join(lines).encode()
        taken = 0
        for seed in range(60):
            dice = random.Random(seed)
            data = bytearray(whole)
            for _ in range(dice.randrange(1, 6)):
                data[dice.randrange(len(data))] = dice.choice(b"0123456789.,-+eEnaif \n\r\x00\xff")
            (self.folder / "fuzzed.txt").write_bytes(data)
            done = subprocess.run([MAREY, "track", "--detections", "fuzzed.txt", "--rate", "25", "-o", self.out],
                                  capture_output=True, text=True, errors="replace", cwd=self.folder, timeout=300)
            self.assertIn(done.returncode, (0, 1), f"seed {seed}: {done.stderr}")
            taken += done.returncode == 0
            if done.returncode == 1:
                self.assertRegex(done.stderr, r"^marey: fuzzed\.txt", f"seed {seed}")
        self.assertGreater(taken, 5)

    def test_position_that_cannot_be_written(self):
        video(self.folder / "film.avi", seconds=1)
        (self.folder / "file").touch()
        self.assertIn("file/out.txt: cannot be written", self.refused("track", "film.avi", "-o", "file/out.txt"))
        self.assertIn("cannot be written", self.refused("track", "film.avi", "-o", "missing/out.txt"))
        self.assertIn("/proc/out.txt: cannot be written", self.refused("track", "film.avi", "-o", "/proc/out.txt"))
        self.assertIn("is a folder", self.refused("track", "film.avi", "-o", self.folder))
        self.assertIn("cannot be written", self.refused("track", "film.avi", "-o", "out.txt", "--overlay", "file/out.mp4"))

    def test_full_position(self):
        video(self.folder / "film.avi", seconds=4)
        self.assertIn("/dev/full: cannot be written (No space left on device)",
                      self.refused("track", "film.avi", "-q", "-o", "/dev/full", "--format", "csv"))
        self.assertTrue(pathlib.Path("/dev/full").is_char_device())

    def test_unknown_values_list_what_is_known(self):
        for option, value, known in (("--background", "gsoc", "marey, mog2, knn"), ("--format", "xml", "csv, jsonl, coco"),
                                     ("--filter", "magic", "kalman"), ("--targets", "cars", "people")):
            said = self.refused("track", "film.avi", option, value, code=2)
            self.assertIn(value, said)
            self.assertIn(known, said)
        for rate in ("0", "-3", "fast", "nan", "inf"):
            self.assertIn("Hz in [0.001, 1e6]", self.refused("track", "film.avi", "--rate", rate, code=2))

    def test_wrong_usage(self):
        for arguments in ((), ("fly",), ("track",), ("track", "a.avi", "--no-such-option"), ("track", "a.avi", "--detections", "b.txt")):
            self.refused(*arguments, code=2)

    def test_overlay_without_images(self):
        (self.folder / "det.txt").write_text("1,-1,10,10,20,40,1\n")
        self.assertIn("needs images", self.refused("track", "--detections", "det.txt", "--overlay", "out.mp4"))

    def test_outlines_that_cannot_be(self):
        video(self.folder / "film.avi", seconds=1)
        for flags, said in ((("--measurement-lines", "0"), "--measurement-lines 0"), (("--measurement-lines", "-4"), "--measurement-lines -4"), (("--measurement-lines", "100000"), "--measurement-lines 100000"),
                            (("--spline-order", "1"), "--spline-order 1"), (("--spline-order", "9"), "--spline-order 9"),
                            (("--control-points", "3"), "--control-points 3"), (("--control-points", "0"), "--control-points 0"),
                            (("--control-points", "5", "--spline-order", "6"), "--control-points 5"),
                            (("--control-points", "1000"), "--control-points 1000"),
                            (("--targets", "markers"), "--contour")):
            self.assertIn(said.split()[0], self.refused("track", "film.avi", "--contour", *flags, code=2))
        (self.folder / "det.txt").write_text("1,-1,10,10,20,40,1\n")
        self.assertIn("searched in images", self.refused("track", "--detections", "det.txt", "--contour"))
        for flags in (("--measurement-lines", "many"), ("--spline-order", "4.5"), ("--control-points",)):
            self.refused("track", "film.avi", "--contour", *flags, code=2)
        self.refused("track", "film.avi", "--measurement-lines", "24", code=2)  # without --contour

    def test_plot_that_cannot_be_written(self):
        video(self.folder / "film.avi", seconds=1)
        (self.folder / "file").touch()
        self.assertIn("cannot be written", self.refused("track", "film.avi", "--plot", "file/out.svg"))

    def test_json_summary_and_default_output(self):
        video(self.folder / "film.avi")
        done = self.run_marey("track", "film.avi", "--json", "--format", "csv", code=0)
        summary = json.loads(done.stdout)
        self.assertEqual(summary["tracks"], "film_tracks.csv")
        self.assertEqual(summary["frames"], 40)
        lines = (self.folder / "film_tracks.csv").read_text().splitlines()
        self.assertEqual(lines[0], "frame,time,id,label,x,y,vx,vy,left,top,width,height,state")
        self.assertEqual(len(lines), 1 + summary["rows"])

    def test_tracks_to_standard_output(self):
        video(self.folder / "film.avi")
        done = self.run_marey("track", "film.avi", "-o", "-", "--format", "jsonl", code=0)
        for line in done.stdout.splitlines():
            self.assertIn("frame", json.loads(line))


if __name__ == "__main__":
    MAREY = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main()
