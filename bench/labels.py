#!/usr/bin/env python3
"""`marey label` on recordings whose names are known: taken away, 5 % hidden in gaps, tracks broken there, 5 % ghosts.

Usage: labels.py MAREY DATA [--subjects HC002D,...] [--hidden 0.05] [--ghosts 0.05] [--gap 10] [--seed 1] [--unseen] [--live]

DATA is the folder that tests call MAREY_DATA. For each child of gait_children the walk straight on is named by a set learned from its turn, and
by one from its static trial; with --unseen also by one from the other children's walks and turns, scaled. Right, wrong (ghosts with a name among them) and
unnamed are shares of the points that belong to the set. With --live each walk is played too, at a third of its speed, and its points are named within the
frame (`marey play --set`): of those frames that come after the first with a name. Beside it a naive peer, which knows the true names of the first frame and hands each on to the
nearest point within 50 mm. The labels of HC038A's wrists are exchanged between its turn and its walk in the files themselves.
"""
import argparse
import csv
import json
import pathlib
import random
import socket
import subprocess
import tempfile
import time

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
            if chance.random() < options.hidden / options.gap:
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


def judge(named, truth, known):
    right = wrong = 0
    for frame, label, place in named:
        true = truth.get(key(frame, place), "")
        right += true == label
        wrong += true != label
    total = sum(label in known for label in truth.values())
    return f"right {100 * right / total:6.2f} %  wrong {100 * wrong / total:5.2f} %  unnamed {100 * (total - right - wrong) / total:6.2f} %"


def label(marey, train, tracks, truth, work, scaled=False):
    names = []
    for index, points in enumerate(train):
        names.append(work / f"train{index}.csv")
        write(names[-1], sorted(points.items()), 100)
    known = sorted({name for points in train for name in points})
    write(work / "bare.csv", tracks, 100)
    subprocess.run([marey, "label", "learn", *names, "--markers", ",".join(known), "-o", work / "set.toml", "-q"] + ["--scaled"] * scaled, check=True)
    done = subprocess.run([marey, "label", work / "bare.csv", "--set", work / "set.toml", "-o", work / "named.csv", "-q"], capture_output=True, text=True)
    if done.returncode != 0:
        return done.stderr.strip()
    with open(work / "named.csv", newline="") as rows:
        named = [(int(r["frame"]), r["label"], (float(r["x"]), float(r["y"]), float(r["z"]))) for r in csv.DictReader(rows) if r["label"]]
    return judge(named, truth, known)


def live(marey, truth, work):
    """The last recording that was named, played, by the set that was learned for it."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        port = server.getsockname()[1]
    played = subprocess.Popen([marey, "play", work / "bare.csv", "--set", work / "set.toml", "--speed", "0.33", "-q", "--stream", f"json::{port}"],
                              stderr=subprocess.PIPE, text=True)
    told = None
    while told is None and played.poll() is None:
        try:
            told = socket.create_connection(("127.0.0.1", port), timeout=60).makefile()
        except OSError:
            time.sleep(0.02)
    named, first = [], None
    for line in told or []:
        frame = json.loads(line)
        for point in frame["points"] if frame["type"] == "frame" else []:
            if not point.get("label"):
                continue
            first = frame["frame"] if first is None else first
            named.append((frame["frame"], point["label"], (point["x"], point["y"], point["z"])))
    said = played.communicate()[1].strip()
    after = {of: label for of, label in truth.items() if first is not None and of[0] >= first}
    return f"{judge(named, after, set(after.values()))}  from frame {first} on" if after else f"nothing was named: {said}"


def naive(tracks, truth):
    """Names of the first frame, handed on to the nearest point."""
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
    return judge(named, truth, set(truth.values()))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("marey")
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("--subjects", default="HC002D,HC030A,HC031A,HC033A,HC038A,HC044A")
    parser.add_argument("--hidden", type=float, default=0.05)
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

    for subject in subjects:
        tracks, truth = strip(take(subject, "straight"), options, random.Random(f"{options.seed} {subject}"))
        print(f"{subject} {len(tracks)} tracks")
        for kind in ("turn", "static"):
            print(f"  from its {kind:8} {label(options.marey, [take(subject, kind)], tracks, truth, work)}", flush=True)
            if options.live:
                print(f"    in the frame    {live(options.marey, truth, work)}", flush=True)
        if options.unseen:
            others = [take(other, kind) for other in sorted(p.name for p in folder.iterdir() if p.is_dir()) if other != subject
                      for kind in ("straight", "turn")]
            print(f"  from others      {label(options.marey, others, tracks, truth, work, scaled=True)}", flush=True)
        print(f"  naive peer       {naive(tracks, truth)}", flush=True)


if __name__ == "__main__":
    main()
