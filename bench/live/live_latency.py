#!/usr/bin/env python3
"""How old live results are, and what is lost, on simulated cameras whose images are drawn beforehand.

Usage: live_latency.py MAREY [--seconds S] [--cases four,twenty]

four:    4 cameras 640x480 at 100 Hz, 40 markers: the time from exposure (the instant the simulator hands an image over) to the instant
twenty:  20 cameras 640x480 at 30 Hz: frames lost or drop, and CPU time as a share of one core (the simulator's hand-over included)
Times of each stage are medians and 99 %; the machine's load is printed beside them, because nothing here is true on a busy one.
"""
import argparse
import json
import os
import resource
import subprocess

CASES = {
    "four": "sim://room?cameras=4&rate=100&markers=40&motion=walk&drawn=1",
    "twenty": "sim://room?cameras=20&rate=30&markers=40&motion=walk&drawn=1",
}


def run(marey, name, seconds):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    said = subprocess.run([marey, "live", CASES[name], "--duration", str(seconds), "--json", "-q"], capture_output=True, text=True, check=True).stdout
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    told = json.loads(said)
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    print(f"{name}: {told['instants']} instants in {told['seconds']:.1f} s, {told['targets']} targets; CPU {cpu:.1f} s with drawing; load {os.getloadavg()[0]:.1f}")
    frames = {key: sum(camera[key] for camera in told["cameras"].values()) for key in ("frames", "lost", "damaged", "overrun", "missed")}
    print("  ", ", ".join(f"{value} {key}" for key, value in frames.items()), "|", ", ".join(f"{value} {key}" for key, value in told["dropped"].items()))
    for stage, times in told["stages"].items():
        print(f"   {stage:20} median {times['median_ms']:7.3f} ms, p99 {times['p99_ms']:7.3f} ms")
    return cpu


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("marey")
    parser.add_argument("--seconds", type=float, default=10)
    parser.add_argument("--cases", default="four,twenty")
    given = parser.parse_args()
    for name in given.cases.split(","):
        drawing = run(given.marey, name, 1)
        whole = run(given.marey, name, 1 + given.seconds)
        print(f"   running alone: {100 * (whole - drawing) / given.seconds:.0f} % of one core")


if __name__ == "__main__":
    main()
