"""`marey evaluate` against motmetrics (CLEAR, IDF1: 1e-6) and trackeval (HOTA: 1e-4), on the TUD pairs and on random tracks.

    evaluate_test.py PROGRAM [SEED]      PROGRAM is marey; exits 77 (skipped) where the references are not installed
"""
import json
import math
import os
import pathlib
import random
import subprocess
import sys
import tempfile
import warnings

try:
    import numpy as np
    if not hasattr(np, "asfarray"):  # motmetrics 1.4 still calls it; NumPy 2, which trackeval needs, has it no more
        np.asfarray = lambda values: np.asarray(values, dtype=float)
    import motmetrics as mm
    import pandas as pd
    from trackeval.datasets._base_dataset import _BaseDataset
    from trackeval.metrics import HOTA
except ImportError as missing:
    print(f"skipped: {missing}; script/setup installs it")
    sys.exit(77)

warnings.simplefilter("ignore")
ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
DATA = pathlib.Path(os.environ.get("MAREY_DATA", ROOT / "../shared/data"))
CLEAR = {"mota": "mota", "motp": "motp", "num_false_positives": "fp", "num_misses": "fn", "num_switches": "idsw",
         "num_fragmentations": "frag", "mostly_tracked": "mt", "partially_tracked": "pt", "mostly_lost": "ml", "idf1": "idf1",
         "idp": "idp", "idr": "idr", "precision": "precision", "recall": "recall", "num_frames": "frames"}
BOX = ["X", "Y", "Width", "Height"]
PUBLISHED = {"TUD-Campus": (0.526, 0.558, 13, 150, 7, 0.3914), "TUD-Stadtmitte": (0.564, 0.645, 45, 452, 7, 0.3978)}


def read(path, truth):
    """Rows of frame, id, left, top, width, height by a plain split; pixels from 0, as motmetrics counts."""
    rows = []
    for line in filter(None, pathlib.Path(path).read_text().splitlines()):
        values = [float(field) for field in line.split(",")]
        if not (truth and values[6] == 0):
            rows.append(values[:2] + [values[2] - 1, values[3] - 1] + values[4:6])
    rows.sort(key=lambda row: row[0])
    return rows


def frames_of(rows):
    frames = {}
    for row in rows:
        frames.setdefault(int(row[0]), []).append(row)
    return frames


def by_motmetrics(truth, tracks, iou):
    accumulator = mm.MOTAccumulator()
    true_frames, track_frames = frames_of(truth), frames_of(tracks)
    for frame in sorted(true_frames.keys() | track_frames.keys()):
        rows, columns = true_frames.get(frame, []), track_frames.get(frame, [])
        distances = mm.distances.iou_matrix(np.array([r[2:] for r in rows]), np.array([c[2:] for c in columns]), max_iou=1 - iou)
        accumulator.update([int(r[1]) for r in rows], [int(c[1]) for c in columns], distances, frameid=frame)
    summary = mm.metrics.create().compute(accumulator, metrics=list(CLEAR), name="all")
    return {ours: float(summary[theirs]["all"]) for theirs, ours in CLEAR.items()}


def by_trackeval(truth, tracks):
    objects = {name: i for i, name in enumerate(sorted({r[1] for r in truth}))}
    names = {name: i for i, name in enumerate(sorted({r[1] for r in tracks}))}
    true_frames, track_frames = frames_of(truth), frames_of(tracks)
    data = {"num_gt_dets": len(truth), "num_tracker_dets": len(tracks), "num_gt_ids": len(objects), "num_tracker_ids": len(names),
            "gt_ids": [], "tracker_ids": [], "similarity_scores": []}
    for frame in sorted(true_frames.keys() | track_frames.keys()):
        rows, columns = true_frames.get(frame, []), track_frames.get(frame, [])
        data["gt_ids"].append(np.array([objects[r[1]] for r in rows], dtype=int))
        data["tracker_ids"].append(np.array([names[c[1]] for c in columns], dtype=int))
        data["similarity_scores"].append(_BaseDataset._calculate_box_ious(
            np.array([r[2:] for r in rows]).reshape(-1, 4), np.array([c[2:] for c in columns]).reshape(-1, 4)))
    result = HOTA().eval_sequence(data)
    return {"hota": result["HOTA"].mean(), "deta": result["DetA"].mean(), "assa": result["AssA"].mean(), "loca": result["LocA"].mean()}


