"""Every command while the outside world fails: the disk at any write, memory, standard output, signals at any instant, the clock.

Never a crash, never half a file at its final name, never exit 0 with something lost.

Usage: faults_test.py MAREY SHIM [--runs N] [--signals N] [--seed N]
  --runs     commands with a failing disk, little memory, a closed pipe or a jumping clock (60)
  --signals  commands for each of INT, TERM, HUP and KILL (4)
"""

import argparse
import collections
import math
import os
import pathlib
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time

SECONDS = 120
SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGKILL)

# name, arguments, what it writes (a folder counts with all that is in it)
COMMANDS = (
    ("track video", "track plain/video.mp4 --targets markers -o out/t.txt", ["out/t.txt"]),
    ("track take", "track plain/video.mp4 --targets markers -o out/t.marey", ["out/t.marey"]),
    ("track overlay", "track plain/video.mp4 --targets markers -o out/t.csv --overlay out/t.mp4 --plot out/t.svg", ["out/t.csv", "out/t.mp4", "out/t.svg"]),
    ("track detections", "track --detections boxes.txt --rate 25 -o out/t.jsonl --json", ["out/t.jsonl"]),
    ("track ground", "track match/rig.toml --ground -o out/t.csv", ["out/t.csv"]),
    ("measure", "measure places.csv -o out/m.csv --report out/report --json", ["out/m.csv", "out/report"]),
    ("reconstruct", "reconstruct floor/rig.toml --observations floor/blobs.csv -o out/r.marey", ["out/r.marey"]),
    ("reconstruct c3d", "reconstruct floor/rig.toml --observations floor/blobs.csv -o out/r.c3d", ["out/r.c3d"]),
    ("convert take", "convert points.csv out/p.marey", ["out/p.marey"]),
    ("convert c3d", "convert points.csv out/p.c3d --json", ["out/p.c3d"]),
    ("convert trc", "convert points.csv out/p.trc", ["out/p.trc"]),
    ("convert csv", "convert take.marey out/p.csv", ["out/p.csv"]),
    ("convert metrica", "convert places.csv out/p_home.csv", ["out/p_home.csv", "out/p_away.csv"]),
    ("convert epts", "convert places.csv out/p.xml", ["out/p.xml", "out/p.txt"]),
    ("convert tracab", "convert places.csv out/p.dat", ["out/p.dat", "out/p.xml"]),
    ("convert rig", "convert floor/rig.toml out/r.yml", ["out/r.yml"]),
    ("convert qualisys", "convert floor/rig.toml out/r.qca.txt", ["out/r.qca.txt"]),
    ("simulate markers", "simulate markers plain --frames 12 -o out/plain", ["out/plain"]),
    ("simulate people", "simulate people --frames 5 --size 96 72 --height 20 -o out/people", ["out/people"]),
    ("simulate room", "simulate room --motion ground --frames 10 --cameras 3 -o out/room", ["out/room"]),
    ("simulate match", "simulate match --seconds 1 --cameras 2 -o out/match", ["out/match"]),
    ("calibrate ground", "calibrate ground floor/rig.toml --observations floor/observations.csv -o out/r.toml", ["out/r.toml"]),
    ("evaluate", "evaluate --truth boxes_truth.txt --tracks boxes_truth.txt --json", []),
    ("info", "info take.marey --json", []),
    ("edit", "edit out/e.marey --script edits.txt --json", ["out/e.marey"]),
    ("body define", "body define leg.csv --markers T1,T2,T3 --name thigh -o out/b.toml", ["out/b.toml"]),
    ("body track", "body track leg.csv bodies.toml -o out/f.marey", ["out/f.marey"]),
    ("label learn", "label learn leg.csv -o out/set.toml --json", ["out/set.toml"]),
    ("label", "label leg.csv --marker-set set.toml -o out/l.c3d", ["out/l.c3d"]),
    ("solve", "solve leg.csv --skeleton leg.toml -o out/s.mot -o out/s.bvh -o out/s.glb --write-skeleton out/s.toml --json",
     ["out/s.mot", "out/s.bvh", "out/s.glb", "out/s.toml"]),
    ("gait", "gait walk.c3d --static-trial standing.c3d -o out/c.csv --angles out/a.csv --report out/g.html", ["out/c.csv", "out/a.csv", "out/g.html"]),
    ("batch plan", "batch plan table.csv --job measure -o out/plan.tsv --json", ["out/plan.tsv"]),
    ("batch run", "batch run out/plan.tsv", ["out/plan.tsv.results/places.csv"]),
    ("batch reduce", "batch reduce done/plan.tsv -o out/r.csv --report out/page", ["out/r.csv", "out/page"]),
    ("play", "play points.csv --speed 100 --stream osc -q", []),
    ("completion", "completion --manual out/pages", ["out/pages"]),
)
# What a command changes, or wants beside its output: made again before each run.
BEFOREHAND = {"out/e.marey": "take.marey", "out/plan.tsv": "plan.tsv"}
LEG = """name = "leg"
[[segment]]
name = "thigh"
[[segment]]
name = "shank"
parent = "thigh"
at = [0, 0, -0.42]
joint = "hinge"
axes = ["y"]
coordinates = ["knee"]
"""
LEG_MARKERS = {"T1": ("thigh", (0.1, 0, -0.1)), "T2": ("thigh", (0, 0.12, -0.2)), "T3": ("thigh", (-0.08, 0, -0.35)),
               "S1": ("shank", (0.05, 0, -0.1)), "S2": ("shank", (0, 0.05, -0.3)), "S3": ("shank", (-0.06, 0, -0.2))}
