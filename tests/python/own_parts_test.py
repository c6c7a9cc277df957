"""Parts of one's own in a job from Python: detectors, filters and sinks, and the loop over what is live.

Usage: own_parts_test.py MAREY ROOT [unittest options].
"""

import os
import threading
import time
import traceback
import unittest

from own_kalman import Kalman
from simulated_video import SimulatedVideo, command, np

import marey


class OwnParts(SimulatedVideo):
    def test_own_detector(self):
        seen = marey.track(self.film, detector=self.bright)
        # The sanitizers' build is another compiler's, which draws random numbers in another order: people walk elsewhere.
        self.assertIn(len(seen.tracks), (2, 3) if "ASAN_OPTIONS" in os.environ else (3,))
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

    def test_own_filter(self):
        units = set()

        class People(Kalman):
            acceleration_noise, initial_speed = 0.45, 0.8  # a body's height is 1

            def __init__(self, z, R, unit):
                super().__init__(z, R, unit)
                units.add(unit)

        tracks = marey.track(self.film, filter=People)
        self.assertEqual(len(tracks.tracks), 3)
        self.assertTrue(all(30 < unit < 300 for unit in units), units)  # px
        self.assertEqual(tracks.made_by["options"]["filter"], "People")

    def test_own_filter_that_is_none(self):
        class InBodies(Kalman):
            acceleration_noise, initial_speed = 0.45, 0.8

        class Raises(InBodies):
            def correct(self, z, R):
                raise ZeroDivisionError("in my own filter")

        with self.assertRaises(ZeroDivisionError):
            marey.track(self.film, filter=Raises)

        def changed(name, value):
            return type("Changed", (InBodies,), {name: property(lambda self: value)})

        for wrong, said in [
            (changed("position", [1.0, 2.0, 3.0]), "the filter Changed gave a position of shape (3,); it must be (2,)"),
            (changed("velocity", [np.nan, 0.0]), 'the filter "Changed" gave an estimate that is not finite'),
            (changed("covariance", -np.eye(2)), 'the filter "Changed" gave a negative variance'),
            ("kallman", 'filter "kallman" is not known'),
        ]:
            with self.assertRaises(marey.Error) as raised:
                marey.track(self.film, filter=wrong)
            self.assertIn(said, str(raised.exception))

    def test_own_sinks(self):
        instants = []

        class Whole:
            images = True

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

    def test_phones_are_given_an_address(self):
        invited = []

        def invite(address, fingerprint):
            invited.append((address, fingerprint))
            raise InterruptedError("no phone is here")

        with self.assertRaises(InterruptedError):
            next(marey.live("phone:left?port=0", phones=invite))
        (address, fingerprint), = invited
        self.assertRegex(address, r"^https://[^/]+:\d+/\?token=\w+")
        self.assertRegex(fingerprint, r"^[0-9A-Fa-f:]{60,}$")

    def test_live_cameras(self):
        room = "sim://room?cameras=4&rate=30&markers=20&blobs"
        seen = []
        for instant in marey.live(room, take=self.folder / "live.marey"):
            seen.append(instant)
            if instant.time > 1:
                break
        self.assertFalse([t for t in threading.enumerate() if t.name == "marey.live"])
        self.assertEqual(seen[-1].position.shape[1], 3)
        self.assertTrue(6 <= len(seen[-1]) <= 24, len(seen[-1]))
        self.assertGreater(len(marey.read(self.folder / "live.marey").indices), len(seen) - 2)
        # A rig, a loop that is too slow for it, and a sink that goes wrong: the run continues, with the newest instants.
        command("simulate", "room", "--cameras", 3, "--frames", 2, "-o", "live_room", "-q", cwd=self.folder)
        text = (self.folder / "live_room" / "rig.toml").read_text()
        rig = self.folder / "live_room" / "live.toml"
        for number in (1, 2, 3):
            source = f'name = "cam{number}"\nsource = "sim://room?cameras=3&rate=30&markers=8&blobs&size=1280x1024&camera={number}"'
            text = text.replace(f'name = "cam{number}"', source)
        rig.write_text(text)
        moments, ends = [], time.monotonic() + 2
        for instant in marey.live(rig, sinks=[lambda instant: 1 / 0]):
            moments.append(instant.index)
            time.sleep(0.15)
            if time.monotonic() > ends:
                break
        self.assertEqual(moments, sorted(moments))
        self.assertGreater(moments[-1] - moments[0], 1.5 * len(moments))
        for wrong, said in [
            (lambda: marey.live("sim://room?colour=red"), "no option"),
            (lambda: marey.live(room, targets="cars"), 'targets is "cars"'),
            (lambda: marey.live(room, filter="imm"), "filter is not an option of this job (live)"),
            (lambda: marey.live(room, sinks=["out.csv"]), "no files but a take"),
            (lambda: marey.live(self.film, ground=True), "for live cameras"),
        ]:
            with self.assertRaises(marey.Error) as raised:
                next(wrong())
            self.assertIn(said, str(raised.exception))


if __name__ == "__main__":
    unittest.main()
