"""Recordings in Python: columns without copies, what other packages accept, files, and arrays that are not any.

Usage: recordings_test.py MAREY ROOT [unittest options].
"""

import gc
import pathlib
import subprocess
import sys
import tempfile
import unittest

try:
    import numpy as np
    import pandas
    import supervision
    import xarray  # noqa: F401
    from floodlight.core.xy import XY
except ImportError as missing:
    print(f"the tests' virtual environment lacks {missing.name}; script/setup --tests installs it")
    sys.exit(77)

import marey

MAREY = sys.argv.pop(1)
ROOT = pathlib.Path(sys.argv.pop(1))


def three_players():
    """Three players over two seconds; the second is not known at first."""
    times = np.arange(50) / 25
    position = np.stack([np.column_stack([10 + 5 * times, 20 + 0 * times]), np.column_stack([50 + 0 * times, 30 - times]), np.full((50, 2), 40.0)], axis=1)
    position[:20, 1] = np.nan
    return position


class Loading(unittest.TestCase):
    """What a user reads where the compiled part of the package is missing, or was built for another Python."""

    def import_error(self, *built):
        with tempfile.TemporaryDirectory(prefix="marey_loading_") as folder:
            package = pathlib.Path(folder, "marey")
            package.mkdir()
            for source in (ROOT / "python/marey").glob("*.py"):
                (package / source.name).symlink_to(source)
            for name in built:
                (package / name).write_bytes(b"no library")
            environment = {"PYTHONPATH": folder, "PYTHONDONTWRITEBYTECODE": "1"}
            done = subprocess.run(["/usr/bin/python3", "-S", "-c", "import marey"], env=environment, capture_output=True, text=True)
            self.assertEqual(done.returncode, 1)
            return done.stderr.splitlines()[-1]

    def test_the_sources_alone(self):
        self.assertIn("holds the sources only; import the package from build/release/python", self.import_error())

    def test_another_version_of_python(self):
        self.assertIn("was built for another Python than this one", self.import_error("_core.cpython-399-x86_64-linux-gnu.so"))

    def test_a_library_that_is_none(self):
        self.assertIn("cannot be loaded", self.import_error(f"_core.cpython-{sys.version_info.major}{sys.version_info.minor}-x86_64-linux-gnu.so"))


