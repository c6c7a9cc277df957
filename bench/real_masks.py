#!/usr/bin/env python3
"""The pixels that `marey track --foreground-masks` calls people, live and offline, beside OpenCV's MOG2 and KNN, on frames of real videos.

Usage: real_masks.py MAREY [--masks masks/people.json] [--videos TEXT] [--medians]

MAREY_DATA names the folder of the recordings; vtest.avi is taken from it or from Debian's opencv-doc. What is not there is
skipped, and said. The truth is people drawn by hand as polygons in pixels (bench/masks/people.json), contour by contour, a second
contour of one person being a hole; frames are counted from 0, and every pixel of `region` (left, top, width, height) is evaluated.
What people carry belongs to them where it was drawn: bags and papers on vtest, but no papers in the room; shadows do not. Peers
see the video from its first frame, on BGR, with OpenCV's defaults, what they call shadow omitted. Needs OpenCV for Python.
"""
import argparse
import collections
import json
import os
import pathlib
import subprocess
import tempfile

import cv2
import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
DEBIAN = pathlib.Path("/usr/share/doc/opencv-doc/examples/data/vtest.avi")


def path_of(video):
    data = pathlib.Path(os.environ.get("MAREY_DATA") or HERE.parent.parent / "shared" / "data")
    inside = data / video
    return DEBIAN if video == DEBIAN.name and not inside.exists() else inside


def drawn(mask):
    """The people of one entry, within its region."""
    left, top, width, height = mask["region"]
    truth = np.zeros((height, width), np.uint8)
    for person in mask["people"]:
        one = np.zeros_like(truth)
        sub = 16  # of a pixel, as OpenCV draws
        cv2.fillPoly(one, [np.int32(np.round((np.array(c) - (left, top)) * sub)) for c in person], 255, shift=4)
        truth |= one
    return truth


def marey_masks(marey, video, frames, more):
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder)
        subprocess.run([marey, "track", video, "-o", out / "tracks.txt", "--foreground-masks", out / "masks", "-q", *more], check=True,
                       stderr=subprocess.DEVNULL)
        return {f: cv2.imread(str(out / "masks" / f"bin{f + 1:06}.png"), cv2.IMREAD_GRAYSCALE) for f in frames}


def peer_masks(video, frames):
    models = {"MOG2": cv2.createBackgroundSubtractorMOG2(), "KNN": cv2.createBackgroundSubtractorKNN()}
    capture, masks = cv2.VideoCapture(str(video)), collections.defaultdict(dict)
    for index in range(max(frames) + 1):
        picture = capture.read()[1]
        for name, model in models.items():
            mask = model.apply(picture)
            if index in frames:
                mask = np.where(mask > 200, 255, 0).astype(np.uint8)
                masks[name][index] = mask
                masks[f"{name}, median"][index] = cv2.medianBlur(mask, 5)
    return masks


def figures(masks, entries):
    hit = marked = people = 0
    for entry in entries:
        left, top, width, height = entry["region"]
        seen = masks[entry["frame"]][top:top + height, left:left + width] > 0
        truth = drawn(entry) > 0
        hit, marked, people = hit + int((seen & truth).sum()), marked + int(seen.sum()), people + int(truth.sum())
    return hit / max(marked, 1), hit / people, 2 * hit / (marked + people)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("marey", type=pathlib.Path)
    parser.add_argument("--masks", type=pathlib.Path, default=HERE / "masks" / "people.json")
    parser.add_argument("--videos", default="", help="those whose name contains this")
    given = parser.parse_args()
    by_video = collections.defaultdict(list)
    for entry in json.loads(given.masks.read_text()):
        if given.videos in entry["video"]:
            by_video[entry["video"]].append(entry)
    names = ("Marey, live", "Marey, offline", "MOG2", "MOG2, median", "KNN", "KNN, median")
    print("| video, masks: precision, recall, F |", " | ".join(names), "|\n|", " --- |" * (len(names) + 1))
    for video, entries in by_video.items():
        path = path_of(video)
        if not path.exists():
            print(f"{path} is not there; set MAREY_DATA")
            continue
        frames = {entry["frame"] for entry in entries}
        masks = {"Marey, live": marey_masks(given.marey, path, frames, ["--live"]),
                 "Marey, offline": marey_masks(given.marey, path, frames, []), **peer_masks(path, frames)}
        row = [" ".join(f"{v:.3f}" for v in figures(masks[name], entries)) for name in names]
        print(f"| {video}, {len(entries)} |", " | ".join(row), "|", flush=True)


if __name__ == "__main__":
    main()
