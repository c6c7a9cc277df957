"""The programs of examples/ run and say what they should: examples_test.py MAREY FOLDER_OF_EXAMPLES."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

MAREY = sys.argv.pop(1)
EXAMPLES = pathlib.Path(sys.argv.pop(1))


class Examples(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def run_in_folder(self, *command):
        done = subprocess.run([str(word) for word in command], cwd=self.folder.name, capture_output=True, text=True, timeout=120)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def video(self):
        self.run_in_folder(MAREY, "simulate", "people", "--situation", "crowd", "--people", "3", "--frames", "80", "--seed", "4",
                           "-o", "film", "-q")
        return "film/video.mp4"

    def test_people_in_a_video(self):
        said = self.run_in_folder(EXAMPLES / "people_in_a_video", self.video())
        self.assertIn("3 people in", said)
        self.assertEqual(said.count(" px"), 3, said)

    def test_own_detector(self):
        self.run_in_folder("ffmpeg", "-nostdin", "-v", "error", "-f", "lavfi", "-i", "color=black:size=320x240:rate=25", "-f", "lavfi",
                           "-i", "color=white:size=20x50:rate=25", "-filter_complex", "[0][1]overlay=x='20+50*t':y=80", "-t", "4",
                           "-c:v", "mpeg4", "-q:v", "2", "lights.avi")
        said = self.run_in_folder(EXAMPLES / "own_detector", "lights.avi", "tracks.csv")
        self.assertEqual(said, "1 targets\n")
        rows = (pathlib.Path(self.folder.name) / "tracks.csv").read_text().splitlines()
        self.assertTrue(rows[0].startswith("frame,time,id"))
        self.assertGreater(len(rows), 50)

    def test_own_sink(self):
        boxes = "".join(f"{i},-1,{600 - 5 * i},100,30,80,0.9\n" for i in range(1, 100))
        (pathlib.Path(self.folder.name) / "boxes.txt").write_text(boxes)
        said = self.run_in_folder(EXAMPLES / "own_sink", "boxes.txt", "25")
        self.assertIn("1 enters", said)
        self.assertTrue(said.endswith("that was all\n"))

    def test_markers_in_memory(self):
        words = self.run_in_folder(EXAMPLES / "markers_in_memory").split()
        self.assertGreater(float(words[0]), 18)
        self.assertGreater(float(words[3]), 18)

    def test_calibrate_from_arrays(self):
        self.assertIn("clicks; the camera is found", self.run_in_folder(EXAMPLES / "calibrate_from_arrays"))

    def test_read_a_take(self):
        self.run_in_folder(MAREY, "simulate", "room", "--frames", "60", "--markers", "10", "-o", "room", "-q")
        self.run_in_folder(MAREY, "reconstruct", "room/rig.toml", "--observations", "room/observations.csv", "-o", "walk.marey", "-q")
        said = self.run_in_folder(EXAMPLES / "read_a_take", "walk.marey", "walk.svg")
        self.assertIn("m in space, 120 Hz, made by marey reconstruct", said)
        self.assertGreaterEqual(said.count("samples"), 10)
        self.assertTrue((pathlib.Path(self.folder.name) / "walk.svg").read_text().endswith("</svg>\n"))


if __name__ == "__main__":
    unittest.main()
