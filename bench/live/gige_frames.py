#!/usr/bin/env python3
"""Frames of four of Aravis's fake GigE Vision cameras: sent, used and lost, in a network of their own (root, arv-fake-gv-camera-0.8).

Usage: gige_frames.py MAREY [--rates 30,60] [--seconds 60] [--cameras 4]

Every number from a camera's first frame to its last is a frame that came or one that is counted: anything else is an error.
"""
import argparse
import json
import os
import resource
import shutil
import subprocess
import sys
import time


def inside(given) -> None:
    subprocess.run(["ip", "link", "set", "lo", "up"], check=True)
    for k in range(1, given.cameras):
        subprocess.run(["ip", "addr", "add", f"127.0.0.{k + 1}/8", "dev", "lo"], check=True)
    cameras = [subprocess.Popen(["arv-fake-gv-camera-0.8", "-i", f"127.0.0.{k + 1}", "-s", f"CAM{k + 1}"]) for k in range(given.cameras)]
    try:
        time.sleep(2)
        for rate in map(float, given.rates.split(",")):
            before = resource.getrusage(resource.RUSAGE_CHILDREN)
            sources = [f"gige:127.0.0.{k + 1}?rate={rate:g}" for k in range(given.cameras)]
            said = subprocess.run([given.marey, "live", *sources, "--duration", str(given.seconds), "--json", "-q"], capture_output=True, text=True, check=True).stdout
            after = resource.getrusage(resource.RUSAGE_CHILDREN)
            told = json.loads(said)
            cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
            print(f"{given.cameras} cameras at {rate:g} Hz for {given.seconds} s: CPU {cpu:.1f} s, load {os.getloadavg()[0]:.1f}")
            for name, camera in told["cameras"].items():
                counts = ", ".join(f"{camera[key]} {key}" for key in ("frames", "lost", "damaged", "overrun", "missed"))
                print(f"  {name}: {counts}; {camera['frames'] / given.seconds:.2f} Hz")
            print("  drop:", ", ".join(f"{value} {key}" for key, value in told["dropped"].items()))
    finally:
        for camera in cameras:
            camera.kill()


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("marey")
    parser.add_argument("--rates", default="30,60")
    parser.add_argument("--seconds", type=float, default=60)
    parser.add_argument("--cameras", type=int, default=4)
    parser.add_argument("--inside", action="store_true", help=argparse.SUPPRESS)
    given = parser.parse_args()
    if shutil.which("arv-fake-gv-camera-0.8") is None or shutil.which("unshare") is None:
        print("arv-fake-gv-camera-0.8 (Debian's aravis-tools) is not here")
        return 77
    if not given.inside:
        return subprocess.run(["unshare", "-n", sys.executable, *sys.argv, "--inside"]).returncode
    inside(given)
    return 0


if __name__ == "__main__":
    sys.exit(main())
