#!/usr/bin/env python3
"""How well the ball is found in simulated matches: `marey track --ground --ball`, evaluated by the truth, beside a naive peer.

    bench/ball.py build/release/marey [--seeds 21,22,23] [--stands 1,2,4] [--seconds 20] [--size 1920x1080] [--work FOLDER] [--without]

For each match: `marey simulate match --render --ball`, then the track named "ball". `F1` counts images, by the published rule (a
hit is within 4 px of the true centre): the place that is reported for an image whose camera is said to have seen the ball, projected
into it, against the true one where half of the ball's disc or more is to be seen. `place` is how far the place told is from the true
one in space, m, over all instants with both, in play; p50 and p90. `told` is the share of instants in play with a place.
`--without` plays without a ball, and tells how many instants of one were reported nevertheless. A stand of 2 is the football stand; of 1 or 4, cameras round the pitch. The peer (`--peer`, which needs OpenCV's Python) takes the
brightest small spot of each image nearest to its last one.
"""

import argparse
import csv
import math
import pathlib
import subprocess
import sys
import tomllib

NEAR = 4.0  # px


def run(*command):
    subprocess.run([str(word) for word in command], check=True, stdout=subprocess.DEVNULL)


def rows(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


class Camera:
    def __init__(self, table):
        self.name, self.size = table["name"], table["size"]
        self.focal, self.principal = table["focal"], table["principal"]
        self.k = (table.get("distortion", []) + [0.0] * 8)[:8]
        self.R, self.t = table["rotation"], table["translation"]

    def pixel(self, point):
        """Of a point of the world, m; nothing behind the camera. OpenCV's formula."""
        x, y, z = (sum(self.R[i][j] * point[j] for j in range(3)) + self.t[i] for i in range(3))
        if z <= 0:
            return None
        x, y = x / z, y / z
        k1, k2, p1, p2, k3, k4, k5, k6 = self.k
        r2 = x * x + y * y
        scale = (1 + r2 * (k1 + r2 * (k2 + r2 * k3))) / (1 + r2 * (k4 + r2 * (k5 + r2 * k6)))
        u = x * scale + 2 * p1 * x * y + p2 * (r2 + 2 * x * x)
        v = y * scale + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y
        return self.focal[0] * u + self.principal[0], self.focal[1] * v + self.principal[1]


def world_from(rig):
    """Of places on the user's ground: the inverse of ground_from_world, an isometry."""
    g = rig.get("world", {}).get("ground_from_world", [[1, 0, 0], [0, 1, 0], [0, 0, 1]])
    a, b, c, d = g[0][0], g[0][1], g[1][0], g[1][1]
    det = a * d - b * c

    def rotated(x, y, z):
        x, y = x - g[0][2], y - g[1][2]
        return (d * x - b * y) / det, (a * y - c * x) / det, z
    return rotated


def simulate(program, folder, stand, seed, options):
    where = ["--layout", "football"] if stand == 2 else ["--cameras", stand]
    width, height = options.size.split("x")
    ball = [] if options.without else ["--ball"]
    run(program, "simulate", "match", "-o", folder, "--render", *ball, "--no-boxes", "--seconds", options.seconds, "--seed", seed,
        "--size", width, height, "--quiet", *where)


def assess(folder, told):
    """`told`: by frame (x, y, z in m on the pitch, names of cameras)."""
    rig = tomllib.loads((folder / "rig.toml").read_text())
    rotated = world_from(rig)
    hits = false = missed = 0
    for table in rig["camera"]:
        camera = Camera(table)
        truth = {int(row["frame"]): row for row in rows(folder / f"{camera.name}_ball.csv")}
        for frame in sorted(truth.keys() | told.keys()):
            true, one = truth.get(frame), told.get(frame)
            seen = true is not None and float(true["visible"]) > 0
            at = camera.pixel(rotated(*one[:3])) if one and camera.name in one[3] else None
            hit = seen and at is not None and math.dist(at, (float(true["x"]), float(true["y"]))) <= NEAR
            hits += hit
            false += at is not None and not hit
            missed += seen and not hit and float(true["visible"]) >= 0.5
    errors, playing = [], 0
    for row in rows(folder / "ball.csv"):
        if row["state"] == "dead":
            continue
        playing += 1
        one = told.get(int(row["frame"]))
        if one:
            errors.append(math.dist(one[:3], [float(row[axis]) for axis in "xyz"]))
    return hits, false, missed, errors, playing


def ours(program, folder):
    run(program, "track", folder / "rig.toml", "--ground", "--size", "105x68", "--ball", "-o", folder / "match.csv", "--quiet")
    return {int(row["frame"]): (float(row["x"]), float(row["y"]), float(row["z"]), row["cameras"].split())
            for row in rows(folder / "match.csv") if row["label"] == "ball"}


def peer(folder):
    """Hits, false, missed of the brightest small spot nearest to the last, camera by camera."""
    import cv2
    import numpy as np
    rig = tomllib.loads((folder / "rig.toml").read_text())
    hits = false = missed = 0
    for table in rig["camera"]:
        truth = {int(row["frame"]): row for row in rows(folder / f"{table['name']}_ball.csv")}
        film, last, frame = cv2.VideoCapture(str(folder / f"{table['name']}.mp4")), None, 0
        subtractor = cv2.createBackgroundSubtractorMOG2(history=200, detectShadows=False)
        while True:
            ok, picture = film.read()
            if not ok:
                break
            grey = cv2.cvtColor(picture, cv2.COLOR_BGR2GRAY)
            mask = (subtractor.apply(picture) > 0) & (grey > 150)
            count, _, figures, centres = cv2.connectedComponentsWithStats(mask.astype(np.uint8))
            spots = [centres[i] for i in range(1, count) if 3 <= figures[i][4] <= 150]
            near = min(spots, key=lambda spot: math.dist(spot, last) if last is not None else -grey[int(spot[1]), int(spot[0])], default=None)
            last = near if near is not None else last
            true = truth.get(frame)
            seen = true is not None and float(true["visible"]) > 0
            hit = seen and near is not None and math.dist(near, (float(true["x"]), float(true["y"]))) <= NEAR
            hits, false, missed = hits + hit, false + (near is not None and not hit), missed + (seen and not hit and float(true["visible"]) >= 0.5)
            frame += 1
    return hits, false, missed


def f1(hits, false, missed):
    return 2 * hits / max(1, 2 * hits + false + missed)


def at_fraction(values, share):
    return sorted(values)[min(len(values) - 1, int(share * len(values)))] if values else math.nan


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--seeds", default="21,22,23")
    parser.add_argument("--stands", default="1,2,4")
    parser.add_argument("--seconds", default="20")
    parser.add_argument("--size", default="1920x1080")
    parser.add_argument("--work", default="ball_bench")
    parser.add_argument("--peer", action="store_true")
    parser.add_argument("--without", action="store_true")
    options = parser.parse_args()
    print(f"{'cameras':>7} {'seed':>5} {'F1':>6} {'precision':>9} {'recall':>6} {'place p50':>9} {'p90, m':>7} {'told':>5} {'peer F1':>7}")
    for stand in map(int, options.stands.split(",")):
        sums, errors, playing = [0, 0, 0], [], 0
        for seed in options.seeds.split(","):
            folder = pathlib.Path(options.work) / (f"none_{stand}_{seed}" if options.without else f"{stand}_{seed}")
            if not (folder / "truth.csv").exists():
                folder.mkdir(parents=True, exist_ok=True)
                simulate(options.program, folder, stand, seed, options)
            if options.without:
                print(f"{stand:>7} {seed:>5} {len(ours(options.program, folder))} instants told of a ball that is not there", flush=True)
                continue
            hits, false, missed, off, held = assess(folder, ours(options.program, folder))
            beside = f"{f1(*peer(folder)):.3f}" if options.peer else "-"
            line(stand, seed, hits, false, missed, off, held, beside)
            sums = [a + b for a, b in zip(sums, (hits, false, missed))]
            errors, playing = errors + off, playing + held
        if not options.without:
            line(stand, "all", *sums, errors, playing, "")


def line(stand, seed, hits, false, missed, errors, playing, beside):
    print(f"{stand:>7} {seed:>5} {f1(hits, false, missed):6.3f} {hits / max(1, hits + false):9.3f} {hits / max(1, hits + missed):6.3f} "
          f"{at_fraction(errors, 0.5):9.2f} {at_fraction(errors, 0.9):7.2f} {len(errors) / max(1, playing):5.2f} {beside:>7}", flush=True)


if __name__ == "__main__":
    sys.exit(main())
