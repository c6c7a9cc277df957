#!/usr/bin/env python3
"""`marey augment` on walkers whose joints' angles are known, and what its deviations are worth.

Usage: augmented_angles.py MAREY DATA [--seeds 3] [--sigma 10]

DATA is the folder that tests call MAREY_DATA; needs numpy and the networks of script/model --augmenter (MAREY_MODELS). Of arnold_synthetic's three walkers the
centres of joints, heels and toes are given as keypoints, 60 Hz. The first table: flexion of hips, knees and ankles against the model's own coordinates, degrees
RMS, as it is and once a constant is taken off; beside it the peer, the human skeleton that `marey solve` makes of the same keypoints. The second: keypoints with
errors of --sigma mm an axis, of which half (53 % of the variance) stays and the rest falls off in 0.1 s, as simulated keypoints' do; how many of the errors of an
angle against the one without are within two of its deviations.
"""
import argparse
import csv
import json
import pathlib
import sqlite3
import subprocess
import tempfile

import numpy as np

RATE = 60.0
JOINTS = {"hip_flexion": "hip_flexion", "knee_flexion": "knee_angle", "ankle_dorsiflexion": "ankle_angle"}
PEER = {"hip_flexion": "hip_flexion", "knee_flexion": "knee_flexion", "ankle_dorsiflexion": "ankle_dorsiflexion"}


def trc(path):
    lines = path.read_text().split("\n")
    names = [name for name in lines[3].split("\t")[2:] if name.strip()]
    rows = np.array([[float(value) for value in line.split("\t") if value.strip()] for line in lines[5:] if line.strip()])
    return rows[:, 1], {name: rows[:, 2 + 3 * i : 5 + 3 * i] for i, name in enumerate(names)}


def table(path):
    """A .sto or .mot file: times, columns."""
    head, body = path.read_text().split("endheader\n")
    lines = body.strip().split("\n")
    rows = np.array([[float(value) for value in line.split()] for line in lines[1:]])
    return rows[:, 0], dict(zip(lines[0].split()[1:], rows[:, 1:].T, strict=True)), "inDegrees=yes" in head


def keypoints_of(folder):
    """Times of even steps, and the points in metres with z up."""
    times, marks = trc(folder / "markers.trc")
    even = np.arange(times[0], times[-1], 1 / RATE)
    at = {name: np.stack([np.interp(even, times, path[:, axis]) for axis in range(3)], 1)[:, [0, 2, 1]] * (1, -1, 1) for name, path in marks.items()}
    points = {}
    for side, name in (("R", "right"), ("L", "left")):
        for point, marker in (("shoulder", "SJC"), ("hip", "HJC"), ("knee", "KJC"), ("ankle", "AJC"), ("heel", "CAL"), ("small_toe", "MT5"), ("big_toe", "TOE"), ("elbow", "EJC")):
            points[f"{name}_{point}"] = at[side + marker]
        points[f"{name}_wrist"] = (at[f"{side}FAradius"] + at[f"{side}FAulna"]) / 2
    return even, points


def write_take(marey, work, name, points, sigma=0.0):
    """A take of the points; with a sigma, m, its square is every covariance."""
    with open(work / f"{name}.csv", "w") as out:
        out.write("frame,time,id,label,x,y,z\n")
        for frame in range(len(next(iter(points.values())))):
            for track, (label, path) in enumerate(points.items(), 1):
                out.write(f"{frame},{frame / RATE:.6f},{track},{label},{path[frame, 0]:.6f},{path[frame, 1]:.6f},{path[frame, 2]:.6f}\n")
    take = work / f"{name}.marey"
    subprocess.run([marey, "convert", work / f"{name}.csv", take, "-q"], check=True)
    if sigma:
        with sqlite3.connect(take) as file:
            for key, rows in file.execute("SELECT id, rows FROM samples").fetchall():
                blob = np.tile(np.array([1, 0, 0, 1, 0, 1], "<f4") * sigma**2, rows).tobytes()
                file.execute("UPDATE samples SET covariance = ? WHERE id = ?", (blob, key))
    return take


