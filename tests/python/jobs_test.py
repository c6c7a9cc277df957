"""The jobs from Python: the same bytes as the command line, frames of any reader, and what goes wrong.

Usage: jobs_test.py MAREY ROOT [unittest options].
"""

import os
import pathlib
import signal
import subprocess
import sys
import threading
import time
import unittest
import warnings

from own_kalman import Kalman
from simulated_video import MAREY, ROOT, SimulatedVideo, command, np

import marey


class Jobs(SimulatedVideo):
    # ---- people in one image

    def test_same_bytes_as_the_command_line(self):
        command("track", self.film, "-o", "shell.txt", "-q", cwd=self.folder)
        command("track", self.film, "-o", "shell.marey", "-q", cwd=self.folder)
        tracks = marey.track(self.film, sinks=[self.folder / "beside.marey"])
        tracks.write(self.folder / "python.txt")
        self.assertEqual((self.folder / "python.txt").read_bytes(), (self.folder / "shell.txt").read_bytes())
        self.assertEqual((self.folder / "beside.marey").read_bytes(), (self.folder / "shell.marey").read_bytes())
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

    def test_inputs_are_not_written_over(self):
        warnings.simplefilter("ignore", marey.Warning)
        command("simulate", "room", "--cameras", 3, "--markers", 8, "--frames", 20, "-o", "kept", "-q", cwd=self.folder)
        room = self.folder / "kept"
        rig, seen, take, boxes = room / "rig.toml", room / "observations.csv", room / "walk.marey", room / "boxes.txt"
        marey.reconstruct(rig, observations=seen, sinks=[take])
        marey.track(self.film, sinks=[boxes])
        os.link(seen, room / "linked.csv")
        before = {path: path.read_bytes() for path in (seen, take, boxes)}
        for wrong in [
            lambda: marey.reconstruct(rig, observations=seen, sinks=[seen]),
            lambda: marey.reconstruct(rig, observations=seen, sinks=[room / "linked.csv"]),
            lambda: marey.reconstruct(rig, observations=take, sinks=[take]),
            lambda: marey.track(detections=boxes, rate=25, sinks=[boxes]),
            lambda: next(iter(marey.live(f"play:{take}", take=take))),
        ]:
            with self.assertRaises(marey.Error) as raised:
                wrong()
            self.assertIn("is an input too", str(raised.exception))
            self.assertEqual({path: path.read_bytes() for path in before}, before)

    def test_frames_that_are_none(self):
        picture = self.pictures[0]
        for wrong, said in [
            (lambda: marey.Frames([picture.astype(float)], rate=25), "is of float64; give uint8"),
            (lambda: marey.Frames([picture[..., None]], rate=25), "has the shape"),
            (lambda: marey.Frames([picture], rate=float("nan")), "the rate is nan"),
            (lambda: marey.Frames([], rate=25), "there is no image"),
            (lambda: marey.Frames([picture], rate=25, colour="hsv"), 'colour is "hsv"'),
            (lambda: marey.track(marey.Frames([picture, picture[:100]], rate=25)), "image 1: has"),
            (lambda: marey.track(marey.Frames(lambda: [(0.0, picture), (float("nan"), picture)], rate=25)), "its time is nan s"),
            (lambda: marey.track(marey.Frames(lambda: [(1.0, picture), (1.0, picture)], rate=25)), "is not later"),
            (lambda: marey.track(self.pictures), "wrap images: marey.Frames"),
            (lambda: marey.track("nothing.mp4"), "nothing.mp4: no such file"),
            (lambda: marey.track(), "what is to be tracked?"),
            (lambda: marey.track(self.film, targets="cars"), "use one of people, keypoints, markers"),
            (lambda: marey.track(self.film, filter="imn"), 'filter: filter "imn" is not known'),
            (lambda: marey.track(self.film, measured_onyl=True), "did you mean measured_only?"),
            (lambda: marey.track(self.film, association="mht"), "association is not an option of this job (track people)"),
            (lambda: marey.track(self.film, lag=1), "lag 1: is an option of live"),
            (lambda: marey.track(self.film, spline_order=3), "spline_order requires contour"),
            (lambda: marey.track(self.film, plot="plot.png"), "name a file that ends in .svg"),
            (lambda: marey.track(self.film, rate=[1, 2]), 'rate: "1x2" is no number'),
            (lambda: marey.track(self.film, plot=object()), "is neither a number nor text nor a path"),
            (lambda: marey.track(self.film, rate=-1), "rate: -1 is out of range; give Hz in"),
            (lambda: marey.track(self.film, sinks=["tracks.xyz"]), "xyz"),
            (lambda: marey.track(self.film, sinks=["/nowhere/tracks.txt"]), "/nowhere/tracks.txt"),
            (lambda: marey.track(self.film, sinks=[3]), "3 is not a sink"),
        ]:
            with self.assertRaises(marey.Error) as raised:
                wrong()
            self.assertIn(said, str(raised.exception))
            self.assertNotIn("\n", str(raised.exception))

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
            "def images():\n"
            "    print('runs', flush=True)\n"
            "    yield from itertools.repeat(picture)\n"
            "try:\n"
            "    marey.track(marey.Frames(images(), rate=25), live=True, keep=False)\n"
            "except KeyboardInterrupt:\n"
            "    print('interrupted', flush=True)\n"
        )
        run = subprocess.Popen([self.interpreter(), "-c", program], stdout=subprocess.PIPE, text=True)
        self.assertEqual(run.stdout.readline(), "runs\n")
        time.sleep(0.3)
        run.send_signal(signal.SIGINT)
        self.assertEqual(run.communicate(timeout=30)[0], "interrupted\n")
        self.assertEqual(run.returncode, 0)

    @staticmethod
    def interpreter():
        """This one: of the virtual environment, or, under sanitizers, the program with the package built in."""
        program = os.readlink("/proc/self/exe")
        return program if "marey_python_shell" in program else sys.executable

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
        done = subprocess.run([self.interpreter(), "-c", program], capture_output=True, text=True, timeout=60)
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_signatures_name_the_options(self):
        import inspect

        for function, option in ((marey.track, "measured_only"), (marey.track, "model"), (marey.track_ground, "ball"), (marey.reconstruct, "no_offsets"), (marey.live, "frame_timeout")):
            self.assertIn(option, inspect.signature(function).parameters)
            self.assertIn(f"    {option}: ", function.__doc__)
        self.assertNotIn("options", inspect.signature(marey.track).parameters)

    # ---- markers, the ground, space

    def test_markers(self):
        command("simulate", "markers", "plain", "--frames", 60, "-o", "markers", "-q", cwd=self.folder)
        film = next((self.folder / "markers").glob("*.mp4"))
        command("track", film, "--targets", "markers", "-o", "markers.csv", "-q", cwd=self.folder)
        marey.track(film, targets="markers", sinks=[self.folder / "python_markers.csv"])
        self.assertEqual((self.folder / "python_markers.csv").read_bytes(), (self.folder / "markers.csv").read_bytes())
        named, own = marey.track(film, targets="markers", filter="kalman"), marey.track(film, targets="markers", filter=Kalman)
        np.testing.assert_allclose(own.to_numpy(), named.to_numpy(), rtol=0, atol=1e-6)

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

        class InSpace(Kalman):
            acceleration_noise, initial_speed = 5.0, 2.0  # m

        own = marey.reconstruct(found.rig, observations=seen, filter=InSpace)
        self.assertEqual(len(own.tracks), len(points.tracks))
        self.assertLess(np.nanmax(np.abs(own.to_numpy() - points.to_numpy())), 0.01)
        self.assertGreaterEqual(len(points.tracks), 3)
        self.assertEqual(points.rig["cam1"].size, found.rig["cam1"].size)
        with self.assertRaises(KeyError):
            found.rig["nobody"]
        with self.assertRaises(marey.Error):
            marey.calibrate.wand(observations=seen, distances=[0, 0.3, 0.1])


if __name__ == "__main__":
    unittest.main(verbosity=1)
