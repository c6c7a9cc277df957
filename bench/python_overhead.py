"""What Python costs: `marey.track` against `marey track` on one video, by turns, CPU and wall.

    python3 bench/python_overhead.py MAREY VIDEO [--runs N]      `import marey` must work: docs/install.md
"""

import argparse
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

TRACK = "import marey, sys; marey.track(sys.argv[1], sinks=[sys.argv[2]], keep=False)"


def measure(command):
    before, begin = os.times(), time.monotonic()
    subprocess.run(command, check=True)
    after = os.times()
    return after.children_user + after.children_system - before.children_user - before.children_system, time.monotonic() - begin


def main():
    options = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    options.add_argument("marey")
    options.add_argument("film")
    options.add_argument("--runs", type=int, default=5)
    options.add_argument("--python", default=sys.executable, help="an interpreter that has marey")
    given = options.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        shell, python = str(pathlib.Path(folder, "shell.txt")), str(pathlib.Path(folder, "python.txt"))
        commands = {"command line": [given.marey, "track", given.film, "-o", shell, "-q"], "Python": [given.python, "-c", TRACK, given.film, python]}
        figures = {name: [] for name in commands}
        for _ in range(given.runs):
            for name, command in commands.items():
                figures[name].append(measure(command))
        same = pathlib.Path(shell).read_bytes() == pathlib.Path(python).read_bytes()
    print(f"{'':14}{'CPU, s':>10}{'wall, s':>10}   median of {given.runs}, by turns; {'same bytes' if same else 'OTHER BYTES'}")
    medians = {name: [statistics.median(column) for column in zip(*rows, strict=True)] for name, rows in figures.items()}
    for name, (cpu, wall) in medians.items():
        print(f"{name:14}{cpu:>10.2f}{wall:>10.2f}")
    ratio = [python / shell for python, shell in zip(medians["Python"], medians["command line"], strict=True)]
    print(f"{'ratio':14}{ratio[0]:>10.3f}{ratio[1]:>10.3f}")


if __name__ == "__main__":
    main()
