"""`marey live` and `marey cameras`: cameras that are simulated, played, on a network and absent; recording; how it ends.

Usage: live_cameras_test.py MAREY [unittest options]. What needs ffmpeg or Aravis's fake camera is omitted where that is not installed.
How fast it is belongs to bench/live; here nothing fails because the machine is busy.
"""
import contextlib
import functools
import http.server
import json
import os
import pathlib
import pty
import select
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
import unittest

MAREY = ""
ROOM = "sim://room?cameras=4&rate=30&markers=20&blobs"


RTSP_SERVER = """
import sys
import gi
gi.require_version("Gst", "1.0")
gi.require_version("GstRtspServer", "1.0")
from gi.repository import GLib, Gst, GstRtspServer
Gst.init(None)
server = GstRtspServer.RTSPServer()
server.set_address("127.0.0.1")
server.set_service(sys.argv[1])
factory = GstRtspServer.RTSPMediaFactory()
factory.set_launch("( videotestsrc is-live=1 ! video/x-raw,width=320,height=240,framerate=25/1 ! "
                   "x264enc tune=zerolatency bframes=0 key-int-max=25 ! rtph264pay name=pay0 )")
factory.set_shared(True)
server.get_mount_points().add_factory("/left", factory)
server.attach(None)
print("ready", flush=True)
GLib.MainLoop().run()
"""


class JpegCamera(http.server.BaseHTTPRequestHandler):
    """What many network cameras do: one JPEG after the other, without end."""
    jpegs = []

    def do_GET(self):
        self.send_response(200)
        self.send_header("Content-Type", "multipart/x-mixed-replace; boundary=frame")
        self.end_headers()
        with contextlib.suppress(OSError):
            for number in range(1_000_000):
                picture = self.jpegs[number % len(self.jpegs)]
                self.wfile.write(b"--l-frame\r\nContent-Type: image/jpeg\r\nContent-Length: %d\r\n\r\n" % len(picture) + picture + b"\r\n")
                time.sleep(0.04)

    def log_message(self, *_):
        pass


