#!/usr/bin/env python3
"""`marey batch` over many recordings: what it costs beside the tasks themselves, and whether the memory is said beforehand.

Usage: batch.py MAREY engines [--films 200] [--rounds 2] | finished [--tasks 10000] | memory   [--work FOLDER]

engines   a loop, GNU parallel and a real Slurm of two nodes of a core each (root; Debian's packages) over short simulated videos, against
          `marey track` of the same videos by xargs, as many at a time; "slurm 1000" makes each video a job of the array, "slurm" as many jobs as `submit` chooses. Wall, CPU (of all processes but Slurm's daemons), and the
          overhead a task: how much longer one of those at work is busy with it. All results are compared byte by byte.
finished  the second run of a plan whose tasks are all done: by `marey batch run`, each of them, on recordings that differ.
memory    what `plan` says of a task beside the peak of its resident memory, for each --job and for images of several sizes. None of
          these recordings is one that the figures in apps/cli/batch_costs.cpp were fitted to.
"""
import argparse
import contextlib
import csv
import ctypes
import filecmp
import os
import pathlib
import resource
import shutil
import struct
import subprocess
import sys
import tempfile
import time

sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent / "tests" / "cli"))
import slurm_nodes  # noqa: E402

DISTINCT = 4  # videos that are simulated; the others are these with other bytes behind their images


def run(words, **more):
    return subprocess.run([str(word) for word in words], check=True, stdout=subprocess.PIPE, text=True, **more).stdout


# ---- engines

def make_videos(marey, folder, count):
    """Each has bytes of its own: a box "free" at its end, which players pass over, holds its number."""
    folder.mkdir()
    for number in range(DISTINCT):
        run([marey, "simulate", "people", "--frames", 8, "--size", 160, 120, "--people", 2, "--height", 30, "--seed", number + 1, "-o", folder / "scene", "-q"])
        shutil.move(folder / "scene" / "video.mp4", folder / f"{number:05}.mp4")
        shutil.rmtree(folder / "scene")
    for number in range(DISTINCT, count):
        pictures = (folder / f"{number % DISTINCT:05}.mp4").read_bytes()
        (folder / f"{number:05}.mp4").write_bytes(pictures + struct.pack(">I4sQ", 16, b"free", number))


def cpu_of_children():
    """Of all that ended, also of what daemons left behind: they are given to this process (see `adopt`)."""
    with contextlib.suppress(ChildProcessError):
        while os.waitid(os.P_ALL, 0, os.WEXITED | os.WNOHANG | os.WNOWAIT) is not None:
            os.waitpid(-1, os.WNOHANG)
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def adopt():
    """Processes whose parent ends become children of this one."""
    PR_SET_CHILD_SUBREAPER = 36
    ctypes.CDLL(None).prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)


class Engines:
    """Ways to do the videos of a folder; each leaves its results in a folder."""

    def __init__(self, marey, work, slurm):
        self.marey, self.work, self.slurm = marey, work, slurm

    def bare(self, at_once, out):
        """The tasks alone, by xargs."""
        films = "".join(f"{film}\n" for film in sorted((self.work / "films").iterdir()))
        line = f'{self.marey} track "$1" -o {out}/$(basename "$1" .mp4).csv -q --threads 1'
        run(["xargs", "-P", at_once, "-I", "{}", "sh", "-c", line, "sh", "{}"], input=films)

    def planned(self, how, out):
        plan = self.work / f"{how.replace(' ', '_')}.tsv"
        run([self.marey, "batch", "plan", self.work / "films", "-o", plan, "-q"])
        began, used = time.monotonic(), cpu_of_children()
        if how == "loop":
            run([self.marey, "batch", "run", plan, "-q", "--task-threads", 1])
        elif how == "parallel":
            line = run([self.marey, "batch", "submit", plan, "--engine", "parallel", "--dry-run"]).strip()
            pathlib.Path(f"{plan}.results").mkdir()
            run(["sh", "-c", line.replace("parallel ", "parallel --max-jobs 2 ", 1)], stderr=subprocess.DEVNULL)
        else:
            jobs = ["--max-jobs", how.partition(" ")[2]] if " " in how else []
            run([self.marey, "batch", "submit", plan, "--engine", "slurm", *jobs, "-q"], env=self.slurm.environment)
            self.slurm.wait_until_empty(1200)
        took = time.monotonic() - began, cpu_of_children() - used
        for result in pathlib.Path(f"{plan}.results").glob("*.csv"):
            result.rename(out / result.name)
        shutil.rmtree(f"{plan}.results")
        return took

    def timed(self, how, out):
        if not how.startswith("bare"):
            return self.planned(how, out)
        began, used = time.monotonic(), cpu_of_children()
        self.bare(int(how.split()[1]), out)
        return time.monotonic() - began, cpu_of_children() - used


def same_bytes(folder, other):
    names = sorted(path.name for path in folder.iterdir())
    same, different, missing = filecmp.cmpfiles(folder, other, names, shallow=False)
    return not different and not missing and len(names) == len(list(other.iterdir()))


