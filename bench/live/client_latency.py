#!/usr/bin/env python3
"""From the instant the simulator hands an image over (drawn beforehand) to a client's hands: 4 cameras 640x480 at 100 Hz, 40 markers, JSON lines by TCP.

Usage: client_latency.py MAREY [--seconds 15]
"""
import argparse
import json
import os
import socket
import statistics
import subprocess
import time

PORT = 18766


def connected():
    for _ in range(100):
        try:
            return socket.create_connection(("127.0.0.1", PORT))
        except OSError:
            time.sleep(0.1)
    raise SystemExit(f"nothing listens on port {PORT}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("marey")
    parser.add_argument("--seconds", type=float, default=15)
    given = parser.parse_args()
    run = subprocess.Popen([given.marey, "live", "sim://room?cameras=4&rate=100&markers=40&motion=walk&drawn=1", "--duration", str(given.seconds + 10), "-q",
                            "--stream", f"json:127.0.0.1:{PORT}"])
    ages, arrivals, begin = [], [], time.monotonic()
    for line in connected().makefile():
        now = time.monotonic_ns()
        frame = json.loads(line)
        if frame["type"] != "frame" or time.monotonic() < begin + 4:
            continue  # the first seconds are the simulator's drawing
        ages.append((now - frame["capture_ns"]) / 1e6)
        arrivals.append(now / 1e6)
        if len(ages) >= 100 * given.seconds:
            break
    run.terminate()
    run.wait()
    ages.sort()
    between = [later - sooner for sooner, later in zip(arrivals, arrivals[1:])]
    print(f"{len(ages)} frames: capture to client p50 {ages[len(ages) // 2]:.2f}, p99 {ages[int(0.99 * len(ages))]:.2f} ms; "
          f"from one to the next {statistics.mean(between):.2f} ± {statistics.pstdev(between):.2f} ms; load {os.getloadavg()[0]:.1f}")


if __name__ == "__main__":
    main()
