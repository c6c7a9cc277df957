#!/usr/bin/env python3
"""Who is who across cameras: simulated people a metre apart, four cameras, as `marey reconstruct --targets keypoints` and Pose2Sim place them from the same points.

Joint error: the median distance of hips, knees, ankles, shoulders, elbows and wrists from where the nearest true person's are. A swap: a person's nearest true person is another one than in the frame before. A wrong limb: an elbow, wrist, knee or ankle more than 0.2 m from where the person's own truly is.
Without PYTHON, which imports Pose2Sim (BSD-3), only Marey runs: pip install --no-deps pose2sim rtoml anytree c3d, and its requirements.

Usage: bench/keypoint_association.py MAREY [PYTHON [FRAMES]]
"""
import csv
import json
import math
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile

CAMERAS, RATE, FRAMES, SIZE = 4, 50, 600, (1080, 1920)
JOINTS = ("hip", "knee", "ankle", "shoulder", "elbow", "wrist")
LIMBS = ("elbow", "wrist", "knee", "ankle")
WRONG_M = 0.2
PEER = """
import logging, pathlib, sys
import rtoml
from Pose2Sim import personAssociation, triangulation
import Pose2Sim
logging.disable(logging.CRITICAL)
folder = sys.argv[1]
config = rtoml.load(pathlib.Path(Pose2Sim.__file__).parent / "Demo_MultiPerson" / "Config.toml")
config["project"] |= {"project_dir": folder, "multi_person": True, "frame_rate": int(sys.argv[2]), "frame_range": "all"}
config["pose"]["pose_model"] = "BODY_25B"
config["triangulation"] |= {"make_c3d": False, "show_interp_indices": False}
personAssociation.associate_all(config)
triangulation.triangulate_all(config)
"""


def rows_of(path):
    """{person: {frame: {point: place}}} of a CSV with labels "P1:left_knee", or of one person."""
    people = {}
    with open(path) as file:
        for row in csv.DictReader(file):
            person, _, point = row["label"].rpartition(":")
            place = tuple(float(row[axis]) for axis in "xyz")
            people.setdefault(person, {}).setdefault(int(row["frame"]), {})[point] = place
    return people


def evaluated(placed, truth):
    swaps = wrong = limbs = there = 0
    apart = []
    for frames in placed.values():
        before = None
        for frame in sorted(frames):
            points = frames[frame]
            best, nearest = math.inf, None
            for person, true in truth.items():
                common = [math.dist(place, true[frame][point]) for point, place in points.items() if frame in true and point in true[frame]]
                if len(common) < 5:
                    continue
                distance = sum(min(1, each) for each in common) / len(common)
                if distance < best:
                    best, nearest = distance, person
            if nearest is None:
                continue
            there += 1
            swaps += before is not None and nearest != before
            before = nearest
            apart += [math.dist(place, truth[nearest][frame][point]) for point, place in points.items() if point.endswith(JOINTS) and point in truth[nearest][frame]]
            for point, place in points.items():
                if point.endswith(LIMBS) and point in truth[nearest][frame]:
                    limbs += 1
                    wrong += math.dist(place, truth[nearest][frame][point]) > WRONG_M
    return swaps, wrong, limbs, there, apart


def marey(*arguments):
    done = subprocess.run([MAREY, *map(str, arguments)], capture_output=True, text=True)
    if done.returncode:
        sys.exit(done.stderr)
    return done.stdout


def write_for_peer(folder):
    """The same points as OpenPose's folders, and the rig."""
    for c in range(1, CAMERAS + 1):
        pose = folder / "peer" / "pose" / f"cam{c}_json"
        pose.mkdir(parents=True)
        file = json.loads((folder / f"keypoints_cam{c}.json").read_text())
        frames = {image["id"]: [] for image in file["images"]}
        for one in file["annotations"]:
            frames[one["image_id"]].append({"person_id": [-1], "pose_keypoints_2d": one["keypoints"]})
        for frame, people in frames.items():
            (pose / f"cam{c}_{frame:012}_keypoints.json").write_text(json.dumps({"version": 1.3, "people": people}))
    (folder / "peer" / "Config.toml").write_text("")  # by which it knows its folder
    (folder / "peer" / "calibration").mkdir()
    marey("convert", folder / "rig.toml", folder / "peer" / "calibration" / "Calib.toml", "--format", "aniposelib")


