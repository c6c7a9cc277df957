#!/usr/bin/env python3
"""Simulated matches through the whole of `marey track --ground` with their exact rigs, evaluated against their truth, as a Markdown table.

Usage: simulated_match.py MAREY [--distance 1.5] --scene "OPTIONS --seed N" [--scene ...]

Each scene is a run of `marey simulate match OPTIONS`, a row of the table; a track finds a person within --distance metres.
"""
import argparse
import json
import pathlib
import shlex
import subprocess
import tempfile


def row(marey, options, distance, work):
    subprocess.run([marey, "simulate", "match", *shlex.split(options), "-o", work, "-q"], check=True)
    subprocess.run([marey, "track", work / "rig.toml", "--targets", "people", "--ground", "-o", work / "match.csv", "-q"], check=True)
    judge = [marey, "evaluate", "--truth", work / "truth.csv", "--tracks", work / "match.csv", "--distance", str(distance), "--json"]
    scores = json.loads(subprocess.run(judge, check=True, capture_output=True, text=True).stdout)
    return [f"`{options}`", f"{100 * scores['found']:.1f} / {100 * scores['false']:.1f} %", f"{scores['idf1']:.3f}", f"{100 * scores['tracked_fraction']:.0f} %",
            f"{scores['position_rms_m']:.2f}", f"{scores['speed_rms_mps']:.2f}", f"{100 * scores['distance_error']:.1f} %"]


def print_row(cells):
    print("| " + " | ".join(cells) + " |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("marey")
    parser.add_argument("--scene", action="append", required=True)
    parser.add_argument("--distance", type=float, default=1.5)
    options = parser.parse_args()
    print_row(["scene", f"found within {options.distance:g} m / false", "IDF1", "kept", "position, m RMS", "speed, m/s RMS", "distance"])
    print_row(["---"] * 7)
    for scene in options.scene:
        with tempfile.TemporaryDirectory(prefix="marey_match_") as work:
            print_row(row(options.marey, scene, options.distance, pathlib.Path(work)))


if __name__ == "__main__":
    main()
