#!/usr/bin/env python3
"""`marey evaluate` of SoccerNet's game states beside the task's own program, sn-trackeval 0.4.0, on made clips: how fast, and how equal.

    MAREY_SN_TRACKEVAL=sn/bin/python bench/game_state.py build/release/marey [--seeds 1,2,3]

Each seed makes 20 clips of 60 images with 14 people (tests/clients/game_state_test.py). Both compute four measures
(places, roles, teams, numbers); marey's time is that of the whole process, sn-trackeval's that of reading and evaluating, without its start. Its time for
GS-HOTA alone stands beside it. Both read the files once before.
MAREY_SN_TRACKEVAL: a Python with sn-trackeval (`python3 -m venv sn && sn/bin/pip install sn-trackeval==0.4.0`).
"""

import argparse
import json
import pathlib
import random
import statistics
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "tests/clients"))
import game_state_test as made  # noqa: E402

REPEATS = 5  # of marey, whose time is short; the median counts


def figures(ours, reference):
    """The largest difference of any figure of any clip."""
    clips = {one["clip"]: one for one in ours["clips"]} | {"COMBINED_SEQ": ours}
    return max(max(abs(found[name] - reference["numbers"][clip][of]) for name, of in made.FIGURES.items())
               + max(abs(found["hota_of"][detail] - reference[detail][clip]["HOTA"]) for detail in reference) for clip, found in clips.items())


def run(marey, seed):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        made.make(folder, random.Random(seed))
        done = subprocess.run([made.PYTHON, "-c", made.REFERENCE, folder], capture_output=True, text=True, check=True)
        reference, one_s, reference_s = json.loads(done.stdout.splitlines()[-1])
        took = []
        for _ in range(REPEATS):
            start = time.perf_counter()
            done = subprocess.run([marey, "evaluate", "--truth", folder / "truth/valid", "--tracks", folder / "trackers/SoccerNetGS-valid/made", "--json"],
                                  capture_output=True, text=True, check=True)
            took.append(time.perf_counter() - start)
    marey_s = statistics.median(took)
    print(f"| {seed} | {reference_s:.2f} | {one_s:.2f} | {marey_s:.2f} | {reference_s / marey_s:.0f} | {one_s / marey_s:.1f} | {figures(json.loads(done.stdout), reference):.0e} |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("marey")
    parser.add_argument("--seeds", default="1,2,3")
    given = parser.parse_args()
    if not made.PYTHON:
        sys.exit("bench/game_state.py: MAREY_SN_TRACKEVAL must name a Python that has sn-trackeval 0.4.0")
    print("| seed | sn-trackeval, four measures, s | GS-HOTA alone, s | marey, four measures, s | times as fast | as GS-HOTA alone | largest difference |\n"
          + "| --- " * 7 + "|")
    for seed in map(int, given.seeds.split(",")):
        run(given.marey, seed)


if __name__ == "__main__":
    main()