GAIT = {"walk.c3d": "straight_HC002D06.c3d", "standing.c3d": "static_HC002D02.c3d"}  # of MAREY_DATA; without it `gait` is omitted


def content(folder, outputs):
    """The bytes of each output that is there, by name; of a folder each file in it."""
    found = {}
    for name in outputs:
        path = folder / name
        for file in sorted(path.rglob("*")) if path.is_dir() else [path]:
            if file.is_file():
                found[str(file.relative_to(folder))] = file.read_bytes()
    return found


def frames_of(video):
    """The decoded frames of a video's bytes, as hashes; empty if it cannot be decoded."""
    with tempfile.NamedTemporaryFile(suffix=".mp4") as file:
        file.write(video)
        file.flush()
        done = subprocess.run(["ffmpeg", "-v", "error", "-nostdin", "-i", file.name, "-f", "framemd5", "-"], capture_output=True)
        return [line.split(b",")[-1] for line in done.stdout.splitlines() if not line.startswith(b"#")] if done.returncode == 0 else []


def without_fragments(there, whole):
    """The outputs, and for a video of the same frames the bytes of `whole`: without room for a second file it stays as it was written (draw/mp4_file.h)."""
    def of(key, data):
        same = key.endswith(".mp4") and data != whole.get(key, data) and frames_of(data) and frames_of(data) == frames_of(whole[key])
        return whole[key] if same else data
    return {key: of(key, data) for key, data in there.items()}


def without_speed(text):
    """What a command prints, but for how fast it was."""
    return re.sub(rb'"(elapsed|frames_per_second)": *[-+0-9.e]+', b"", text)


