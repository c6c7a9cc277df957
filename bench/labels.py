#!/usr/bin/env python3
"""`marey label` on recordings whose names are known: taken away, 5 % hidden in gaps, tracks broken there, 5 % ghosts.

Usage: labels.py MAREY DATA [--subjects HC002D,...] [--max-occlusion 0.05] [--ghosts 0.05] [--gap 10] [--seed 1] [--unseen] [--live]

DATA is the folder that tests call MAREY_DATA. For each child of gait_children the walk straight on is named by a set learned from its turn, and
by one from its static trial; with --unseen also by one from the other children's walks and turns, scaled. Prints a Markdown table: right and wrong (ghosts
with a name among them), % of the points that belong to the set; the rest has no name. With --live the points are named within the frame too
(build/release/bench/live_labels): of those frames that come after the first with a name. The last column is a naive peer, which knows the true names of the first
frame and hands each on to the nearest point within 50 mm. The labels of HC038A's wrists are exchanged between its turn and its walk in the files themselves.
"""
import argparse
import csv
import json
import pathlib
import random
import subprocess
import tempfile

LIVE = pathlib.Path(__file__).resolve().parent.parent / "build/release/bench/live_labels"
MARKERS = """LFHD RFHD LBHD RBHD C7 T10 CLAV STRN RBAK LSHO LELB LWRA LWRB LFIN RSHO RELB RWRA RWRB RFIN LASI RASI LPSI RPSI SACR
LTHI LKNE LTIB LANK LHEE LTOE RTHI RKNE RTIB RANK RHEE RTOE""".split()


def read(marey, file, work):
    out = work / (file.stem + ".csv")
    if not out.exists():
        subprocess.run([marey, "convert", file, out, "-q"], check=True)
    with open(out, newline="") as rows:
        points = {}
        for row in csv.DictReader(rows):
            if row["label"] in MARKERS and row["state"] in ("", "measured"):
                points.setdefault(row["label"], {})[int(row["frame"])] = tuple(
                    round(float(row[axis]), 6) for axis in "xyz")  # so that a point is known again in what comes back
    return points


def write(file, tracks, rate):
    with open(file, "w") as out:
        out.write("frame,time,id,label,x,y,z\n")
        rows = sorted((frame, track, label, place) for track, (label, places) in enumerate(tracks, 1) for frame, place in places.items())
        for frame, track, label, place in rows:
            out.write(f"{frame},{frame / rate:.6f},{track},{label},{place[0]:.9f},{place[1]:.9f},{place[2]:.9f}\n")


def strip(points, options, chance):
    """Tracks without names, and whose each point is."""
    frames = sorted({frame for places in points.values() for frame in places})
    tracks, truth = [], {}
    for label, places in sorted(points.items()):
        hidden, piece = set(), {}
        for frame in frames:
            if chance.random() < options.max_occlusion / options.gap:
                hidden.update(range(frame, frame + chance.randint(1, 2 * options.gap - 1)))
        for frame in frames:
            if frame in hidden or frame not in places:
                if piece:
                    tracks.append(("", piece))
                piece = {}
                continue
            piece[frame] = places[frame]
            truth[key(frame, places[frame])] = label
        if piece:
            tracks.append(("", piece))
    every = [place for places in points.values() for place in places.values()]
    low, high = [min(p[i] for p in every) for i in range(3)], [max(p[i] for p in every) for i in range(3)]
    made = 0
    while made < options.ghosts * len(every):
        first, place = chance.choice(frames), tuple(chance.uniform(a, b) for a, b in zip(low, high))
        piece = {frame: place for frame in range(first, min(first + chance.randint(1, 10), frames[-1] + 1))}
        made += len(piece)
        tracks.append(("", piece))
    return tracks, truth


def key(frame, place):
    return frame, *(round(value, 6) for value in place)


def assess(named, truth, known):
    right = wrong = 0
    for frame, label, place in named:
        true = truth.get(key(frame, place), "")
        right += true == label
        wrong += true != label
    total = sum(label in known for label in truth.values())
    return f"{100 * right / total:.2f}, {100 * wrong / total:.2f}"


