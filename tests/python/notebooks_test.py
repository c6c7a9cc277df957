"""The notebooks of examples/ run from beginning to end, and leave what they promise; they are kept without outputs.

Usage: notebooks_test.py MAREY ROOT [unittest options].
"""

import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

try:
    import cv2
    import ezc3d
    import ipykernel  # noqa: F401
    import kloppy  # noqa: F401
    import matplotlib
    import nbformat
    import numpy as np
    import pandas
    from nbclient import NotebookClient
except ImportError as missing:
    print(f"the tests' virtual environment lacks {missing.name}; script/setup --tests installs it")
    sys.exit(77)

import marey

MAREY = pathlib.Path(sys.argv.pop(1))
ROOT = pathlib.Path(sys.argv.pop(1))


def stated(cell):
    """What a cell printed, and the plain text of what it returned."""
    return "".join(output.get("text", "") or output.get("data", {}).get("text/plain", "") for output in cell.get("outputs", []))


class Notebooks(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        program = os.readlink("/proc/self/exe")
        if "marey_python_shell" in program:
            sys.executable = program  # what jupyter_client starts as the kernel
        matplotlib.use("agg")

    def setUp(self):
        holder = tempfile.TemporaryDirectory(prefix="marey_notebooks_")
        self.addCleanup(holder.cleanup)
        self.folder = pathlib.Path(holder.name)
        (self.folder / "bin").mkdir()
        (self.folder / "bin/marey").symlink_to(MAREY)
        environment = dict(os.environ)
        self.addCleanup(lambda: (os.environ.clear(), os.environ.update(environment)))
        os.environ.pop("MAREY_FILM", None)
        os.environ.pop("MAREY_FILMS", None)
        jupyter = {name: str(self.folder / name.lower()) for name in ("IPYTHONDIR", "JUPYTER_CONFIG_DIR", "JUPYTER_RUNTIME_DIR")}
        os.environ.update(jupyter, PATH=f"{self.folder / 'bin'}:{os.environ['PATH']}")

    def run_notebook(self, name):
        """All that its cells stated, one after the other."""
        book = nbformat.read(ROOT / f"examples/{name}.ipynb", as_version=4)
        NotebookClient(book, timeout=300, startup_timeout=180, kernel_name="python3", resources={"metadata": {"path": str(self.folder)}}).execute()
        self.assertTrue(all(cell.execution_count for cell in book.cells if cell.cell_type == "code"))
        return "\n".join(stated(cell) for cell in book.cells if cell.cell_type == "code")

    def number(self, text, pattern):
        found = re.search(pattern, text)
        self.assertTrue(found, f"{pattern!r} is not in:\n{text}")
        return float(found[1])

    def assert_image(self, name):
        picture = cv2.imread(str(self.folder / name))
        self.assertIsNotNone(picture, name)
        self.assertGreater(picture.std(), 10, name)

    def test_kept_without_outputs(self):
        books = sorted((ROOT / "examples").glob("*.ipynb"))
        self.assertEqual([book.stem for book in books], ["match", "street_video", "videos_to_bvh", "wand_to_c3d"])
        for path in books:
            book = nbformat.read(path, as_version=4)
            nbformat.validate(book)
            self.assertFalse([cell.id for cell in book.cells if cell.get("outputs") or cell.get("execution_count")], path.name)

    def test_types(self):
        for path in sorted((ROOT / "examples").glob("*.ipynb")):
            cells = [re.sub(r"^( *)!(\\\n|.)*$", r"\1pass", cell.source, flags=re.M) for cell in nbformat.read(path, as_version=4).cells if cell.cell_type == "code"]
            program = self.folder / f"{path.stem}.py"
            program.write_text("\n\n".join(cell for cell in cells if not cell.startswith("%%")))
            checked = subprocess.run([ROOT / ".venv/bin/python", "-m", "mypy", "--strict", "--no-strict-optional", "--ignore-missing-imports", program],
                                     capture_output=True, text=True, timeout=300, env={**os.environ, "MYPYPATH": str(ROOT / "python")})
            self.assertEqual(checked.returncode, 0, f"{path.name}: {checked.stdout}{checked.stderr}")

    def test_street_video(self):
        text = self.run_notebook("street_video")
        self.assertGreater(self.number(text, r"found ([\d.]+)%"), 80)
        # The sanitizers' build is another compiler's: bench/tuning.md tells what small things do to numbers.
        self.assertGreater(self.number(text, r"IDF1 ([\d.]+)%"), 70 if "ASAN_OPTIONS" in os.environ else 80)
        people = marey.read(self.folder / "street.marey")
        self.assertTrue(5 <= len(people.tracks) <= 8, people)
        self.assertEqual(len(pandas.read_csv(self.folder / "street.csv")), sum(map(len, people.tracks)))
        self.assertEqual(len((self.folder / "street.txt").read_text().splitlines()), sum(map(len, people.tracks)))
        self.assert_image("street.png")

    def test_street_video_of_ones_own(self):
        os.environ["MAREY_FILM"] = "own.mp4"
        with self.assertRaisesRegex(Exception, "own.mp4: no such file"):
            self.run_notebook("street_video")
        self.assertFalse((self.folder / "street").exists())

    def test_wand_to_c3d(self):
        text = self.run_notebook("wand_to_c3d")
        self.assertGreater(self.number(text, r"([\d.]+)% of the places"), 99)
        self.assertLess(self.number(text, r"([\d.]+) mm RMS"), 1)
        self.assertIn("40 markers, 600 frames at 120 Hz, in mm", text)
        read = ezc3d.c3d(str(self.folder / "walk.c3d"))
        names = read["parameters"]["POINT"]["LABELS"]["value"]
        truth = pandas.read_csv(self.folder / "walk/truth.csv")
        self.assertEqual(set(names), set(truth.label))
        for name in ("head1", "left_shank1"):
            places = read["data"]["points"][:3, names.index(name)].T / 1000
            true = truth[truth.label == name].sort_values("frame")[["x", "y", "z"]].to_numpy()
            self.assertLess(np.nanmedian(np.linalg.norm(places - true, axis=1)), 0.002, name)
        self.assert_image("walk.png")

    def assert_skeleton_of(self, text, frames, spread):
        for bone, least, most in (("thigh", 330, 520), ("shank", 330, 500), ("forearm", 180, 320)):
            for side in ("left", "right"):
                length = self.number(text, rf"{side} {bone}: (\d+) mm")
                self.assertTrue(least < length < most, f"{side} {bone}: {length} mm")
                self.assertLess(self.number(text, rf"{side} {bone}: \d+ mm, spread (\d+) mm"), spread)
        joints = self.number(text, r"(\d+) joints")
        self.assertEqual(self.number(text, r"joints, (\d+) frames"), frames)
        lines = (self.folder / "dance.bvh").read_text().splitlines()
        rows = lines[next(i for i, line in enumerate(lines) if line.startswith("Frame Time")) + 1 :]
        self.assertEqual(len(rows), frames)
        self.assertGreaterEqual(len(rows[0].split()), 3 * joints)
        self.assertGreater((self.folder / "person.toml").stat().st_size, 0)
        self.assert_image("dance.png")

    def test_videos_to_bvh(self):
        self.assert_skeleton_of(self.run_notebook("videos_to_bvh"), 300, 25)

    def test_videos_to_bvh_of_ones_own(self):
        data = pathlib.Path(os.environ.get("MAREY_DATA", ROOT.parent / "shared/data")) / "markerless"
        models = pathlib.Path(os.environ.get("MAREY_MODELS", ROOT / "build/models"))
        if not data.is_dir() or not (models / "pose_landmark_full.onnx").is_file():
            self.skipTest(f"{data} or {models} is not here")
        films = self.folder / "films"
        films.mkdir()
        for number in (1, 2, 3, 4):
            (films / f"cam0{number}.mp4").symlink_to(data / f"videos/cam0{number}.mp4")
        subprocess.run([MAREY, "convert", data / "calibration/Calib.qca.txt", films / "rig.toml", "--quiet"], check=True)
        os.environ.update(MAREY_FILMS=str(films), MAREY_MODELS=str(models))
        self.assert_skeleton_of(self.run_notebook("videos_to_bvh"), 100, 80)

    def test_match(self):
        text = self.run_notebook("match")
        self.assertGreater(self.number(text, r"([\d.]+)% of the places"), 95)
        self.assertLess(self.number(text, r"([\d.]+) m RMS"), 0.3)
        self.assertIn("750 frames at 25", text)
        figures = pandas.read_csv(self.folder / "figures.csv")
        self.assertTrue(24 <= len(figures) <= 28, len(figures))
        self.assertTrue(figures.distance_m.between(0, 30 * 9).all() and 20 < figures.distance_m.median() < 120)
        self.assertTrue(figures.max_mps.max() < 10)
        self.assertIn("<svg", (self.folder / "report/report.html").read_text())
        self.assertEqual(len(marey.read(self.folder / "match.dat").tracks), len(figures))
        self.assert_image("match.png")


if __name__ == "__main__":
    unittest.main(verbosity=1)
