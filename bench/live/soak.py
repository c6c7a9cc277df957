"""A live run for a long time: memory, open files and threads while it runs, and what was lost.

    python3 bench/live/soak.py MAREY [--minutes 30] [--source SIM] [--record]
"""

import argparse
import json
import pathlib
import subprocess
import tempfile
import time


def state_of(pid):
    status = dict(line.split(":", 1) for line in pathlib.Path(f"/proc/{pid}/status").read_text().splitlines())
    return int(status["VmRSS"].split()[0]) / 1024, len(list(pathlib.Path(f"/proc/{pid}/fd").iterdir())), int(status["Threads"])


def main():
    options = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    options.add_argument("marey")
    options.add_argument("--minutes", type=float, default=30)
    options.add_argument("--source", default="sim://room?cameras=8&rate=120&markers=40&blobs")
    options.add_argument("--record", action="store_true", help="into a take")
    options.add_argument("--rows", type=int, default=12, help="of the table that is printed")
    given = options.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        record = ["-o", "soak.marey"] if given.record else []
        run = subprocess.Popen([given.marey, "live", given.source, "--duration", str(60 * given.minutes), "--json", "-q", *record], cwd=folder, stdout=subprocess.PIPE, text=True)
        print(f"{'minute':>8}{'MB':>8}{'files':>8}{'threads':>9}")
        begin, states = time.monotonic(), []
        while run.poll() is None:
            time.sleep(60 * given.minutes / (given.rows + 1))
            try:
                states.append(state_of(run.pid))
            except (FileNotFoundError, KeyError):
                break  # it has ended
            print(f"{(time.monotonic() - begin) / 60:8.1f}{states[-1][0]:8.1f}{states[-1][1]:8}{states[-1][2]:9}", flush=True)
        told = json.loads(run.communicate()[0])
        size = sum(path.stat().st_size for path in pathlib.Path(folder).iterdir()) / 2**20
    lost = {name: {key: camera[key] for key in ("frames", "lost", "damaged", "overrun")} for name, camera in told["cameras"].items()}
    print(f"{told['instants']} instants in {told['seconds']:.0f} s, dropped {told['dropped']}, take {size:.0f} MB")
    for name, counts in lost.items():
        print(f"  {name}: {counts}")
    for sentence in told["warnings"]:
        print(sentence)


if __name__ == "__main__":
    main()