def engines(marey, work, films, rounds):
    adopt()
    make_videos(marey, work / "films", films)
    ways = {"bare 1": 1, "loop": 1, "bare 2": 2, "parallel": 2, "slurm": 2, "slurm 1000": 2}
    best = dict.fromkeys(ways, (float("inf"), float("inf")))
    equal = dict.fromkeys(ways, True)
    with slurm_nodes.SlurmNodes(cpus=1) if slurm_nodes.available() else contextlib.nullcontext() as slurm:
        if slurm is None:
            del ways["slurm"], ways["slurm 1000"]
        if shutil.which("parallel") is None:
            del ways["parallel"]
        ways_of = Engines(marey, work, slurm)
        for _ in range(rounds):
            for how in ways:
                out = work / f"out {how}".replace(" ", "_")
                out.mkdir()
                took = ways_of.timed(how, out)
                print(f"{how}: {took[0]:.1f} s wall, {took[1]:.1f} s CPU", file=sys.stderr, flush=True)
                best[how] = tuple(map(min, best[how], took))
                equal[how] &= same_bytes(work / "out_bare_1", out)
                if how != "bare 1":
                    shutil.rmtree(out)
            shutil.rmtree(work / "out_bare_1")
    print(f"{films} videos, the best of {rounds} rounds in turns\n{'':10}{'at once':>8}{'wall s':>9}{'CPU s':>9}{'overhead s a task':>19}{'equal bytes':>13}")
    for how, at_once in ways.items():
        wall, cpu = best[how]
        overhead = at_once * (wall - best[f"bare {at_once}"][0]) / films
        print(f"{how:10}{at_once:8}{wall:9.1f}{cpu:9.1f}{overhead:19.3f}{'yes' if equal[how] else 'NO':>13}")


# ---- finished

def finished(marey, work, tasks):
    (work / "matches").mkdir()
    for number in range(tasks):
        rows = "".join(f"{i},{i / 25},1,{i / 10 + number / 1000:.3f},20\n" for i in range(50))
        (work / "matches" / f"{number:05}.csv").write_text("frame,time,id,x,y\n" + rows)
    plan = ["batch", "plan", "matches", "--job", "measure", "-o", "plan.tsv", "-q"]
    again = ["batch", "run", "plan.tsv", "--json"]
    for name, words in (("plan", plan), ("first run", again), ("second run", again), ("third run", again), ("plan again", plan),
                        ("reduce", ["batch", "reduce", "plan.tsv", "-o", "season.csv", "-q"])):
        began, used = time.monotonic(), cpu_of_children()
        said = run([marey, *words], cwd=work).strip()
        told = " ".join(said.split())
        print(f"{name:12}{time.monotonic() - began:9.2f} s wall{cpu_of_children() - used:9.2f} s CPU  {told}", flush=True)


# ---- memory

def recordings(marey, work):
    """(job, its input) of each kind; sizes that nothing was fitted to."""
    def simulate(*words):
        folder = work / "_".join(str(word).strip("-") for word in words)
        run([marey, "simulate", *words, "-o", folder, "-q"])
        return folder
    for width, height in ((400, 300), (960, 540), (1600, 900), (2560, 1440)):
        yield "track", simulate("people", "--frames", 25, "--people", 5, "--size", width, height) / "video.mp4"
    for cameras, width, height in ((2, 960, 540), (3, 1600, 900), (4, 960, 540)):
        yield "ground", simulate("match", "--render", "--seconds", 1, "--cameras", cameras, "--size", width, height) / "rig.toml"
    for cameras, width, height in ((3, 960, 540), (6, 800, 600)):
        yield "reconstruct", simulate("room", "--render", "--frames", 20, "--cameras", cameras, "--size", width, height) / "rig.toml"
    for seconds in (30, 200):
        yield "measure", simulate("match", "--no-boxes", "--cameras", 2, "--seconds", seconds) / "truth.csv"


def memory(marey, work):
    print(f"{'--job':12}{'of':60}{'said MB':>8}{'taken MB':>9}{'off':>7}")
    for number, (job, path) in enumerate(recordings(marey, work)):
        plan, table = work / f"{number}.tsv", work / f"{number}.csv"
        table.write_text(f"input,name\n{path},one\n")
        run([marey, "batch", "plan", table, "--job", job, "-o", plan, "-q"])
        run([marey, "batch", "run", plan, "-q", "--task-threads", 1])
        with open(plan) as rows:
            said = int(next(csv.DictReader(rows, delimiter="\t"))["memory_mb"])
        record = dict(line.split("\t", 1) for line in (work / f"{number}.tsv.results" / "tasks" / "000001.tsv").read_text().splitlines())
        taken = int(record["peak_mb"])
        print(f"{job:12}{path.parent.name:60}{said:8}{taken:9}{said / taken - 1:+7.0%}", flush=True)


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("marey", type=pathlib.Path)
    parser.add_argument("what", choices=("engines", "finished", "memory"))
    parser.add_argument("--films", type=int, default=200)
    parser.add_argument("--rounds", type=int, default=2)
    parser.add_argument("--tasks", type=int, default=10_000)
    parser.add_argument("--work", type=pathlib.Path)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="marey_bench_", dir=given.work) as folder:
        marey, work = given.marey.resolve(), pathlib.Path(folder)
        if given.what == "engines":
            engines(marey, work, given.films, given.rounds)
        elif given.what == "finished":
            finished(marey, work, given.tasks)
        else:
            memory(marey, work)


if __name__ == "__main__":
    main()
