"""Ctrl-C, SIGTERM and SIGHUP while `marey` waits or works: it ends within a second, with one sentence and exit code 130, and leaves
whole files or none.

Usage: stopping_test.py MAREY [unittest options]
"""

import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

MAREY = ""
UPPER_LIMIT = 1.0  # s from the signal to the end, or on a machine that does other things too, s of processor time
SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)

RIG = """[[camera]]
name = "left"
size = [640, 480]
rate = 25

[[camera]]
name = "right"
size = [640, 480]
rate = 25
"""


def default_signals():
    """What a test's parent ignores, as a shell's background job does, is not ignored here."""
    for number in SIGNALS:
        signal.signal(number, signal.SIG_DFL)


def catches(process, number):
    """Whether the process has a handler for the signal by now."""
    status = pathlib.Path(f"/proc/{process.pid}/status").read_text()
    caught = next((line for line in status.splitlines() if line.startswith("SigCgt:")), "SigCgt: 0")
    return int(caught.split()[1], 16) >> (number - 1) & 1 == 1


def processor_time(process):
    """s that it took so far."""
    fields = pathlib.Path(f"/proc/{process.pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def is_idle(process, seconds=0.5):
    """Whether the process waits: it takes no processor time for this long."""
    before = processor_time(process)
    time.sleep(seconds)
    return processor_time(process) == before


class OverTooSoon(Exception):
    """There was nothing left to stop."""


class Stopping(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="marey_stop_"))
        self.addCleanup(shutil.rmtree, self.folder)
        self.pipe = self.folder / "pipe"
        os.mkfifo(self.pipe)
        (self.folder / "rig.toml").write_text(RIG)

    def files(self):
        return sorted(path.name for path in self.folder.rglob("*"))

    def stopped(self, *arguments, number=signal.SIGINT, after=0.5, stdin=subprocess.DEVNULL, ready=None):
        """What it said on standard error, once it was sent the signal, `after` s after it was `ready` for it."""
        return self.outputs_when_stopped(*arguments, number=number, after=after, stdin=stdin, ready=ready)[1]

    def outputs_when_stopped(self, *arguments, number=signal.SIGINT, after=0.5, stdin=subprocess.DEVNULL, ready=None):
        """What it wrote on standard output and on standard error."""
        run = subprocess.Popen([MAREY, *map(str, arguments)], cwd=self.folder, stdin=stdin, stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE, text=True, preexec_fn=default_signals)
        end = time.monotonic() + 60
        while run.poll() is None and time.monotonic() < end and not (catches(run, number) and (ready is None or ready(run))):
            time.sleep(0.01)
        time.sleep(after)
        if run.poll() is not None:
            raise OverTooSoon(f"{arguments}\n{run.communicate()[1]}")
        begin, used = time.monotonic(), processor_time(run)
        run.send_signal(number)
        took, needed = self.wait_for(run, arguments)
        written, said = run.stdout.read(), run.stderr.read()
        run.stderr.close(), run.stdout.close()
        self.assertEqual(run.returncode, 130, f"{arguments}\n{said}")
        self.assertLess(min(took - begin, needed - used), UPPER_LIMIT, arguments)
        return written, said

    def wait_for(self, run, arguments):
        """When it ended, and what it took in all, s."""
        deadline = time.monotonic() + 60
        while time.monotonic() < deadline:
            pid, status, used = os.wait4(run.pid, os.WNOHANG)
            if pid == run.pid:
                run.returncode = os.waitstatus_to_exitcode(status)
                return time.monotonic(), used.ru_utime + used.ru_stime
            time.sleep(0.01)
        run.kill()
        run.wait()
        self.fail(f"{arguments}: did not end")

    def leaves_nothing(self, *arguments, **how):
        before = self.files()
        said = self.stopped(*arguments, **how)
        self.assertEqual(self.files(), before, arguments)
        self.assertEqual(len(said.strip().splitlines()), 1, said)
        self.assertIn("stopped", said)

    def leaves_nothing_in_mid_work(self, *arguments):
        """After 0.4 s, or sooner on a machine that is done by then."""
        before, after = self.files(), 0.4
        while True:
            try:
                return self.leaves_nothing(*arguments, after=after)
            except OverTooSoon:
                if after < 0.01:
                    raise
                after /= 2
                for name in set(self.files()) - set(before):
                    (self.folder / name).unlink()

    def test_every_command_that_waits_for_a_pipe(self):
        out = ("-o", "out.csv")
        for number, arguments in enumerate((
                ("track", self.pipe, *out),
                ("track", self.pipe, *out, "--live"),
                ("track", "--detections", self.pipe, *out),
                ("track", self.pipe, "--targets", "markers", *out),
                ("track", "rig.toml", f"left={self.pipe}", f"right={self.pipe}", "--ground", *out),
                ("reconstruct", "rig.toml", "--observations", self.pipe, "-o", "out.marey"),
                ("reconstruct", "rig.toml", f"left={self.pipe}", "-o", "out.c3d"),
                ("calibrate", "wand", "rig.toml", "--observations", self.pipe, "--wand", "led", "-o", "out.toml"),
                ("calibrate", "ground", "rig.toml", "--observations", self.pipe, "-o", "out.toml"),
                ("calibrate", "lens", self.pipe, "--board", "chess:9x6:0.025", "-o", "out.toml"),
                ("calibrate", "board", "rig.toml", f"left={self.pipe}", f"right={self.pipe}", "--board", "chess:9x6:0.025",
                 "-o", "out.toml"),
                ("calibrate", "pitch", "rig.toml", "--points", f"left={self.pipe}", "--points", f"right={self.pipe}", "-o", "out.toml"),
                ("measure", self.pipe, *out),
                ("evaluate", "--truth", self.pipe, "--tracks", self.pipe))):
            with self.subTest(arguments=arguments):
                self.leaves_nothing(*arguments, number=SIGNALS[number % len(SIGNALS)])

    def test_every_signal(self):
        for number in SIGNALS:
            self.leaves_nothing("track", self.pipe, "-o", "out.csv", number=number, after=0.3)

    def test_silent_standard_input(self):
        read, write = os.pipe()
        self.addCleanup(os.close, write)
        for arguments in (("track", "--detections", "-", "-o", "out.csv"), ("measure", "-", "-o", "out.csv"),
                          ("track", "--detections", "/dev/stdin", "-o", "out.csv")):
            with self.subTest(arguments=arguments):
                self.leaves_nothing(*arguments, stdin=read, after=0.3)
        os.close(read)

    def test_a_video_on_a_pipe_that_stalls_keeps_what_was_tracked(self):
        subprocess.run([MAREY, "simulate", "people", "--frames", "100", "--size", "320", "240", "--height", "60", "-o",
                        self.folder / "people", "-q"], check=True, timeout=120)
        subprocess.run(["ffmpeg", "-v", "error", "-i", self.folder / "people/video.mp4", "-c", "copy", self.folder / "film.mkv"],
                       check=True)
        shutil.rmtree(self.folder / "people")
        data = (self.folder / "film.mkv").read_bytes()
        for more in ((), ("--live",)):
            writer = None

            def fed(run):
                nonlocal writer
                if writer is None:
                    writer = os.open(self.pipe, os.O_WRONLY)
                    os.write(writer, data[: len(data) * 9 // 10])
                return is_idle(run)

            written, said = self.outputs_when_stopped("track", self.pipe, "-o", "out.csv", "--json", *more, ready=fed, after=0)
            os.close(writer)
            self.assertIn("what was tracked until then is written", said)
            self.assertEqual(self.files(), ["film.mkv", "out.csv", "pipe", "rig.toml"], said)
            summary = json.loads(written)
            self.assertTrue(summary["interrupted"])
            self.assertTrue(50 < summary["frames"] < 100, summary)
            rows = (self.folder / "out.csv").read_text().splitlines()[1:]
            self.assertEqual(len(rows), summary["rows"])
            self.assertGreater(len(rows), 0)
            os.remove(self.folder / "out.csv")

    def test_simulations_that_are_stopped_leave_no_half_files(self):
        for arguments in (("simulate", "room", "--frames", "100000000", "-o", "made"),
                          ("simulate", "people", "--frames", "1000000", "-o", "made"),
                          ("simulate", "match", "--seconds", "86400", "-o", "made"),
                          ("simulate", "markers", "plain", "--frames", "20000", "--markers", "30", "-o", "made")):
            with self.subTest(arguments=arguments):
                said = self.stopped(*arguments, ready=lambda run: list(self.folder.glob("made/*.part")), after=0.5)
                self.assertEqual(list(self.folder.glob("made/*")), [], said)
                shutil.rmtree(self.folder / "made")

    def test_long_work_on_files(self):
        rows = "frame,time,id,label,x,y,z\n" + "".join(
            f"{f},{f / 100:.6f},{m},M{m},{0.1 * m},{f % 1000 / 64},1.5\n" for f in range(60_000) for m in range(1, 31))
        (self.folder / "walk.csv").write_text(rows)
        self.leaves_nothing_in_mid_work("convert", "walk.csv", "walk.c3d")
        boxes = "".join(f"{f},{m},{10 * m},{f % 500},20,50,1,-1,-1,-1\n" for f in range(1, 20_000) for m in range(1, 40))
        (self.folder / "boxes.txt").write_text(boxes)
        self.leaves_nothing_in_mid_work("evaluate", "--truth", "boxes.txt", "--tracks", "boxes.txt")
        ground = "frame,time,id,x,y\n" + "".join(
            f"{f},{f / 25:.3f},{m},{m},{f % 500 / 10}\n" for f in range(40_000) for m in range(1, 31))
        (self.folder / "ground.csv").write_text(ground)
        self.leaves_nothing_in_mid_work("measure", "ground.csv", "-o", "measured.csv")


if __name__ == "__main__":
    MAREY = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main()
