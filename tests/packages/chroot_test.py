"""The Debian packages in a Debian 12 that has nothing else: installed, used, and how long that takes.

Usage: chroot_test.py FOLDER_OF_PACKAGES [--video FILM] (root; debootstrap). Downloads are timed apart: they are the network's. Exits 77 where it cannot
be tried here.
"""

import argparse
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

MIRROR = os.environ.get("MAREY_DEBIAN_MIRROR", "http://deb.debian.org/debian")


def main() -> int:
    parser = argparse.ArgumentParser()
    parser.add_argument("packages", type=pathlib.Path)
    parser.add_argument("--video", type=pathlib.Path)
    given = parser.parse_args()
    if os.geteuid() != 0 or shutil.which("debootstrap") is None:
        print("not tried: this needs root and debootstrap (apt install debootstrap)")
        return 77
    packages = sorted(given.packages.glob("marey_*.deb"))
    if not packages:
        print(f"{given.packages}: holds no marey_*.deb; script/package makes it")
        return 1
    root = pathlib.Path(tempfile.mkdtemp(prefix="marey_chroot_", dir="/var/tmp"))
    try:
        return try_in(root, packages[-1], given.film)
    finally:
        subprocess.run(["umount", root / "proc"], capture_output=True)
        shutil.rmtree(root, ignore_errors=True)


def timed(words, root=None, environment=None):
    begin = time.monotonic()
    command = [*(["chroot", root] if root else []), *words]
    done = subprocess.run(command, capture_output=True, text=True, env=environment)
    if done.returncode:
        raise SystemExit(f"{' '.join(map(str, command))}\n{done.stdout[-3000:]}\n{done.stderr[-3000:]}")
    return time.monotonic() - begin, done.stdout


def try_in(root: pathlib.Path, package: pathlib.Path, film: pathlib.Path | None) -> int:
    seconds, _ = timed(["debootstrap", "--variant=minbase", "bookworm", root, MIRROR])
    print(f"a bare Debian 12: {seconds:.0f} s")
    subprocess.run(["mount", "-t", "proc", "proc", root / "proc"], check=True)
    for file in ("resolv.conf", "ssl/certs/ca-certificates.crt", "apt/apt.conf.d/99marey-test"):
        if (source := pathlib.Path("/etc") / file).exists():
            (root / "etc" / file).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(source, root / "etc" / file)
    for settings in pathlib.Path("/etc/apt/apt.conf.d").glob("*proxy*"):  # the way out, where there is one alone
        shutil.copy(settings, root / "etc/apt/apt.conf.d")
    shutil.copy(package, root / "marey.deb")
    environment = os.environ | {"DEBIAN_FRONTEND": "noninteractive", "LC_ALL": "C"}
    update, _ = timed(["apt-get", "update", "-qq"], root, environment)
    download, _ = timed(["apt-get", "install", "-qq", "-y", "--no-install-recommends", "--download-only", "/marey.deb"], root, environment)
    install, _ = timed(["apt-get", "install", "-qq", "-y", "--no-install-recommends", "/marey.deb"], root, environment)
    if film:
        shutil.copy(film, root / "film.mp4")
    else:
        timed(["marey", "simulate", "people", "--people", "2", "--frames", "40", "-o", "/scene", "-q"], root, environment)
        shutil.move(root / "scene/video.mp4", root / "film.mp4")
    track, _ = timed(["marey", "track", "/film.mp4", "-o", "/tracks.csv", "-q"], root, environment)
    rows = len((root / "tracks.csv").read_text().splitlines()) - 1
    assert rows > 0
    version, said = timed(["marey", "--version"], root, environment)
    for file in ("usr/share/man/man1/marey-track.1.gz", "usr/share/bash-completion/completions/marey", "usr/share/zsh/vendor-completions/_marey"):
        assert (root / file).exists(), file
    print(f"apt's lists {update:.0f} s, download {download:.0f} s; from the cache: install {install:.1f} s, first video {track:.1f} s ({rows} rows): "
          f"{install + track:.1f} s; {said.strip()} starts in {version:.2f} s")
    return 0


if __name__ == "__main__":
    sys.exit(main())
