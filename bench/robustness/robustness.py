#!/usr/bin/env python3
"""How much `marey track` hangs on small things: recordings with truth, each perturbed in ways that change no person in it.

Usage: robustness.py MAREY DATA [--cache build/robustness] [--recordings vtest,street,boxes] [--only NAME,...] [--jobs 2]
                     [--options="--live"] [--film VTEST.avi] [--json OUT.json] [--quiet]

Recordings: `vtest` (truth of 300 frames in DATA/pets2009); `street`, simulated streets of several densities; `boxes`, the boxes
of a Faster R-CNN over DATA/tud's two videos and those of weak_detector.py over the truth of pets2009. A perturbed video is made
once and kept below the cache folder. Printed: IDF1, MOTA and switches of each, and of each recording the mean, the worst, and how far
the worst is below the mean. Needs FFmpeg's program.
"""
import argparse
import collections
import concurrent.futures
import dataclasses
import json
import pathlib
import subprocess
import sys

import perturb

sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent / "live"))
import weak_detector  # noqa: E402

STREETS = ((1, 6), (2, 10), (3, 14), (4, 18))  # seed, people at a time


@dataclasses.dataclass(frozen=True)
class Recording:
    name: str
    truth: pathlib.Path
    rate: float
    frames: int
    width: int
    film: pathlib.Path | None = None
    boxes: pathlib.Path | None = None


def street(marey, cache, seed, people):
    folder = cache / f"street_{people}_{seed}"
    if not (folder / "truth.txt").exists():
        subprocess.run([marey, "simulate", "people", "--situation", "crowd", "--people", str(people), "--seed", str(seed), "--rate", "10",
                        "--frames", "250", "--height", "70", "-q", "-o", folder], check=True)
    return Recording(f"street, {people} people", folder / "truth.txt", 10, 250, 768, film=folder / "video.mp4")


def recordings(marey, data, cache, film, which):
    pets = data / "pets2009" / "gt_001_300.txt"
    if "vtest" in which:
        yield Recording("vtest", pets, 7, 300, 768, film=film)
    if "street" in which:
        for seed, people in STREETS:
            yield street(marey, cache, seed, people)
    if "boxes" in which:
        for name, frames in (("TUD-Campus", 71), ("TUD-Stadtmitte", 179)):
            folder = data / "tud" / name
            yield Recording(name, folder / "gt.txt", 25, frames, 640, boxes=folder / "det_faster_rcnn.txt")
        for seed, missed in ((1, 0.25), (5, 0.4)):
            weak = cache / f"pets_{seed}.txt"
            weak_detector.write(weak, weak_detector.weaken(weak_detector.read(pets), seed, missed))
            yield Recording(f"PETS boxes, {100 * missed:.0f} % missed", pets, 7, 300, 768, boxes=weak)


def file_name(recording, perturbation):
    return "".join(c if c.isalnum() else "_" for c in f"{recording.name}__{perturbation.name}")


def evaluated(marey, recording, perturbation, cache, options):
    """(IDF1, MOTA, switches)"""
    stem = cache / file_name(recording, perturbation)
    truth, tracks = stem.with_suffix(".truth.txt"), stem.with_suffix(".tracks.txt")
    truth.write_text(perturb.perturbed_rows(perturb.read(recording.truth), perturbation, recording.frames, recording.width))
    if recording.film:
        film = stem.with_suffix(".mkv")
        if not film.exists():
            perturb.write_video(recording.film, film, perturbation, recording.frames)
        given = [film]
    else:
        boxes = stem.with_suffix(".boxes.txt")
        boxes.write_text(perturb.perturbed_rows(perturb.read(recording.boxes), perturbation, recording.frames, recording.width, noisy=True))
        given = ["--detections", boxes]
    subprocess.run([marey, "track", *given, "--rate", str(recording.rate * perturbation.rate), "-o", tracks, "-q", "--threads", "1",
                    *options], check=True)
    said = subprocess.run([marey, "evaluate", "--truth", truth, "--tracks", tracks, "--json"], capture_output=True, text=True, check=True)
    told = json.loads(said.stdout)
    return figure(told, "idf1"), figure(told, "mota"), figure(told, "idsw")


def figure(told, name):
    for key, value in told.items():
        if isinstance(value, dict):
            inner = figure(value, name)
            if inner is not None:
                return inner
        elif key.lower() == name:
            return value
    return None


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("marey", type=pathlib.Path)
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("--cache", type=pathlib.Path, default=pathlib.Path("build/robustness"))
    parser.add_argument("--recordings", default="vtest,street,boxes")
    parser.add_argument("--only", help="perturbations, by name, with commas between where names have none")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--options", default="", help="of `marey track`")
    parser.add_argument("--film", type=pathlib.Path, default=pathlib.Path("/usr/share/doc/opencv-doc/examples/data/vtest.avi"))
    parser.add_argument("--json", type=pathlib.Path)
    parser.add_argument("--quiet", action="store_true", help="means and worst alone")
    given = parser.parse_args()
    given.cache.mkdir(parents=True, exist_ok=True)
    only = given.only.split(";" if ";" in given.only else ",") if given.only else None
    work = []
    for recording in recordings(given.marey, given.data, given.cache, given.film, given.recordings.split(",")):
        for perturbation in perturb.VIDEOS if recording.film else perturb.BOXES:
            if only is None or perturbation.name in only:
                work.append((recording, perturbation))
    options = given.options.split()
    with concurrent.futures.ThreadPoolExecutor(given.jobs) as pool:
        found = list(pool.map(lambda one: evaluated(given.marey, *one, given.cache, options), work))
    by_recording = collections.defaultdict(list)
    for (recording, perturbation), figures in zip(work, found):
        by_recording[recording.name].append((perturbation.name, *figures))
    for name, rows in by_recording.items():
        if not given.quiet:
            for perturbed, idf1, mota, switches in rows:
                print(f"{name:24} {perturbed:22} IDF1 {idf1:.3f}  MOTA {mota:.3f}  switches {switches}")
        values = [row[1] for row in rows]
        mean, worst = sum(values) / len(values), min(rows, key=lambda row: row[1])
        switches = sum(row[3] for row in rows) / len(rows)
        print(f"{name:24} mean IDF1 {mean:.3f}  worst {worst[1]:.3f} ({worst[0]})  apart {mean - worst[1]:.3f}  "
              f"MOTA {sum(row[2] for row in rows) / len(rows):.3f}  switches {switches:.1f}")
    if given.json:
        given.json.write_text(json.dumps(by_recording, indent=1))


if __name__ == "__main__":
    main()
