#!/usr/bin/env python3
"""Shirt numbers on simulated people, whose numbers are known: `marey simulate people` draws them, this writes numbers on their backs and chests (several fonts,
turned with the body, squeezed by perspective, bent by folds, shaded as the shirt, encoded by x264), `marey track --numbers` reads them.

    shirt_numbers.py MAREY [--seeds 1,2] [--heights 100,150] [--crf 23] [--limits] [--keep FOLDER]

Prints a Markdown table: precision and share of the tracks that are named with the probability that `marey identify` asks for, and by other limits with
--limits. A track's true number is that of the person that it shows in most of its frames (IoU 0.5 with the truth); a track of less than 2 s does not count.
Needs numpy and Pillow, ffmpeg, and the fonts DejaVu and Liberation.
"""

import argparse
import collections
import csv
import json
import pathlib
import re
import subprocess
import sys
import tempfile

import numpy as np
from PIL import Image, ImageDraw, ImageFont

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from drawn_contours import decoded  # noqa: E402

FONTS = [f"/usr/share/fonts/truetype/{name}.ttf" for name in
         ("dejavu/DejaVuSans-Bold", "dejavu/DejaVuSansCondensed-Bold", "dejavu/DejaVuSerif-Bold", "liberation/LiberationSans-Bold",
          "liberation/LiberationSansNarrow-Bold", "liberation/LiberationSerif-Bold", "liberation/LiberationMono-Bold")]
SIZE, RATE, FRAMES, PEOPLE = (1280, 720), 25, 250, 8
LIMIT = 0.95  # of identify
INKS = ((245, 245, 245), (15, 15, 15), (235, 205, 30), (190, 30, 30), (25, 50, 160))  # red, green, blue
FINE = 6  # numbers are drawn this many times larger
FOLD = 0.1  # of a number's height: how far folds move its outline


def rows_of(path):
    with open(path) as file:
        return list(csv.DictReader(file))


def truth_of(folder):
    """By frame, by person: the box, and the visible silhouette."""
    boxes, masks = collections.defaultdict(dict), collections.defaultdict(dict)
    for line in (folder / "truth.txt").read_text().split():
        frame, person, left, top, width, height = map(float, line.split(",")[:6])
        boxes[int(frame) - 1][int(person)] = (left - 1, top - 1, width, height)
    for line in open(folder / "silhouettes.jsonl"):
        one = json.loads(line)
        masks[one["frame"]][one["id"]] = one
    return boxes, masks


def facing(folder):
    """By person, by frame: (share of the shirt's width that shows, its side: 1 back, -1 chest), by the person's direction and the camera's."""
    text = (folder / "rig.toml").read_text()
    rotation = np.array(json.loads(re.search(r"rotation = (\[\[.*?\]\])", text, re.S)[1]))
    paths = collections.defaultdict(list)
    for row in rows_of(folder / "positions.csv"):
        paths[int(row["id"])].append((int(row["frame"]), float(row["x"]), float(row["y"])))
    found = {}
    for person, path in paths.items():
        path = np.array(path)
        found[person] = {}
        for i, (frame, *_) in enumerate(path):
            a, b = path[max(0, i - 6), 1:], path[min(len(path) - 1, i + 6), 1:]
            ahead = rotation @ np.append(b - a, 0)
            across = np.hypot(ahead[0], ahead[2])
            found[person][int(frame)] = (abs(ahead[2]) / across, 1 if ahead[2] > 0 else -1) if across > 0.05 else (0, 1)
    return found


def drawn_number(number, font, height):
    """A number's coverage, FINE times larger than `height` px."""
    letters = ImageFont.truetype(font, int(height * FINE * 1.38))
    left, top, right, bottom = letters.getbbox(str(number))
    image = Image.new("L", (right - left + 8, bottom - top + 8))
    ImageDraw.Draw(image).text((4 - left, 4 - top), str(number), 255, letters)
    return np.asarray(image, np.float32) / 255


def noise(random, shape, width):
    """Smooth noise of unit deviation."""
    small = random.normal(size=(max(2, int(shape[0] / width) + 2), max(2, int(shape[1] / width) + 2)))
    made = np.asarray(Image.fromarray(small.astype(np.float32)).resize(shape[::-1], Image.BICUBIC))
    return made / max(1e-6, made.std())