def peer_people(folder):
    people = {}
    for path in (folder / "peer" / "pose-3d").glob("*.trc"):
        lines = path.read_text().splitlines()
        names = [name for name in lines[3].split("\t")[2:] if name.strip()]
        frames = people.setdefault(path.stem, {})
        for line in lines[5:]:
            values = line.split("\t")
            for i, name in enumerate(names):
                place = [float(value) if value.strip() else math.nan for value in values[2 + 3 * i : 5 + 3 * i]]
                if len(place) == 3 and not any(map(math.isnan, place)):
                    frames.setdefault(int(values[0]), {})[common(name)] = (place[2], place[0], place[1])  # its y is up
    first = min((frame for frames in people.values() for frame in frames), default=0)
    return {person: {frame - first: points for frame, points in frames.items()} for person, frames in people.items()}


def common(name):
    for letter, side in (("R", "right_"), ("L", "left_")):
        if name.startswith(letter) and len(name) > 1 and name[1].isupper():
            return side + {"BigToe": "big_toe", "SmallToe": "small_toe"}.get(name[1:], name[1:].lower())
    return {"Nose": "nose", "Neck": "upper_neck", "Head": "head_top"}.get(name, name.lower())


def simulated(people, seed, folder):
    marey("simulate", "room", "--keypoints", "--motion", "walk", "--actors", people, "--cameras", CAMERAS, "--markers", 4, "--rate", RATE, "--frames", FRAMES,
          "--size", *SIZE, "--volume", 2.8, 2.8, 2.5, "--zoom", 1.3, "--seed", seed, "-o", folder, "-q")
    return rows_of(folder / "keypoints_truth.csv")


def nearest_pair(truth):
    hips = [{frame: points["left_hip"] for frame, points in frames.items()} for frames in truth.values()]
    return min((math.dist(a[frame], b[frame]) for i, a in enumerate(hips) for b in hips[:i] for frame in a), default=math.nan)


def with_marey(folder):
    pairs = [f"cam{c}={folder}/keypoints_cam{c}.json" for c in range(1, CAMERAS + 1)]
    told = json.loads(marey("reconstruct", folder / "rig.toml", *pairs, "--targets", "keypoints", "-o", folder / "placed.csv", "--json"))
    return rows_of(folder / "placed.csv"), told["place_ms"]


def with_peer(folder):
    write_for_peer(folder)
    done = subprocess.run([PYTHON, "-c", PEER, folder / "peer", str(RATE)], capture_output=True, text=True, env=os.environ | {"MPLBACKEND": "agg"})
    if done.returncode:
        print(done.stderr.strip().splitlines()[-1], file=sys.stderr)
        return None
    return peer_people(folder)


def main():
    print("| people | nearest two, m | program | tracks | swaps a minute | wrong limbs, % | joint error, mm | of the true people, % | placing, ms a frame |\n| --- " + "| --- " * 8 + "|")
    for people in (2, 3, 4, 6):
        sums, apart, times = {}, math.inf, []
        for seed in (1, 2):
            with tempfile.TemporaryDirectory() as name:
                folder = pathlib.Path(name) / "room"
                truth = simulated(people, seed, folder)
                apart = min(apart, nearest_pair(truth))
                placed, ms = with_marey(folder)
                times.append(ms)
                results = {"marey": placed} | ({"Pose2Sim": with_peer(folder)} if PYTHON else {})
                for program, found in results.items():
                    if found is None:
                        continue
                    entry = sums.setdefault(program, [0, 0, 0, 0, [], 0])
                    for i, value in enumerate((*evaluated(found, truth), len(found))):
                        entry[i] += value
        minutes = 2 * FRAMES / RATE / 60
        for program, (swaps, wrong, limbs, there, distances, tracks) in sums.items():
            ms = f"{sum(times) / len(times):.2f}" if program == "marey" else ""
            print(f"| {people} | {apart:.2f} | {program} | {tracks / 2:g} | {swaps / minutes:.1f} | {100 * wrong / max(1, limbs):.2f} | {1000 * statistics.median(distances or [math.nan]):.1f} | "
                  f"{100 * there / (2 * people * FRAMES):.1f} | {ms} |", flush=True)


if __name__ == "__main__":
    if len(sys.argv) not in (2, 3, 4):
        sys.exit(__doc__)
    MAREY, PYTHON = sys.argv[1], sys.argv[2] if len(sys.argv) > 2 else None
    FRAMES = int(sys.argv[3]) if len(sys.argv) > 3 else FRAMES
    main()