class LiveCameras(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="marey_live_"))
        self.addCleanup(shutil.rmtree, self.folder)

    def marey(self, *arguments, code=0, within=None):
        done = subprocess.run([*(within or []), MAREY, *map(str, arguments)], capture_output=True, text=True, cwd=self.folder, timeout=120)
        self.assertEqual(done.returncode, code, f"{arguments}\n{done.stdout}\n{done.stderr}")
        return done

    def live(self, *arguments, **more):
        return json.loads(self.marey("live", *arguments, "--json", "-q", **more).stdout)

    def test_markers_of_a_simulated_room_are_tracked_and_recorded(self):
        told = self.live(ROOM, "--duration", 2, "-o", "take.marey")
        self.assertEqual(told["job"], "markers in space")
        self.assertGreater(told["instants"], 15)
        self.assertGreaterEqual(told["targets"], 10)
        self.assertEqual(sorted(told["cameras"]), ["cam1", "cam2", "cam3", "cam4"])
        self.assertIn("capture to instant", told["stages"])
        info = json.loads(self.marey("info", "take.marey", "--json").stdout)
        self.assertTrue(info)
        self.assertEqual(told["take"], "take.marey")

    def test_every_frame_is_used_or_counted(self):
        told = self.live(ROOM, "--duration", 2)
        dropped = told["dropped"]
        for name, camera in told["cameras"].items():
            self.assertEqual(camera["lost"] + camera["damaged"], 0, name)
            # What came is in an instant, or waited when it ended, or was dropped.
            gone = dropped["superseded"] + dropped["incomplete"] + dropped["late_frames"] + camera["overrun"]
            self.assertLessEqual(abs(camera["frames"] - (told["instants"] - camera["missed"]) - gone), 4 + dropped["late_frames"], name)

    def test_a_camera_that_goes_away_costs_only_itself_and_comes_back(self):
        done = self.marey("live", ROOM + "&away=2,1,2", "--duration", 4, "--json")
        told = json.loads(done.stdout)
        self.assertEqual(told["cameras"]["cam2"]["connections"], 2)
        self.assertEqual(told["cameras"]["cam1"]["connections"], 1)
        self.assertIn('camera "cam2" is stalled: sim://', done.stderr)
        self.assertIn('camera "cam2" is back', done.stderr)
        self.assertEqual(told["cameras"]["cam2"]["state"], "live")

    def test_a_camera_that_is_not_there_is_inspected_for(self):
        done = self.marey("live", "sim://room?cameras=1&rate=30", "v4l2:/dev/video63", "--duration", 1.5, "--connect-timeout", 0.3, "--json")
        told = json.loads(done.stdout)
        self.assertEqual(told["job"], "a preview")
        self.assertEqual(told["cameras"]["cam2"]["state"], "connecting")
        self.assertIn("no such camera now", done.stderr)
        self.assertGreater(told["cameras"]["cam1"]["frames"], 3)

    def test_without_any_camera_it_states_why(self):
        done = self.marey("live", "v4l2:/dev/video63", "--duration", 0.5, "--connect-timeout", 0.1, "-o", "take.marey", "--armed", code=1)
        self.assertIn("no camera gave a frame", done.stderr)
        self.assertIn("/dev/video63", done.stderr)
        self.assertFalse((self.folder / "take.marey").exists())

    def test_a_take_stays_where_the_next_run_observes_nothing(self):
        self.live(ROOM, "--duration", 1, "-o", "take.marey")
        before = (self.folder / "take.marey").read_bytes()
        for name in ("take.marey", "new.marey"):
            done = self.marey("live", "v4l2:/dev/video63", "--duration", 0.5, "--connect-timeout", 0.1, "-o", name, code=1)
            self.assertIn("no camera gave a frame", done.stderr)
        self.assertEqual((self.folder / "take.marey").read_bytes(), before)
        self.assertFalse((self.folder / "new.marey").exists())

    def test_a_full_disk_ends_the_take_and_nothing_else(self):
        disk = self.folder / "disk"
        disk.mkdir()
        mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=300k", "tmpfs", disk], capture_output=True, text=True)
        if mounted.returncode != 0:
            self.skipTest(f"a small disk cannot be made here: {mounted.stderr.strip()}")
        self.addCleanup(subprocess.run, ["umount", disk], check=True)
        done = self.marey("live", "sim://room?cameras=4&rate=60&markers=40&blobs", "--duration", 8, "-o", "disk/take.marey", "--json", "-q", code=1)
        told = json.loads(done.stdout)
        said = "disk/take.marey: cannot be written, the disk is full; what was written before is kept"
        self.assertIn(said, told["warnings"])
        self.assertEqual(done.stderr.count(said), 1)
        self.assertGreater(told["seconds"], 6)
        kept = json.loads(self.marey("info", "disk/take.marey", "--json").stdout)
        self.assertTrue(0 < kept["frames"] < told["instants"], kept)

    def test_real_time_is_requested_for(self):
        run = subprocess.Popen([MAREY, "live", ROOM, "--duration", "20", "--realtime-priority", "-q"], stderr=subprocess.PIPE, text=True, cwd=self.folder)
        self.addCleanup(run.stderr.close)
        time.sleep(2)
        policies = [os.sched_getscheduler(int(task.name)) for task in pathlib.Path(f"/proc/{run.pid}/task").iterdir()]
        run.send_signal(signal.SIGINT)
        said = run.communicate(timeout=30)[1]
        if "marey: warning: --realtime-priority was refused (" not in said:
            self.assertGreater(policies.count(os.SCHED_RR), 4, policies)  # the run, and its cameras
        refused = subprocess.run(["setpriv", "--reuid", "65534", "--clear-groups", "--inh-caps=-all", "--bounding-set=-all", MAREY, "live", ROOM, "--duration", "0.5", "--realtime-priority", "-q"],
                                 capture_output=True, text=True, timeout=60)
        if os.geteuid() == 0 and "Permission denied" not in refused.stderr:
            self.assertEqual(refused.returncode, 0, refused.stderr)
            self.assertIn("--realtime-priority was refused (Operation not permitted); it continues at the typical priority", refused.stderr)

    def test_the_images_are_kept_to_do_it_again(self):
        room = "sim://room?cameras=3&rate=15&markers=20&size=320x240&drawn=1"
        told = self.live(room, "--duration", 4, "-o", "walk.marey", "--record", "video")
        pictures = self.folder / "walk_video"
        self.assertEqual(sorted(path.name for path in pictures.iterdir()), ["cam1.mp4", "cam2.mp4", "cam3.mp4", "rig.toml"])
        again = json.loads(self.marey("reconstruct", "walk_video/rig.toml", "-o", "again.marey", "--json", "-q").stdout)
        self.assertGreater(told["instants"], 5)
        self.assertLessEqual(abs(again["frames"] - told["instants"]), 3)
        live, anew = (json.loads(self.marey("info", take, "--json").stdout) for take in ("walk.marey", "again.marey"))
        self.assertGreater(live["observations"], 50)
        self.assertLess(abs(live["observations"] - anew["observations"]), 0.1 * live["observations"])
        self.live(room, "--duration", 0.5, "-o", "none.marey", "--record", "video", "--armed")
        self.assertFalse((self.folder / "none_pictures").exists())
        self.assertIn("--record video: name the take with -o", self.marey("live", room, "--record", "video", code=2).stderr)
        (self.folder / "file_video").write_text("a file")
        self.assertIn("file_video", self.marey("live", room, "--duration", 0.5, "-o", "file.marey", "--record", "video", code=1).stderr)

    def test_images_drawn_beforehand_take_little_memory(self):
        room = "sim://room?cameras=8&rate=240&markers=8&size=1280x1024&drawn=2"  # 5 GB of images
        with open(self.folder / "said.txt", "w+") as said:
            run = subprocess.Popen([MAREY, "live", room, "--duration", "0.5", "-q"], cwd=self.folder, stderr=said)
            _, status, used = os.wait4(run.pid, 0)
            run.returncode = os.waitstatus_to_exitcode(status)
            self.assertEqual(run.returncode, 0, (self.folder / "said.txt").read_text())
        self.assertLess(used.ru_maxrss, 500_000, "kB")

    def test_what_is_played_is_not_recorded_over(self):
        self.live("sim://room?cameras=2&rate=15&markers=20&size=320x240&drawn=1", "--duration", 1, "-o", "walk.marey", "--record", "video")
        pictures = self.folder / "walk_video"
        before = {path.name: path.read_bytes() for path in pictures.iterdir()}
        for played in (["walk_video/rig.toml"], ["cam1=walk_video/cam1.mp4"], ["play:walk_video/cam1.mp4?loop"],
                       ["./walk_video/../walk_video/cam1.mp4"]):
            said = self.marey("live", *played, "-o", "walk.marey", "--record", "video", "--duration", 0.5, code=2).stderr
            self.assertIn("is an input too", said)
            self.assertEqual({path.name: path.read_bytes() for path in pictures.iterdir()}, before, played)
        taken = (self.folder / "walk.marey").read_bytes()
        self.assertIn("is an input too", self.marey("live", "play:walk.marey", "-o", "walk.marey", "--duration", 0.5, code=2).stderr)
        self.assertEqual((self.folder / "walk.marey").read_bytes(), taken)
        self.marey("live", "walk_video/rig.toml", "-o", "again.marey", "--record", "video", "--duration", 0.5, "-q")
        self.assertEqual({path.name: path.read_bytes() for path in pictures.iterdir()}, before)

    def test_a_take_is_played_as_its_cameras(self):
        self.marey("simulate", "room", "-o", "room", "--cameras", 4, "--markers", 20, "--frames", 100, "--rate", 50, "--size", 640, 480, "-q")
        self.marey("reconstruct", "room/rig.toml", "--observations", "room/observations.csv", "-o", "walk.marey", "-q")
        begin = time.monotonic()
        told = self.live("play:walk.marey", "-o", "again.marey")
        self.assertGreater(time.monotonic() - begin, 1.9)  # s, as long as it is
        self.assertEqual(told["job"], "markers in space")
        cameras = told["cameras"]
        self.assertEqual(sorted(cameras), ["cam1", "cam2", "cam3", "cam4"])
        self.assertEqual({camera["state"] for camera in cameras.values()}, {"ended"})
        self.assertEqual({camera["frames"] + camera["lost"] for camera in cameras.values()}, {100})
        if told["instants"] == 100:  # nothing was dropped: what the live run made of videos and of the take is one thing
            self.marey("reconstruct", "room/rig.toml", "--observations", "room/observations.csv", "--live", "-o", "offline.marey", "-q")
            infos = [json.loads(self.marey("info", take, "--json").stdout) for take in ("again.marey", "offline.marey")]
            self.assertEqual(*(info["observations"] for info in infos))
            self.assertEqual(*(len(info["tracks"]) for info in infos))
        looped = self.live("play:walk.marey?loop", "--duration", 4)
        self.assertGreater(min(camera["frames"] for camera in looped["cameras"].values()), 110)
        alone = self.live("play:walk.marey?camera=2", "--duration", 1)
        self.assertEqual(alone["job"], "markers in an image")
        for name, said in (("play:walk.marey?camera=5", "has 4 cameras"), ("play:none.marey", "none.marey"), ("play:walk.marey?rate=5", "no option")):
            self.assertIn(said, self.marey("live", name, "--duration", 0.5, code=1).stderr)

    def test_a_video_is_played_in_real_time_and_ends(self):
        self.marey("simulate", "people", "-o", "film", "--frames", 30, "--size", 192, 144, "-q")
        begin = time.monotonic()
        told = self.live("film/video.mp4", "--targets", "people")
        self.assertGreater(time.monotonic() - begin, 1.0, "30 frames of 25 Hz")
        self.assertEqual(told["job"], "people in an image")
        self.assertEqual(told["cameras"]["cam1"]["state"], "ended")
        self.assertEqual(told["cameras"]["cam1"]["frames"] + told["cameras"]["cam1"]["lost"], 30)
        looped = self.live("play:film/video.mp4?loop", "--targets", "people", "--duration", 5)
        self.assertGreater(looped["cameras"]["cam1"]["frames"] + looped["cameras"]["cam1"]["lost"], 35)

    def test_a_rig_names_its_cameras(self):
        self.marey("simulate", "room", "-o", "room", "--cameras", 3, "--frames", 5, "-q")
        rig = (self.folder / "room/rig.toml").read_text()
        for number in (1, 2, 3):
            source = f'name = "cam{number}"\nsource = "sim://room?cameras=3&rate=30&markers=20&blobs&size=1280x1024&camera={number}"'
            rig = rig.replace(f'name = "cam{number}"', source)
        rig = "\n".join(line if not line.startswith("rate") else "rate = 30.0" for line in rig.splitlines())
        (self.folder / "room/live.toml").write_text(rig)
        told = self.live("room/live.toml", "--duration", 2)
        self.assertEqual(told["job"], "markers in space")
        self.assertGreater(told["targets"], 0)
        told = self.live("room/live.toml", "cam2=sim://room?cameras=3&rate=30&blobs&size=1280x1024&camera=1", "--duration", 1)
        self.assertEqual(len(told["cameras"]), 3)
        self.assertIn("run marey live", self.marey("reconstruct", "room/live.toml", "-o", "x.marey", code=1).stderr)
        wrong = self.marey("live", "room/live.toml", "cam2=sim://room?cameras=3&rate=30&size=640x480&camera=1", "--duration", 1, code=1)
        self.assertIn("cam2", wrong.stderr)

    def test_a_rate_that_is_not_the_cameras_own_is_warned_of(self):
        self.marey("simulate", "room", "-o", "room", "--cameras", 2, "--frames", 5, "-q")
        rig = (self.folder / "room/rig.toml").read_text()
        for number in (1, 2):
            source = f'name = "cam{number}"\nsource = "sim://room?cameras=2&rate=20&markers=5&blobs&size=1280x1024&camera={number}"'
            rig = rig.replace(f'name = "cam{number}"', source)
        for rate, warned in ((40, True), (20, False)):
            lines = [line if not line.startswith("rate") else f"rate = {rate}" for line in rig.splitlines()]
            (self.folder / "room/live.toml").write_text("\n".join(lines))
            said = self.marey("live", "room/live.toml", "--duration", 1).stderr
            for number in (1, 2):
                words = f'camera "cam{number}": the rig says rate = {rate}, the camera 20 frames per second'
                (self.assertIn if warned else self.assertNotIn)(words, said)
            if warned:
                self.assertIn("set rate = 20 in the rig, or remove it", said)
                self.assertLess(said.index("the rig says rate"), said.index("instants in"), "at the beginning, not after hours")

    def test_ctrl_c_ends_it_whole(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            with subprocess.Popen([MAREY, "live", ROOM, "-o", "take.marey", "--json", "-q"], cwd=self.folder, stdout=subprocess.PIPE,
                                  stderr=subprocess.PIPE, text=True) as running:
                end = time.monotonic() + 60  # on a busy machine it begins late
                while not (self.folder / "take.marey").exists() and time.monotonic() < end:
                    time.sleep(0.05)
                time.sleep(2)
                running.send_signal(number)
                told, problems = running.communicate(timeout=30)
            self.assertEqual(running.returncode, 0, problems)
            self.assertGreater(json.loads(told)["instants"], 5)
            self.marey("info", "take.marey")
            (self.folder / "take.marey").unlink()

    def test_keys_record_and_end_on_a_terminal(self):
        here, there = pty.openpty()
        running = subprocess.Popen([MAREY, "live", ROOM, "-o", "take.marey", "--armed", "--preroll", "0.5"], cwd=self.folder, stdin=there,
                                   stdout=there, stderr=there, start_new_session=True, preexec_fn=functools.partial(take_terminal, there))
        os.close(there)
        said = b""
        plan = [(0.5, b"r"), (2.0, b"q")]  # s after its first line
        begin, end = None, time.monotonic() + 60
        while time.monotonic() < end:
            if begin is None and b"targets |" in said:
                begin = time.monotonic()
            if begin is not None and plan and time.monotonic() - begin > plan[0][0]:
                os.write(here, plan.pop(0)[1])
            ready, _, _ = select.select([here], [], [], 0.1)
            try:
                said += os.read(here, 65536) if ready else b""
            except OSError:
                break  # it has ended
        self.assertEqual(running.wait(30), 0, said.decode(errors="replace"))
        os.close(here)
        self.assertIn(b"REC", said)
        self.assertIn(b"targets | dropped", said)
        info = self.marey("info", "take.marey").stdout
        self.assertIn("frames", info)

    def test_a_take_that_cannot_be_written_is_reported(self):
        self.assertIn("nowhere", self.marey("live", ROOM, "-o", "nowhere/take.marey", "--duration", 1, code=1).stderr)
        self.marey("live", ROOM, "-o", "take.c3d", code=2)
        self.marey("live", ROOM, "--armed", code=2)
        self.marey("live", code=2)

    def test_names_that_mean_nothing_are_refused(self):
        for name, word in (("sim://space", "room, people"), ("sim://room?cameras=900", "whole number"), ("sim://room?colour=red", "no option"),
                           ("node:/left", "node"), ("play:missing.mp4", "no such file"), ("missing.mp4", "no such file"),
                           ("v4l2:/dev/video0?format=H264", "H264"), ("http://", "names no host")):
            self.assertIn(word, self.marey("live", name, "--duration", 1, code=1).stderr, name)

    def test_cameras_lists_and_writes_no_empty_rig(self):
        told = json.loads(self.marey("cameras", "--json").stdout)
        if told["cameras"]:
            self.skipTest("cameras are plugged in here")
        self.assertIn("no camera", self.marey("cameras", "-o", "rig.toml", code=1).stderr)
        self.assertFalse((self.folder / "rig.toml").exists())

    def test_a_network_camera_comes_and_goes(self):
        if shutil.which("ffmpeg") is None:
            self.skipTest("ffmpeg is not here")
        subprocess.run(["ffmpeg", "-v", "error", "-f", "lavfi", "-i", "testsrc=size=160x120:rate=25", "-frames:v", "10", "picture%02d.jpg"],
                       cwd=self.folder, check=True)
        JpegCamera.jpegs = [path.read_bytes() for path in sorted(self.folder.glob("picture*.jpg"))]
        server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), JpegCamera)
        server.daemon_threads = True
        port = server.server_address[1]
        threading.Thread(target=server.serve_forever, daemon=True).start()
        told = self.live(f"http://eve:secret@127.0.0.1:{port}/left", "--targets", "people", "--duration", 3, "-o", "take.marey")
        server.shutdown()
        server.server_close()
        self.assertGreater(told["cameras"]["cam1"]["frames"], 20)
        self.assertNotIn("secret", json.dumps(told))
        self.assertFalse(b"secret" in (self.folder / "take.marey").read_bytes(), "a take holds no password")
        gone = self.marey("live", f"http://eve:secret@127.0.0.1:{port}/left", "--duration", 1, code=1)
        self.assertIn("cannot be reached", gone.stderr)
        self.assertNotIn("secret", gone.stderr)

    def test_an_rtsp_camera_that_is_restarted_comes_back(self):
        """A server of GStreamer's, ended and started again while it is watched."""
        def server():
            started = subprocess.Popen(["/usr/bin/python3", "-c", RTSP_SERVER, str(port)], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
            if started.stdout.readline() != "ready\n":
                started.kill()
                started.communicate()
                self.skipTest("GStreamer's RTSP server is not here (gir1.2-gst-rtsp-server-1.0, python3-gi, gstreamer1.0-plugins-ugly)")
            return started

        with contextlib.closing(socket.socket()) as some:
            some.bind(("127.0.0.1", 0))
            port = some.getsockname()[1]
        running = server()
        with subprocess.Popen([MAREY, "live", f"rtsp://127.0.0.1:{port}/left", "--targets", "people", "--duration", "14", "--json"], cwd=self.folder,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as live:
            time.sleep(6)
            running.kill()
            running.communicate()
            time.sleep(1.5)
            running = server()
            told, said = live.communicate(timeout=60)
        running.kill()
        running.communicate()
        self.assertEqual(live.returncode, 0, said)
        camera = json.loads(told)["cameras"]["cam1"]
        self.assertGreaterEqual(camera["connections"], 2, said)
        self.assertGreater(camera["frames"], 30, said)
        self.assertIn('camera "cam1" is back', said)

    def test_fake_machine_vision_cameras(self):
        """Two of Aravis's fake cameras in a network of their own: found, streamed, every frame counted."""
        if shutil.which("arv-fake-gv-camera-0.8") is None or "gige:" not in self.marey("live", "--help").stdout:
            self.skipTest("Aravis or its fake camera is not here")
        script = self.folder / "run.sh"
        script.write_text(f"""ip link set lo up && ip addr add 127.0.0.2/8 dev lo || exit 77
arv-fake-gv-camera-0.8 -i 127.0.0.1 -s LEFT & one=$!
arv-fake-gv-camera-0.8 -i 127.0.0.2 -s RIGHT & two=$!
sleep 2
{MAREY} cameras --json -o rig.toml > found.json
{MAREY} live gige:LEFT gige:RIGHT --duration 4 --json -q > live.json
code=$?
kill $one $two
exit $code
""")
        done = subprocess.run(["unshare", "-rn", "bash", "run.sh"], cwd=self.folder, capture_output=True, text=True, timeout=120)
        if done.returncode == 77 or "unshare" in done.stderr:
            self.skipTest(f"no network namespace here: {done.stderr}")
        self.assertEqual(done.returncode, 0, done.stderr)
        found = json.loads((self.folder / "found.json").read_text())["cameras"]
        self.assertEqual(sorted(camera["source"] for camera in found), ["gige:LEFT", "gige:RIGHT"])
        self.assertIn('source = "gige:LEFT"', (self.folder / "rig.toml").read_text())
        told = json.loads((self.folder / "live.json").read_text())
        for name, camera in told["cameras"].items():
            self.assertGreater(camera["frames"], 5, name)
            self.assertEqual(camera["connections"], 1, name)


def take_terminal(file):
    """The terminal's keys and signals are for the program that runs on it."""
    import fcntl
    import termios
    fcntl.ioctl(file, termios.TIOCSCTTY, 0)


if __name__ == "__main__":
    MAREY = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main()
