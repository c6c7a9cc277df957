#!/usr/bin/env python3
"""`marey calibrate people` on simulated rooms, whose cameras are known: four cameras at 25 Hz, people's keypoints with a network's errors (8 px, 20 mm,
outliers), started up to 0.2 s apart.

    people_rig.py MAREY [--seeds 1,2,3] [--people 1,3] [--seconds 30] [--drift 25e-6] [--rolling-shutter 0.02]

Prints a Markdown table, a row a room: the worst of the five distances but that of cameras 1 and 2, which gives the scale; of the turns between the first camera
and another; of the focal lengths; of the offsets between the first camera and another, in the middle of the recording and at its ends; of the rates, ppm, of
each camera against the first (--drift: by which cameras' clocks run slower or faster than the first one's at most). In parentheses the naive peer: every camera
at the rate that its file says, its offset right in the middle. Needs numpy.
"""

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile
import time
import tomllib

import numpy as np

RATE, OFFSET_S = 25, 0.2


def cameras_of(path):
    return tomllib.loads(pathlib.Path(path).read_text())["camera"]


def centre(camera):
    return -np.array(camera["rotation"]).T @ np.array(camera["translation"])


def angle(a, b):
    return np.degrees(np.arccos(np.clip((np.trace(a @ b.T) - 1) / 2, -1, 1)))


def figures(found, truth, middle_s):
    """Worst relative distance, angle (degrees), relative focal length, offset in the middle (frames), and of each camera but the first the error of its rate and
    its true drift (ppm)."""
    count = range(len(truth))
    apart = lambda rig, a, b: np.linalg.norm(centre(rig[a]) - centre(rig[b]))
    distance = max(abs(apart(found, a, b) / apart(truth, a, b) - 1) for a in count for b in range(a) if (a, b) != (1, 0))
    turn = lambda rig, a: np.array(rig[a]["rotation"]) @ np.array(rig[0]["rotation"]).T
    rotation = max(angle(turn(found, a), turn(truth, a)) for a in count)
    focal = max(abs(found[a]["focal"][0] / truth[a]["focal"][0] - 1) for a in count)
    slow = lambda rig, a: RATE / rig[a].get("rate", RATE) - 1
    true = [slow(truth, a) - slow(truth, 0) for a in count]
    drift = np.array([slow(found, a) - slow(found, 0) - true[a] for a in count])
    offset = lambda rig, a: rig[a]["offset_s"] - rig[0]["offset_s"]
    late = np.array([offset(found, a) - offset(truth, a) + drift[a] * middle_s for a in count]) * RATE
    return distance, rotation, focal, late, 1e6 * drift, 1e6 * np.array(true)


def run(marey, seed, people, seconds, drift, readout_s):
    with tempfile.TemporaryDirectory(prefix="marey_people_rig_") as name:
        folder = pathlib.Path(name)
        words = ["simulate", "room", "--cameras", 4, "--frames", int(seconds * RATE), "--rate", RATE, "--keypoints", "--markers", 4, "--actors", people,
                 "--offset", OFFSET_S, "--drift", drift, "--rolling-shutter", readout_s, "--seed", seed, "-o", "room", "-q"]
        subprocess.run([marey, *map(str, words)], cwd=folder, check=True)
        truth = cameras_of(folder / "room/rig.toml")
        blind = [f'[[camera]]\nname = "{c["name"]}"\nsize = {c["size"]}\nrate = {RATE}\n' for c in truth]
        (folder / "blind.toml").write_text("\n".join(blind))
        sources = [f"{c['name']}=room/keypoints_{c['name']}.json" for c in truth]
        scale = f"cam1,cam2={np.linalg.norm(centre(truth[0]) - centre(truth[1]))}"
        start = time.perf_counter()
        done = subprocess.run([marey, "calibrate", "people", "blind.toml", *sources, "--distance", scale, "-o", "rig.toml", "--json", "-q"], cwd=folder,
                              capture_output=True, text=True)
        took = time.perf_counter() - start
        if done.returncode:
            print(f"| {people} | {seconds:g} | {seed} | {done.stderr.strip()} | | | | | | {took:.0f} |", flush=True)
            return
        distance, rotation, focal, late, ppm, true = figures(cameras_of(folder / "rig.toml"), truth, seconds / 2)
        half = 1e-6 * RATE * seconds / 2  # frames at an end of the recording, of a ppm
        end, peer = (np.abs(late) + np.abs(ppm) * half).max(), np.abs(true).max() * half
        rates = ", ".join(f"{one:+.1f} ({-rate:+.1f})" for one, rate in zip(ppm[1:], true[1:]))
        print(f"| {people} | {seconds:g} | {seed} | {distance:.2%} | {rotation:.2f}° | {focal:.2%} | {np.abs(late).max():.2f} | {end:.2f} ({peer:.2f}) | {rates} | "
              f"{took:.0f} |", flush=True)
        for note in json.loads(done.stdout)["notes"]:
            print(note, file=sys.stderr)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("marey")
    parser.add_argument("--seeds", default="1,2,3")
    parser.add_argument("--people", default="1,3")
    parser.add_argument("--seconds", type=float, default=30)
    parser.add_argument("--drift", type=float, default=0)
    parser.add_argument("--rolling-shutter", type=float, default=0, help="s from the first row's exposure to the last one's")
    given = parser.parse_args()
    print("| people | s | seed | distances | rotations | focal lengths | offsets, frames | at the ends | rates, ppm | took, s |\n" + "| --- " * 10 + "|")
    for people in map(int, given.people.split(",")):
        for seed in map(int, given.seeds.split(",")):
            run(pathlib.Path(given.marey).resolve(), seed, people, given.seconds, given.drift, given.rolling_shutter)


if __name__ == "__main__":
    main()
