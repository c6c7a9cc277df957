"""A wand that is waved before a page, without a browser: coverage, cameras that are set in the meantime, the rig, the ground. wand_page_test.py MAREY."""

import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import tomllib
import unittest

import shown_page
from shown_page import LivePage, WebSocket, receive_until

MAREY = ""


class Wand(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="marey_wand_page_"))
        self.addCleanup(shutil.rmtree, self.folder)

    def write_rig(self, motion, options=""):
        source = f"sim://room?cameras=4&rate=60&motion={motion}&blobs&size=1280x1024&noise=0.1{options}"
        cameras = [f'[[camera]]\nname = "cam{c}"\nsize = [1280, 1024]\nsource = "{source}&camera={c}"\n' for c in range(1, 5)]
        (self.folder / "live.toml").write_text("\n".join(cameras))
        return ["calibrate", "wand", "live.toml", "--wand", "0,0.12,0.30", "-o", "waved.toml", "--view", "--port", 0, "--duration", 90]

    def test_coverage_grows_until_it_is_enough_and_the_rig_is_written(self):
        with LivePage(self.folder, *self.write_rig("wand"), "--json") as shown:
            scene = shown.scene()
            self.assertEqual(scene["job"], "wand")
            self.assertTrue(scene["can_change"])
            page = WebSocket(shown)
            status = receive_until(page, "status", lambda s: len(s["cameras"]) == 4 and s["cameras"][3]["frames"] > 0)
            self.assertEqual((status["cameras"][0]["threshold"], status["cameras"][0]["controls"]), (None, []), "points have no exposure")
            page.send("mask 3 0 0 20 0 0 20")
            page.send("threshold 3 90")
            receive_until(page, "status", lambda s: s["cameras"][3]["masks"] == [[0, 0, 20, 0, 0, 20]] and s["cameras"][3]["threshold"] == 90)
            early = receive_until(page, "wand", lambda w: w.get("cameras") and all(c["parts"] for c in w["cameras"]), 60)
            self.assertEqual((early["across"], early["down"]), (10, 8))
            for camera in early["cameras"]:
                self.assertAlmostEqual(camera["coverage"], len(camera["parts"]) / 80)
            self.assertEqual([(pair["a"], pair["b"]) for pair in early["shared"]], [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)])
            page.send("watch 0 320")
            picture = next(data for data in iter(page.receive, None) if isinstance(data, bytes) and data[0] == 3 and int.from_bytes(data[28:32], "little") == 3)
            tracks = [int.from_bytes(picture[64 + 4 * i:68 + 4 * i], "little") for i in range(3)]
            self.assertEqual(sorted(tracks), [1, 2, 3], "the wand's markers are distinguished from others")
            later = receive_until(page, "wand", lambda w: len(w["cameras"][0]["parts"]) > len(early["cameras"][0]["parts"]), 60)
            self.assertEqual(later["phase"], "waving")
            done = receive_until(page, "wand", lambda w: w["phase"] == "done", 180)
            self.assertEqual(done["rig"], "waved.toml")
            self.assertTrue((self.folder / "waved.toml").exists())
            self.assertIn("centre", shown.scene()["cameras"][0], "the page knows where the cameras stand")
            self.assertIsNone(shown.process.poll(), "it waits for the page")
            page.wire.close()
            report = json.loads(shown.process.stdout.read())
            self.assertEqual(shown.process.wait(timeout=20), 0)
            self.assertEqual(report["grade"], done["report"]["grade"])
        cameras = tomllib.loads((self.folder / "waved.toml").read_text())["camera"]
        self.assertEqual((cameras[3]["masks"], cameras[3]["threshold"]), ([[0, 0, 20, 0, 0, 20]], 90), "as it was set on the page")
        self.assertNotIn("masks", cameras[0])

    def test_enough_is_a_button_and_what_comes_of_too_little_is_reported(self):
        with LivePage(self.folder, *self.write_rig("ground")) as shown:
            page = WebSocket(shown)
            receive_until(page, "wand", lambda w: w.get("cameras") and w["seconds"] > 0.5)
            page.send("mask 0 1 2 3 4")
            page.send("enough")
            failed = receive_until(page, "wand", lambda w: w["phase"] == "failed", 60)
            self.assertGreater(len(failed["why"]), 20)
            self.assertEqual(shown.process.wait(timeout=20), 1)
        self.assertFalse((self.folder / "waved.toml").exists())

    def test_the_ground_is_set_by_an_l_frame(self):
        with LivePage(self.folder, *self.write_rig("wand", "&frame")) as shown:
            page = WebSocket(shown)
            page.send("ground")  # there is no rig yet
            receive_until(page, "wand", lambda w: w["phase"] == "done", 180)
            before = tomllib.loads((self.folder / "waved.toml").read_text())["camera"]
            page.send("ground")
            receive_until(page, "wand", lambda w: w.get("ground", {}).get("phase") == "looking")
            told = receive_until(page, "wand", lambda w: w["ground"]["phase"] != "looking", 60)["ground"]
            self.assertEqual(told["phase"], "set", told)
            self.assertLess(told["rms_mm"], 5)
            after = tomllib.loads((self.folder / "waved.toml").read_text())["camera"]
            self.assertNotEqual(before[0]["translation"], after[0]["translation"])
            # As the simulator has it: cameras stand round the world's origin, which the L-frame's first marker is.
            truth = subprocess.run([MAREY, "simulate", "room", "--motion", "ground", "--cameras", "4", "--frames", "2", "-o", "truth", "-q"], cwd=self.folder, timeout=60)
            self.assertEqual(truth.returncode, 0)
            for found, true in zip(after, tomllib.loads((self.folder / "truth/rig.toml").read_text())["camera"]):
                for a, b in zip(found["translation"], true["translation"]):
                    self.assertAlmostEqual(a, b, delta=0.05)
            page.wire.close()
            self.assertEqual(shown.process.wait(timeout=20), 0)

    def test_others_in_the_network_set_no_cameras_unless_that_is_allowed(self):
        for allowed in (False, True):
            with LivePage(self.folder, *self.write_rig("wand"), "--listen", "0.0.0.0", *["--allow-control"] * allowed) as shown:
                self.assertEqual(shown.scene()["can_change"], allowed)

    def test_only_live_cameras_are_shown(self):
        subprocess.run([MAREY, "simulate", "room", "--motion", "wand", "--frames", "5", "-o", "room", "-q"], cwd=self.folder, check=True, timeout=60)
        done = subprocess.run([MAREY, "calibrate", "wand", "room/start.toml", "--observations", "room/observations.csv", "--wand", "0,0.12,0.30", "-o", "a.toml", "--view"],
                              cwd=self.folder, capture_output=True, text=True, timeout=60)
        self.assertEqual(done.returncode, 2)
        self.assertIn("--view: shows live cameras", done.stderr)


if __name__ == "__main__":
    shown_page.MAREY = MAREY = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main()
