"""Rerun converts the MCAP files that are written: every instant, at its time, with every point where it is.

Usage: rerun_test.py MAREY (a network: Rerun, 170 MB, goes into a virtual environment of its own). Exits 77 where it cannot be had.
"""

import csv
import math
import pathlib
import re
import subprocess
import sys
import tempfile
import venv

VERSION = "0.41.0"


def run(*arguments) -> str:
    done = subprocess.run([str(a) for a in arguments], capture_output=True, text=True)
    assert done.returncode == 0, (arguments, done.stdout[-2000:], done.stderr[-2000:])
    return done.stdout


def clouds(printed: str) -> list[tuple[float, list[list[float]]]]:
    """Of each row that Rerun shows: its time, s, and the points that it does not cut off."""
    found = []
    for row in re.findall(r"1970-01-01T00:00:(\d\d(?:\.\d+)?).*?┆ (\[\[[^┆]*?)… │", printed):
        points = re.findall(r"\[(-?[\d.e-]+), (-?[\d.e-]+), (-?[\d.e-]+)\]", row[1])
        found.append((float(row[0]), [[float(c) for c in point] for point in points]))
    return found


def main() -> int:
    marey = sys.argv[1]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        venv.create(folder / "venv", with_pip=True)
        if subprocess.run([folder / "venv/bin/pip", "install", "--quiet", f"rerun-sdk=={VERSION}"]).returncode != 0:
            print("rerun-sdk cannot be had")
            return 77
        rerun = folder / "venv/bin/rerun"
        run(rerun, "analytics", "disable")
        run(marey, "simulate", "room", "--motion", "walk", "--frames", 60, "-o", folder / "room", "-q")
        run(marey, "reconstruct", folder / "room/rig.toml", "--observations", folder / "room/observations.csv", "-o", folder / "walk.marey", "-q")
        for copy in ("walk.csv", "walk.mcap"):
            run(marey, "convert", folder / "walk.marey", folder / copy, "-q")
        run(rerun, "mcap", "convert", folder / "walk.mcap", "-o", folder / "walk.rrd")
        run(rerun, "rrd", "verify", folder / "walk.rrd")
        shown = clouds(run(rerun, "rrd", "print", "-vvv", "--entity", "/marey/points", folder / "walk.rrd"))
        moments: dict[float, list[list[float]]] = {}
        for row in csv.DictReader((folder / "walk.csv").open()):
            moments.setdefault(float(row["time"]), []).append([float(row[c]) for c in "xyz"])
        assert len(shown) == len(moments) == 60, (len(shown), len(moments))
        compared = 0
        for time, points in shown:
            at = min(moments, key=lambda moment: abs(moment - time))
            assert abs(at - time) < 1e-5, (time, at)
            assert points, f"no point at {time} s"
            for point in points:
                nearest = min(math.dist(point, other) for other in moments[at])
                assert nearest < 2e-5, (time, point, nearest)
                compared += 1
        print(f"Rerun {VERSION}: {len(shown)} instants, {compared} points inspected")
    return 0


if __name__ == "__main__":
    sys.exit(main())
