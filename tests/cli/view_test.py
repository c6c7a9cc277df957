"""`marey view` and the live viewer without a browser: what is served, to whom, and what untrusted clients and slow readers can do. view_test.py MAREY LIVE_SCENE."""

import contextlib
import json
import pathlib
import random
import re
import shutil
import signal
import socket
import sqlite3
import struct
import subprocess
import sys
import time
import unittest

import shown_page
from shown_page import Shown, TimeChunk, WebSocket, marey

LIVE_SCENE = ""


def rows_of(text):
    return [line.split(",") for line in text.splitlines()[1:]]


class View(unittest.TestCase):
    def test_what_is_served_is_what_is_in_the_file(self):
        marey("convert", "walk.marey", "walk.csv", "-q")
        wanted = {}
        for frame, _, track, _, x, *_ in rows_of((shown_page.FOLDER / "walk.csv").read_text()):
            wanted[int(frame), int(track)] = float(x)
        with Shown(shown_page.MAREY, "view", "walk.marey", "--port", "0") as shown:
            scene = shown.scene()
            self.assertEqual((scene["frame"], scene["name"], scene["instants"], len(scene["cameras"])), ("space", "walk.marey", 150, 4))
            self.assertEqual(len(scene["cameras"][0]["corners"]), 4)
            found = {}
            for number in range(len(scene["chunks"])):
                stretch = TimeChunk(shown.request(f"/stretch?n={number}")[2])
                self.assertEqual(stretch.kind, 1)
                row = 0
                for index, end in zip(stretch.index, stretch.row_end):
                    for row in range(row, end):
                        found[index, stretch.track[row]] = stretch.x[row]
                    row = end
            self.assertEqual(found.keys(), wanted.keys())
            self.assertLess(max(abs(found[key] - wanted[key]) for key in wanted), 1e-5)
            track = scene["tracks"][3]
            course = shown.request(f"/course?track={track['id']}")[2]
            self.assertEqual(struct.unpack_from("<I", course, 24)[0], track["rows"])
            self.assertEqual(track["rows"], sum(1 for _, id in wanted if id == track["id"]))
            for path in ("/stretch?n=99", "/stretch?n=-1", "/stretch?n=x", "/stretch", "/course?track=", "/../../etc/passwd", "//", "/page.js/x"):
                self.assertEqual(shown.request(path)[0], 404, path)
            for path, kind in (("/", "text/html"), ("/page.js", "text/javascript"), ("/page.css", "text/css")):
                status, headers, body = shown.request(path)
                self.assertEqual((status, headers["content-type"].split(";")[0]), (200, kind))
                self.assertGreater(len(body), 1000)
                self.assertIn("frame-ancestors 'none'", headers["content-security-policy"])
                self.assertEqual(shown.request(path, method="HEAD")[2], b"")

    def test_every_kind_of_recording(self):
        marey("convert", "walk.marey", "walk.c3d", "-q")
        marey("convert", "walk.marey", "walk.trc", "-q")
        (shown_page.FOLDER / "boxes.txt").write_text("".join(f"{i},1,{100 + 3 * i},80,30,90,1,-1,-1,-1\n" for i in range(1, 80)))
        (shown_page.FOLDER / "ground.csv").write_text("frame,id,x,y,team\n" + "".join(f"{i},{p},{5 * p},{3 * p},red\n" for i in range(20) for p in range(1, 21)))
        for file, frame in (("walk.c3d", "space"), ("walk.trc", "space"), ("boxes.txt", "image"), ("ground.csv", "ground")):
            with self.subTest(file), Shown(shown_page.MAREY, "view", file, "--port", "0", "-q") as shown:
                scene = shown.scene()
                self.assertEqual(scene["frame"], frame)
                self.assertGreater(scene["instants"], 10)
                if frame == "ground":
                    self.assertEqual(scene["pitch"], {"length": 105.0, "width": 68.0, "x": 0.0, "y": 0.0})

    def test_only_identify_has_the_token_and_queries_this_machine_may_inspect(self):
        with Shown(shown_page.MAREY, "view", "walk.marey", "--port", "0", "-q") as shown:
            for path in ("/", "/scene", "/page.js", "/stretch?n=0"):
                self.assertEqual(shown.request(path, token=False)[0], 401, path)
                self.assertEqual(shown.request(path, Host="evil.example")[0], 403, path)
                self.assertEqual(shown.request(path, Host=None)[0], 403, path)
                self.assertEqual(shown.request(path, Origin="http://evil.example")[0], 403, path)
                self.assertEqual(shown.request(path, method="POST")[0], 405, path)
                self.assertNotIn("access-control-allow-origin", shown.request(path)[1])
            status, headers, _ = shown.request(f"/?token={shown.token}", token=False)
            self.assertEqual(status, 200)
            self.assertEqual(headers["set-cookie"], f"marey_{shown.port}={shown.token}; Path=/; HttpOnly; SameSite=Strict")
            self.assertEqual(shown.request("/scene", token=False, Cookie=headers["set-cookie"].split(";")[0])[0], 200)
            self.assertEqual(WebSocket(shown).status, 101)
            self.assertEqual(WebSocket(shown, Origin="http://evil.example").status, 403)
            self.assertEqual(WebSocket(shown, Host="evil.example", Origin="http://evil.example").status, 403)
            self.assertEqual(WebSocket(shown, Cookie="marey=1").status, 401)
            self.assertEqual(WebSocket(shown, Origin="").status, 403)

    def test_bytes_of_untrusted_cost_nothing(self):
        seed = random.randrange(1 << 32)
        dice = random.Random(seed)
        with Shown(shown_page.MAREY, "view", "walk.marey", "--port", "0", "-q") as shown:
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
            for line in ("film", "video x y", "video 0 0", "film 0 640", "video 99999999999 640", "watch " + "9 " * 1000, "record on", "ping", "\0\0", "sleep" * 700):
                page.send(line)
            crowd = [shown.connect() for _ in range(300)]
            time.sleep(0.2)
            for wire in crowd:
                wire.close()
            self.assertEqual(shown.request("/scene")[0], 200, f"seed {seed}")
            if not shown_page.SANITIZED:
                self.assertLess(shown.memory_mb() - before, 30, f"seed {seed}")

    def test_it_ends_when_it_is_reported_to(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            with Shown(shown_page.MAREY, "view", "walk.marey", "--port", "0") as shown:
                page = WebSocket(shown)
                self.assertEqual(page.status, 101)
                began = time.monotonic()
                shown.process.send_signal(number)
                self.assertEqual(shown.process.wait(timeout=5), 0)
                self.assertLess(time.monotonic() - began, 4)  # at once, on a busy machine too

    def test_a_take_of_another_version_is_reported(self):
        later = shown_page.FOLDER / "later.marey"
        shutil.copy(shown_page.FOLDER / "walk.marey", later)
        with contextlib.closing(sqlite3.connect(later)) as take:
            take.execute("pragma user_version = 99")
            take.commit()
        self.assertRegex(marey("view", "later.marey", "--port", "0", code=1).stderr, r"^marey: later.marey: was written by a later version of Marey .*\n$")

    def test_the_axis_that_a_c3d_file_states_is_up(self):
        marey("convert", "walk.marey", "y_up.c3d", "--up", "y", "-q")
        marey("convert", "walk.marey", "z_up.c3d", "-q")
        extents = []
        for words in (("z_up.c3d",), ("y_up.c3d",), ("y_up.c3d", "--up", "z")):
            with Shown(shown_page.MAREY, "view", *words, "--port", "0", "-q") as shown:
                scene = shown.scene()
                extents.append((scene["low"], scene["high"]))
                self.assertEqual(any("its y is taken for up" in warning for warning in scene["warnings"]), words == ("y_up.c3d",), scene["warnings"])
        for one, other in zip(extents[0], extents[1]):
            for a, b in zip(one, other):
                self.assertAlmostEqual(a, b, places=3)
        self.assertAlmostEqual(extents[2][1][1], extents[0][1][2], places=3)

    def test_what_cannot_be_is_stated_in_one_message(self):
        with Shown(shown_page.MAREY, "view", "walk.marey", "--port", "0", "-q") as shown:
            taken = marey("view", "walk.marey", "--port", shown.port, code=1).stderr
            self.assertRegex(taken, rf"^marey: 127\.0\.0\.1 port {shown.port}: cannot listen there \(.*\); --port 0 takes one that is free\n$")
        (shown_page.FOLDER / "noise.bin").write_bytes(bytes(range(256)) * 9)
        for arguments, code, words in (
            (["no_such.marey"], 1, "no_such.marey"),
            (["noise.bin"], 1, "noise.bin"),
            (["walk/rig.toml"], 1, "rig.toml"),
            (["walk.marey", "--video", "walk.marey"], 1, "holds no tracks in an image"),
            (["walk.marey", "--listen", "nowhere"], 1, "not an address to listen on"),
            (["walk.marey", "--port", "70000"], 2, "port"),
            (["walk.marey", "--size", "3"], 2, "size"),
        ):
            said = marey("view", *arguments, code=code).stderr
            self.assertIn(words, said)
            self.assertEqual(said.count("\n"), 1, said)

    def test_json_reports_the_address(self):
        process = subprocess.Popen([shown_page.MAREY, "view", "walk.marey", "--port", "0", "--json"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=shown_page.FOLDER)
        text = ""
        while not text.endswith("}\n"):
            text += process.stdout.readline()
        self.assertIn("token=", json.loads(text)["address"])
        process.terminate()
        process.communicate(timeout=5)
        self.assertEqual(process.returncode, 0)


class Live(unittest.TestCase):
    def test_a_page_gets_what_it_queries_for_and_the_newest(self):
        with Shown(LIVE_SCENE, "walk.marey", "100") as shown:
            self.assertEqual(shown.scene()["kind"], "live")
            page = WebSocket(shown)
            page.send("watch 0 160 2 64")
            page.send("ping 7")
            kinds, texts, cameras = {}, set(), {}
            states = []
            begin = time.monotonic()
            while (passed := time.monotonic() - begin) < 2 or (kinds.get(2, 0) <= 60 and passed < 60):
                heard = page.receive()
                if isinstance(heard, str):
                    texts.add(heard.split()[0])
                    continue
                kinds[heard[0]] = kinds.get(heard[0], 0) + 1
                if heard[0] == 2:
                    states.append(TimeChunk(heard))
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
            page.send("sleep")
            page.wire.settimeout(1.5)
            asleep = 0
            end = time.monotonic() + 2
            try:
                while time.monotonic() < end:
                    heard = page.receive()
                    asleep += isinstance(heard, bytes)
            except TimeoutError:
                pass
            self.assertLess(asleep, 20)  # what was on its way

    def test_the_record_button_reaches_the_run(self):
        with Shown(LIVE_SCENE, "walk.marey", "50") as shown:
            page = WebSocket(shown)
            for word in ("on", "off"):
                page.send(f"record {word}")
                self.assertEqual(shown.process.stdout.readline().strip(), f"record {word}")
                while not (isinstance(heard := page.receive(), str) and heard.startswith(f"recording {word}")):
                    pass

    def test_a_page_that_stops_reading_costs_none_anything(self):
        with Shown(LIVE_SCENE, "walk.marey", "100") as shown:
            pages = [WebSocket(shown) for _ in range(3)]
            stalled, *others = pages
            for page in pages:
                page.send("watch 0 320 1 320 2 320 3 320")
            stalled.wire.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
            for page in others:
                for _ in range(50):
                    page.receive()
            before = shown.memory_mb()
            counts, late, last = [0, 0], [], [time.monotonic()] * 2
            begin = time.monotonic()
            while (passed := time.monotonic() - begin) < 6 or (min(counts) <= 200 and passed < 60):
                for i, page in enumerate(others):
                    if isinstance(heard := page.receive(), bytes) and heard[0] == 2:
                        counts[i] += 1
                        late.append(time.monotonic() - last[i])
                        last[i] = time.monotonic()
            self.assertGreater(min(counts), 200)
            if not shown_page.SANITIZED:
                self.assertLess(shown.memory_mb() - before, 16)
            shown.process.stdin.close()
            figures = shown.process.stdout.read()
            print(figures.strip(), "others' longest silence", f"{1000 * max(late):.0f} ms")
            self.assertGreater(int(re.search(r"dropped (\d+)", figures)[1]), 0)  # the stalled page's


if __name__ == "__main__":
    LIVE_SCENE = str(pathlib.Path(sys.argv.pop(2)).resolve())
    shown_page.run_tests()
