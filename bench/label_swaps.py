#!/usr/bin/env python3
"""Exchanged names that `marey label` puts right, in walks whose true names are known.

Usage: label_swaps.py MAREY DATA [--subjects HC002D,...] [--swaps 20] [--seed 1] [--from turn]

DATA is the folder that tests call MAREY_DATA. In each child's walk straight on, two markers within 0.4 m of each other exchange names, `swaps` times:
both are hidden for 0.03 to 0.15 s where they are nearest within a random second, and come back under each other's name, for 0.1 to 0.5 s or to the end. A
set learned from the child's turn (or static trial) then names the walk again. A swap is corrected where no point of the two bears the other's name any
more; false is a stretch of points that had the right name before and has another after. Beside it a naive peer: a name belongs to the point nearest to
where its constant velocity leads, from the first frame on, which knows no bodies.
"""
import argparse
import math
import pathlib
import random
import subprocess
import tempfile

from labels import key, print_row, read, rows_of, write

NEAR_M = 0.4


def inject(points, count, chance):
    """By label its places with `count` swaps in them, and (a, b, first, last) of each. What is hidden goes out of `points` too."""
    names = {label: dict(places) for label, places in points.items()}
    frames = sorted({frame for places in points.values() for frame in places})
    swaps, labels = [], sorted(points)
    while len(swaps) < count:
        a, b = chance.sample(labels, 2)
        begin = chance.choice(frames)
        both = [f for f in range(begin, begin + 100) if f in points[a] and f in points[b]]
        if not both:
            continue
        first = min(both, key=lambda f: math.dist(points[a][f], points[b][f]))
        if math.dist(points[a][first], points[b][first]) > NEAR_M:
            continue
        last = frames[-1] if chance.random() < 0.3 else first + chance.randint(10, 50)
        if any({a, b} & {c, d} for c, d, _, _ in swaps):
            taken = {name for c, d, f, l in swaps for name in (c, d) if f <= last and first <= l}
            if {a, b} & taken:
                continue
        hidden = chance.randint(3, 15)
        for frame in range(first - hidden // 2, first + hidden // 2 + 1):
            for label in (a, b):
                points[label].pop(frame, None)
                names[label].pop(frame, None)
        for frame in range(first, last + 1):
            there = names[a].pop(frame, None), names[b].pop(frame, None)
            if there[0]:
                names[b][frame] = there[0]
            if there[1]:
                names[a][frame] = there[1]
        swaps.append((a, b, first, min(last, frames[-1])))
    return names, swaps


def assess(named, points, before, swaps):
    """Swaps corrected; stretches that were right before and are not now; share of points right."""
    truth = {key(frame, place): label for label, places in points.items() for frame, place in places.items()}
    had = {key(frame, place): label for label, places in before.items() for frame, place in places.items()}
    now = {key(frame, place): label for frame, label, place in named}
    right = 0
    for a, b, first, last in swaps:
        there = [key(f, points[m][f]) for m in (a, b) for f in range(first, last + 1) if f in points[m]]
        right += all(now.get(k, truth[k]) == truth[k] for k in there)
    spoilt = {}
    for k, label in now.items():
        if had.get(k) == truth.get(k) != label:
            spoilt.setdefault((truth.get(k), label), []).append(k[0])
    false = 0
    for frames in spoilt.values():
        frames.sort()
        false += 1 + sum(later - earlier > 10 for earlier, later in zip(frames, frames[1:]))
    share = sum(now.get(k) == label for k, label in truth.items()) / len(truth)
    return right, false, share


def by_marey(marey, teacher, before, work):
    write(work / "teacher.csv", sorted(teacher.items()), 100)
    write(work / "swapped.csv", sorted(before.items()), 100)
    subprocess.run([marey, "label", "learn", work / "teacher.csv", "-o", work / "set.toml", "-q"], check=True)
    subprocess.run([marey, "label", work / "swapped.csv", "--marker-set", work / "set.toml", "-o", work / "named.csv", "-q"], check=True)
    return rows_of(work / "named.csv")


def by_velocity(before):
    frames = {}
    for label, places in before.items():
        for frame, place in places.items():
            frames.setdefault(frame, []).append((label, place))
    last, named = {}, []
    for frame in sorted(frames):
        due = {name: tuple(p + v for p, v in zip(place, velocity)) for name, (place, velocity) in last.items()}
        pairs = sorted((math.dist(place, at), name, i) for i, (_, place) in enumerate(frames[frame]) for name, at in due.items())
        used, given = set(), set()
        for distance, name, i in pairs:
            if distance > 0.05 or i in used or name in given:
                continue
            used.add(i)
            given.add(name)
            place = frames[frame][i][1]
            last[name] = place, tuple(a - b for a, b in zip(place, last[name][0]))
            named.append((frame, name, place))
        for i, (label, place) in enumerate(frames[frame]):
            if i not in used and label not in given:
                last[label] = place, (0, 0, 0)
                given.add(label)
                named.append((frame, label, place))
    return named


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("marey")
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("--subjects", default="HC002D,HC030A,HC031A,HC033A,HC038A,HC044A")
    parser.add_argument("--swaps", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--from", dest="teacher", choices=["turn", "static"], default="turn")
    options = parser.parse_args()
    work = pathlib.Path(tempfile.mkdtemp(prefix="marey_swaps_"))
    print_row(["subject", "seconds", "marey label: corrected", "spoilt", "points right, %", "naive peer: corrected", "spoilt", "points right, %"])
    print_row(["---"] * 8)
    for subject in options.subjects.split(","):
        folder = options.data / "gait_children" / subject
        points, teacher = (read(options.marey, next(folder.glob(kind + "_*.c3d")), work) for kind in ("straight", options.teacher))
        before, swaps = inject(points, options.swaps, random.Random(f"{options.seed} {subject}"))
        cells = [subject, f"{len({f for places in points.values() for f in places}) / 100:.1f}"]
        for named in (by_marey(options.marey, teacher, before, work), by_velocity(before)):
            right, false, share = assess(named, points, before, swaps)
            cells += [f"{right} of {len(swaps)}", str(false), f"{100 * share:.2f}"]
        print_row(cells)


if __name__ == "__main__":
    main()
