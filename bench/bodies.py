#!/usr/bin/env python3
"""`marey body tracking` on the true paths of BROAD (rigid_bodies/broad), with simulated markers hung on them.

Usage: bodies.py MAREY DATA [--seconds 20] [--sigma 0.2] [--missing 0.05] [--seed 1] [--every 1] [--work FOLDER]

DATA is the folder that tests call MAREY_DATA. Needs numpy and scipy (PyPI, or Debian's python3-scipy), which reads MATLAB's files. Printed:
  noise      RMS error of the pose where three markers or more are seen, against the Cramer-Rao bound of those very markers
  flips      of an asymmetric body: instants that are more than 5 degrees off; losses: instants with three markers or more without a pose
  symmetric  the same path with a body that appears the same after half a turn, all hidden for 0.05 to 0.5 s: gaps after which it is turned, gaps
             after which it is reported that it may be, and those turned without that
  identical  four bodies alike on four paths through each other: instants at which one bears another's name
"""
import argparse
import json
import pathlib
import sqlite3
import subprocess
import tempfile

import numpy as np
import scipy.io

ASYMMETRIC = np.array([[0.06, 0, 0], [-0.05, 0.03, 0], [0, -0.06, 0.02], [0.02, 0.05, 0.06], [-0.03, -0.02, -0.05]])
SYMMETRIC = np.array([[0.07, 0, 0], [-0.07, 0, 0], [0, 0.04, 0.05], [0, -0.04, 0.05]])  # half a turn about z
RATE = 2000 / 7


def paths(data, seconds):
    """(name, positions, rotations) of a stretch in the middle of each file without a hole."""
    for file in sorted((data / "rigid_bodies" / "broad").glob("*.mat")):
        mat = scipy.io.loadmat(file)
        position, quaternion = mat["opt_pos"].astype(float), mat["opt_quat"].astype(float)
        known = np.isfinite(position).all(1) & np.isfinite(quaternion).all(1)
        count = int(seconds * RATE)
        for begin in range(len(known) // 3, len(known) - count, count // 4):
            if known[begin:begin + count].all():
                q = quaternion[begin:begin + count]
                yield file.stem, position[begin:begin + count], rotations(q / np.linalg.norm(q, axis=1)[:, None])
                break


def rotations(q):
    w, x, y, z = q.T
    return np.stack([np.stack([1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)], 1),
                     np.stack([2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)], 1),
                     np.stack([2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)], 1)], 1)


def write_points(file, frames):
    with open(file, "w") as out:
        out.write("frame,time,id,label,x,y,z\n")
        for index, points in enumerate(frames):
            for number, point in enumerate(points, 1):
                out.write(f"{index},{index / RATE:.6f},{number},,{point[0]:.9f},{point[1]:.9f},{point[2]:.9f}\n")


def write_bodies(file, layouts):
    with open(file, "w") as out:
        for body, layout in enumerate(layouts, 1):
            out.write(f'[[body]]\nname = "b{body}"\n')
            for marker, place in enumerate(layout):
                out.write(f'[[body.marker]]\nlabel = "b{body}m{marker}"\nposition = [{", ".join(map(str, place))}]\n')


def poses_of(take):
    """{body: (frames, [R t], tracked)}"""
    rows = {}
    database = sqlite3.connect(take)
    chunks = database.execute("SELECT id, first_index, instants, indices FROM chunk ORDER BY last_index").fetchall()
    for chunk, first, instants, indices in chunks:
        frames = first + (np.arange(instants) if indices is None else np.frombuffer(indices, "<u4").astype(int))
        for key, count, at, pose, tracked in database.execute(
                "SELECT id, rows, at, pose, tracked FROM poses WHERE id >= ? AND id < ?", [chunk << 32, chunk + 1 << 32]):
            where = at + np.arange(count) if isinstance(at, int) else np.frombuffer(at, "<u4").astype(int)
            seen = np.full(count, tracked) if isinstance(tracked, int) else np.frombuffer(tracked, "u1")
            rows.setdefault(key & 0xffffffff, []).append((frames[where], np.frombuffer(pose, "<f8").reshape(count, 3, 4), seen != 0))
    return {body: tuple(np.concatenate(part) for part in zip(*parts)) for body, parts in rows.items()}


def tracking(marey, work, frames, layouts):
    write_points(work / "points.csv", frames)
    write_bodies(work / "bodies.toml", layouts)
    command = [marey, "body", "track", work / "points.csv", work / "bodies.toml", "-o", work / "out.marey", "--json"]
    reported = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
    return poses_of(work / "out.marey"), [one["frame"] for one in reported["in_question"]]


def angle(a, b):
    """rad, between two stacks of rotations."""
    trace = np.einsum("nij,nij->n", a, b)
    return np.arccos(np.clip((trace - 1) / 2, -1, 1))


