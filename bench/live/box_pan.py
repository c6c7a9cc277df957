#!/usr/bin/env python3
"""What a slow pan costs on simulated street boxes: the same people before a camera that stands and one that
pans, boxes weakened by weak_detector.py; and what the pan shows in the coordinates of the standing camera, its path known exactly.

Usage: box_pan.py MAREY [--seeds 24] [--degrees 7]

"at most" is the IDF1 of a tracker that errs nowhere but gives everybody who comes back into the picture a new number: people leave
and enter at borders that move. The scenes of box_peers.py have other people each.
"""
import argparse
import dataclasses
import math
import pathlib
import statistics
import subprocess
import tempfile

import box_scenes
import live_peers
import weak_detector

STREET = next(scene for scene in box_scenes.SCENES if scene.name == "street, still")


def shift(still, pan):
    """px, by frame: how much farther to the right people stand in the picture of the camera that stands."""
    result, last = {}, 0.0
    for frame, people in pan.items():
        whole = [p for p in people if p in still.get(frame, {})
                 and all(b[0] > 3 and b[0] + b[2] < box_scenes.WIDTH - 3 for b in (people[p], still[frame][p]))]
        if whole:
            last = statistics.median(still[frame][p][0] + still[frame][p][2] / 2 - people[p][0] - people[p][2] / 2 for p in whole)
        result[frame] = last
    return result


def shifted(boxes, by):
    return {frame: {who: (b[0] + by[frame], *b[1:]) for who, b in people.items()} for frame, people in boxes.items()}


def at_most(boxes):
    """IDF1 where each stay in the picture has a number of its own, as many true positives as the longest stays have."""
    kept = total = 0
    for who in {who for people in boxes.values() for who in people}:
        frames = sorted(frame for frame, people in boxes.items() if who in people)
        stays = [1]
        for before, after in zip(frames, frames[1:]):
            stays = [*stays[:-1], stays[-1] + 1] if after - before <= 2 else [*stays, 1]
        kept, total = kept + max(stays), total + len(frames)
    return kept / total


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("marey", type=pathlib.Path)
    parser.add_argument("--seeds", type=int, default=24)
    parser.add_argument("--degrees", type=float, default=7)
    given = parser.parse_args()
    rows = {}
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        for seed in range(1, given.seeds + 1):
            still = box_scenes.truth(STREET, seed)
            pan = box_scenes.truth(dataclasses.replace(STREET, pan=given.degrees), seed)
            by = shift(still, pan)
            weak = weak_detector.weaken(pan, seed, rate=STREET.rate)
            known = {frame: [(b[0] + by.get(frame, 0), *b[1:]) for b in boxes] for frame, boxes in weak.items()}
            for name, truth, boxes in (("stands", still, weak_detector.weaken(still, seed, rate=STREET.rate)), ("pans", pan, weak),
                                       ("pans, path known", shifted(pan, by), known)):
                box_scenes.write_truth(work / "truth.txt", truth)
                weak_detector.write(work / "boxes.txt", boxes)
                for mode, more in (("live", ["--live"]), ("offline", [])):
                    subprocess.run([given.marey, "track", "--detections", work / "boxes.txt", "--rate", str(STREET.rate), "-o",
                                    work / "tracks.txt", "-q", *more], check=True, stderr=subprocess.DEVNULL)
                    figures = live_peers.judged(given.marey, work / "truth.txt", work / "tracks.txt")
                    rows.setdefault((name, mode), []).append((*(figures[n] for n in live_peers.FIGURES), at_most(truth)))
    for (name, mode), values in rows.items():
        figures = " ".join(f"{100 * statistics.mean(column):5.1f}" for column in list(zip(*values))[:3])
        lost = [a[1] - b[1] for a, b in zip(rows["stands", mode], values)]
        error = statistics.stdev(lost) / math.sqrt(len(lost)) if len(lost) > 1 else 0.0
        print(f"{name:17} {mode:8} {figures}  IDF1 lost {100 * statistics.mean(lost):5.1f} ± {100 * error:.1f}"
              f"  at most {100 * statistics.mean(v[3] for v in values):5.1f}")


if __name__ == "__main__":
    main()
