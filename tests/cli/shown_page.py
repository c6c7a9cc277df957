"""Programs that show a page, and a page without a browser, for the tests of `marey view` and of the pages of live runs."""

import base64
import json
import os
import pathlib
import re
import shutil
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import time
import unittest

MAREY = ""
FOLDER = pathlib.Path()
SANITIZED = bool(os.environ.get("MAREY_SANITIZE"))  # what was freed is kept back then, to see who reads it


def marey(*arguments, code=0):
    done = subprocess.run([MAREY, *map(str, arguments)], capture_output=True, text=True, cwd=FOLDER, timeout=120)
    assert done.returncode == code, f"{arguments}\n{done.stdout}\n{done.stderr}"
    return done


class Shown:
    """A program that shows a page, until the end of the block."""

    def __init__(self, *command):
        self.process = subprocess.Popen(list(map(str, command)), stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=FOLDER)
        self.address = self.process.stdout.readline().strip()
        found = re.fullmatch(r"http://127\.0\.0\.1:(\d+)/\?token=([0-9a-f]{48})", self.address)
        assert found, (self.address, self.process.stderr.read())
        self.port, self.token = int(found[1]), found[2]
        self.host = f"127.0.0.1:{self.port}"
        self.wires = []

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for wire in self.wires:
            wire.close()
        if self.process.poll() is None:
            self.process.terminate()
        self.process.wait(timeout=10)
        for pipe in (self.process.stdin, self.process.stdout, self.process.stderr):
            pipe.close()

    def connect(self):
        self.wires.append(socket.create_connection(("127.0.0.1", self.port), timeout=5))
        return self.wires[-1]

    def request(self, path, method="GET", token=True, **headers):
        """Status, headers by lower-case name, body."""
        lines = {"Host": self.host, "Connection": "close", **{name.replace("_", "-"): value for name, value in headers.items()}}
        if token:
            lines["Authorization"] = f"token {self.token}"
        text = f"{method} {path} HTTP/1.1\r\n" + "".join(f"{name}: {value}\r\n" for name, value in lines.items() if value is not None) + "\r\n"
        with self.connect() as wire:
            wire.sendall(text.encode())
            answer = b""
            while part := wire.recv(1 << 16):
                answer += part
        head, _, body = answer.partition(b"\r\n\r\n")
        status, *rest = head.decode().split("\r\n")
        return int(status.split()[1]), {line.split(":")[0].lower(): line.split(":", 1)[1].strip() for line in rest}, body

    def scene(self):
        """When all of it was read."""
        for _ in range(100):
            said = json.loads(self.request("/scene")[2])
            if said["kind"] == "live" or said["complete"]:
                return said
            time.sleep(0.05)
        raise AssertionError("it was never read to its end")

    def memory_mb(self):
        status = pathlib.Path(f"/proc/{self.process.pid}/status").read_text()
        return int(re.search(r"VmRSS:\s+(\d+)", status)[1]) / 1024


class LivePage(Shown):
    """A command that shows live cameras, until the end of the block."""

    def __init__(self, folder, *command):
        self.process = subprocess.Popen([MAREY, *map(str, command)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=folder)
        said = []
        for line in self.process.stderr:
            said.append(line)
            if found := re.search(r"open (http://[^:]+:(\d+)/\?token=([0-9a-f]{48})) in a browser", line):
                break
        else:
            raise AssertionError(said)
        self.address, self.port, self.token = found[1], int(found[2]), found[3]
        self.host = f"127.0.0.1:{self.port}"
        self.wires = []

    def end(self):
        self.process.send_signal(signal.SIGINT)
        told = self.process.stdout.read()
        self.process.wait(timeout=30)
        return told


class WebSocket:
    def __init__(self, shown, **headers):
        self.wire = shown.connect()
        lines = {"Host": shown.host, "Origin": f"http://{shown.host}", "Cookie": f"marey_{shown.port}={shown.token}", **headers}
        key = base64.b64encode(os.urandom(16)).decode()
        text = "GET /socket HTTP/1.1\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n" + f"Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: {key}\r\n"
        self.wire.sendall((text + "".join(f"{name}: {value}\r\n" for name, value in lines.items()) + "\r\n").encode())
        head = b""
        while b"\r\n\r\n" not in head:
            part = self.wire.recv(1)
            if not part:
                break
            head += part
        self.status = int(head.split()[1])

    def send(self, text, masked=True):
        data = text.encode()
        length = bytes([len(data)]) if len(data) < 126 else b"\x7e" + struct.pack(">H", len(data))
        head = b"\x81" + (bytes([length[0] | 0x80]) + length[1:] if masked else length)
        self.wire.sendall(head + (b"\0\0\0\0" if masked else b"") + data)

    def receive(self):
        """Text or bytes; answers pings."""
        head = self.exactly(2)
        length = head[1] & 127
        if length == 126:
            length = struct.unpack(">H", self.exactly(2))[0]
        elif length == 127:
            length = struct.unpack(">Q", self.exactly(8))[0]
        data = self.exactly(length)
        kind = head[0] & 15
        if kind == 9:
            self.wire.sendall(bytes([0x8A, 0x80 | len(data)]) + b"\0\0\0\0" + data)
            return self.receive()
        return data.decode() if kind == 1 else data

    def exactly(self, count):
        data = b""
        while len(data) < count:
            part = self.wire.recv(count - len(data))
            if not part:
                raise ConnectionError("closed")
            data += part
        return data


class TimeChunk:
    """Kinds 1 and 2 of apps/viewer/wire.h."""

    def __init__(self, data):
        self.kind, version, flags, self.sequence, capture, sent, n, rows, poses, _ = struct.unpack_from("<BBHIQQIIII", data)
        assert version == 1
        at = 40
        self.time = struct.unpack_from(f"<{n}d", data, at)
        at += 8 * n
        self.index = struct.unpack_from(f"<{n}I", data, at)
        self.row_end = struct.unpack_from(f"<{n}I", data, at + 4 * n)
        at += 12 * n
        self.track = struct.unpack_from(f"<{rows}i", data, at)
        self.x = struct.unpack_from(f"<{rows}f", data, at + 4 * rows)


def receive_until(page, word, holds=lambda rest: True, patience_s=20):
    """What is behind that word, once it holds."""
    end = time.monotonic() + patience_s
    page.wire.settimeout(max(5, patience_s))  # while a rig is computed nothing is said
    while time.monotonic() < end:
        line = page.receive()
        if isinstance(line, str) and line.split(" ")[0] == word:
            rest = line[len(word) + 1:]
            rest = json.loads(rest) if word in ("status", "wand") else rest
            if rest != {} and holds(rest):
                return rest
    raise AssertionError(f"no {word} like that came")


def make_walk():
    """walk.marey, 20 markers seen by 4 cameras for 150 frames, and what it was made of."""
    marey("simulate", "room", "--motion", "walk", "--cameras", "4", "--markers", "20", "--frames", "150", "--size", "320", "240", "-o", "walk", "-q")
    marey("reconstruct", "walk/rig.toml", "--observations", "walk/observations.csv", "--labels", "walk/labels.csv", "-o", "walk.marey", "-q")


def run_tests():
    """Of the calling script, whose first argument is the program, in a folder with walk.marey."""
    global MAREY, FOLDER
    MAREY = str(pathlib.Path(sys.argv.pop(1)).resolve())
    FOLDER = pathlib.Path(tempfile.mkdtemp(prefix="marey_view_"))
    try:
        make_walk()
        unittest.main()
    finally:
        shutil.rmtree(FOLDER)
