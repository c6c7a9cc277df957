"""kill -9 while `marey` writes: what it had written of a recording and of every video can be read.

Usage: killed_test.py MAREY [unittest options]
"""
import json
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

MAREY = ""
RATE = 25
ROOM = f"sim://room?cameras=2&markers=10&rate={RATE}&size=320x240"


def frames_in(video):
    """How many frames can be decoded; with the ffprobe that every FFmpeg has."""
    words = ["ffprobe", "-v", "quiet", "-select_streams", "v", "-count_frames", "-show_entries", "stream=nb_read_frames", "-of", "csv=p=0"]
    told = subprocess.run([*words, f"file:{video}"], capture_output=True, text=True).stdout.strip().strip(",")
    return int(told) if told.isdigit() else 0


class Killed(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="marey_killed_"))
        self.addCleanup(shutil.rmtree, self.folder)

    def marey(self, *arguments, code=0):
        done = subprocess.run([MAREY, *map(str, arguments)], capture_output=True, text=True, cwd=self.folder, timeout=120)
        self.assertEqual(done.returncode, code, f"{arguments}\n{done.stdout}\n{done.stderr}")
        return done

    def killed(self, *arguments, when):
        """Starts it, and kills it as soon as `when()` is true."""
        run = subprocess.Popen([MAREY, *map(str, arguments)], cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        self.addCleanup(run.stderr.close)
        end = time.monotonic() + 60
        while not when() and run.poll() is None and time.monotonic() < end:
            time.sleep(0.02)
        self.assertIsNone(run.poll(), f"{arguments}: ended by itself\n{run.stderr.read() if run.poll() is not None else ''}")
        run.send_signal(signal.SIGKILL)
        run.wait()

    def instants(self, take):
        return json.loads(self.marey("info", take, "--json").stdout)["frames"]

    def test_images_of_a_live_run_are_kept_as_its_take_is(self):
        pictures = self.folder / "take_video"
        begun = []

        def three_seconds():
            if not begun and (pictures / "rig.toml").exists():
                begun.append(time.monotonic())
            return begun and time.monotonic() > begun[0] + 3

        self.killed("live", ROOM, "--record", "video", "-o", "take.marey", "-q", when=three_seconds)
        self.assertIn("cam2.mp4", (pictures / "rig.toml").read_text())
        self.assertFalse(list(pictures.glob("*.part")))
        for camera in ("cam1.mp4", "cam2.mp4"):
            frames = frames_in(pictures / camera)
            self.assertGreater(frames, RATE, "three seconds, on a machine that may be busy")
            self.assertLess(self.instants("take.marey") - frames, RATE, "less than a second is lost, as of the take")
        self.marey("reconstruct", "take_video/rig.toml", "-o", "again.marey", "-q")
        self.assertGreater(self.instants("again.marey"), RATE)
        self.marey("live", ROOM, "--record", "video", "-o", "take.marey", "--duration", 1, "-q")  # nothing of the killed run is in its way
        self.assertEqual({path.name for path in pictures.iterdir()}, {"cam1.mp4", "cam2.mp4", "rig.toml"})

    def test_an_overlay_can_be_read_as_far_as_it_was_written(self):
        self.marey("simulate", "people", "--frames", 150, "--size", 320, 240, "--height", 60, "--people", 2, "-o", "scene", "-q")
        parts = lambda: [path for path in self.folder.glob("overlay.mp4.*.part") if path.stat().st_size > 200_000]  # noqa: E731
        self.killed("track", "scene/video.mp4", "--live", "-o", "out.csv", "--overlay", "overlay.mp4", "-q", when=parts)
        part, = parts()
        self.assertGreater(frames_in(part), 5)
        shutil.copy(part, self.folder / "saved.mp4")
        self.marey("track", "saved.mp4", "--live", "-o", "out.csv", "-q")


if __name__ == "__main__":
    MAREY = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main()