class Faults:
    def __init__(self, marey, shim, seed, commands=COMMANDS):
        self.marey, self.shim, self.random = marey, shim, random.Random(seed)
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="marey_faults_"))
        self.found, self.counts = [], collections.Counter()
        self.make_inputs()
        self.commands = [self.reference(*each) for each in self.runnable(commands)]

    def runnable(self, commands):
        """The commands without those whose input is missing, with a message for each."""
        missing = [name for name in GAIT if not (self.folder / name).exists()]
        if missing and any(command[0] == "gait" for command in commands):
            print(f"gait is skipped: {', '.join(GAIT[name] for name in missing)} not found; MAREY_DATA sets the folder of the test data")
            return [command for command in commands if command[0] != "gait"]
        return list(commands)

    def make_inputs(self):
        def write(name, text):
            (self.folder / name).write_text(text)

        for arguments in ("simulate markers plain --frames 12 -o plain", "simulate room --motion ground --frames 20 --cameras 5 -o floor",
                          "simulate match --seconds 1 --cameras 2 -o match"):
            self.plain(arguments)
        write("places.csv", "frame,time,id,team,x,y\n" + "".join(
            f"{f},{f / 25:.2f},{i},{'ab'[i % 2]},{10 + i + 0.2 * f:.2f},{20 + i}\n" for f in range(100) for i in (1, 2, 3)))
        write("boxes.txt", "".join(f"{f},-1,{10 + 3 * f},50,20,50,0.9,-1,-1,-1\n" for f in range(1, 61)))
        write("boxes_truth.txt", "".join(f"{f},1,{10 + 3 * f},50,20,50,1\n" for f in range(1, 61)))
        write("points.csv", "frame,time,label,x,y,z\n" + "".join(
            f"{i},{i / 100:.2f},{m},{i / 100 + k:.3f},0,1\n" for i in range(300) for k, m in enumerate("abc")))
        self.plain("convert points.csv take.marey")
        write("edits.txt", "rename a knee\nswap knee b 20:29\nfilter c 6\n")
        write("leg.toml", LEG + "".join(f'[[marker]]\nname = "{name}"\non = "{on}"\nat = {list(at)}\n' for name, (on, at) in LEG_MARKERS.items()))
        write("leg.csv", "frame,time,label,x,y,z\n" + "".join(self.leg_row(f, *each) for f in range(120) for each in LEG_MARKERS.items()))
        self.plain("body define leg.csv --markers T1,T2,T3 --name thigh -o bodies.toml")
        self.plain("label learn leg.csv -o set.toml")
        write("table.csv", "input\nplaces.csv\n")
        for folder in ("done", "out"):
            (self.folder / folder).mkdir()
            self.plain(f"batch plan table.csv --job measure -o {folder}/plan.tsv")
        self.plain("batch run done/plan.tsv")
        shutil.move(self.folder / "out/plan.tsv", self.folder / "plan.tsv")
        data = pathlib.Path(os.environ.get("MAREY_DATA", pathlib.Path(__file__).resolve().parents[3] / "shared/data")) / "gait_children/HC002D"
        for name, source in GAIT.items():
            if (data / source).exists():
                shutil.copy(data / source, self.folder / name)

    @staticmethod
    def leg_row(frame, name, where):
        """The marker at that frame: the leg walks on, and the knee bends."""
        on, (x, y, z) = where
        bent = 0.3 + 0.3 * math.sin(frame / 15) if on == "shank" else 0
        x, z = x * math.cos(bent) + z * math.sin(bent), z * math.cos(bent) - x * math.sin(bent) - (0.42 if on == "shank" else 0)
        return f"{frame},{frame / 100:.2f},{name},{x + frame / 100:.6f},{y:.6f},{z + 1:.6f}\n"

    def plain(self, arguments):
        done = subprocess.run([self.marey, *arguments.split(), "-q"], cwd=self.folder, capture_output=True, timeout=SECONDS)
        if done.returncode != 0:
            sys.exit(f"faults: {arguments}: {done.stderr.decode()}")

    def reference(self, name, arguments, outputs):
        """What the command writes, and how many calls to files it makes, where nothing fails. Twice: it must be the same."""
        wholes = []
        for _ in range(2):
            done = self.run(arguments, {"FAULT_COUNT": str(self.folder / "calls")})
            if done.returncode != 0:
                sys.exit(f"faults: {name}: {done.stderr.decode()}")
            wholes.append((content(self.folder, outputs), without_speed(done.stdout)))
        if wholes[0] != wholes[1]:
            differ = [key for key in wholes[0][0] if wholes[0][0][key] != wholes[1][0].get(key)]
            self.found.append(f"{name}: other bytes the second time: {differ or 'standard output'}")
        return name, arguments, outputs, wholes[0], int((self.folder / "calls").read_text())

    def run(self, arguments, environment=None, megabytes=None, stop=None, closed=False):
        shutil.rmtree(self.folder / "out", ignore_errors=True)
        (self.folder / "out").mkdir()
        for place, source in BEFOREHAND.items():
            if place in arguments.split() and f"-o {place}" not in arguments:
                shutil.copy2(self.folder / source, self.folder / place)
        variables = dict(os.environ, **(environment or {}))
        if environment:
            variables["LD_PRELOAD"] = str(self.shim)

        def prepare():
            signal.signal(signal.SIGPIPE, signal.SIG_DFL)
            resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
            if megabytes:
                resource.setrlimit(resource.RLIMIT_AS, (megabytes << 20, megabytes << 20))

        pipe = None
        if closed:
            reading, pipe = os.pipe()
            os.close(reading)
        process = subprocess.Popen([self.marey, *arguments.split()], cwd=self.folder, stdin=subprocess.DEVNULL, stdout=pipe or subprocess.PIPE,
                                   stderr=subprocess.PIPE, env=variables, preexec_fn=prepare)
        if pipe:
            os.close(pipe)
        if stop:
            time.sleep(stop[1])
            process.send_signal(stop[0])
        try:
            out, err = process.communicate(timeout=SECONDS)
        except subprocess.TimeoutExpired:
            process.kill()
            out, err = process.communicate()
            err += b"\nHUNG"
        return subprocess.CompletedProcess(arguments, process.returncode, out, err)

    def check(self, command, what, done, killed=(), may_leave_parts=False):
        name, _, outputs, (whole, said), _ = command
        problem = None
        there = without_fragments(content(self.folder, outputs), whole)
        err = done.stderr.decode(errors="replace")
        if "HUNG" in err:
            problem = "hangs"
        elif done.returncode < 0 and -done.returncode not in killed:
            problem = f"ends by signal {-done.returncode}"
        elif "terminate called" in err or "AddressSanitizer" in err:
            problem = "crashes"
        elif done.returncode == 0 and there != whole:
            problem = f"exit 0, and lost: {[key for key in whole if there.get(key) != whole[key]]}"
        elif done.returncode == 0 and done.stdout is not None and without_speed(done.stdout) != said:
            problem = "exit 0, and standard output is another"
        elif done.returncode > 0 and not killed and not err.strip():
            problem = f"exit {done.returncode} without a word"
        elif done.returncode != 130 and "until then" not in err:  # what was known until then is written, and that is said
            problem = self.half_file(outputs, there, whole)
        left = [str(path.relative_to(self.folder)) for path in (self.folder / "out").rglob("*") if ".part" in path.name or "-journal" in path.name]
        if not problem and left and not may_leave_parts:
            problem = f"leaves {left}"
        self.counts[what] += 1
        if problem:
            self.found.append(f"{name}, {what}: {problem}\n    {err.strip()[-300:]}")

    def half_file(self, outputs, there, whole):
        """A file that is neither missing nor what it is to be. A take is whole up to where it was stopped."""
        for name, bytes_there in there.items():
            if ".part" in name or name not in whole or bytes_there == whole[name] or name.endswith((".marey-wal", ".marey-shm")):
                continue
            if name.endswith(".marey"):
                done = subprocess.run([self.marey, "info", name], cwd=self.folder, capture_output=True, timeout=SECONDS)
                if done.returncode == 0 or b"nothing" in done.stderr or b"not a take" not in done.stderr and done.returncode == 1:
                    continue
            return f"half of {name} is at its final name ({len(bytes_there)} of {len(whole[name])} bytes)"
        return None

    # --- faults ---

    def failing_disk(self, command):
        calls = command[4]
        if calls == 0:
            return self.closed_pipe(command)
        environment = {"FAULT_AT": str(self.random.randint(1, calls))}
        if self.random.random() < 0.6:
            environment["FAULT_STAYS"] = "1"
        if self.random.random() < 0.3:
            environment["FAULT_SHORT"] = "1"
        what = "failing disk"
        self.check(command, what, self.run(command[1], environment), may_leave_parts=True)
        if self.found and self.found[-1].startswith(f"{command[0]}, {what}"):
            self.found[-1] += f"\n    {environment}, {calls} calls"

    def little_memory(self, command):
        self.check(command, "little memory", self.run(command[1], megabytes=self.random.choice((200, 400, 600, 800, 1000, 1200, 1600))))

    def closed_pipe(self, command):
        done = self.run(command[1], closed=True)
        if done.returncode == 0 and command[3][1]:
            self.found.append(f"{command[0]}, closed pipe: exit 0, and its standard output is lost")
        self.check(command, "closed pipe", done, killed=(signal.SIGPIPE,))

    def jumping_clock(self, command):
        done = self.run(command[1], {"FAULT_CLOCK": "1"})
        self.check(command, "jumping clock", done)
        if done.returncode != 0:
            self.found.append(f"{command[0]}, jumping clock: exit {done.returncode}: {done.stderr.decode()[-300:]}")

    def stopped(self, command, which):
        began = time.monotonic()
        self.run(command[1])
        length = time.monotonic() - began
        done = self.run(command[1], stop=(which, self.random.uniform(0, length)))
        self.check(command, which.name, done, killed=(which,), may_leave_parts=which == signal.SIGKILL)

    def campaign(self, runs, signals):
        ways = [self.failing_disk] * 6 + [self.little_memory, self.closed_pipe, self.jumping_clock]
        for run in range(runs):
            self.random.choice(ways)(self.commands[run % len(self.commands)])
        for which in SIGNALS:
            # What a batch began ends an instant after the batch was killed: in the next run's time.
            stopped = [each for each in self.commands if which != signal.SIGKILL or each[0] != "batch run"]
            for _ in range(signals):
                self.stopped(self.random.choice(stopped), which)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("marey")
    parser.add_argument("shim")
    parser.add_argument("--runs", type=int, default=60)
    parser.add_argument("--signals", type=int, default=4)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    faults = Faults(os.path.abspath(options.marey), os.path.abspath(options.shim), options.seed)
    faults.campaign(options.runs, options.signals)
    shutil.rmtree(faults.folder)
    for what, count in sorted(faults.counts.items()):
        print(f"{count:5} {what}")
    for problem in faults.found:
        print("FOUND " + problem)
    print(f"{sum(faults.counts.values())} runs, {len(faults.found)} found (seed {options.seed})")
    return 1 if faults.found else 0


if __name__ == "__main__":
    sys.exit(main())
