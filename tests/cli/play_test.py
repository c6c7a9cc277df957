"""`marey play`: what it says, what it refuses, how it ends; hostile clients on its ports.

Usage: play_test.py MAREY [unittest options]
"""
import json
import os
import pathlib
import shutil
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import unittest

MAREY = ""


def default_signals():
    signal.signal(signal.SIGINT, signal.SIG_DFL)


class Play(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="marey_play_"))
        self.addCleanup(shutil.rmtree, self.folder)
        rows = "".join(f"{k},{k / 50:.3f},{m},P{m},{k / 100},{m},1.5\n" for k in range(100) for m in (1, 2))
        (self.folder / "points.csv").write_text("frame,time,id,label,x,y,z\n" + rows)
        (self.folder / "people.csv").write_text("frame,time,id,label,team,x,y\n" + "".join(f"{k},{k / 50:.3f},1,9,Home,{k / 10},3\n" for k in range(100)))
        (self.folder / "boxes.txt").write_text("".join(f"{k},1,{k},20,30,40,1,-1,-1,-1\n" for k in range(1, 60)))

    def marey(self, *arguments, code=0):
        done = subprocess.run([MAREY, *map(str, arguments)], capture_output=True, text=True, cwd=self.folder, timeout=60)
        self.assertEqual(done.returncode, code, f"{arguments}\n{done.stdout}\n{done.stderr}")
        return done

    def start(self, *arguments):
        """The process and its wires' ports."""
        process = subprocess.Popen([MAREY, "play", *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=self.folder,
                                   preexec_fn=default_signals)
        self.addCleanup(process.kill)
        count = sum(word == "--stream" for word in arguments)
        return process, [int(process.stderr.readline().split(":")[2].split(",")[0]) for _ in range(count)]

    def end(self, process, number=signal.SIGINT):
        process.send_signal(number)
        out, errors = process.communicate(timeout=20)
        return process.returncode, out, errors

    def test_the_summary_counts(self):
        told = json.loads(self.marey("play", "points.csv", "--speed", 10, "--stream", "osc", "--stream", "json::0", "--json").stdout)
        self.assertEqual((told["instants"] + told["skipped"], told["loops"], told["interrupted"]), (100, 1, False))
        self.assertEqual([wire["wire"] for wire in told["streams"]], ["osc", "json"])
        self.assertEqual(told["streams"][0]["sent"], told["instants"])
        said = self.marey("play", "points.csv", "--speed", 10, "--rate", 10, "--stream", "vmc").stderr
        self.assertIn("80 omitted by --rate", said)
        self.assertIn("vmc to 127.0.0.1:39539: 20 frames sent, 0 dropped", said)
        self.assertEqual(self.marey("play", "points.csv", "--speed", 100, "--stream", "osc", "-q").stderr, "")

    def test_every_recording_plays(self):
        for name in ("points.csv", "people.csv"):
            self.marey("convert", name, "take.marey", "-q")
            for file in (name, "take.marey"):
                self.marey("play", file, "--speed", 50, "--stream", "qtm::0", "--stream", "foxglove::0", "--stream", "lsl::0", "-q")
        self.marey("play", "boxes.txt", "--speed", 50, "--stream", "json::0", "-q")
        self.assertIn("qtm: carries metres", self.marey("play", "boxes.txt", "--stream", "qtm::0", code=1).stderr)

    def test_what_is_wrong_is_reported(self):
        for arguments, code, sentence in (
                (("points.csv", "--stream", "word"), 2, "there are qtm, natnet"),
                (("points.csv", "--stream", "qtm:a:99999"), 2, "names no port"),
                (("points.csv", "--speed", "0"), 2, "[0.01, 100]"),
                (("none.csv",), 1, "no such file"),
                (("points.csv", "--stream", "json:203.0.113.7"), 1, "not an address of this host"),
                (("points.csv", "--stream", "osc:no.such.host.invalid"), 1, "no host is called")):
            said = self.marey("play", *arguments, code=code).stderr
            self.assertIn(sentence, said)
            self.assertEqual(said.count("\n"), 1, said)
        with socket.socket() as taken:
            taken.bind(("127.0.0.1", 0))
            taken.listen()
            said = self.marey("play", "points.csv", "--stream", f"qtm::{taken.getsockname()[1]}", code=1).stderr
        self.assertIn("is in use by another program", said)

    def test_it_ends_when_it_is_reported_to(self):
        process, _ = self.start("points.csv", "--loop", "--stream", "json::0")
        code, _, said = self.end(process)
        self.assertEqual(code, 0, said)
        self.assertIn(" loop", said)
        process, _ = self.start("points.csv", "--speed", "0.01", "--stream", "json::0")
        self.assertEqual(self.end(process)[0], 130)

    def test_hostile_clients_cost_none_else_anything(self):
        process, ports = self.start("points.csv", "--loop", "--json", "--stream", "qtm::0", "--stream", "json::0", "--stream", "foxglove::0",
                                    "--stream", "lsl::0")
        good = socket.create_connection(("127.0.0.1", ports[1]))
        lines = good.makefile()
        self.assertEqual(json.loads(lines.readline())["type"], "header")
        attacks = (os.urandom(4096), struct.pack("<II", 0xffffffff, 1), b"\x10\0\0\0\x01\0", b"GET / HTTP/1.1\r\n" + b"a" * 60000,
                   b"\x81\xff" + b"\xff" * 8, b"LSL:streamfeed/110 " + b"x" * 9000, b"\0" * 100000, b"")
        kept = []
        for port in ports:
            for attack in attacks:
                client = socket.create_connection(("127.0.0.1", port))
                try:
                    client.sendall(attack)
                except OSError:
                    pass  # disconnected in the meantime
                kept.append(client)
        for port in ports:
            for _ in range(250):
                kept.append(socket.create_connection(("127.0.0.1", port)))
        first = json.loads(lines.readline())["frame"]
        for _ in range(20):
            last = json.loads(lines.readline())["frame"]
        self.assertGreaterEqual(last - first, 20)
        for client in kept:
            client.close()
        code, out, said = self.end(process)
        self.assertEqual(code, 0, said)
        told = {wire["wire"]: wire for wire in json.loads(out)["streams"]}
        self.assertGreater(told["qtm"]["disconnected"], 0)
        self.assertGreater(told["qtm"]["refused"], 0)


if __name__ == "__main__":
    MAREY = sys.argv.pop(1)
    unittest.main()
