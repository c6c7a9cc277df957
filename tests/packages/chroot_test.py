"""The Debian packages in a Debian 12 that has nothing else: installed, used, and how long that takes.

Usage: chroot_test.py FOLDER_OF_PACKAGES [--video VIDEO] (root; debootstrap). Downloads are timed apart: they are the network's. Exits 77 where it cannot
be tried here.
"""

import argparse
import pathlib
import shutil
import sys

import bare_system


def main() -> int:
    parser = argparse.ArgumentParser()
    parser.add_argument("packages", type=pathlib.Path)
    parser.add_argument("--video", type=pathlib.Path)
    given = parser.parse_args()
    if why := bare_system.missing():
        print(f"not tried: {why}")
        return 77
    packages = [sorted(given.packages.glob(f"{name}_*.deb"))[-1:] for name in ("marey", "marey-models", "python3-marey")]
    if not packages[0]:
        print(f"{given.packages}: holds no marey_*.deb; script/package makes it")
        return 1
    with bare_system.BareSystem("bookworm") as bare:
        print(f"a bare Debian 12: {bare.seconds:.0f} s")
        return try_in(bare, [package for found in packages for package in found], given.video)


def try_in(bare: bare_system.BareSystem, packages: list[pathlib.Path], video: pathlib.Path | None) -> int:
    for package in packages:
        shutil.copy(package, bare.root)
    install = ["apt-get", "install", "-qq", "-y", "--no-install-recommends", *(f"/{package.name}" for package in packages)]
    update, _ = bare.run("apt-get", "update", "-qq")
    download, _ = bare.run(*install, "--download-only")
    installed, _ = bare.run(*install)
    if video:
        shutil.copy(video, bare.root / "video.mp4")
    else:
        bare.run("marey", "simulate", "people", "--people", "2", "--frames", "40", "-o", "/scene", "-q")
        shutil.move(bare.root / "scene/video.mp4", bare.root / "video.mp4")
    track, _ = bare.run("marey", "track", "/video.mp4", "-o", "/tracks.csv", "-q", network=False)
    rows = len((bare.root / "tracks.csv").read_text().splitlines()) - 1
    assert rows > 0
    if any(package.name.startswith("marey-models") for package in packages):
        bare.run("marey", "track", "/video.mp4", "--targets", "keypoints", "--model", "lite", "-o", "/keypoints.csv", "-q", network=False)
    if any(package.name.startswith("python3-marey") for package in packages):
        bare.run("python3", "-c", "import marey; assert marey.read('/tracks.csv').tracks", network=False)
    version, said = bare.run("marey", "--version")
    for file in ("usr/share/man/man1/marey-track.1.gz", "usr/share/bash-completion/completions/marey", "usr/share/zsh/vendor-completions/_marey"):
        assert (bare.root / file).exists(), file
    print(f"apt's lists {update:.0f} s, download {download:.0f} s; from the cache: install of {len(packages)} packages {installed:.1f} s, "
          f"first video {track:.1f} s ({rows} rows): {installed + track:.1f} s; {said.strip()} starts in {version:.2f} s")
    return 0


if __name__ == "__main__":
    sys.exit(main())
