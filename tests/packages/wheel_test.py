"""The Python wheel in bare environments: how large it is, how long it takes to install, and whether program and package work without a network then.

Usage: wheel_test.py FOLDER_OF_PACKAGES [--suites SUITE...] (a network, for pip)
Tried with each of Python 3.11 to 3.14 that is here, and in each of the Debian and Ubuntu suites named, which have others: trixie has 3.13, noble 3.12
(root, debootstrap). Exits 77 where there is no wheel, or nothing to try it with.
"""

import argparse
import glob
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

import bare_system
from bare_system import timed

VERSIONS = ("3.11", "3.12", "3.13", "3.14")

# Videos are read by the wheel itself; arrays are people as bright boxes that walk to the right, each in a row of its own.
USE = """
import sys
import marey
people = marey.track(sys.argv[1] + "/scene/video.mp4")
assert people.tracks, people
people.write(sys.argv[1] + "/people.csv")
assert len(marey.read(sys.argv[1] + "/people.csv").tracks) == len(people.tracks)
import numpy
noise = numpy.random.default_rng(1)
def images():
    for k in range(60):
        image = noise.integers(40, 60, (240, 320, 3), dtype=numpy.uint8)
        for row, left in enumerate((20, 60)):
            image[30 + 100 * row : 90 + 100 * row, left + 3 * k : left + 3 * k + 24] = 200
        yield image
tracks = marey.track(marey.Frames(list(images()), rate=25))
assert len(tracks.tracks) == 2, tracks
speed = numpy.median(numpy.diff(tracks.tracks[0].x))
assert abs(speed - 3) < 0.2, speed
try:
    marey.read(sys.argv[1] + "/nothing.csv")
    raise SystemExit("a missing file was read")
except marey.Error as error:
    assert "nothing.csv" in str(error)
print(f"Python {sys.version.split()[0]}: {len(people.tracks)} tracks of the video, {len(tracks.tracks)} of the arrays")
"""


def interpreter(version: str) -> str | None:
    """One that starts: a name on PATH can be that of a manager of versions, which keeps it elsewhere."""
    home = os.environ.get("PYENV_ROOT", os.path.expanduser("~/.pyenv"))
    for found in (shutil.which(f"python{version}"), *glob.glob(f"{home}/versions/*/bin/python{version}")):
        if found and subprocess.run([found, "--version"], capture_output=True).returncode == 0:
            return found
    return None


def use(run, marey: str, python: str, folder: str) -> float:
    """The program and the package, by run(WORD...) without a network; seconds for the first overlay and the package together."""
    run(marey, "--version")
    # 4 seconds of 2 people; then what a newcomer does first.
    run(marey, "simulate", "people", "--people", "2", "--frames", "100", "-o", f"{folder}/scene", "-q")
    first, _ = run(marey, "track", f"{folder}/scene/video.mp4", "-o", f"{folder}/tracks.csv", "--overlay", f"{folder}/overlay.mp4", "-q")
    run(marey, "info", f"{folder}/overlay.mp4")
    run(marey, "track", f"{folder}/scene/video.mp4", "--targets", "keypoints", "--model", "lite", "-o", f"{folder}/keypoints.csv", "-q")
    second, said = run(python, "-c", USE, folder)
    print(said.strip())
    return first + second


def try_here(wheel: pathlib.Path, python: str) -> None:
    with tempfile.TemporaryDirectory() as folder:
        home = pathlib.Path(folder) / "venv"
        timed([python, "-m", "venv", home])
        installed, _ = timed([home / "bin/pip", "install", "--quiet", "--disable-pip-version-check", wheel])
        alone = ["unshare", "--net"] if os.geteuid() == 0 else []
        # Not from the checkout, whose own package would be found first.
        run = lambda *words: timed(["env", "-C", folder, *alone, *words])
        used = use(run, home / "bin/marey", home / "bin/python", folder)
        print(f"{python}: installed with numpy in {installed:.1f} s; first overlay and the package {used:.1f} s")


def try_in(wheel: pathlib.Path, suite: str) -> None:
    with bare_system.BareSystem(suite, ("python3-venv", "ca-certificates")) as bare:
        shutil.copy(wheel, bare.root)
        bare.run("python3", "-m", "venv", "/venv")
        installed, _ = bare.run("/venv/bin/pip", "install", "--quiet", "--disable-pip-version-check", f"/{wheel.name}")
        (bare.root / "work").mkdir()
        run = lambda *words: bare.run(*words, network=False)
        used = use(run, "/venv/bin/marey", "/venv/bin/python", "/work")
        print(f"{suite}: installed with numpy in {installed:.1f} s; first overlay and the package {used:.1f} s")


def main() -> int:
    parser = argparse.ArgumentParser()
    parser.add_argument("packages", type=pathlib.Path)
    parser.add_argument("--suites", nargs="*", default=[])
    given = parser.parse_args()
    wheels = sorted(given.packages.glob("marey-*.whl"))
    if not wheels:
        print(f"{given.packages}: holds no marey-*.whl; script/package --wheel makes it")
        return 77
    wheel = wheels[-1].resolve()
    size = wheel.stat().st_size / 1e6
    print(f"{wheel.name}: {size:.1f} MB")
    assert size < 100, size
    tried = 0
    for version in VERSIONS:
        if found := interpreter(version):
            try_here(wheel, found)
            tried += 1
        else:
            print(f"Python {version}: not here, not tried")
    for suite in given.suites:
        if why := bare_system.missing():
            print(f"{suite}: not tried: {why}")
        else:
            try_in(wheel, suite)
            tried += 1
    return 0 if tried else 77


if __name__ == "__main__":
    sys.exit(main())
