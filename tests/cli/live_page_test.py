"""A live run that is changed from its page, without a browser: who may, what reaches the cameras, the rig file and the take, and what
untrusted clients write. live_page_test.py MAREY."""

import json
import os
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile
import time
import tomllib
import unittest

import node_test
import shown_page
from shown_page import LivePage, WebSocket, receive_until

MAREY = ""


class Page(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="marey_page_"))
        self.addCleanup(shutil.rmtree, self.folder)

    def write_rig(self, lines="", options="&drawn=1&lamps=2"):
        cameras = [f'[[camera]]\nname = "cam{c}"\nsource = "sim://room?cameras=2&markers=8&size=320x240&rate=20{options}&camera={c}"\n{lines}' for c in (1, 2)]
        (self.folder / "rig.toml").write_text("\n".join(cameras))

    def rig(self):
        return tomllib.loads((self.folder / "rig.toml").read_text())["camera"]

    def test_what_is_changed_reaches_the_camera_and_the_rig_file(self):
        self.write_rig()
        with LivePage(self.folder, "live", "rig.toml", "--view", "--port", 0) as shown:
            scene = shown.scene()
            self.assertTrue(scene["can_change"])
            self.assertEqual(scene["rig_file"], "rig.toml")
            page = WebSocket(shown)
            status = receive_until(page, "status", lambda s: len(s["cameras"]) == 2 and all(len(c["controls"]) == 2 for c in s["cameras"]))
            controls = {camera_control["name"]: camera_control for camera_control in status["cameras"][0]["controls"]}
            self.assertEqual((controls["exposure"]["unit"], controls["exposure"]["max"], controls["exposure"]["now"]), ("ms", 50, 2))
            self.assertFalse(status["unsaved"])
            for line in ("dial 0 exposure 1.5", "dial 0 gain 2", "threshold 1 90", "mask 1 10 20 30 40", "mask 1 50 60 7 8", "unmask 1 10 20 30 40", "mask 1 9 9 90 9 50 80", "mask 1 1 1 2 2 3 9", "unmask 1 1 1 2 2 3 9"):
                page.send(line)
            status = receive_until(page, "status", lambda s: s["unsaved"] and len(s["cameras"][1].get("masks", [])) == 2 and [d["now"] for d in s["cameras"][0]["controls"]] == [1.5, 2])
            self.assertEqual(status["cameras"][1]["masks"], [[50, 60, 7, 8], [9, 9, 90, 9, 50, 80]])
            self.assertEqual(status["cameras"][1]["threshold"], 90)
            self.assertIsNone(status["cameras"][0]["threshold"])
            page.send("dial 0 exposure 500")
            refused = receive_until(page, "status", lambda s: "refused" in s["cameras"][0])["cameras"][0]
            self.assertTrue(refused["refused"].startswith("cam1: does not take that exposure; it must be 0.02 to 50 ms"), refused["refused"])
            self.assertEqual(refused["controls"][0]["now"], 1.5)
            for level in ("99999", "-1", "0"):
                page.send(f"threshold 1 {level}")
                self.assertIn("cam2: does not take that threshold; it must be a grey level above 0", receive_until(page, "said", lambda text: text != ""))
            page.send("lit 0")
            receive_until(page, "status", lambda s: s["cameras"][0]["learning"])
            receive_until(page, "status", lambda s: not s["cameras"][0]["learning"] and len(s["cameras"][0]["masks"]) >= 2)
            page.send("save")
            receive_until(page, "status", lambda s: not s["unsaved"])
        one, two = self.rig()
        self.assertEqual((one["exposure"], one["gain"]), (1.5, 2))
        self.assertGreaterEqual(len(one["masks"]), 2)
        self.assertEqual((two["threshold"], two["masks"]), (90, [[50, 60, 7, 8], [9, 9, 90, 9, 50, 80]]))
        self.assertNotIn("exposure", two)
        self.assertIn("sim://room", one["source"])
        self.assertNotIn("seen from this file", (self.folder / "rig.toml").read_text())

    def test_a_rig_that_states_so_is_set_so_from_the_beginning(self):
        self.write_rig("exposure = 0.7\nthreshold = 33\nmasks = [[0, 0, 320, 240]]\n")
        with LivePage(self.folder, "live", "rig.toml", "--view", "--port", 0) as shown:
            page = WebSocket(shown)
            status = receive_until(page, "status", lambda s: len(s["cameras"]) == 2 and all(c["controls"] and c["controls"][0]["now"] == 0.7 for c in s["cameras"]))
            self.assertEqual(status["cameras"][0]["threshold"], 33)
            self.assertFalse(status["unsaved"])
            page.send("watch 0 320")
            picture = next(data for data in iter(page.receive, None) if isinstance(data, bytes) and data[0] == 3)
            self.assertEqual(int.from_bytes(picture[28:32], "little"), 0, "markers are found under the mask")
        self.write_rig("masks = [[0, 0, 320]]\n")
        done = subprocess.run([MAREY, "live", "rig.toml"], capture_output=True, text=True, cwd=self.folder, timeout=60)
        self.assertEqual(done.returncode, 1)
        self.assertIn("masks must be [[x, y, width, height], …] in px", done.stderr)

    def test_videos_are_searched_as_the_rig_states(self):
        subprocess.run([MAREY, "simulate", "room", "--cameras", "2", "--frames", "30", "--size", "320", "240", "--render", "-o", "room", "-q"], cwd=self.folder, check=True, timeout=120)
        rig = (self.folder / "room/rig.toml").read_text()
        detected = []
        for lines in ("", "masks = [[0, 0, 320, 240]]", "masks = [[0, 0, 160, 240]]", "threshold = 255", "masks = [[0, 0, 319, 0, 319, 239, 0, 239]]"):
            (self.folder / "room/set.toml").write_text(rig.replace("[[camera]]", f"[[camera]]\n{lines}"))
            done = subprocess.run([MAREY, "reconstruct", "room/set.toml", "-o", "out.marey", "--json", "-q"], cwd=self.folder, capture_output=True, text=True, timeout=120)
            self.assertEqual(done.returncode, 0, done.stderr)
            detected.append(json.loads(done.stdout)["observations"])
        self.assertGreater(detected[0], 100)
        self.assertEqual(detected[1], 0)
        self.assertTrue(0 < detected[2] < detected[0], detected)
        self.assertEqual(detected[3], 0)
        self.assertEqual(detected[4], 0, "a polygon round all of it")

    def test_markers_that_come_ready_are_masked_too(self):
        self.write_rig(options="&blobs&lamps=2")
        with LivePage(self.folder, "live", "rig.toml", "--view", "--port", 0) as shown:
            page = WebSocket(shown)
            status = receive_until(page, "status", lambda s: len(s["cameras"]) == 2 and s["cameras"][0]["frames"] > 5)
            self.assertEqual(status["cameras"][0]["controls"], [], "points have no exposure")
            page.send("watch 0 320")
            detected = lambda: next(int.from_bytes(data[28:32], "little") for data in iter(page.receive, None) if isinstance(data, bytes) and data[0] == 3)
            self.assertGreater(max(detected() for _ in range(5)), 2)
            page.send("mask 0 0 0 320 240")
            for _ in range(50):
                if detected() == 0:
                    break
            else:
                self.fail("they are not masked")

    def test_names_are_in_the_take(self):
        with LivePage(self.folder, "live", "sim://room?cameras=4&markers=6&motion=cloud&rate=30&blobs", "-o", "named.marey", "--view", "--port", 0) as shown:
            self.assertNotIn("rig_file", shown.scene())
            page = WebSocket(shown)
            tracks = []
            for _ in range(100):
                tracks = shown.scene()["tracks"]
                if len(tracks) >= 2:
                    break
                time.sleep(0.1)
            one, two = tracks[0]["id"], tracks[1]["id"]
            page.send(f"name {one} left knee")
            receive_until(page, "said", lambda text: text == "")
            page.send(f"name {two} left knee")
            self.assertIn("is called left knee and is seen now", receive_until(page, "said"))
            page.send("name 999999 no person")
            self.assertIn("there is no track 999999", receive_until(page, "said"))
            page.send("save")
            self.assertIn("there is no rig file", receive_until(page, "said", lambda text: "rig" in text))
            for _ in range(100):
                if any(track["label"] == "left knee" for track in shown.scene()["tracks"]):
                    break
                time.sleep(0.1)
            time.sleep(1)
            shown.end()
        subprocess.run([MAREY, "convert", "named.marey", "named.trc", "-q"], cwd=self.folder, check=True, timeout=60)
        self.assertRegex((self.folder / "named.trc").read_text(), "left.knee")

    def test_others_in_the_network_change_nothing_unless_that_is_allowed(self):
        self.write_rig()
        for allowed in (False, True):
            with LivePage(self.folder, "live", "rig.toml", "--view", "--port", 0, "--listen", "0.0.0.0", *["--allow-control"] * allowed) as shown:
                self.assertEqual(shown.scene()["can_change"], allowed)
                page = WebSocket(shown)
                receive_until(page, "status", lambda s: len(s["cameras"]) == 2 and s["cameras"][0]["controls"])
                page.send("mask 0 1 2 3 4")
                page.send("dial 0 gain 3")
                page.send("save")
                time.sleep(0.6)
                receive_until(page, "status")
                status = receive_until(page, "status")
                self.assertEqual(status["cameras"][0]["masks"], [[1, 2, 3, 4]] if allowed else [])
                self.assertEqual("masks" in self.rig()[0], allowed)

    def test_lines_of_untrusted_cost_nothing(self):
        self.write_rig()
        before = (self.folder / "rig.toml").read_text()
        generator = random.Random(7)
        words = ["dial", "threshold", "mask", "unmask", "lit", "name", "0", "-1", "63", "64", "1e308", "nan", "all", "auto", "exposure", "\0", "ä", " ", "99999999999999999999", "x" * 900]
        with LivePage(self.folder, "live", "rig.toml", "--view", "--port", 0) as shown:
            page = WebSocket(shown)
            for _ in range(3000):
                page.send(" ".join(generator.choices(words, k=generator.randint(0, 7))))
            for i in range(400):
                page.send(f"mask 0 {i} 0 1 1")
            self.assertIn("256 masks already", receive_until(page, "said", lambda text: "masks" in text))
            status = receive_until(page, "status", lambda s: len(s["cameras"]) == 2 and len(s["cameras"][0].get("masks", [])) == 256)
            self.assertEqual(len(status["cameras"]), 2)
            page.send("lit 63")
            self.assertIn("there is no camera 64", receive_until(page, "said", lambda text: "camera" in text))
        self.assertEqual((self.folder / "rig.toml").read_text(), before, "save was not pressed")


