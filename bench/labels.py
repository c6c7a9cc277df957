#!/usr/bin/env python3
"""`marey label` on recordings whose names are known: taken away, 5 % hidden in gaps, tracks broken there, 5 % ghosts.

Usage: labels.py MAREY DATA [--subjects HC002D,...] [--max-occlusion 0.05] [--ghosts 0.05] [--gap 10] [--seed 1] [--unseen] [--live] [--other-sets] [--labels-of-files]

DATA is the folder that tests call MAREY_DATA. For each child of gait_children the walk straight on is named by a set learned from its turn, and
by one from its static trial; with --unseen also by one from the other children's walks and turns, scaled. Prints a Markdown table: right and wrong (ghosts
with a name among them), % of the points that belong to the set; the rest has no name. With --live the points are named within the frame too
(build/release/bench/live_labels): of those frames that come after the first with a name. The last column is a naive peer, which knows the true names of the first
frame and hands each on to the nearest point within 50 mm. With --other-sets another table: the set that one person taught names another one's recording, each child's turn the others' walks, and both takes of
vicon_skeleton; mean over the recordings, how many sets were said not to fit, and the same of those that were not. In two children's files markers of a wrist are exchanged: in walking A lies 43 to 67 mm ahead of B on every wrist but HC030A's left (60 behind, in all takes) and both of HC038A's
walk (54 and 53 behind; ahead in its turn). They are exchanged back, in what teaches and in the truth, except with --labels-of-files.
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

SWAPPED_WRISTS = {"HC030A static": "L", "HC030A turn": "L", "HC030A straight": "L", "HC038A straight": "LR"}


def with_swaps_undone(points, sides):
    back = {side + a: side + b for side in sides for a, b in (("WRA", "WRB"), ("WRB", "WRA"))}
    return {back.get(label, label): places for label, places in points.items()}


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


def label_by_other(marey, learned, tracks, truth, known, work):
    """Right and wrong, %, and whether the set is said not to fit."""
    write(work / "bare.csv", tracks, 100)
    done = subprocess.run([marey, "label", work / "bare.csv", "--marker-set", learned, "-o", work / "named.csv", "--json"], capture_output=True, text=True)
    if done.returncode != 0:
        return 0.0, 0.0, True
    right, wrong = (float(value) for value in assess(rows_of(work / "named.csv"), truth, known).split(", "))
    return right, wrong, "not fit" in done.stderr


def other_sets(options, people, work):
    """people: by name what teaches, and what is named."""
    found = []
    for teacher, (lesson, _) in people.items():
        write(work / "lesson.csv", sorted(lesson.items()), 100)
        subprocess.run([options.marey, "label", "learn", work / "lesson.csv", "--markers", ",".join(sorted(lesson)), "-o", work / "other.toml", "-q"], check=True, capture_output=True)
        for other, (_, walk) in people.items():
            if other != teacher:
                tracks, truth = strip(walk, options, random.Random(f"{options.seed} {other}"))
                found.append((teacher, other, *label_by_other(options.marey, work / "other.toml", tracks, truth, set(lesson), work)))
    return found


def print_other_sets(options, name, people, work):
    found = other_sets(options, people, work)
    trusted = [row for row in found if not row[4]]
    mean = lambda rows, i: f"{sum(row[i] for row in rows) / len(rows):.2f}" if rows else "–"
    print_row([name, str(len(found)), f"{mean(found, 2)}, {mean(found, 3)}", str(len(found) - len(trusted)), f"{mean(trusted, 2)}, {mean(trusted, 3)}"])


def all_labels(marey, file, work):
    """Every label of a C3D file."""
    out = work / (file.stem + "_all.csv")
    subprocess.run([marey, "convert", file, out, "-q"], check=True, capture_output=True)
    points = {}
    with open(out, newline="") as rows:
        for row in csv.DictReader(rows):
            if row["state"] in ("", "measured"):
                points.setdefault(row["label"].rpartition(":")[2], {})[int(row["frame"])] = tuple(round(float(row[axis]), 6) for axis in "xyz")
    return points


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
    parser.add_argument("--other-sets", action="store_true")
    parser.add_argument("--labels-of-files", action="store_true", help="without exchanging back wrists that are exchanged in the files")
    options = parser.parse_args()
    work = pathlib.Path(tempfile.mkdtemp(prefix="marey_labels_"))
    folder = options.data / "gait_children"
    subjects = options.subjects.split(",")

    def take(subject, kind):
        points = read(options.marey, next((folder / subject).glob(kind + "_*.c3d")), work)
        return points if options.labels_of_files else with_swaps_undone(points, SWAPPED_WRISTS.get(f"{subject} {kind}", ""))

    if options.other_sets:
        print_row(["whose sets", "recordings", "right, wrong", "said not to fit", "right, wrong of the others"])
        print_row(["---"] * 5)
        print_other_sets(options, "children", {subject: (take(subject, "turn"), take(subject, "straight")) for subject in subjects}, work)
        two = [all_labels(options.marey, options.data / "vicon_skeleton" / name, work) for name in ("nick_freeform_001.c3d", "squat.c3d")]
        print_other_sets(options, "vicon_skeleton", {str(i): (take, take) for i, take in enumerate(two)}, work)
        return
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
