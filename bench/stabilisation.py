#!/usr/bin/env python3
"""What `marey track --stabilise` gives people before a shaking camera: simulated videos with their truth, the same video with a camera that
stands beside it. Prints IDF1 and MOTA of the still video, of the shaken one as it is, and of the shaken one stabilised, and the time of the
last two; and how far the stabilised rest lay from the truth's, as far as that shows in them.

Usage: bench/stabilisation.py MAREY [--seeds 1 2 3] [--shakes 1 3 8 20] [--frames 250] [--folder FOLDER]
"""

import argparse
import json
import pathlib
import subprocess
import tempfile
import time


def run(*arguments):
    done = subprocess.run([str(each) for each in arguments], capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit(f"{arguments}\n{done.stderr}")
    return done.stdout


def simulate(marey, folder, seed, frames, shake):
    if not (folder / "rig.toml").exists():
        run(marey, "simulate", "people", "-o", folder, "--seed", seed, "--frames", frames, "--size", 1280, 720, "--height", 90, "--people", 8,
            "--shake", shake, "-q")


def evaluated(marey, folder, *options):
    begin = time.time()
    report = json.loads(run(marey, "track", folder / "video.mp4", "-o", folder / "tracks.txt", "--json", *options))
    took = time.time() - begin
    score = json.loads(run(marey, "evaluate", "--truth", folder / "truth.txt", "--tracks", folder / "tracks.txt", "--json"))
    return score["idf1"], score["mota"], 1e3 * took / report["frames"], report


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("marey")
    parser.add_argument("--seeds", type=int, nargs="+", default=[1, 2, 3])
    parser.add_argument("--shakes", type=float, nargs="+", default=[1, 3, 8, 20])
    parser.add_argument("--frames", type=int, default=250)
    parser.add_argument("--folder", type=pathlib.Path, default=pathlib.Path(tempfile.gettempdir()) / "marey_steady")
    given = parser.parse_args()
    for seed in given.seeds:
        still = given.folder / f"still_{seed}"
        simulate(given.marey, still, seed, given.frames, 0)
        idf1, mota, ms, _ = evaluated(given.marey, still)
        print(f"seed {seed}  still            IDF1 {idf1:.3f}  MOTA {mota:.3f}  {ms:6.1f} ms a frame", flush=True)
        for shake in given.shakes:
            film = given.folder / f"shaken_{seed}_{shake:g}"
            simulate(given.marey, film, seed, given.frames, shake)
            for name, options in (("as it is", ()), ("--stabilise", ("--stabilise",))):
                idf1, mota, ms, report = evaluated(given.marey, film, *options)
                print(f"seed {seed}  {shake:4g} px {name:9} IDF1 {idf1:.3f}  MOTA {mota:.3f}  {ms:6.1f} ms a frame  {' '.join(report['notes'])}",
                      flush=True)


if __name__ == "__main__":
    main()
