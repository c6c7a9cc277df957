#!/usr/bin/env python3
"""What a slow pan costs on simulated street boxes: the same people before a static camera and one that pans,
boxes weakened by weak_detector.py; and the boxes of the pan in the coordinates of the static camera, the rotation known exactly.

Usage: box_pan.py MAREY [--seeds 24] [--degrees 7]

"at most" is the IDF1 of a tracker without errors that gives people who return to the image a new number: people leave and enter at
borders that move. The scenes of box_peers.py have other people each.
"""
import argparse
import dataclasses
import math
import pathlib
import statistics
import subprocess
import tempfile

import numpy as np

import box_scenes
import live_peers
import weak_detector

STREET = next(scene for scene in box_scenes.SCENES if scene.name == "street, still")


def simulated(scene, seed):
    """The truth, and the camera's state in each frame."""
    pans = []

    class Watched(box_scenes.Operator):
        def step(self, time, play):
            state = super().step(time, play)
            pans.append(state)
            return state

    operator, box_scenes.Operator = box_scenes.Operator, Watched
    try:
        boxes = box_scenes.truth(scene, seed, np.random.default_rng(seed))
    finally:
        box_scenes.Operator = operator
    return boxes, pans[-int(scene.seconds * scene.rate):]


def in_standing_view(box, state, first):
    """The box in the image of a camera of state `first` at the same place; neither rolls."""
    pan, tilt, _, focal, _ = state
    there, its_tilt, _, its_focal, _ = first
    left, top, width, height = box[:4]
    points = []
    for v in (top, top + height):
        x, y = (left + width / 2 - box_scenes.WIDTH / 2) / focal, (v - box_scenes.HEIGHT / 2) / focal
        ahead, up = math.cos(tilt) + y * math.sin(tilt), math.sin(tilt) - y * math.cos(tilt)
        right, forward = (x * math.cos(pan - there) + ahead * math.sin(pan - there),
                          ahead * math.cos(pan - there) - x * math.sin(pan - there))
        depth = forward * math.cos(its_tilt) + up * math.sin(its_tilt)
        points.append((its_focal * right / depth + box_scenes.WIDTH / 2,
                       its_focal * (forward * math.sin(its_tilt) - up * math.cos(its_tilt)) / depth + box_scenes.HEIGHT / 2))
    (x0, y0), (x1, y1) = points
    wide = width * (y1 - y0) / height
    return ((x0 + x1 - wide) / 2, y0, wide, y1 - y0, *box[4:])


def upper_bound(boxes):
    """IDF1 where each stay in the image has its own number: the true positives are those of the longest stays."""
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
            still, stands = simulated(STREET, seed)
            pan, pans = simulated(dataclasses.replace(STREET, pan=given.degrees), seed)
            weak = weak_detector.weaken(pan, seed, rate=STREET.rate)
            known = {frame: [in_standing_view(b, pans[frame - 1], stands[frame - 1]) for b in boxes] for frame, boxes in weak.items()}
            standing = {frame: {who: in_standing_view(b, pans[frame - 1], stands[frame - 1]) for who, b in people.items()}
                      for frame, people in pan.items()}
            for name, truth, boxes in (("stands", still, weak_detector.weaken(still, seed, rate=STREET.rate)), ("pans", pan, weak),
                                       ("pans, path known", standing, known)):
                box_scenes.write_truth(work / "truth.txt", truth)
                weak_detector.write(work / "boxes.txt", boxes)
                for mode, more in (("live", ["--live"]), ("offline", [])):
                    subprocess.run([given.marey, "track", "--detections", work / "boxes.txt", "--rate", str(STREET.rate), "-o",
                                    work / "tracks.txt", "-q", *more], check=True, stderr=subprocess.DEVNULL)
                    figures = live_peers.evaluated(given.marey, work / "truth.txt", work / "tracks.txt")
                    rows.setdefault((name, mode), []).append((*(figures[n] for n in live_peers.FIGURES), upper_bound(truth)))
    for (name, mode), values in rows.items():
        figures = " ".join(f"{100 * statistics.mean(column):5.1f}" for column in list(zip(*values))[:3])
        lost = [a[1] - b[1] for a, b in zip(rows["stands", mode], values)]
        error = statistics.stdev(lost) / math.sqrt(len(lost)) if len(lost) > 1 else 0.0
        print(f"{name:17} {mode:8} {figures}  IDF1 lost {100 * statistics.mean(lost):5.1f} ± {100 * error:.1f}"
              f"  at most {100 * statistics.mean(v[3] for v in values):5.1f}")


if __name__ == "__main__":
    main()
