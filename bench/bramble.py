#!/usr/bin/env python3
"""BraMBLe beside ours on the same simulated videos: people who go anywhere before one fixed camera, whose number is not given.

    bench/bramble.py build/release/marey [--people 2,4,6,8,10] [--seeds 1,2,3] [--frames 250] [--work FOLDER]

For each number of people the videos of all seeds (`marey simulate people --situation crowd`) are followed by `marey track --ground` at its
defaults, by the same with `--association gnn --live`, by `--association bramble` and by that with `--live`: the first and third with the
second pass that joins and smooths, the others as each instant came. Evaluated on the ground by `marey evaluate --distance 1` with hidden
people counted as missed; figures are means over the seeds. Frames a second are of the whole run, decoding included, on this machine.
"""

import argparse
import json
import pathlib
import subprocess
import tempfile
import time

METHODS = {
    "ours": [],
    "ours, live": ["--association", "gnn", "--live"],
    "bramble": ["--association", "bramble"],
    "bramble, live": ["--association", "bramble", "--live"],
}
FIGURES = {"MOTA": "mota", "IDF1": "idf1", "HOTA": "hota"}


def run(*command):
    return subprocess.run([str(word) for word in command], check=True, capture_output=True, text=True).stdout


def found_in(figures, name):
    """A figure wherever it stands in what evaluate prints."""
    for key, value in figures.items():
        if key.lower() == name and not isinstance(value, dict):
            return float(value)
        if isinstance(value, dict) and (inner := found_in(value, name)) is not None:
            return inner
    return None


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("marey", type=pathlib.Path)
    parser.add_argument("--people", default="2,4,6,8,10")
    parser.add_argument("--seeds", default="1,2,3")
    parser.add_argument("--frames", type=int, default=250)
    parser.add_argument("--work", type=pathlib.Path)
    options = parser.parse_args()
    marey = options.marey.resolve()
    work = options.work or pathlib.Path(tempfile.mkdtemp(prefix="marey_bramble_"))
    print("| people | way | " + " | ".join(FIGURES) + " | frames/s |\n| --- " * 1 + "| --- " * (len(FIGURES) + 2) + "|")
    for people in map(int, options.people.split(",")):
        sums = {way: [0.0] * (len(FIGURES) + 1) for way in METHODS}
        seeds = options.seeds.split(",")
        for seed in seeds:
            folder = work / f"{people}_{seed}"
            run(marey, "simulate", "people", "--situation", "crowd", "--people", people, "--frames", options.frames, "--seed", seed,
                "-o", folder, "-q")
            for way, more in METHODS.items():
                tracks = folder / (way.replace(", ", "_") + ".csv")
                begin = time.monotonic()
                run(marey, "track", folder / "rig.toml", "--targets", "people", "--ground", "-o", tracks, "-q", *more)
                took = time.monotonic() - begin
                told = json.loads(run(marey, "evaluate", "--truth", folder / "positions.csv", "--tracks", tracks, "--distance", 1, "--json"))
                row = [found_in(told, name) or 0.0 for name in FIGURES.values()] + [options.frames / took]
                sums[way] = [a + b for a, b in zip(sums[way], row)]
        for way, row in sums.items():
            figures = [value / len(seeds) for value in row]
            print(f"| {people} | {way} | " + " | ".join(f"{value:.2f}" for value in figures[:-1]) + f" | {figures[-1]:.1f} |", flush=True)


if __name__ == "__main__":
    main()