class Recordings(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory(prefix="marey_recordings_")
        self.addCleanup(holder.cleanup)
        self.folder = pathlib.Path(holder.name)

    def ground(self):
        return marey.Recording.from_arrays(
            three_players(), rate=25, frame="user_ground", labels=["Anna", "Béla", "Chloé"], teams=["home", "home", "away"]
        )

    def tracks_of_video(self):
        subprocess.run([MAREY, "simulate", "people", "--people", "3", "--frames", "40", "--seed", "4", "-o", "film", "-q"], cwd=self.folder, check=True)
        return marey.track(self.folder / "film" / "video.mp4", measured_only=True)

    # ---- columns

    def test_columns_are_views(self):
        track = self.ground()["Anna"]
        self.assertFalse(track.x.flags.owndata)
        self.assertFalse(track.x.flags.writeable)
        self.assertTrue(np.shares_memory(track.x, track.x))
        x = self.ground()["Anna"].x  # the recording is kept by its columns
        gc.collect()
        np.testing.assert_allclose(x[:3], [10, 10.2, 10.4])
        np.testing.assert_array_equal(self.ground()["Béla"].at, np.arange(20, 50))
        self.assertTrue(np.isnan(track.optional("score")).all())
        with self.assertRaises(KeyError):
            track.optional("weight")

    def test_numpy_and_pandas(self):
        people = self.ground()
        np.testing.assert_array_equal(people.to_numpy(), three_players())
        np.testing.assert_allclose(people.times, np.arange(50) / 25)
        table = people.to_pandas()
        self.assertEqual(list(table.columns), ["frame", "time", "id", "label", "team", "x", "y", "provenance"])
        self.assertEqual(len(table), 130)
        self.assertEqual(set(table.provenance), {"measured"})
        self.assertEqual(list(table[table.frame == 30].label), ["Anna", "Béla", "Chloé"])
        boxes = self.tracks_of_video().to_pandas()
        self.assertTrue({"left", "top", "width", "height"} <= set(boxes.columns))
        self.assertIn("<svg", people._repr_html_())
        self.assertIn("Chlo", people._repr_html_())

    def test_arrays_that_are_none(self):
        good = three_players()
        half = good.copy()
        half[3, 0, 1] = np.nan
        infinite = good.copy()
        infinite[3, 0] = np.inf
        for wrong, said in [
            (dict(position=good[0]), "has the shape (3, 2)"),
            (dict(position=good, frame="space"), "instants × targets × 3"),
            (dict(position=half), "unknown is NaN on all axes"),
            (dict(position=infinite), "infinite"),
            (dict(position=good, rate=0), "must be positive"),
            (dict(position=good, times=[0, 1]), "one for each of the 50"),
            (dict(position=good, times=np.zeros(50)), "grow from instant"),
            (dict(position=good, times=np.full(50, np.nan)), "grow from instant"),
            (dict(position=good, labels=["Anna"]), "1 names for 3"),
            (dict(position=good, frame="moon"), '"moon" is not a frame of reference'),
        ]:
            with self.assertRaises(marey.Error, msg=said) as raised:
                marey.Recording.from_arrays(**({"rate": 25, "frame": "ground"} | wrong))
            self.assertIn(said, str(raised.exception))

    # ---- files

    def test_files(self):
        people = self.ground()
        for name in ("people.marey", "people.csv"):
            people.write(self.folder / name)
            again = marey.read(self.folder / name)
            np.testing.assert_allclose(again.to_numpy(), people.to_numpy(), atol=1e-3, err_msg=name)
            self.assertEqual([t.label for t in again.tracks], ["Anna", "Béla", "Chloé"])
        with self.assertRaises(marey.Error):
            people.write(self.folder / "people.c3d")  # holds points in space
        with self.assertRaises(marey.Error):
            people.write("/nowhere/people.csv")
        with self.assertRaises(marey.Error):
            marey.read(self.folder / "people.csv", format="tape")
        self.assertIn("c3d", marey.formats()["read"])
        points = marey.Recording.from_arrays(np.random.default_rng(3).normal(size=(20, 4, 3)), rate=100, frame="space", labels=["a", "b", "c", "d"])
        points.write(self.folder / "points.c3d")
        np.testing.assert_allclose(marey.read(self.folder / "points.c3d").to_numpy(), points.to_numpy(), atol=1e-5)

    # ---- others

    def test_movement(self):
        boxes = self.tracks_of_video().to_xarray()
        self.assertEqual(boxes.position.dims, ("time", "space", "individuals"))
        points = marey.Recording.from_arrays(np.random.default_rng(3).normal(size=(20, 4, 3)), rate=100, frame="space", labels=list("abcd"))
        poses = points.to_xarray()
        self.assertEqual(poses.position.dims, ("time", "space", "keypoints", "individuals"))
        from movement.validators.datasets import ValidBboxesInputs, ValidPosesInputs

        ValidBboxesInputs.validate(boxes)
        ValidPosesInputs.validate(poses)
        import movement.kinematics

        speed = movement.kinematics.compute_speed(poses.position)
        self.assertEqual(speed.dims, ("time", "keypoints", "individuals"))

    def test_supervision(self):
        people = self.tracks_of_video()
        instant = int(np.argmax(~np.isnan(people.to_numpy()[..., 0]).any(axis=0)))
        given = people.to_supervision(30)
        self.assertIsInstance(given, supervision.Detections)
        self.assertEqual((given.xyxy.dtype, given.xyxy.shape[1]), (np.float32, 4))
        self.assertEqual(sorted(given.tracker_id), [t.id for t in people.tracks if 30 in t.at])
        self.assertGreater(len(given), 0)
        drawn = supervision.BoxAnnotator().annotate(np.zeros((480, 640, 3), dtype=np.uint8), given)
        self.assertGreater(drawn.sum(), 0)
        with self.assertRaises(IndexError):
            people.to_supervision(10_000)
        del instant

    def test_floodlight(self):
        teams = self.ground().to_floodlight()
        self.assertEqual(set(teams), {"home", "away"})
        self.assertIsInstance(teams["home"], XY)
        self.assertEqual((teams["home"].N, teams["away"].N, teams["home"].framerate), (2, 1, 25))
        from floodlight.models.kinematics import VelocityModel

        model = VelocityModel()
        model.fit(teams["away"])
        self.assertEqual(float(np.nanmax(model.velocity().property)), 0)
        with self.assertRaises(marey.Error):
            self.tracks_of_video().to_floodlight()

    def test_kloppy_by_file(self):
        from kloppy import tracab

        people = self.ground()
        lost = people.write(self.folder / "match.dat")
        self.assertTrue((self.folder / "match.dat").exists(), lost)
        metadata = next(p for p in self.folder.iterdir() if p.suffix == ".xml")
        match = tracab.load(raw_data=str(self.folder / "match.dat"), meta_data=str(metadata), coordinates="tracab", only_alive=False)
        self.assertEqual(len(match), 50)

    def test_napari(self):
        tracks = self.ground().to_napari()
        self.assertEqual(tracks.shape, (130, 4))
        self.assertFalse(np.isnan(tracks).any())
        order = np.lexsort((tracks[:, 1], tracks[:, 0]))
        np.testing.assert_array_equal(order, np.arange(len(tracks)))  # as napari wants it
        np.testing.assert_allclose(tracks[0], [1, 0, 20, 10])  # id, frame, y, x

    def test_evaluate(self):
        people = self.tracks_of_video()
        same = marey.evaluate(people, people)
        self.assertEqual((same.mota, same.idf1, same.switches), (1.0, 1.0, 0))
        people.write(self.folder / "t.txt")
        files = marey.evaluate(self.folder / "t.txt", self.folder / "t.txt")
        self.assertEqual(files.hota, same.hota)
        for wrong in (dict(iou=0), dict(distance=-1), dict(motchallenge=True)):
            with self.assertRaises(marey.Error):
                marey.evaluate(people, people, **wrong)
        with self.assertRaises(marey.Error):
            marey.evaluate(self.ground(), self.ground())  # has no boxes
        self.assertEqual(marey.evaluate(self.ground(), self.ground(), distance=1).recall, 1.0)

    def test_stubs_report_what_there_is(self):
        import ast

        core = sys.modules["marey._core"]
        told = {node.name for node in ast.parse((ROOT / "python/marey/_core.pyi").read_text()).body if hasattr(node, "name")}
        there = {name for name in dir(core) if not name.startswith("_")} - {"version"}
        self.assertEqual(told, there)
        for name in marey.__all__:
            if not name.startswith("__") and name != "calibrate":
                self.assertTrue(getattr(marey, name).__doc__, name)


if __name__ == "__main__":
    unittest.main(verbosity=1)