def label(marey, train, tracks, truth, work, scaled=False):
    names = []
    for index, points in enumerate(train):
        names.append(work / f"train{index}.csv")
        write(names[-1], sorted(points.items()), 100)
    known = sorted({name for points in train for name in points})
    write(work / "bare.csv", tracks, 100)
    subprocess.run([marey, "label", "learn", *names, "--markers", ",".join(known), "-o", work / "set.toml", "-q"] + ["--scale-invariant"] * scaled, check=True)
    done = subprocess.run([marey, "label", work / "bare.csv", "--marker-set", work / "set.toml", "-o", work / "named.csv", "-q"], capture_output=True, text=True)
    if done.returncode != 0:
        return "none: " + done.stderr.strip().splitlines()[-1].rpartition(": ")[2]
    return assess(rows_of(work / "named.csv"), truth, known)


def rows_of(file):
    with open(file, newline="") as rows:
        return [(int(r["frame"]), r["label"], (float(r["x"]), float(r["y"]), float(r["z"]))) for r in csv.DictReader(rows) if r["label"]]


def live(truth, work):
    """The last recording that was named, within the frame, by the set that was learned for it."""
    subprocess.run([LIVE, work / "bare.csv", "--marker-set", work / "set.toml", "-o", work / "live.csv"], check=True)
    named = rows_of(work / "live.csv")
    if not named:
        return "none"
    first = min(frame for frame, _, _ in named)
    after = {of: label for of, label in truth.items() if of[0] >= first}
    return assess(named, after, set(after.values()))


def naive(tracks, truth):
    """Names of the first frame, forwarded to the nearest point."""
    frames = {}
    for _, places in tracks:
        for frame, place in places.items():
            frames.setdefault(frame, []).append(place)
    last, named = {}, []
    for frame in sorted(frames):
        if not last:
            last = {truth[key(frame, place)]: place for place in frames[frame] if key(frame, place) in truth}
        pairs = sorted((sum((a - b) ** 2 for a, b in zip(place, at)), name, i)
                       for i, place in enumerate(frames[frame]) for name, at in last.items())
        used, given = set(), set()
        for square, name, i in pairs:
            if square > 0.05 ** 2 or name in given or i in used:
                continue
            used.add(i)
            given.add(name)
            last[name] = frames[frame][i]
            named.append((frame, name, frames[frame][i]))
    return assess(named, truth, set(truth.values()))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("marey")
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("--subjects", default="HC002D,HC030A,HC031A,HC033A,HC038A,HC044A")
    parser.add_argument("--max-occlusion", type=float, default=0.05)
    parser.add_argument("--ghosts", type=float, default=0.05)
    parser.add_argument("--gap", type=int, default=10, help="frames, on average")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--unseen", action="store_true")
    parser.add_argument("--live", action="store_true")
    options = parser.parse_args()
    work = pathlib.Path(tempfile.mkdtemp(prefix="marey_labels_"))
    folder = options.data / "gait_children"
    subjects = options.subjects.split(",")

    def take(subject, kind):
        return read(options.marey, next((folder / subject).glob(kind + "_*.c3d")), work)

    titles = ["subject", "its turn", "its static trial"]
    if options.live:
        titles = ["subject", "its turn", "its turn, live", "its static trial", "its static trial, live"]
    titles += ["the others"] * options.unseen + ["naive peer"]
    print_row(titles)
    print_row(["---"] * len(titles))
    for subject in subjects:
        tracks, truth = strip(take(subject, "straight"), options, random.Random(f"{options.seed} {subject}"))
        cells = [subject]
        for kind in ("turn", "static"):
            cells.append(label(options.marey, [take(subject, kind)], tracks, truth, work))
            if options.live:
                cells.append(live(truth, work))
        if options.unseen:
            others = [take(other, kind) for other in sorted(p.name for p in folder.iterdir() if p.is_dir()) if other != subject
                      for kind in ("straight", "turn")]
            cells.append(label(options.marey, others, tracks, truth, work, scaled=True))
        print_row([*cells, naive(tracks, truth)])


def print_row(cells):
    print("| " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    main()
