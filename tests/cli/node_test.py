"""`marey node` hands cameras to `marey live` on another computer, here the same one.

Usage: node_test.py MAREY [unittest options].
"""

import json
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest

MAREY = ""
ROOM = "sim://room?cameras=4&rate=40&markers=12&blobs&size=1280x1024&drawn=1"


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Node(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="marey_node_"))
        self.addCleanup(shutil.rmtree, self.folder)
        self.port = free_port()
        self.where = f"node:127.0.0.1:{self.port}"

    def start(self, *arguments):
        node = subprocess.Popen([MAREY, "node", *map(str, arguments), "--port", str(self.port), "--json"], cwd=self.folder, text=True,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.addCleanup(node.kill)
        line = node.stderr.readline()
        self.assertIn(f"marey live {self.where}", line)
        return node

    def end(self, node):
        node.send_signal(signal.SIGINT)
        out, said = node.communicate(timeout=30)
        self.assertEqual(node.returncode, 0, said)
        return json.loads(out)

    def live(self, *arguments):
        done = subprocess.run([MAREY, "live", *map(str, arguments), "--quiet", "--json"], cwd=self.folder, capture_output=True, text=True,
                              timeout=60)
        self.assertEqual(done.returncode, 0, done.stderr)
        return json.loads(done.stdout)

    def refused(self, *arguments, code=1):
        done = subprocess.run([MAREY, *map(str, arguments)], cwd=self.folder, capture_output=True, text=True, timeout=60)
        self.assertEqual(done.returncode, code, done.stderr)
        self.assertEqual(len(done.stderr.strip().splitlines()), 1, done.stderr)
        return done.stderr

    def test_markers_of_another_computer_in_space(self):
        node = self.start(ROOM)
        live = self.live(self.where, "--duration", 3, "-o", "walk.marey")
        told = self.end(node)
        self.assertEqual(live["job"], "markers in space", "the calibration comes along")
        self.assertEqual(sorted(live["cameras"]), ["cam1", "cam2", "cam3", "cam4"])
        for name, camera in live["cameras"].items():
            self.assertEqual((camera["damaged"], camera["connections"]), (0, 1), name)
            self.assertGreater(camera["frames"], 40)
            self.assertLess(camera["lost"], 0.1 * camera["frames"], "on a machine that is busy a few may be")
            self.assertGreaterEqual(told["cameras"][name]["sent"], camera["frames"] + camera["lost"])
        self.assertGreaterEqual(live["targets"], 6)
        info = json.loads(subprocess.run([MAREY, "info", "walk.marey", "--json"], cwd=self.folder, capture_output=True, text=True, check=True).stdout)
        self.assertGreater(info["points"], 200)

    def test_images_of_one_camera_that_the_host_names(self):
        node = self.start("left=sim://room?cameras=1&rate=20&markers=8&drawn=1", "--send", "images")
        live = self.live(f"mine={self.where}/left", "--duration", 3)
        self.assertGreater(self.end(node)["bytes"], 50_000)
        self.assertEqual(live["job"], "markers in an image")
        self.assertEqual(list(live["cameras"]), ["mine"])
        self.assertEqual(live["cameras"]["mine"]["damaged"], 0)
        self.assertGreaterEqual(live["targets"], 5)

    def test_a_node_that_is_killed_and_started_again_is_back(self):
        node = self.start(ROOM)
        live = subprocess.Popen([MAREY, "live", self.where, "--duration", "9", "--json"], cwd=self.folder, text=True, stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE)
        self.addCleanup(live.kill)
        time.sleep(2.5)
        node.kill()
        node.communicate()
        time.sleep(1)
        with socket.create_connection(("127.0.0.1", self.port)) if self.is_open() else open(os.devnull):
            node = self.start(ROOM)
        out, said = live.communicate(timeout=60)
        self.end(node)
        self.assertEqual(live.returncode, 0, said)
        for name, camera in json.loads(out)["cameras"].items():
            self.assertGreaterEqual(camera["connections"], 2, name)
            self.assertIn(camera["state"], ("live", "back"), name)
        self.assertIn("stalled", said)

    def is_open(self):
        with socket.socket() as probe:
            return probe.connect_ex(("127.0.0.1", self.port)) == 0

    def test_garbage_from_a_client_disturbs_no_other(self):
        node = self.start(ROOM)
        for garbage in (b"", b"GET / HTTP/1.1\r\n\r\n", b"\xff" * 100_000, b"\x00" * 10, os.urandom(5000)):
            with socket.create_connection(("127.0.0.1", self.port)) as wire:
                try:
                    wire.sendall(garbage)
                except OSError:
                    pass
        crowd = [socket.create_connection(("127.0.0.1", self.port)) for _ in range(100)]
        live = self.live(self.where, "--duration", 2)
        for wire in crowd:
            wire.close()
        camera = self.end(node)["cameras"]["cam1"]
        self.assertLessEqual(camera["lost"], 0.1 * camera["sent"], "a few may be lost on a busy machine")
        self.assertGreaterEqual(live["targets"], 6)

    def test_a_web_page_is_refused(self):
        node = self.start(ROOM)
        for origin, status in (("Origin: https://evil.example\r\n", b"403"), ("Origin: null\r\n", b"403"), ("", b"101")):
            with socket.create_connection(("127.0.0.1", self.port), timeout=10) as wire:
                wire.sendall((f"GET / HTTP/1.1\r\nHost: 127.0.0.1:{self.port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n{origin}"
                              "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n").encode())
                self.assertEqual(wire.recv(4096).split()[1], status, origin)
        self.end(node)

    def test_what_cannot_be_is_stated(self):
        self.assertIn("does not answer; does marey node run there", self.refused("live", self.where, "--duration", 1))
        self.assertIn("names no host", self.refused("live", "node:/left", "--duration", 1))
        node = self.start(ROOM)
        self.assertIn("cannot be had", self.refused("node", ROOM, "--port", self.port))
        done = subprocess.run([MAREY, "live", f"{self.where}/nobody", "--duration", "1"], cwd=self.folder, capture_output=True, text=True, timeout=60)
        self.assertEqual(done.returncode, 1)
        self.assertIn('has no camera "nobody"; it has cam1, cam2, cam3, cam4', done.stderr)
        self.end(node)
        self.refused("node", ROOM, "--jpeg-quality", 0, code=2)
        self.refused("node", ROOM, "--port", 65536, code=2)
        self.assertIn("is not an address of this computer", self.refused("node", ROOM, "--listen", "nowhere.example"))
        self.assertIn("no such file", self.refused("node", "film.mp4", "--port", self.port))


if __name__ == "__main__":
    MAREY = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main()