class OtherComputer(unittest.TestCase):
    """A node, here on the same computer."""

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="marey_node_page_"))
        self.addCleanup(shutil.rmtree, self.folder)

    def node(self, *options):
        port = node_test.free_port()
        node = subprocess.Popen([MAREY, "node", "sim://room?cameras=2&rate=20&markers=8&drawn=1&size=320x240", "--port", str(port), *options],
                                cwd=self.folder, text=True, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        self.addCleanup(lambda: (node.kill(), node.wait(), node.stderr.close()))
        self.assertIn("marey live node:", node.stderr.readline())
        return f"node:127.0.0.1:{port}"

    def test_its_camera_is_set_from_the_hosts_page(self):
        where = self.node()
        (self.folder / "rig.toml").write_text("".join(f'[[camera]]\nname = "mine{c}"\nsource = "{where}/cam{c}"\nexposure = 1.5\n' for c in (1, 2)))
        found = lambda page: max(next(int.from_bytes(data[28:32], "little") for data in iter(page.receive, None) if isinstance(data, bytes) and data[0] == 3) for _ in range(4))
        now = lambda s: [camera_control["now"] for camera_control in s["cameras"][0].get("controls", [])]
        with LivePage(self.folder, "live", "rig.toml", "--view", "--port", 0) as shown:
            page = WebSocket(shown)
            status = receive_until(page, "status", lambda s: len(s["cameras"]) == 2 and now(s) == [1.5, 1])
            self.assertEqual([camera_control["name"] for camera_control in status["cameras"][0]["controls"]], ["exposure", "gain"])
            page.send("watch 0 320")
            self.assertGreater(found(page), 2)
            page.send("dial 0 exposure 2.5")
            page.send("dial 0 gain 2")
            receive_until(page, "status", lambda s: now(s) == [2.5, 2])
            page.send("dial 0 exposure 500")
            refused = receive_until(page, "status", lambda s: "refused" in s["cameras"][0])["cameras"][0]["refused"]
            self.assertTrue(refused.startswith("mine1: does not take that exposure; it must be 0.02 to 50 ms"), refused)
            page.send("threshold 0 254")
            receive_until(page, "status", lambda s: s["cameras"][0]["threshold"] == 254 and "refused" not in s["cameras"][0])
            for _ in range(50):
                if found(page) < 2:
                    break
            else:
                self.fail("the node finds as many markers as before")
            page.send("save")
            receive_until(page, "status", lambda s: not s["unsaved"])
        kept = tomllib.loads((self.folder / "rig.toml").read_text())["camera"][0]
        self.assertEqual((kept["exposure"], kept["gain"], kept["threshold"]), (2.5, 2, 254))
        with LivePage(self.folder, "live", where, "--view", "--port", 0) as shown:
            page = WebSocket(shown)
            receive_until(page, "status", lambda s: len(s["cameras"]) == 2 and now(s) == [2.5, 2] and s["cameras"][0]["threshold"] == 254)
            page.send("threshold 0 auto")
            receive_until(page, "status", lambda s: s["cameras"][0]["threshold"] is None)
            page.send("watch 0 320")
            for _ in range(50):
                if found(page) > 2:
                    break
            else:
                self.fail("automatic finds no more")

    def test_a_node_that_others_reach_is_set_where_it_allows_that(self):
        for options, refused in (((), True), (("--allow-control",), False)):
            where = self.node("--listen", "0.0.0.0", *options)
            with LivePage(self.folder, "live", where, "--view", "--port", 0) as shown:
                page = WebSocket(shown)
                receive_until(page, "status", lambda s: len(s["cameras"]) == 2 and s["cameras"][0]["controls"])
                page.send("dial 0 exposure 3")
                if refused:
                    why = receive_until(page, "status", lambda s: "refused" in s["cameras"][0])["cameras"][0]["refused"]
                    self.assertEqual(why, "cam1: its exposure cannot be set from here: marey node there was started without --allow-control")
                else:
                    receive_until(page, "status", lambda s: s["cameras"][0]["controls"][0]["now"] == 3)


class MachineVision(unittest.TestCase):
    def test_a_machine_vision_camera_is_set(self):
        """Aravis's fake camera, in a network of its own, in which this test runs again."""
        if "MAREY_FAKE_CAMERA" not in os.environ:
            if shutil.which("arv-fake-gv-camera-0.8") is None or "gige:" not in subprocess.run([MAREY, "live", "--help"], capture_output=True, text=True).stdout:
                self.skipTest("Aravis or its fake camera is not here")
            again = f"ip link set lo up || exit 77; arv-fake-gv-camera-0.8 -i 127.0.0.1 -s EYE & camera=$!; sleep 2; {sys.executable} {__file__} {MAREY} {self.id().removeprefix('__main__.')}; code=$?; kill $camera; exit $code"
            done = subprocess.run(["unshare", "-rn", "bash", "-c", again], capture_output=True, text=True, timeout=120, env={**os.environ, "MAREY_FAKE_CAMERA": "1"})
            if done.returncode == 77 or "unshare" in done.stderr:
                self.skipTest(f"no network namespace here: {done.stderr}")
            self.assertEqual(done.returncode, 0, done.stderr)
            return
        folder = pathlib.Path(tempfile.mkdtemp(prefix="marey_gige_"))
        self.addCleanup(shutil.rmtree, folder)
        (folder / "rig.toml").write_text('[[camera]]\nname = "eye"\nsource = "gige:EYE"\nexposure = 4.0\n')
        with LivePage(folder, "live", "rig.toml", "--view", "--port", 0) as shown:
            page = WebSocket(shown)
            camera_control = lambda s, name: next(each for each in s["cameras"][0]["controls"] if each["name"] == name)
            status = receive_until(page, "status", lambda s: len(s["cameras"][0]["controls"]) == 2)
            self.assertAlmostEqual(camera_control(status, "exposure")["now"], 4, places=2)
            page.send("dial 0 exposure 7.5")
            receive_until(page, "status", lambda s: abs(camera_control(s, "exposure")["now"] - 7.5) < 0.01)
            page.send(f"dial 0 gain {camera_control(status, 'gain')['max'] / 2}")
            receive_until(page, "status", lambda s: abs(camera_control(s, "gain")["now"] - camera_control(s, "gain")["max"] / 2) < 0.51)
            page.send("save")
            receive_until(page, "status", lambda s: not s["unsaved"])
        self.assertEqual(tomllib.loads((folder / "rig.toml").read_text())["camera"][0]["exposure"], 7.5)


if __name__ == "__main__":
    shown_page.MAREY = MAREY = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main()
