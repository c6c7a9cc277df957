"""`marey evaluate --distance` against motmetrics (CLEAR, IDF1: 1e-6) and trackeval (HOTA: 1e-4) on random people on the ground.

    evaluate_ground_test.py PROGRAM [SEED]      PROGRAM is marey; exits 77 (skipped) where the references are not installed
"""
import json
import math
import pathlib
import random
import subprocess
import sys
import tempfile

from evaluate_test import CLEAR, HOTA, frames_of, mm, np, same


def distances(rows, columns):
    return np.array([[math.hypot(r[2] - c[2], r[3] - c[3]) for c in columns] for r in rows]).reshape(len(rows), len(columns))


def by_motmetrics(truth, tracks, farthest):
    accumulator = mm.MOTAccumulator()
    true_frames, track_frames = frames_of(truth), frames_of(tracks)
    for frame in sorted(true_frames.keys() | track_frames.keys()):
        rows, columns = true_frames.get(frame, []), track_frames.get(frame, [])
        apart = distances(rows, columns)
        accumulator.update([int(r[1]) for r in rows], [int(c[1]) for c in columns], np.where(apart > farthest, np.nan, apart), frameid=frame)
    summary = mm.metrics.create().compute(accumulator, metrics=list(CLEAR), name="all")
    return {ours: float(summary[theirs]["all"]) for theirs, ours in CLEAR.items()}


def by_trackeval(truth, tracks, farthest):
    objects = {name: i for i, name in enumerate(sorted({r[1] for r in truth}))}
    names = {name: i for i, name in enumerate(sorted({r[1] for r in tracks}))}
    true_frames, track_frames = frames_of(truth), frames_of(tracks)
    data = {"num_gt_dets": len(truth), "num_tracker_dets": len(tracks), "num_gt_ids": len(objects), "num_tracker_ids": len(names),
            "gt_ids": [], "tracker_ids": [], "similarity_scores": []}
    for frame in sorted(true_frames.keys() | track_frames.keys()):
        rows, columns = true_frames.get(frame, []), track_frames.get(frame, [])
        data["gt_ids"].append(np.array([objects[r[1]] for r in rows], dtype=int))
        data["tracker_ids"].append(np.array([names[c[1]] for c in columns], dtype=int))
        data["similarity_scores"].append(np.maximum(0, 1 - distances(rows, columns) / farthest))
    result = HOTA().eval_sequence(data)
    return {"hota": result["HOTA"].mean(), "deta": result["DetA"].mean(), "assa": result["AssA"].mean(), "loca": result["LocA"].mean()}


def random_match(rng):
    """People who run about, cross and leave; a tracker that jitters, loses, swaps and invents."""
    people = [[rng.uniform(0, 20), rng.uniform(0, 10), rng.uniform(-0.3, 0.3), rng.uniform(-0.3, 0.3)] for _ in range(rng.randint(1, 10))]
    names = list(range(1, len(people) + 1))
    truth, tracks = [], []
    for frame in range(rng.randint(5, 60)):
        if rng.random() < 0.1 and len(people) > 1:
            a, b = rng.sample(range(len(people)), 2)
            names[a], names[b] = names[b], names[a]
        for i, person in enumerate(people):
            person[0] += person[2]
            person[1] += person[3]
            if rng.random() < 0.95:
                truth.append((frame, i + 1, round(person[0], 3), round(person[1], 3)))
            if rng.random() < 0.85:
                spread = rng.choice([0, 0.3, 1.0])
                tracks.append((frame, names[i], round(person[0] + rng.gauss(0, spread), 3), round(person[1] + rng.gauss(0, spread), 3)))
        if rng.random() < 0.3:
            tracks.append((frame, 900 + rng.randint(0, 1), round(rng.uniform(0, 20), 3), round(rng.uniform(0, 10), 3)))
        truth.append((frame, 500, 40.0, 40.0))  # one in every frame, so that both files tell the same instants
        tracks.append((frame, 501, 40.5, 40.0))
    return truth, tracks


def write(path, rows):
    path.write_text("frame,time,id,x,y\n" + "".join(f"{r[0]},{r[0] / 25:.4f},{r[1]},{r[2]},{r[3]}\n" for r in rows))


def main(program, seed):
    print(f"seed {seed}")
    rng, problems = random.Random(seed), []
    with tempfile.TemporaryDirectory() as folder:
        truth_path, tracks_path = pathlib.Path(folder, "truth.csv"), pathlib.Path(folder, "tracks.csv")
        for scene in range(60):
            truth, tracks = random_match(rng)
            write(truth_path, truth)
            write(tracks_path, tracks)
            farthest = rng.choice([0.5, 1.0, 1.5])
            done = subprocess.run([program, "evaluate", "--truth", truth_path, "--tracks", tracks_path, "--distance", str(farthest), "--json"],
                                  capture_output=True, text=True)
            assert done.returncode == 0, done.stderr
            ours = json.loads(done.stdout)
            for reference, tolerance in ((by_motmetrics, 1e-6), (by_trackeval, 1e-4)):
                for key, value in reference(truth, tracks, farthest).items():
                    if not same(ours[key], value, tolerance):
                        problems.append(f"scene {scene} of seed {seed}, {farthest} m: {key} is {ours[key]}, {reference.__name__} {value}")
    print("\n".join(problems) or "marey evaluate --distance agrees with motmetrics and trackeval on 60 matches")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else random.SystemRandom().randrange(2**32)))
