"""A system that has nothing but its package manager, made by debootstrap in a folder of its own."""

import os
import pathlib
import shutil
import subprocess
import tempfile
import time

DEBIAN = os.environ.get("MAREY_DEBIAN_MIRROR", "http://deb.debian.org/debian")
UBUNTU = os.environ.get("MAREY_UBUNTU_MIRROR", "http://archive.ubuntu.com/ubuntu")
ENVIRONMENT = {key: value for key, value in os.environ.items() if key not in ("PYTHONPATH", "VIRTUAL_ENV")} | {
    "DEBIAN_FRONTEND": "noninteractive",
    "LC_ALL": "C",
}
# Access to the network, if there is one gateway alone: names, certificates, and the settings of apt and pip.
KEPT = ("resolv.conf", "ssl/certs/ca-certificates.crt", "pip.conf")


def missing() -> str | None:
    """What there would have to be here to make one."""
    if os.geteuid() != 0 or shutil.which("debootstrap") is None:
        return "this needs root and debootstrap (apt install debootstrap)"
    return None


def timed(words, environment=None) -> tuple[float, str]:
    """Seconds, and what was printed; ends the test where the command fails."""
    begin = time.monotonic()
    done = subprocess.run(list(map(str, words)), capture_output=True, text=True, env=environment or ENVIRONMENT)
    if done.returncode:
        raise SystemExit(f"{' '.join(map(str, words))}\n{done.stdout[-3000:]}\n{done.stderr[-3000:]}")
    return time.monotonic() - begin, done.stdout


class BareSystem:
    """`with BareSystem("bookworm") as bare: bare.run("apt-get", "update")`; `bare.root` is its folder."""

    def __init__(self, suite: str, include: tuple[str, ...] = ()):
        self.suite = suite
        self.include = include

    def __enter__(self):
        self.root = pathlib.Path(tempfile.mkdtemp(prefix="marey_bare_", dir="/var/tmp"))
        try:
            more = [f"--include={','.join(self.include)}"] if self.include else []
            # A suite that this system's debootstrap does not know is made as the last that it knows, of its own family.
            ubuntu = self.suite in ("jammy", "noble")
            script = pathlib.Path("/usr/share/debootstrap/scripts", self.suite)
            how = [] if script.exists() else [script.with_name("gutsy" if ubuntu else "sid")]
            # Ubuntu's packages are signed by a key that Debian does not have.
            source = ["--no-check-gpg", "--components=main,universe"] if ubuntu else []
            self.seconds, _ = timed(["debootstrap", "--variant=minbase", *source, *more, self.suite, self.root, UBUNTU if ubuntu else DEBIAN, *how])
            subprocess.run(["mount", "-t", "proc", "proc", self.root / "proc"], check=True)
            for file in KEPT:
                self._copy(pathlib.Path("/etc") / file)
            for settings in pathlib.Path("/etc/apt/apt.conf.d").glob("*proxy*"):
                self._copy(settings)
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        subprocess.run(["umount", self.root / "proc"], capture_output=True)
        shutil.rmtree(self.root, ignore_errors=True)

    def _copy(self, file: pathlib.Path):
        if file.exists():
            target = self.root / file.relative_to("/")
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(file, target)

    def run(self, *words, network: bool = True) -> tuple[float, str]:
        """As root of that system, in its folder /; without a network where none is wanted."""
        return timed([*([] if network else ["unshare", "--net"]), "chroot", self.root, *words])
