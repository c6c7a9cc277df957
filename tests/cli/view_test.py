"""`marey view` and the live viewer without a browser: what is served, to whom, and what strangers and slow readers can do. view_test.py MAREY LIVE_SCENE."""

import base64
import json
import os
import pathlib
import random
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
SANITIZED = bool(os.environ.get("MAREY_SANITIZE"))  # what was freed is kept back then, to see who reads it
LIVE_SCENE = ""
FOLDER = pathlib.Path()


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

    def ask(self, path, method="GET", token=True, **headers):
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
            said = json.loads(self.ask("/scene")[2])
            if said["kind"] == "live" or said["complete"]:
                return said
            time.sleep(0.05)
        raise AssertionError("it was never read to its end")

    def memory_mb(self):
        status = pathlib.Path(f"/proc/{self.process.pid}/status").read_text()
        return int(re.search(r"VmRSS:\s+(\d+)", status)[1]) / 1024


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

    def say(self, text, masked=True):
        data = text.encode()
        length = bytes([len(data)]) if len(data) < 126 else b"\x7e" + struct.pack(">H", len(data))
        head = b"\x81" + (bytes([length[0] | 0x80]) + length[1:] if masked else length)
        self.wire.sendall(head + (b"\0\0\0\0" if masked else b"") + data)

    def hear(self):
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
            return self.hear()
        return data.decode() if kind == 1 else data

    def exactly(self, count):
        data = b""
        while len(data) < count:
            part = self.wire.recv(count - len(data))
            if not part:
                raise ConnectionError("closed")
            data += part
        return data


class Stretch:
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


def rows_of(text):
    return [line.split(",") for line in text.splitlines()[1:]]


