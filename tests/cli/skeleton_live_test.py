"""A skeleton while cameras observe: `--skeleton` of reconstruct, live and play.

Usage: skeleton_live_test.py MAREY ROOT [unittest options]; exits 77 (skipped) where the recordings (MAREY_DATA) are not here.
"""

import contextlib
import csv
import json
import socket
import struct
import subprocess
import time

import skeleton_recordings as recordings
from skeleton_recordings import OnRecordings, main


class SkeletonLive(OnRecordings):
    def room(self):
        """A simulated walker: what eight cameras saw of it, its names, its skeleton."""
        self.marey("simulate", "room", "--motion", "walk", "--markers", 50, "--frames", 240, "-o", "room", "-q")
        return ["room/rig.toml", "--observations", "room/observations.csv", "--labels", "room/labels.csv"]

    def poses(self, take):
        self.marey("convert", take, "poses.csv", "--format", "poses", "-q")
        with open(self.folder / "poses.csv", newline="") as file:
            return list(csv.reader(file))[1:]

    def test_with_every_instant_is_what_is_solved_afterwards(self):
        said = json.loads(self.marey("reconstruct", *self.room(), "--skeleton", "room/skeleton.toml", "--live", "-o", "live.marey", "--json").stdout)
        self.assertLess(said["skeleton"]["rms_mm"], 2)
        self.assertEqual(said["skeleton"]["initialisations"], 1)
        self.assertIn("skeleton", said["stages"])
        self.marey("solve", "live.marey", "--skeleton", "room/skeleton.toml", "-o", "after.marey", "-q")
        live, after = self.poses("live.marey"), self.poses("after.marey")
        self.assertGreater(len(live), 15 * 200)
        self.assertEqual(live, after[-len(live):])

    def test_bones_go_over_the_protocols_while_cameras_observe(self):
        self.marey("reconstruct", *self.room(), "-o", "walk.marey", "-q")
        with contextlib.ExitStack() as sockets:
            vmc = sockets.enter_context(socket.socket(socket.AF_INET, socket.SOCK_DGRAM))
            vmc.bind(("127.0.0.1", 0))
            vmc.settimeout(20)
            taken = [sockets.enter_context(socket.create_server(("127.0.0.1", 0))) for _ in range(2)]
            qtm, lines = (server.getsockname()[1] for server in taken)
            for server in taken:
                server.close()
            process = subprocess.Popen([recordings.MAREY, "live", "play:walk.marey?loop", "--skeleton", "room/skeleton.toml", "-o", "again.marey", "--json", "--duration", "4",
                                        "--stream", f"vmc:127.0.0.1:{vmc.getsockname()[1]}", "--stream", f"qtm::{qtm}", "--stream", f"json::{lines}"],
                                       cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
            self.addCleanup(process.kill)
            bones = set()
            while not {b"Hips", b"LeftUpperLeg", b"RightLowerArm"} <= bones:
                bones |= {bone for bone in (b"Hips", b"LeftUpperLeg", b"RightLowerArm") if b"/VMC/Ext/Bone/Pos" in (told := vmc.recv(65536)) and bone in told}
            told = sockets.enter_context(socket.create_connection(("127.0.0.1", lines), timeout=20)).makefile()
            header = json.loads(told.readline())
            self.assertEqual({body["skeleton"] for body in header["bodies"]}, {"body"})
            frames = [json.loads(told.readline()) for _ in range(20)]
            self.assertIn(15, [len(frame.get("bodies", [])) for frame in frames if frame["type"] == "frame"])
            client = sockets.enter_context(socket.create_connection(("127.0.0.1", qtm), timeout=20))
            for words in (b"Version 1.25\0", b"GetParameters Skeleton\0"):
                client.sendall(struct.pack("<II", 8 + len(words), 1) + words)
            heard = b""
            while b"</QTM_Parameters" not in heard:
                heard += client.recv(65536)
            self.assertIn(b'<Skeleton Name="body">', heard)
            self.assertIn(b"left_thigh", heard)
            told.close()
        out, errors = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 0, errors)
        self.assertEqual(json.loads(out)["job"], "markers in space")
        self.assertLess(json.loads(out)["skeleton"]["rms_mm"], 2)
        self.assertEqual({row[3] for row in self.poses("again.marey")} & {"pelvis", "left_foot"}, {"pelvis", "left_foot"})

    def test_a_recording_is_played_with_its_bones(self):
        self.marey("solve", "walk.c3d", "--static-trial", "standing.c3d", "--write-skeleton", "person.toml", "-o", "walk.marey", "-q")
        with contextlib.ExitStack() as sockets:
            server = sockets.enter_context(socket.create_server(("127.0.0.1", 0)))
            port = server.getsockname()[1]
            server.close()
            process = subprocess.Popen([recordings.MAREY, "play", "walk.c3d", "--skeleton", "person.toml", "--loop", "-q", "--stream", f"json::{port}"], cwd=self.folder)
            self.addCleanup(process.kill)
            for _ in range(200):
                with contextlib.suppress(OSError):
                    told = sockets.enter_context(socket.create_connection(("127.0.0.1", port), timeout=20)).makefile()
                    break
                time.sleep(0.05)
            said = [json.loads(told.readline()) for _ in range(30)]
            self.assertIn("left_shank", [body["label"] for body in said[0]["bodies"]])
            shown = {body["label"] for frame in said if frame["type"] == "frame" for body in frame["bodies"] if body["tracked"]}
            self.assertLessEqual({"pelvis", "left_thigh", "right_shank", "head"}, shown)
            told.close()
            process.terminate()
            process.wait(timeout=20)

    def test_without_names_there_is_no_pose(self):
        rig, *more = self.room()
        for arguments, words in ((("reconstruct", rig, *more[:2], "--skeleton", "room/skeleton.toml", "-o", "x.marey"), "--labels"),
                                 (("live", "sim://people", "--targets", "people", "--skeleton", "room/skeleton.toml", "--duration", "1"), "two calibrated cameras")):
            with self.subTest(words=words):
                said = self.marey(*arguments, "-q", code=1).stderr
                self.assertIn(words, said)
                self.assertEqual(said.count("\n"), 1, said)
        self.assertFalse((self.folder / "x.marey").exists())
        said = self.marey("reconstruct", rig, *more, "--skeleton", "other.toml", "-o", "x.marey", "-q", code=1)
        self.assertIn("other.toml", said.stderr)
        for arguments in (("reconstruct", rig, *more, "--skeleton", "figure.bvh", "-o", "x.marey"), ("play", "walk.trc", "--skeleton", "figure.bvh")):
            said = self.marey(*arguments, "-q").stderr
            self.assertIn("has no pose: none of its labels is a marker of the skeleton", said)


if __name__ == "__main__":
    main()