def draw_on_shirt(frame, mask, box, person, seen, random):
    """Writes a number onto a person, where the silhouette is."""
    left, top, width, height = box
    share, side = seen
    if share < 0.35:
        return
    rows = slice(max(0, int(top + 0.2 * height)), int(top + 0.5 * height))
    trunk = mask[rows]
    if trunk.sum() < 0.02 * height * height:
        return
    middle = np.nonzero(trunk)[1].mean()
    shirt = frame[rows][trunk].reshape(-1, 3)
    if person.get("ink") is None:
        luma = shirt.mean(0) @ (0.3, 0.59, 0.11)
        person["ink"] = max(INKS, key=lambda ink: (abs(np.dot(ink, (0.3, 0.59, 0.11)) - luma) > 90) * random.uniform())
    digit = height * person["size"] * (1 if side > 0 else 0.85)
    cover = drawn_number(person["number"], person["font"], digit)
    wide = min(cover.shape[1], 0.23 * height * FINE)  # it has to be on the shirt
    folds = FOLD * digit * FINE * np.stack([noise(random, cover.shape, 0.5 * digit * FINE) for _ in range(2)])
    ys, xs = np.mgrid[: cover.shape[0], : cover.shape[1]]
    cover = cover[np.clip((ys + 0.3 * folds[0]).astype(int), 0, cover.shape[0] - 1), np.clip((xs + 0.3 * folds[1]).astype(int), 0, cover.shape[1] - 1)]
    image = Image.fromarray((255 * cover).astype(np.uint8)).resize((max(2, int(wide * share)), cover.shape[0]), Image.BILINEAR)
    image = image.rotate(person["turn"] + random.normal(0, 2), Image.BILINEAR, expand=True)
    cover = np.asarray(image.resize((max(1, round(image.width / FINE)), max(1, round(image.height / FINE))), Image.BOX), np.float32) / 255
    y, x = int(top + (0.32 + person["lower"]) * height - cover.shape[0] / 2), int(middle - cover.shape[1] / 2)
    y0, x0, y1, x1 = max(0, y), max(0, x), min(frame.shape[0], y + cover.shape[0]), min(frame.shape[1], x + cover.shape[1])
    if y1 <= y0 or x1 <= x0:
        return
    cover = (cover[y0 - y : y1 - y, x0 - x : x1 - x] * mask[y0:y1, x0:x1])[..., None]
    part = frame[y0:y1, x0:x1]
    shade = (part @ (0.3, 0.59, 0.11))[..., None] / max(1, shirt.mean(0) @ (0.3, 0.59, 0.11))
    frame[y0:y1, x0:x1] = part * (1 - cover) + np.clip(np.array(person["ink"]) * np.clip(shade, 0.5, 1.3), 0, 255) * cover


def with_numbers(folder, crf, seed):
    """Writes numbered.mp4, and gives each person's number."""
    random = np.random.default_rng(seed)
    boxes, masks = truth_of(folder)
    seen = facing(folder)
    numbers = random.permutation(np.arange(1, 100))
    people = {person: {"number": int(numbers[i]), "font": FONTS[random.integers(len(FONTS))], "size": random.uniform(0.13, 0.17), "turn": random.normal(0, 3),
                       "lower": random.uniform(-0.02, 0.03)} for i, person in enumerate(sorted(seen))}
    source = subprocess.Popen(["ffmpeg", "-v", "error", "-i", folder / "video.mp4", "-f", "rawvideo", "-pix_fmt", "rgb24", "-"], stdout=subprocess.PIPE)
    target = subprocess.Popen(["ffmpeg", "-v", "error", "-y", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{SIZE[0]}x{SIZE[1]}", "-r", str(RATE), "-i", "-", "-c:v",
                               "libx264", "-crf", str(crf), "-pix_fmt", "yuv420p", folder / "numbered.mp4"], stdin=subprocess.PIPE)
    for frame in range(FRAMES):
        data = source.stdout.read(3 * SIZE[0] * SIZE[1])
        if len(data) < 3 * SIZE[0] * SIZE[1]:
            break
        image = np.frombuffer(data, np.uint8).reshape(SIZE[1], SIZE[0], 3).astype(np.float32)
        for person, box in boxes[frame].items():
            if person in masks[frame] and person in seen and frame in seen[person]:
                draw_on_shirt(image, mask_of(masks[frame][person]), box, people[person], seen[person][frame], random)
        target.stdin.write(np.clip(image, 0, 255).astype(np.uint8).tobytes())
    target.stdin.close()
    source.stdout.close()
    assert target.wait() == 0
    source.wait()
    return {person: one["number"] for person, one in people.items()}, boxes