def by_marey(program, truth_path, tracks_path, iou):
    done = subprocess.run([program, "evaluate", "--motchallenge", "--truth", truth_path, "--tracks", tracks_path, "--iou", repr(iou), "--json"],
                          capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def same(ours, theirs, tolerance):
    if not math.isfinite(theirs):
        return ours is None
    return ours is not None and abs(ours - theirs) <= tolerance


def compare(program, truth_path, tracks_path, iou, name):
    truth, tracks = read(truth_path, True), read(tracks_path, False)
    ours = by_marey(program, str(truth_path), str(tracks_path), iou)
    problems = []
    if truth and tracks:  # motmetrics fails where either is empty
        for key, value in by_motmetrics(truth, tracks, iou).items():
            if not same(ours[key], value, 1e-6):
                problems.append(f"{name}: {key} is {ours[key]}, motmetrics says {value}")
    for key, value in by_trackeval(truth, tracks).items():
        if not same(ours[key], value, 1e-4):
            problems.append(f"{name}: {key} is {ours[key]}, trackeval says {value}")
    return ours, problems


def random_scene(rng):
    """Walkers that cross and pause, a tracker that jitters, loses, swaps, doubles and invents. On a grid of whole pixels in half
    of the scenes, where many overlaps and costs are equal; sometimes with boxes not to be evaluated, or one side empty."""
    digits = rng.choice([0, 2])
    frames, people = rng.randint(1, 40), rng.randint(1, 8)
    first = rng.choice([1, 1, 1, 500])
    write = lambda frame, name, box, score: f"{frame},{name}," + ",".join(f"{v:.{digits}f}" for v in box) + f",{score},-1,-1,-1"
    truth, tracks = [], []
    names = {person: person + 1 for person in range(people)}
    unused = people + 1
    places = [[rng.uniform(0, 100), rng.uniform(0, 40), rng.uniform(-4, 4), rng.uniform(-1, 1)] for _ in range(people)]
    for frame in range(first, first + frames):
        if rng.random() < 0.08:  # a frame that neither side has
            continue
        blind = rng.random() < 0.05
        if rng.random() < 0.2 and people > 1:
            a, b = rng.sample(range(people), 2)
            names[a], names[b] = names[b], names[a]
        order = list(range(people))
        rng.shuffle(order)
        for person in order:
            place = places[person]
            place[0] += place[2]
            place[1] += place[3]
            box = [place[0], place[1], 20, 40]
            if rng.random() < 0.9:
                truth.append(write(frame, person + 1, box, 0 if rng.random() < 0.05 else 1))
            if rng.random() < 0.05:
                names[person], unused = unused, unused + 1
            if not blind and rng.random() < 0.85:
                jitter = rng.choice([0, 2, 6])
                tracks.append(write(frame, names[person], [box[0] + rng.uniform(-jitter, jitter), box[1] + rng.uniform(-jitter, jitter),
                                                           20 + rng.uniform(0, jitter), 40], 1))
                if rng.random() < 0.1:  # two tracks on one person
                    tracks.append(write(frame, 1000 + names[person], box, 1))
        if rng.random() < 0.2:
            tracks.append(write(frame, 2000 + rng.randint(0, 2), [rng.uniform(0, 100), rng.uniform(0, 40), 20, 40], 1))
    if rng.random() < 0.03:
        truth = []
    if rng.random() < 0.03:
        tracks = []
    if rng.random() < 0.2:  # what does not overlap in time
        tracks = [f"{int(t.split(',')[0]) + frames // 2},{t.split(',', 1)[1]}" for t in tracks]
    if rng.random() < 0.3:  # lines in any order
        order = {line: rng.random() for line in tracks}
        tracks.sort(key=order.get)
    return truth, tracks


def main(program, seed):
    problems, pairs = [], 0
    for name, (mota, idf1, fp, fn, switches, hota) in PUBLISHED.items():
        folder = DATA / "tud" / name
        if not folder.exists():
            print(f"{folder} is not here: the published figures are not checked")
            continue
        ours, wrong = compare(program, folder / "gt.txt", folder / "test.txt", 0.5, name)
        problems += wrong
        if (round(ours["mota"], 3), round(ours["idf1"], 3), ours["fp"], ours["fn"], ours["idsw"], round(ours["hota"], 4)) != (
                mota, idf1, fp, fn, switches, hota):
            problems.append(f"{name}: {ours} is not what was published")
        pairs += 1
    print(f"seed {seed}")
    rng = random.Random(seed)
    with tempfile.TemporaryDirectory() as folder:
        truth_path, tracks_path = pathlib.Path(folder, "truth.txt"), pathlib.Path(folder, "tracks.txt")
        for scene in range(120):
            truth, tracks = random_scene(rng)
            truth_path.write_text("\n".join(truth) + "\n")
            tracks_path.write_text("\n".join(tracks) + "\n")
            iou = rng.choice([0.5, 0.5, 0.3, 0.7])
            problems += compare(program, truth_path, tracks_path, iou, f"scene {scene} of seed {seed}, IoU {iou}")[1]
            pairs += 1
    print("\n".join(problems) or f"marey evaluate agrees with motmetrics and trackeval on {pairs} pairs")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else random.SystemRandom().randrange(2**32)))
