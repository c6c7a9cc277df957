"""The Python wheel in a bare virtual environment: how large it is, how long it takes to install and to import, and whether it works.

Usage: wheel_test.py FOLDER_OF_PACKAGES [--video FILM] (a network, for numpy; for --video the program ffmpeg). Exits 77 where there is no wheel.
"""

import argparse
import os
import pathlib
import subprocess
import sys
import tempfile
import time
import venv

# People as bright boxes that walk to the right, each in a row of its own, before a dim, noisy wall.
USE = """
import sys, time
begin = time.monotonic()
import marey
imported = time.monotonic() - begin
import numpy
noise = numpy.random.default_rng(1)
def pictures():
    for k in range(60):
        picture = noise.integers(40, 60, (240, 320, 3), dtype=numpy.uint8)
        for row, left in enumerate((20, 60)):
            picture[30 + 100 * row : 90 + 100 * row, left + 3 * k : left + 3 * k + 24] = 200
        yield picture
tracks = marey.track(marey.Frames(list(pictures()), rate=25))
assert len(tracks.tracks) == 2, tracks
tracks.write(sys.argv[1] + "/tracks.csv")
again = marey.read(sys.argv[1] + "/tracks.csv")
assert len(again.tracks) == 2 and again.tracks[0].x.size == tracks.tracks[0].x.size
speed = numpy.median(numpy.diff(tracks.tracks[0].x))
assert abs(speed - 3) < 0.2, speed
try:
    marey.read(sys.argv[1] + "/nothing.csv")
    raise SystemExit("a missing file was read")
except marey.Error as error:
    assert "nothing.csv" in str(error)
if len(sys.argv) > 2:
    print(len(marey.track(sys.argv[2]).tracks), "tracks in the film;", end=" ")
print(f"import {imported:.2f} s; {len(tracks.tracks)} tracks of pictures in an array")
"""


def main() -> int:
    parser = argparse.ArgumentParser()
    parser.add_argument("packages", type=pathlib.Path)
    parser.add_argument("--video", type=pathlib.Path)
    given = parser.parse_args()
    wheels = sorted(given.packages.glob("marey-*.whl"))
    if not wheels:
        print(f"{given.packages}: holds no marey-*.whl; script/package --wheel makes it")
        return 77
    wheel = wheels[-1].resolve()
    with tempfile.TemporaryDirectory() as folder:
        home = pathlib.Path(folder) / "venv"
        venv.create(home, with_pip=True)
        begin = time.monotonic()
        subprocess.run([home / "bin/pip", "install", "--quiet", "--disable-pip-version-check", wheel], check=True)
        installed = time.monotonic() - begin
        # Not from the checkout, whose own package would be found first.
        words = [home / "bin/python", "-c", USE, folder, *([given.film.resolve()] if given.film else [])]
        done = subprocess.run(words, cwd=folder, text=True, capture_output=True, env={k: v for k, v in os.environ.items() if k != "PYTHONPATH"})
    print(done.stdout, done.stderr, sep="", end="")
    print(f"{wheel.name}: {wheel.stat().st_size / 1e6:.1f} MB, installed with numpy in {installed:.1f} s")
    return done.returncode


if __name__ == "__main__":
    sys.exit(main())