def noise(marey, work, position, rotation, sigma, missing, random):
    truth = np.einsum("nij,mj->nmi", rotation, ASYMMETRIC) + position[:, None]
    visible = random.random(truth.shape[:2]) >= missing
    seen = truth + random.normal(0, sigma, truth.shape)
    found = tracking(marey, work, [seen[i][visible[i]] for i in range(len(seen))], [ASYMMETRIC])[0].get(1)
    enough = visible.sum(1) >= 3
    at, pose, tracked = found
    at, pose = at[tracked], pose[tracked]
    error = angle(pose[:, :, :3], rotation[at])
    flips = int((error > np.radians(5)).sum())
    losses = int(enough.sum()) - int(enough[at].sum())
    turn, bound_turn, shift, bound_shift = [], [], [], []
    for i, where in enumerate(at):
        if error[i] > np.radians(5):
            continue
        places = ASYMMETRIC[visible[where]]
        centre = places.mean(0)
        q = places - centre
        spread = (q * q).sum() * np.eye(3) - q.T @ q
        turn.append(error[i] ** 2)
        bound_turn.append(sigma ** 2 * np.trace(np.linalg.inv(spread)))
        off = pose[i, :, :3] @ centre + pose[i, :, 3] - rotation[where] @ centre - position[where]
        shift.append(off @ off)
        bound_shift.append(3 * sigma ** 2 / len(places))
    return (np.sqrt(np.mean(turn)), np.sqrt(np.mean(bound_turn)), np.sqrt(np.mean(shift)), np.sqrt(np.mean(bound_shift)), flips, losses, len(at))


def symmetric(marey, work, position, rotation, sigma, random):
    truth = np.einsum("nij,mj->nmi", rotation, SYMMETRIC) + position[:, None]
    visible = np.ones(len(truth), bool)
    gaps, at = [], int(RATE)
    while at < len(truth) - RATE:
        length = int(random.uniform(0.05, 0.5) * RATE)
        visible[at:at + length] = False
        gaps.append((at, at + length))
        at += length + int(random.uniform(0.4, 0.8) * RATE)
    seen = truth + random.normal(0, sigma, truth.shape)
    poses, in_question = tracking(marey, work, [seen[i] if visible[i] else [] for i in range(len(seen))], [SYMMETRIC])
    at, pose, tracked = poses[1]
    turned = np.full(len(truth), -1)
    turned[at[tracked]] = angle(pose[tracked, :, :3], rotation[at[tracked]]) > np.pi / 2
    flips = reported = unreported = 0
    for begin, end in gaps:
        before, after = turned[:begin][turned[:begin] >= 0], turned[end + int(0.1 * RATE):]
        after = after[after >= 0]
        flip = bool(len(before) and len(after) and before[-1] != after[0])
        asked = any(end <= frame < end + 0.1 * RATE for frame in in_question)
        flips += flip
        reported += asked
        unreported += flip and not asked
    return flips, reported, unreported, len(gaps)


def identical(marey, work, stretches, sigma, missing, random):
    count = min(len(position) for _, position, _ in stretches)
    layout, frames, truths = ASYMMETRIC[:4], [], []
    paths_of = [(stretches[i % len(stretches)], i // len(stretches)) for i in range(4)]
    for (_, position, rotation), late in paths_of:
        roll = late * count // 2
        truths.append((np.roll(position - position.mean(0), roll, 0)[:count], np.roll(rotation, roll, 0)[:count]))
    # Bodies are solid: apart by their size, they still pass through each other's gates.
    apart = np.array([[0, 0, 0], [0.16, 0, 0], [0, 0.16, 0], [0, 0, 0.16]])
    for i in range(count):
        points = [r[i] @ place + p[i] + apart[b] + random.normal(0, sigma, 3) for b, (p, r) in enumerate(truths) for place in layout
                  if random.random() >= missing]
        frames.append([points[k] for k in random.permutation(len(points))])
    found = tracking(marey, work, frames, [layout] * 4)[0]
    names, swaps, total = {}, 0, 0
    for body, (at, pose, tracked) in found.items():
        for i, where in zip(np.flatnonzero(tracked), at[tracked]):
            off = [np.linalg.norm(pose[i, :, 3] - p[where] - apart[b]) for b, (p, _) in enumerate(truths)]
            nearest = int(np.argmin(off))
            names.setdefault(body, nearest)
            total += 1
            swaps += names[body] != nearest
    return swaps, total


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("marey")
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("--seconds", type=float, default=20)
    parser.add_argument("--sigma", type=float, default=0.2, help="mm")
    parser.add_argument("--missing", type=float, default=0.05)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--every", type=int, default=1, help="use every Nth instant: 286 Hz divided by N")
    parser.add_argument("--work", type=pathlib.Path)
    options = parser.parse_args()
    work = options.work or pathlib.Path(tempfile.mkdtemp(prefix="marey_bodies_"))
    random = np.random.default_rng(options.seed)
    sigma = options.sigma / 1000
    stretches = [(name, position[::options.every], rotation[::options.every]) for name, position, rotation in paths(options.data, options.seconds)]
    global RATE
    RATE /= options.every
    for name, position, rotation in stretches:
        turn, bound_turn, shift, bound_shift, flips, losses, count = noise(options.marey, work, position, rotation, sigma, options.missing, random)
        print(f"{name}: turn {np.degrees(turn):.4f} deg, bound {np.degrees(bound_turn):.4f}, ratio {turn / bound_turn:.3f}; "
              f"place {1000 * shift:.4f} mm, bound {1000 * bound_shift:.4f}, ratio {shift / bound_shift:.3f}; "
              f"{flips} flips, {losses} losses in {count} instants")
        turned, reported, unreported, gaps = symmetric(options.marey, work, position, rotation, sigma, random)
        print(f"{name}: symmetric, {turned} of {gaps} gaps turned; {reported} in question, {unreported} turned without that")
    swaps, total = identical(options.marey, work, stretches, sigma, options.missing, random)
    print(f"four identical bodies: {swaps} of {total} instants under another's name")


if __name__ == "__main__":
    main()