def augment(marey, work, take, person):
    out = work / "angles.csv"
    subprocess.run([marey, "augment", take, "--height", str(person["heightM"]), "--mass", str(person["massKg"]), "--hips", "joints", "--angles", out, "-q"], check=True, capture_output=True)
    with open(out) as file:
        rows = list(csv.DictReader(file))
    return {name: np.array([float(row[name] or "nan") for row in rows]) for name in rows[0]}


def errors_of(points, chance, sigma):
    made, kept = {}, np.exp(-1 / (RATE * 0.1))
    for label, path in points.items():
        passing = chance.normal(size=path.shape)
        for k in range(1, len(path)):
            passing[k] = kept * passing[k - 1] + np.sqrt(1 - kept**2) * passing[k]
        made[label] = path + sigma * (np.sqrt(0.53) * chance.normal(size=3) + np.sqrt(0.47) * passing)
    return made


def rms(values):
    return np.sqrt(np.mean(np.square(values)))


def print_row(cells):
    print("| " + " | ".join(cells) + " |", flush=True)


def peer(marey, work, take):
    subprocess.run([marey, "solve", take, "-o", work / "peer.mot", "-q"], check=True, capture_output=True)
    return table(work / "peer.mot")[1]


def compare(angle, truth):
    return f"{rms(angle - truth):.1f}, {rms(angle - truth - np.mean(angle - truth)):.1f}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("marey")
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--sigma", type=float, default=10, help="mm")
    options = parser.parse_args()
    work = pathlib.Path(tempfile.mkdtemp(prefix="marey_augmented_"))
    print_row(["walker", "angle", "augmented: as it is, without a constant", "the peer: as it is, without a constant"])
    print_row(["---"] * 4)
    takes = {}
    for folder in sorted((options.data / "arnold_synthetic").glob("subject*")):
        person = json.loads((folder / "subject.json").read_text())
        even, points = keypoints_of(folder)
        take = write_take(options.marey, work, folder.name, points)
        angles, other = augment(options.marey, work, take, person), peer(options.marey, work, take)
        takes[folder.name] = (points, person, angles)
        times, truth, _ = table(folder / "coordinates.sto")
        for name, coordinate in JOINTS.items():
            sides = [(f"{side}_{name}", np.degrees(np.interp(even, times, truth[f"{coordinate}_{side[0]}"]))) for side in ("left", "right")]
            ours = np.concatenate([angles[angle] for angle, _ in sides])
            theirs = np.concatenate([other[f"{side}_{PEER[name]}"] for side in ("left", "right")])
            print_row([folder.name, name, compare(ours, np.concatenate([true for _, true in sides])), compare(theirs, np.concatenate([true for _, true in sides]))])
    print()
    print_row(["angle", "error, degrees RMS", "deviation, mean", "within two deviations, %"])
    print_row(["---"] * 4)
    found = {}
    for seed in range(1, options.seeds + 1):
        for walker, (points, person, angles) in takes.items():
            chance = np.random.default_rng([seed, int(walker[-2:])])
            noisy = augment(options.marey, work, write_take(options.marey, work, "noisy", errors_of(points, chance, options.sigma / 1000), options.sigma / 1000), person)
            for name in (f"{side}_{angle}" for side in ("left", "right") for angle in (*JOINTS, "hip_adduction", "hip_rotation")):
                found.setdefault(name.partition("_")[2], []).append((noisy[name] - angles[name], noisy[f"{name}_deviation"]))
    for name, pairs in found.items():
        error, deviation = (np.concatenate(values) for values in zip(*pairs, strict=True))
        print_row([name, f"{rms(error):.2f}", f"{np.mean(deviation):.2f}", f"{100 * np.mean(np.abs(error) < 2 * deviation):.1f}"])


if __name__ == "__main__":
    main()
