#!/usr/bin/env python3
"""How well `marey track --contour` agrees with contours that were drawn by hand (tests/data/contours), in the visible part of people.

Usage: drawn_contours.py MAREY [--videos TEXT] [--model lite]

MAREY_DATA names the folder of the recordings; vtest.avi is taken from it or from Debian's opencv-doc. What is not there is skipped, and
said. A person has the contour that overlaps most, one contour serves one person, and a missing one counts as 0; videos are tracked
live, so that nothing of what follows a frame helps. Persons that were drawn twice (second_of) count by their first drawing; how well
the two agree is printed too. Needs numpy.
"""
import argparse
import json
import os
import pathlib
import subprocess
import tempfile

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
DEBIAN = pathlib.Path("/usr/share/doc/opencv-doc/examples/data/vtest.avi")
FILES = {"street.json": "vtest.avi", "room.json": "clips/walk_in_room.mp4", "football_left.json": "football/left_camera.mp4", "football_right.json": "football/right_camera.mp4"}


def path_of(video):
    data = pathlib.Path(os.environ.get("MAREY_DATA") or HERE.parent.parent / "shared" / "data")
    inside = data / video
    return DEBIAN if video == DEBIAN.name and not inside.exists() else inside


def drawn(polygons, width, height):
    """Pixels whose middle is within a polygon (even-odd); COCO's coordinates count from the first pixel's edge."""
    mask = np.zeros((height, width), bool)
    for polygon in polygons:
        points = np.array(polygon).reshape(-1, 2)
        for row in range(max(0, int(points[:, 1].min())), min(height, int(points[:, 1].max()) + 1)):
            y, crossings = row + 0.5, []
            for (ax, ay), (bx, by) in zip(points, np.roll(points, -1, 0)):
                if (ay <= y) != (by <= y):
                    crossings.append(ax + (y - ay) / (by - ay) * (bx - ax))
            crossings.sort()
            for left, right in zip(crossings[::2], crossings[1::2]):
                mask[row, max(0, int(np.ceil(left - 0.5))):max(0, int(np.ceil(right - 0.5)))] ^= True
    return mask


def decoded(text, width, height):
    """COCO's compressed runs."""
    counts, at = [], 0
    while at < len(text):
        value, shift, more = 0, 0, True
        while more:
            code = ord(text[at]) - 48
            value |= (code & 31) << shift
            more = code & 32
            at, shift = at + 1, shift + 5
            if not more and code & 16:
                value |= -1 << shift
        if len(counts) > 2:
            value += counts[-2]
        counts.append(value)
    flat = np.repeat(np.arange(len(counts)) % 2 == 1, counts)
    return flat.reshape(width, height).T


def contours_of(marey, video, frames, more):
    """Masks by frame; MOTS counts frames from 1."""
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder, "masks.txt")
        subprocess.run([marey, "track", video, "--contour", "--live", "--format", "mots", "-o", out, "-q", *more], check=True)
        masks = {frame: [] for frame in frames}
        for line in out.read_text().splitlines():
            frame, _, _, height, width, runs = line.split()
            if int(frame) - 1 in masks:
                masks[int(frame) - 1].append(decoded(runs, int(width), int(height)))
    return masks


def agreement(truth, found):
    """IoU of each true mask with its contour."""
    pairs = sorted(((float((t & f).sum() / max(1, (t | f).sum())), i, j) for i, t in enumerate(truth) for j, f in enumerate(found)), reverse=True)
    values, used = [0.0] * len(truth), set()
    done = set()
    for value, i, j in pairs:
        if i not in done and j not in used and value > 0:
            values[i] = value
            done.add(i)
            used.add(j)
    return values


def repeated(truth):
    """IoU of the two drawings of each person that was drawn twice."""
    first = {a["id"]: a for a in truth["annotations"] if "second_of" not in a}
    size = {image["id"]: (image["width"], image["height"]) for image in truth["images"]}
    values = []
    for second in truth["annotations"]:
        if "second_of" in second:
            masks = [drawn(a["segmentation"], *size[second["image_id"]]) for a in (first[second["second_of"]], second)]
            values.append(float((masks[0] & masks[1]).sum() / (masks[0] | masks[1]).sum()))
    return values


def mean(values):
    return f"{sum(values) / len(values):.3f} ({len(values)})" if values else "-"


def row(name, people, twice):
    """People: visibility and IoU."""
    alone = [value for kind, value in people if kind == "alone"]
    overlapping = [value for kind, value in people if kind != "alone"]
    found = sum(value >= 0.5 for _, value in people)
    print(f"| {name} | {mean(alone)} | {mean(overlapping)} | {found} of {len(people)} | {mean(twice)} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("marey", type=pathlib.Path)
    parser.add_argument("--videos", default="", help="those whose name contains this")
    parser.add_argument("--model", default="", help="a network whose masks count as evidence (marey track --contour-model)")
    given = parser.parse_args()
    more = ["--contour-model", given.model] if given.model else []
    rows = []
    print("| video, frame | visibility: IoU |\n| --- | --- |")
    for name, video in FILES.items():
        if given.videos not in video:
            continue
        path = path_of(video)
        if not path.exists():
            print(f"{path} is not there; set MAREY_DATA")
            continue
        truth = json.loads((HERE.parent / "tests/data/contours" / name).read_text())
        masks = contours_of(given.marey, path, {image["frame_id"] for image in truth["images"]}, more)
        judged = []
        for image in truth["images"]:
            people = [a for a in truth["annotations"] if a["image_id"] == image["id"] and "second_of" not in a]
            values = agreement([drawn(a["segmentation"], image["width"], image["height"]) for a in people], masks[image["frame_id"]])
            judged += [(a["visibility"], value) for a, value in zip(people, values)]
            text = ", ".join(f"{a['visibility']} {value:.2f}" for a, value in zip(people, values))
            print(f"| {video}, {image['frame_id']} | {text} |", flush=True)
        rows.append((video, judged, repeated(truth)))
    print("\n| video | IoU, alone (people) | IoU, overlapping (people) | found at IoU 0.5 | drawn twice (people) |\n| --- | --- | --- | --- | --- |")
    for each in rows:
        row(*each)
    if len(rows) > 1:
        row("all", sum((people for _, people, _ in rows), []), sum((twice for _, _, twice in rows), []))


if __name__ == "__main__":
    main()
