"""The jobs from Python: the same bytes as the command line, frames and detectors and sinks of Python's own, and what goes wrong.

Run by marey_python_shell: jobs_test.py MAREY ROOT [unittest options].
"""

import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import threading
import time
import traceback
import unittest

try:
    import numpy as np
except ImportError:
    print("the tests' virtual environment has no numpy; script/setup --tests installs it")
    sys.exit(77)
import warnings

import marey

MAREY = sys.argv.pop(1)
ROOT = pathlib.Path(sys.argv.pop(1))


def command(*words, cwd):
    done = subprocess.run([MAREY, *map(str, words)], cwd=cwd, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, (words, done.stderr)
    return done.stdout


class Jobs(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        holder = tempfile.TemporaryDirectory(prefix="marey_python_")
        cls.addClassCleanup(holder.cleanup)
        cls.folder = pathlib.Path(holder.name)
        command("simulate", "people", "--situation", "crowd", "--people", 3, "--frames", 80, "--seed", 4, "-o", "film", "-q", cwd=cls.folder)
        cls.film = cls.folder / "film" / "video.mp4"
        raw = subprocess.run(["ffmpeg", "-v", "error", "-i", cls.film, "-f", "rawvideo", "-pix_fmt", "bgr24", "-"], capture_output=True, check=True)
        size = subprocess.run(
            ["ffprobe", "-v", "error", "-show_entries", "stream=width,height", "-of", "csv=p=0", cls.film], capture_output=True, text=True, check=True
        )
        width, height = map(int, size.stdout.strip().rstrip(",").split(","))
        cls.pictures = np.frombuffer(raw.stdout, dtype=np.uint8).reshape(-1, height, width, 3)

    def setUp(self):
        warnings.simplefilter("error", marey.Warning)

    def bright(self, picture):
        """A detector: everybody of the simulated film differs from the median picture."""
        background = self.__dict__.setdefault("_background", np.median(self.pictures[::8], axis=0).astype(np.int16))
        mask = np.abs(picture.astype(np.int16) - background).sum(axis=2) > 60
        columns = np.flatnonzero(mask.sum(axis=0) > 4)
        boxes = []
        for run in np.split(columns, np.flatnonzero(np.diff(columns) > 3) + 1) if len(columns) else []:
            rows = np.flatnonzero(mask[:, run[0] : run[-1] + 1].any(axis=1))
            if len(run) > 5 and len(rows) > 20:
                boxes.append([run[0], rows[0], run[-1] + 1, rows[-1] + 1, 0.9])
        return np.asarray(boxes, dtype=float)

    # ---- people in one picture

    def test_same_bytes_as_the_command_line(self):
        command("track", self.film, "-o", "shell.txt", "-q", cwd=self.folder)
        command("track", self.film, "-o", "shell.marey", "-q", cwd=self.folder)
        tracks = marey.track(self.film, sinks=[self.folder / "beside.marey"])
        tracks.write(self.folder / "python.txt")
        self.assertEqual((self.folder / "python.txt").read_bytes(), (self.folder / "shell.txt").read_bytes())
        beside, shell = marey.read(self.folder / "beside.marey"), marey.read(self.folder / "shell.marey")
        np.testing.assert_array_equal(beside.to_numpy(), shell.to_numpy())  # what a take leaves unused within a page of its own may differ
        self.assertEqual(len(tracks.tracks), 3)
        self.assertEqual(tracks.summary["frames"], 80)
        self.assertEqual(tracks.made_by["inputs"][0][0], "video.mp4")

    def test_frames_of_any_reader(self):
        rate = marey.track(self.film).rate
        whole = marey.track(marey.Frames(self.pictures, rate=rate))
        self.assertEqual(len(whole.tracks), 3)
        strided = np.zeros((*self.pictures.shape[:2], self.pictures.shape[2] * 2, 3), dtype=np.uint8)[:, :, ::2]
        strided[...] = self.pictures
        rgb = self.pictures[..., ::-1]
        reader = lambda: (picture for picture in self.pictures)
        timed = lambda: ((i / rate, picture) for i, picture in enumerate(self.pictures))
        for name, frames in {
            "strided": marey.Frames(strided, rate=rate),
            "rgb": marey.Frames(rgb, rate=rate, colour="rgb"),
            "list": marey.Frames(list(self.pictures), rate=rate),
            "function": marey.Frames(reader, rate=rate),
            "times": marey.Frames(timed, rate=rate),
        }.items():
            again = marey.track(frames)
            np.testing.assert_array_equal(again.to_numpy(), whole.to_numpy(), err_msg=name)
        grey = marey.track(marey.Frames(self.pictures[..., 1], rate=rate))
        self.assertGreaterEqual(len(grey.tracks), 2)
        once = marey.track(marey.Frames(iter(self.pictures), rate=rate), live=True)
        self.assertEqual(len(once), 80)

    def test_frames_that_are_none(self):
        picture = self.pictures[0]
        for wrong, said in [
            (lambda: marey.Frames([picture.astype(float)], rate=25), "is of float64; give uint8"),
            (lambda: marey.Frames([picture[..., None]], rate=25), "has the shape"),
            (lambda: marey.Frames([picture], rate=float("nan")), "the rate is nan"),
            (lambda: marey.Frames([], rate=25), "there is no picture"),
            (lambda: marey.Frames([picture], rate=25, colour="hsv"), 'colour is "hsv"'),
            (lambda: marey.track(marey.Frames([picture, picture[:100]], rate=25)), "picture 1: has"),
            (lambda: marey.track(marey.Frames(lambda: [(0.0, picture), (float("nan"), picture)], rate=25)), "its time is nan s"),
            (lambda: marey.track(marey.Frames(lambda: [(1.0, picture), (1.0, picture)], rate=25)), "is not later"),
            (lambda: marey.track(self.pictures), "wrap pictures: marey.Frames"),
            (lambda: marey.track("nothing.mp4"), "nothing.mp4: no such file"),
            (lambda: marey.track(), "what is to be tracked?"),
            (lambda: marey.track(self.film, targets="cars"), "known are people and markers"),
            (lambda: marey.track(self.film, filter="imn"), "imn"),
            (lambda: marey.track(self.film, rate=-1), "it must be positive"),
            (lambda: marey.track(self.film, sinks=["tracks.xyz"]), "xyz"),
            (lambda: marey.track(self.film, sinks=["/nowhere/tracks.txt"]), "/nowhere/tracks.txt"),
            (lambda: marey.track(self.film, sinks=[3]), "3 is no sink"),
        ]:
            with self.assertRaises(marey.Error) as raised:
                wrong()
            self.assertIn(said, str(raised.exception))
            self.assertNotIn("\n", str(raised.exception))

    def test_own_detector(self):
        seen = marey.track(self.film, detector=self.bright)
        self.assertEqual(len(seen.tracks), 3)
        supervision = __import__("supervision")
        as_detections = lambda p: supervision.Detections(xyxy=self.bright(p)[:, :4].reshape(-1, 4), confidence=self.bright(p)[:, 4].reshape(-1))
        np.testing.assert_array_equal(marey.track(self.film, detector=as_detections).to_numpy(), seen.to_numpy())

    def test_own_detector_that_raises(self):
        def broken(picture):
            raise ZeroDivisionError("in my own detector")

        try:  # assertRaises forgets the traceback
            marey.track(self.film, detector=broken)
            self.fail("it did not raise")
        except ZeroDivisionError as raised:
            self.assertIn("in broken", "".join(traceback.format_exception(raised)))
        for rows, said in [
            (np.zeros((2, 3)), "shape (2, 3)"),
            ([[0, 0, 10, 10, 2.0]], "not in [0, 1]"),
            ([[0, 0, 0, 10, 1.0]], "without area"),
            ([[0, 0, np.nan, 10, 1.0]], "not finite"),
        ]:
            with self.assertRaises(marey.Error) as raised:
                marey.track(self.film, detector=lambda picture: rows)
            self.assertIn(said, str(raised.exception))

    def test_own_sinks(self):
        instants = []

        class Whole:
            pictures = True

            def __init__(self):
                self.said = []

            def begin(self, header):
                self.said.append(header["frame"])

            def write(self, instant):
                self.said.append(instant.frames[0].shape)

            def finish(self):
                self.said.append("finished")

        whole = Whole()
        tracks = marey.track(self.film, sinks=[instants.append, whole])
        self.assertEqual([i.index for i in instants], list(tracks.indices))
        np.testing.assert_array_equal(instants[40].position, tracks.to_numpy()[40][~np.isnan(tracks.to_numpy()[40, :, 0])])
        self.assertEqual(whole.said[0], tracks.frame)
        self.assertEqual(whole.said[1], self.pictures[0].shape)
        self.assertEqual(whole.said[-1], "finished")

        def full(instant):
            raise OSError("no room")

        with self.assertRaises(OSError):
            marey.track(self.film, sinks=[full])

    def test_live(self):
        seen = []
        for instant in marey.live(marey.Frames(iter(self.pictures), rate=25)):
            seen.append(len(instant))
            if instant.index == 60:
                break
        self.assertEqual(len(seen), 61)
        self.assertFalse([t for t in threading.enumerate() if t.name == "marey.live"])
        with self.assertRaises(marey.Error):
            next(iter(marey.live("nothing.mp4")))

    def test_others_have_python_meanwhile(self):
        counted, stop = [0], threading.Event()

        def count():
            while not stop.is_set():
                counted[0] += 1
                time.sleep(0.001)

        worker = threading.Thread(target=count)
        worker.start()
        said = []
        marey.track(self.film, progress=lambda step, done, total: said.append((step, done, total)))
        stop.set()
        worker.join()
        self.assertGreater(counted[0], 20)

    def test_ctrl_c(self):
        program = (
            "import itertools, numpy as np, marey, sys\n"
            "picture = np.zeros((240, 320, 3), dtype=np.uint8)\n"
            "def pictures():\n"
            "    print('runs', flush=True)\n"
            "    yield from itertools.repeat(picture)\n"
            "try:\n"
            "    marey.track(marey.Frames(pictures(), rate=25), live=True, keep=False)\n"
            "except KeyboardInterrupt:\n"
            "    print('interrupted', flush=True)\n"
        )
        run = subprocess.Popen([sys.executable if "shell" in sys.executable else self.shell(), "-c", program], stdout=subprocess.PIPE, text=True)
        self.assertEqual(run.stdout.readline(), "runs\n")
        time.sleep(0.3)
        run.send_signal(signal.SIGINT)
        self.assertEqual(run.communicate(timeout=30)[0], "interrupted\n")
        self.assertEqual(run.returncode, 0)

    @staticmethod
    def shell():
        return os.readlink("/proc/self/exe")

    def test_fork_after_import(self):
        child = os.fork()
        if child == 0:
            try:
                os._exit(0 if len(marey.track(self.film).tracks) == 3 else 1)
            except BaseException:
                os._exit(2)
        self.assertEqual(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), 0)

    def test_shutdown_in_the_middle(self):
        program = f"import marey\nfor instant in marey.live({str(self.film)!r}):\n    break\nkeep = marey.live({str(self.film)!r}); next(keep)\n"
        done = subprocess.run([self.shell(), "-c", program], capture_output=True, text=True, timeout=60)
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_no_slower_than_the_command_line(self):
        def cpu(work):
            begin = time.process_time() + sum(os.times()[2:4])
            work()
            return time.process_time() + sum(os.times()[2:4]) - begin

        shell = min(cpu(lambda: command("track", self.film, "-o", "t.txt", "-q", cwd=self.folder)) for _ in range(3))
        python = min(cpu(lambda: marey.track(self.film, sinks=[self.folder / "p.txt"], keep=False)) for _ in range(3))
        print(f"\ncommand line {shell:.3f} s, Python {python:.3f} s of CPU", file=sys.stderr)
        self.assertLess(python, 1.25 * shell)

    # ---- markers, the ground, space

    def test_markers(self):
        command("simulate", "markers", "plain", "--frames", 60, "-o", "markers", "-q", cwd=self.folder)
        film = next((self.folder / "markers").glob("*.mp4"))
        command("track", film, "--targets", "markers", "-o", "markers.csv", "-q", cwd=self.folder)
        marey.track(film, targets="markers", sinks=[self.folder / "python_markers.csv"])
        self.assertEqual((self.folder / "python_markers.csv").read_bytes(), (self.folder / "markers.csv").read_bytes())

    def test_ground(self):
        command("simulate", "match", "-o", "match", "--cameras", 3, "--seconds", 6, "--boxes", "-q", cwd=self.folder)
        rig = self.folder / "match" / "rig.toml"
        command("track", rig, "--ground", "-o", "ground.csv", "-q", cwd=self.folder)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", marey.Warning)
            people = marey.track_ground(rig, sinks=[self.folder / "python_ground.csv"])
        self.assertEqual((self.folder / "python_ground.csv").read_bytes(), (self.folder / "ground.csv").read_bytes())
        self.assertEqual(people.dimensions, 2)
        scores = marey.evaluate(self.folder / "match" / "truth.csv", people, distance=2)
        self.assertGreater(scores.recall, 0.8)
        self.assertIn("<table>", scores._repr_html_())

    def test_wand_and_space(self):
        command("simulate", "room", "--motion", "wand", "--frames", 400, "--cameras", 5, "-o", "room", "-q", cwd=self.folder)
        room = self.folder / "room"
        seen = room / "observations.csv"
        command("calibrate", "wand", room / "start.toml", "--observations", seen, "--wand", "0,0.12,0.30", "-o", "rig.toml", "-q", cwd=self.folder)
        found = marey.calibrate.wand(room / "start.toml", observations=seen, distances=[0, 0.12, 0.30])
        found.rig.write(self.folder / "python_rig.toml")
        shell, python = marey.read_rig(self.folder / "rig.toml"), marey.read_rig(self.folder / "python_rig.toml")
        for a, b in zip(shell.cameras, python.cameras, strict=True):
            np.testing.assert_array_equal(a.K, b.K)
            np.testing.assert_array_equal(a.t, b.t)
        self.assertLess(found.rms_px, 1)
        self.assertIn("<table>", found._repr_html_())
        points = marey.reconstruct(found.rig, observations=seen)
        self.assertEqual(points.dimensions, 3)
        self.assertGreaterEqual(len(points.tracks), 3)
        self.assertEqual(points.rig["cam1"].size, found.rig["cam1"].size)
        with self.assertRaises(KeyError):
            found.rig["nobody"]
        with self.assertRaises(marey.Error):
            marey.calibrate.wand(observations=seen, distances=[0, 0.3, 0.1])


if __name__ == "__main__":
    unittest.main(verbosity=1)