def mask_of(row):
    """The visible pixels of a row of silhouettes.jsonl."""
    runs = row["visible"]
    runs = runs.get("counts", runs) if isinstance(runs, dict) else runs
    if isinstance(runs, str):
        return decoded(runs, SIZE[0], SIZE[1]).astype(bool)
    flat, at = np.zeros(SIZE[0] * SIZE[1], bool), 0
    for i, run in enumerate(runs):
        flat[at : at + run] = i % 2
        at += run
    return flat.reshape(SIZE[0], SIZE[1]).T


def overlap(a, b):
    x = max(0, min(a[0] + a[2], b[0] + b[2]) - max(a[0], b[0]))
    y = max(0, min(a[1] + a[3], b[1] + b[3]) - max(a[1], b[1]))
    return x * y / (a[2] * a[3] + b[2] * b[3] - x * y)


def shown_by(folder, boxes):
    """By track that is there for 2 s: the person that it shows most."""
    shown, length = collections.defaultdict(collections.Counter), collections.Counter()
    for row in rows_of(folder / "tracks.csv"):
        box = [float(row[name]) for name in ("left", "top", "width", "height")]
        length[int(row["id"])] += 1
        for person, other in boxes[int(row["frame"])].items():
            if overlap(box, other) >= 0.5:
                shown[int(row["id"])][person] += 1
    return {track: people.most_common(1)[0][0] for track, people in shown.items() if length[track] >= 2 * RATE}


def run(marey, folder, height, seed, crf):
    """(true number, number or None, probability) of each track."""
    subprocess.run([marey, "simulate", "people", "--people", str(PEOPLE), "--height", str(height), "--size", str(SIZE[0]), str(SIZE[1]), "--frames", str(FRAMES),
                    "--rate", str(RATE), "--seed", str(seed), "-o", folder, "-q"], check=True)
    numbers, boxes = with_numbers(folder, crf, seed)
    subprocess.run([marey, "track", folder / "numbered.mp4", "-o", folder / "tracks.csv", "--numbers", folder / "numbers.csv", "-q"], check=True)
    read = {int(row["id"]): (int(row["number"]), float(row["probability"])) for row in rows_of(folder / "numbers.csv")}
    return [(numbers[person], *read.get(track, (None, 0))) for track, person in shown_by(folder, boxes).items()]


def line(name, tracks, limit):
    named = [(true, number) for true, number, probability in tracks if number is not None and probability >= limit]
    right = sum(true == number for true, number in named)
    precision = f"{right / len(named):.3f}" if named else "–"
    return f"| {name} | {len(tracks)} | {len(named)} | {len(named) / max(1, len(tracks)):.0%} | {precision} |"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("marey")
    parser.add_argument("--seeds", default="1,2,3")
    parser.add_argument("--heights", default="100,150")
    parser.add_argument("--crf", type=int, default=23)
    parser.add_argument("--limits", action="store_true")
    parser.add_argument("--keep", type=pathlib.Path)
    given = parser.parse_args()
    print("| people, px | tracks | named | of the tracks | precision |\n| --- | --- | --- | --- | --- |")
    everything = []
    for height in map(int, given.heights.split(",")):
        tracks = []
        for seed in map(int, given.seeds.split(",")):
            with tempfile.TemporaryDirectory(prefix="marey_numbers_") as holder:
                folder = given.keep / f"{height}_{seed}" if given.keep else pathlib.Path(holder)
                folder.mkdir(parents=True, exist_ok=True)
                tracks += run(given.marey, folder, height, seed, given.crf)
        everything += tracks
        print(line(f"{height}", tracks, LIMIT), flush=True)
    for limit in (0.5, 0.8, 0.9, 0.99, 0.999) if given.limits else ():
        print(line(f"all, probability {limit}", everything, limit))


if __name__ == "__main__":
    main()
