#!/usr/bin/env python3
"""Do people keep their ID when they enter the view of a second camera?

Simulates matches with two cameras side by side, whose boxes end beside the feet for half a second, tracks them on the ground and counts
how often a track is observed by one camera and in the next row by both, and how often a person who was observed until then gets a new ID
that begins there.

Usage: bench/live/second_view.py [--marey FILE] [--seeds N] [--seconds S] [--foot-error M] [-- TRACK_OPTION ...]
"""
import argparse
import collections
import csv
import math
import pathlib
import subprocess
import tempfile

RADIUS = 1.5  # m, farthest a track is from its person
GAP = 8  # frames that a person may be unobserved and still counts as observed until then
FRESH = 25  # frames that an ID is new


def rows_by_frame(path):
    frames = collections.defaultdict(list)
    with open(path, newline="") as file:
        for row in csv.DictReader(file):
            frames[int(row["frame"])].append(row)
    return frames


def nearest_pairs(people, tracks):
    """Greedy pairs of a person and a track, the nearest first."""
    position = lambda row: (float(row["x"]), float(row["y"]))
    pairs = sorted((math.dist(position(person), position(track)), i, k) for i, person in enumerate(people) for k, track in enumerate(tracks))
    used_people, used_tracks = set(), set()
    for distance, i, k in pairs:
        if distance > RADIUS:
            return
        if i not in used_people and k not in used_tracks:
            used_people.add(i)
            used_tracks.add(k)
            yield people[i]["id"], tracks[k]


def count(truth, tracked):
    """Entries into a second view, and new IDs there."""
    first_frame, before, entries, renewed = {}, {}, 0, 0
    last = {}  # of a person: track ID, frame, cameras
    for frame in sorted(truth):
        for row in tracked[frame]:
            first_frame.setdefault(row["id"], frame)
            cameras = row["cameras"].split()
            entries += len(before.get(row["id"], ())) == 1 and len(cameras) == 2
            if cameras:
                before[row["id"]] = cameras
        for person, track in nearest_pairs(truth[frame], [row for row in tracked[frame] if row["state"] == "measured"]):
            cameras = set(track["cameras"].split())
            if person in last and last[person][0] != track["id"] and frame - last[person][1] <= GAP:
                fresh = frame - first_frame[track["id"]] <= FRESH
                renewed += fresh and not cameras <= last[person][2]
            last[person] = track["id"], frame, cameras
    return entries, renewed


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--marey", type=pathlib.Path, default=pathlib.Path("build/release/marey"))
    parser.add_argument("--seeds", type=int, default=8)
    parser.add_argument("--seconds", default="60")
    parser.add_argument("--foot-error", default="0.25")
    parser.add_argument("options", nargs="*")
    given = parser.parse_args()
    marey = str(given.marey.resolve())
    print("| seed | IDs | observed by one camera, then by both | new IDs there |\n| --- | --- | --- | --- |")
    for seed in range(1, given.seeds + 1):
        with tempfile.TemporaryDirectory() as folder:
            simulate = ["simulate", "match", "-o", "match", "--cameras", "2", "--layout", "football", "--seconds", given.seconds, "--boxes"]
            subprocess.run([marey, *simulate, "--foot-error", given.foot_error, "--seed", str(seed), "-q"], cwd=folder, check=True)
            track = ["track", "match/rig.toml", "--ground", "-o", "tracks.csv", "-q", *given.options]
            subprocess.run([marey, *track], cwd=folder, check=True, stderr=subprocess.DEVNULL)
            tracked = rows_by_frame(f"{folder}/tracks.csv")
            entries, renewed = count(rows_by_frame(f"{folder}/match/truth.csv"), tracked)
            ids = len({row["id"] for rows in tracked.values() for row in rows})
            print(f"| {seed} | {ids} | {entries} | {renewed} |", flush=True)


if __name__ == "__main__":
    main()
