#!/usr/bin/env python3
"""A weak detector, simulated: boxes of the truth, missed in runs, with false ones between, and noise on every side.

Usage: weak_detector.py TRUTH.txt OUT.txt --seed N [--missed SHARE] [--false SHARE] [--noise SHARE] [--rate HZ]

A person goes in and out of being found by a two-state chain (a run of misses lasts RUN seconds in the mean), a false box stands
anywhere in the image with a person's size, every side of a true box is off by NOISE of the box's height. MOT text in and out.
"""
import argparse
import collections
import random


def read(path):
    boxes = collections.defaultdict(dict)
    with open(path) as file:
        for line in file:
            frame, person, left, top, width, height = map(float, line.split(",")[:6])
            boxes[int(frame)][int(person)] = (left, top, width, height)
    return boxes


def weaken(boxes, seed, missed=0.3, false=0.1, noise=0.08, rate=7.0, run=0.6):
    """{frame: [(left, top, width, height, score)]}"""
    draw = random.Random(seed)
    back = 1 / max(1.0, run * rate)             # chance, a frame, that a person who is missed is found again
    away = back * missed / (1 - missed)         # that the share of misses is `missed` in the long run
    found, sizes, result = {}, [], collections.defaultdict(list)
    right = max(l + w for people in boxes.values() for l, t, w, h in people.values())
    bottom = max(t + h for people in boxes.values() for l, t, w, h in people.values())
    for frame in range(min(boxes), max(boxes) + 1):
        for person, (left, top, width, height) in sorted(boxes.get(frame, {}).items()):
            sizes.append((width, height))
            before = found.get(person)
            change = draw.random()
            found[person] = draw.random() >= missed if before is None else (change >= away if before else change < back)
            if found[person]:
                sides = [draw.gauss(0, noise * height / 2 ** 0.5) for _ in range(4)]
                # centre and size are off by NOISE of the height in the mean, each
                w = max(4.0, width + 0.5 * (sides[2] - sides[0]))
                h = max(8.0, height + 0.5 * (sides[3] - sides[1]))
                x = left + width / 2 + (sides[0] + sides[2]) / 2
                y = top + height / 2 + (sides[1] + sides[3]) / 2
                result[frame].append((x - w / 2, y - h / 2, w, h, draw.uniform(0.45, 1)))
            if draw.random() < false * (1 - missed):
                w, h = draw.choice(sizes)
                result[frame].append((draw.uniform(0, right - w), draw.uniform(0, bottom - h), w, h, draw.uniform(0.3, 0.9)))
    return result


def write(path, detections):
    with open(path, "w") as file:
        for frame in sorted(detections):
            for left, top, width, height, score in detections[frame]:
                file.write(f"{frame},-1,{left:.2f},{top:.2f},{width:.2f},{height:.2f},{score:.3f},-1,-1,-1\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("truth")
    parser.add_argument("out")
    parser.add_argument("--seed", type=int, required=True)
    for name, value in (("missed", 0.3), ("false", 0.1), ("noise", 0.08), ("rate", 7.0), ("run", 0.6)):
        parser.add_argument("--" + name, type=float, default=value)
    given = parser.parse_args()
    write(given.out, weaken(read(given.truth), given.seed, given.missed, given.false, given.noise, given.rate, given.run))


if __name__ == "__main__":
    main()