class View(unittest.TestCase):
    def test_what_is_served_is_what_is_in_the_file(self):
        marey("convert", "walk.marey", "walk.csv", "-q")
        wanted = {}
        for frame, _, track, _, x, *_ in rows_of((FOLDER / "walk.csv").read_text()):
            wanted[int(frame), int(track)] = float(x)
        with Shown(MAREY, "view", "walk.marey", "--port", "0") as shown:
            scene = shown.scene()
            self.assertEqual((scene["frame"], scene["name"], scene["instants"], len(scene["cameras"])), ("space", "walk.marey", 150, 4))
            self.assertEqual(len(scene["cameras"][0]["corners"]), 4)
            found = {}
            for number in range(len(scene["stretches"])):
                stretch = Stretch(shown.ask(f"/stretch?n={number}")[2])
                self.assertEqual(stretch.kind, 1)
                row = 0
                for index, end in zip(stretch.index, stretch.row_end):
                    for row in range(row, end):
                        found[index, stretch.track[row]] = stretch.x[row]
                    row = end
            self.assertEqual(found.keys(), wanted.keys())
            self.assertLess(max(abs(found[key] - wanted[key]) for key in wanted), 1e-5)
            track = scene["tracks"][3]
            course = shown.ask(f"/course?track={track['id']}")[2]
            self.assertEqual(struct.unpack_from("<I", course, 24)[0], track["rows"])
            self.assertEqual(track["rows"], sum(1 for _, id in wanted if id == track["id"]))
            for path in ("/stretch?n=99", "/stretch?n=-1", "/stretch?n=x", "/stretch", "/course?track=", "/../../etc/passwd", "//", "/page.js/x"):
                self.assertEqual(shown.ask(path)[0], 404, path)
            for path, kind in (("/", "text/html"), ("/page.js", "text/javascript"), ("/page.css", "text/css")):
                status, headers, body = shown.ask(path)
                self.assertEqual((status, headers["content-type"].split(";")[0]), (200, kind))
                self.assertGreater(len(body), 1000)
                self.assertIn("frame-ancestors 'none'", headers["content-security-policy"])
                self.assertEqual(shown.ask(path, method="HEAD")[2], b"")

    def test_every_kind_of_recording(self):
        marey("convert", "walk.marey", "walk.c3d", "-q")
        marey("convert", "walk.marey", "walk.trc", "-q")
        (FOLDER / "boxes.txt").write_text("".join(f"{i},1,{100 + 3 * i},80,30,90,1,-1,-1,-1\n" for i in range(1, 80)))
        (FOLDER / "ground.csv").write_text("frame,id,x,y,team\n" + "".join(f"{i},{p},{5 * p},{3 * p},red\n" for i in range(20) for p in range(1, 21)))
        for file, frame in (("walk.c3d", "space"), ("walk.trc", "space"), ("boxes.txt", "image"), ("ground.csv", "ground")):
            with self.subTest(file), Shown(MAREY, "view", file, "--port", "0", "-q") as shown:
                scene = shown.scene()
                self.assertEqual(scene["frame"], frame)
                self.assertGreater(scene["instants"], 10)
                if frame == "ground":
                    self.assertEqual(scene["pitch"], {"length": 105.0, "width": 68.0, "x": 0.0, "y": 0.0})

    def test_only_who_has_the_token_and_asks_this_machine_may_look(self):
        with Shown(MAREY, "view", "walk.marey", "--port", "0", "-q") as shown:
            for path in ("/", "/scene", "/page.js", "/stretch?n=0"):
                self.assertEqual(shown.ask(path, token=False)[0], 401, path)
                self.assertEqual(shown.ask(path, Host="evil.example")[0], 403, path)
                self.assertEqual(shown.ask(path, Host=None)[0], 403, path)
                self.assertEqual(shown.ask(path, Origin="http://evil.example")[0], 403, path)
                self.assertEqual(shown.ask(path, method="POST")[0], 405, path)
                self.assertNotIn("access-control-allow-origin", shown.ask(path)[1])
            status, headers, _ = shown.ask(f"/?token={shown.token}", token=False)
            self.assertEqual(status, 200)
            self.assertEqual(headers["set-cookie"], f"marey_{shown.port}={shown.token}; Path=/; HttpOnly; SameSite=Strict")
            self.assertEqual(shown.ask("/scene", token=False, Cookie=headers["set-cookie"].split(";")[0])[0], 200)
            self.assertEqual(WebSocket(shown).status, 101)
            self.assertEqual(WebSocket(shown, Origin="http://evil.example").status, 403)
            self.assertEqual(WebSocket(shown, Host="evil.example", Origin="http://evil.example").status, 403)
            self.assertEqual(WebSocket(shown, Cookie="marey=1").status, 401)
            self.assertEqual(WebSocket(shown, Origin="").status, 403)

    def test_bytes_of_strangers_cost_nothing(self):
        seed = random.randrange(1 << 32)
        dice = random.Random(seed)
        with Shown(MAREY, "view", "walk.marey", "--port", "0", "-q") as shown:
            shown.scene()
            before = shown.memory_mb()
            good = f"GET /scene HTTP/1.1\r\nHost: {shown.host}\r\nAuthorization: token {shown.token}\r\n\r\n".encode()
            attacks = [b"", b"\0" * 100, b"\r\n" * 5000, b"GET " + b"/" * 100000, good + good[:30], b"GET / HTTP/9.9\r\n\r\n", good[:-2] + b"X: " + b"y" * 100000]
            attacks += [good[:-2] + b"Content-Length: 4294967296\r\n\r\n", good[:-2] + b"Transfer-Encoding: chunked\r\n\r\nffffffffffffffff\r\n", b"\x16\x03\x01\x02\x00\x01"]
            attacks += [good[: dice.randrange(len(good))] for _ in range(20)] + [dice.randbytes(dice.randrange(3000)) for _ in range(60)]
            for _ in range(60):
                bent = bytearray(good)
                for _ in range(dice.randrange(1, 6)):
                    bent[dice.randrange(len(bent))] = dice.randrange(256)
                attacks.append(bytes(bent))
            open_ones = []
            for attack in attacks:
                wire = shown.connect()
                try:
                    wire.sendall(attack)
                except OSError:
                    pass
                open_ones.append(wire)
                if len(open_ones) > 40:
                    open_ones.pop(0).close()
            for wire in open_ones:
                wire.close()
            for frame in (b"\x82\xff" + b"\x7f" + b"\xff" * 7 + b"\0\0\0\0", b"\x81\xfe\xff\xff\0\0\0\0" + b"a" * 70000, b"\xff" * 200, b"\x81\x05hello", dice.randbytes(500)):
                page = WebSocket(shown)
                self.assertEqual(page.status, 101)
                try:
                    page.wire.sendall(frame)
                except OSError:
                    pass
            page = WebSocket(shown)
            for line in ("film", "film x y", "film 0 0", "film 99999999999 640", "watch " + "9 " * 1000, "record on", "ping", "\0\0", "sleep" * 700):
                page.say(line)
            crowd = [shown.connect() for _ in range(300)]
            time.sleep(0.2)
            for wire in crowd:
                wire.close()
            self.assertEqual(shown.ask("/scene")[0], 200, f"seed {seed}")
            if not SANITIZED:
                self.assertLess(shown.memory_mb() - before, 30, f"seed {seed}")

    def test_it_ends_when_it_is_told_to(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            with Shown(MAREY, "view", "walk.marey", "--port", "0") as shown:
                page = WebSocket(shown)
                self.assertEqual(page.status, 101)
                began = time.monotonic()
                shown.process.send_signal(number)
                self.assertEqual(shown.process.wait(timeout=5), 0)
                self.assertLess(time.monotonic() - began, 4)  # at once, on a busy machine too

    def test_what_cannot_be_is_said_in_one_sentence(self):
        with Shown(MAREY, "view", "walk.marey", "--port", "0", "-q") as shown:
            taken = marey("view", "walk.marey", "--port", shown.port, code=1).stderr
            self.assertRegex(taken, rf"^marey: 127\.0\.0\.1 port {shown.port}: cannot listen there \(.*\); --port 0 takes one that is free\n$")
        (FOLDER / "noise.bin").write_bytes(bytes(range(256)) * 9)
        for arguments, code, words in (
            (["no_such.marey"], 1, "no_such.marey"),
            (["noise.bin"], 1, "noise.bin"),
            (["walk/rig.toml"], 1, "rig.toml"),
            (["walk.marey", "--film", "walk.marey"], 1, "holds no tracks in a picture"),
            (["walk.marey", "--listen", "nowhere"], 1, "no address to listen on"),
            (["walk.marey", "--port", "70000"], 2, "port"),
            (["walk.marey", "--size", "3"], 2, "size"),
        ):
            said = marey("view", *arguments, code=code).stderr
            self.assertIn(words, said)
            self.assertEqual(said.count("\n"), 1, said)

    def test_json_tells_the_address(self):
        process = subprocess.Popen([MAREY, "view", "walk.marey", "--port", "0", "--json"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=FOLDER)
        text = ""
        while not text.endswith("}\n"):
            text += process.stdout.readline()
        self.assertIn("token=", json.loads(text)["address"])
        process.terminate()
        process.communicate(timeout=5)
        self.assertEqual(process.returncode, 0)


class Edit(unittest.TestCase):
    def setUp(self):
        self.take = FOLDER / f"{self.id().split('.')[-1]}.marey"
        shutil.copy(FOLDER / "walk.marey", self.take)

    def shown(self, *options):
        return Shown(MAREY, "view", self.take, "--port", "0", "-q", *options)

    def answer(self, page, line):
        """What the page is told that asked, and the words before."""
        page.say(line)
        before = []
        while not (heard := page.hear()).split()[0] in ("done", "refused"):
            before.append(heard)
        return heard, before

    def test_an_edit_is_shown_and_is_in_the_take(self):
        with self.shown("--edit") as shown:
            self.assertTrue(shown.scene()["can_edit"])
            page, other = WebSocket(shown), WebSocket(shown)
            a, b = (track["id"] for track in shown.scene()["tracks"][:2])
            before = {track: shown.ask(f"/course?track={track}")[2] for track in (a, b)}
            self.assertEqual(json.loads(shown.ask("/edits")[2]), {"edits": [], "head": 0, "newest": 0})
            said, told = self.answer(page, f"edit 0 0 swap #{a} #{b} 0:149")
            self.assertEqual(said, "done")
            self.assertEqual({other.hear(), other.hear()}, {"scene", "edits"})
            self.assertEqual(shown.ask(f"/course?track={a}")[2], before[b])
            self.assertEqual([track["version"] for track in shown.scene()["tracks"][:3]], [1, 1, 0])
            history = json.loads(shown.ask("/edits")[2])
            listed = json.loads(marey("edit", self.take, "--list", "--json").stdout)
            self.assertEqual((history["head"], history["edits"]), (listed["head"], listed["edits"]))
            self.assertEqual(self.answer(page, "undo 1 1")[0], "done")
            self.assertEqual(shown.ask(f"/course?track={a}")[2], before[a])
            self.assertEqual(self.answer(page, "redo 0 1")[0], "done")
            self.assertEqual(self.answer(page, "go 1 1 0")[0], "done")

    def test_what_cannot_be_is_said_as_on_the_command_line(self):
        with self.shown("--edit") as shown:
            a, b = (track["id"] for track in shown.scene()["tracks"][:2])
            page = WebSocket(shown)
            for edit in (f"join #{a} #{b}", f"swap #{a} nobody", f"delete #{a} 5:100000", "jump"):
                said = marey("edit", self.take, edit, code=1).stderr
                self.assertEqual(f"marey: {self.answer(page, f'edit 0 0 {edit}')[0].removeprefix('refused ')}\n", said)
        self.assertEqual(json.loads(marey("edit", self.take, "--list", "--json").stdout)["edits"], [])

    def test_an_edit_from_elsewhere_is_shown_and_kept(self):
        with self.shown("--edit") as shown:
            track = shown.scene()["tracks"][0]["id"]
            page = WebSocket(shown)
            marey("edit", self.take, f"rename #{track} hip", "-q")
            self.assertEqual({page.hear(), page.hear()}, {"scene", "edits"})
            self.assertEqual(shown.scene()["tracks"][0]["label"], "hip")
            marey("edit", self.take, "rename hip thigh", "-q")
            said, _ = self.answer(page, "edit 1 1 rename hip knee")
            self.assertIn("another program has edited it meanwhile", said)
            self.assertEqual(shown.scene()["tracks"][0]["label"], "thigh")

    def test_without_being_asked_for_nothing_can_be_changed(self):
        before = self.take.read_bytes()
        with self.shown() as shown:
            self.assertFalse(shown.scene()["can_edit"])
            self.assertEqual(shown.ask("/edits")[0], 404)
            page = WebSocket(shown)
            for line in ("edit 0 0 filter all", "undo 0 0", "redo 0 0", "go 0 0 0"):
                self.assertIn("--edit", self.answer(page, line)[0])
        with self.shown("--edit") as shown:
            shown.scene()
            self.assertEqual(shown.ask("/edits", token=False)[0], 401)
            self.assertEqual(shown.ask("/edits", Origin="http://evil.example")[0], 403)
            self.assertEqual(shown.ask("/edits", method="POST")[0], 405)
        self.assertEqual(self.take.read_bytes(), before)
        marey("convert", "walk.marey", "view_edit.csv", "-q")
        said = marey("view", "view_edit.csv", "--edit", code=1).stderr
        self.assertIn("is no take, and only a take can be edited", said)
        self.assertEqual(said.count("\n"), 1)

    def test_lines_of_strangers_change_nothing(self):
        seed = random.randrange(1 << 32)
        dice = random.Random(seed)
        with self.shown("--edit") as shown:
            shown.scene()
            before = shown.memory_mb()
            page = WebSocket(shown)
            good = ["edit 0 0 swap a b 1:2", "edit 0 0 fill nobody 1:2 rigid longest=1 within=5", "go 0 0 5", "undo 0 0", "edit 0 0 split nobody 7 \"x y\""]
            lines = ["edit", "edit 0", "edit 0 0", "edit 0 0 ", "edit -1 0 x", "undo", "go 0 0 99999999999999999999", "edit 0 0 " + "," * 4000, "edit 0 0 rename " + '"' * 4001,
                     "edit 0 0 delete " + "a," * 2000, "edit 0 0 swap \0 \x1b 1:2", "edit 0 0 filter nobody 1e999", "edit 0 0 fill nobody longest=nan"]
            for _ in range(200):
                bent = list(dice.choice(good))
                for _ in range(dice.randrange(1, 5)):
                    bent[dice.randrange(5, len(bent))] = chr(dice.randrange(1, 0x2FF))
                lines.append("".join(bent))
            for line in lines:
                said, _ = self.answer(page, line) if line.split(" ")[0] in ("edit", "undo", "redo", "go") else ("refused", [])
                stays = line.split() == ["go", "0", "0", "0"]  # bent into the one line that is no stranger's: the head goes where it is
                self.assertEqual(said.split(" ")[0].rstrip(":"), "done" if stays else "refused", f"{line!r}: {said!r}, seed {seed}")
                self.assertNotRegex(said, r"[\x00-\x1f]", f"{line!r}, seed {seed}")
            self.assertEqual(json.loads(shown.ask("/edits")[2])["edits"], [])
            if not SANITIZED:
                self.assertLess(shown.memory_mb() - before, 30, f"seed {seed}")


class Live(unittest.TestCase):
    def test_a_page_gets_what_it_asks_for_and_the_newest(self):
        with Shown(LIVE_SCENE, "walk.marey", "100") as shown:
            self.assertEqual(shown.scene()["kind"], "live")
            page = WebSocket(shown)
            page.say("watch 0 160 2 64")
            page.say("ping 7")
            kinds, texts, cameras = {}, set(), {}
            states = []
            begin = time.monotonic()
            while (passed := time.monotonic() - begin) < 2 or (kinds.get(2, 0) <= 60 and passed < 60):
                heard = page.hear()
                if isinstance(heard, str):
                    texts.add(heard.split()[0])
                    continue
                kinds[heard[0]] = kinds.get(heard[0], 0) + 1
                if heard[0] == 2:
                    states.append(Stretch(heard))
                else:
                    camera, points, boxes, size = struct.unpack_from("<IIII", heard, 24)
                    cameras[camera] = heard[40 + 12 * points + 20 * boxes :]
            self.assertGreaterEqual(texts, {"status", "recording", "pong"})
            self.assertEqual(cameras.keys(), {0, 2})
            self.assertTrue(all(jpeg.startswith(b"\xff\xd8") and jpeg.endswith(b"\xff\xd9") for jpeg in cameras.values()))
            self.assertGreater(len(cameras[0]), len(cameras[2]))
            self.assertGreater(kinds[2], 60)
            self.assertLess(kinds[3], 25 * passed)
            self.assertTrue(all(a.sequence < b.sequence for a, b in zip(states, states[1:])))
            page.say("sleep")
            page.wire.settimeout(1.5)
            asleep = 0
            end = time.monotonic() + 2
            try:
                while time.monotonic() < end:
                    heard = page.hear()
                    asleep += isinstance(heard, bytes)
            except TimeoutError:
                pass
            self.assertLess(asleep, 20)  # what was on its way

    def test_the_record_button_reaches_the_run(self):
        with Shown(LIVE_SCENE, "walk.marey", "50") as shown:
            page = WebSocket(shown)
            for word in ("on", "off"):
                page.say(f"record {word}")
                self.assertEqual(shown.process.stdout.readline().strip(), f"record {word}")
                while not (isinstance(heard := page.hear(), str) and heard.startswith(f"recording {word}")):
                    pass

    def test_a_page_that_stops_reading_costs_nobody_anything(self):
        with Shown(LIVE_SCENE, "walk.marey", "100") as shown:
            pages = [WebSocket(shown) for _ in range(3)]
            stalled, *others = pages
            for page in pages:
                page.say("watch 0 320 1 320 2 320 3 320")
            stalled.wire.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
            for page in others:
                for _ in range(50):
                    page.hear()
            before = shown.memory_mb()
            counts, late, last = [0, 0], [], [time.monotonic()] * 2
            begin = time.monotonic()
            while (passed := time.monotonic() - begin) < 6 or (min(counts) <= 200 and passed < 60):
                for i, page in enumerate(others):
                    if isinstance(heard := page.hear(), bytes) and heard[0] == 2:
                        counts[i] += 1
                        late.append(time.monotonic() - last[i])
                        last[i] = time.monotonic()
            self.assertGreater(min(counts), 200)
            if not SANITIZED:
                self.assertLess(shown.memory_mb() - before, 16)
            shown.process.stdin.close()
            figures = shown.process.stdout.read()
            print(figures.strip(), "others' longest silence", f"{1000 * max(late):.0f} ms")
            self.assertGreater(int(re.search(r"dropped (\d+)", figures)[1]), 0)  # the stalled page's


def main():
    global MAREY, LIVE_SCENE, FOLDER
    MAREY, LIVE_SCENE = (str(pathlib.Path(path).resolve()) for path in (sys.argv.pop(1), sys.argv.pop(1)))
    FOLDER = pathlib.Path(tempfile.mkdtemp(prefix="marey_view_"))
    try:
        marey("simulate", "room", "--motion", "walk", "--cameras", "4", "--markers", "20", "--frames", "150", "--size", "320", "240", "-o", "walk", "-q")
        marey("reconstruct", "walk/rig.toml", "--observations", "walk/observations.csv", "--labels", "walk/labels.csv", "-o", "walk.marey", "-q")
        unittest.main()
    finally:
        shutil.rmtree(FOLDER)


if __name__ == "__main__":
    main()
