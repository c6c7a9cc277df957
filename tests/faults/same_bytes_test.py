"""Every command gives the same bytes twice, and with one, two and four threads.

Usage: same_bytes_test.py MAREY
"""

import os
import shutil
import sys

import faults_test


def main():
    faults = faults_test.Faults(os.path.abspath(sys.argv[1]), None, seed=1, commands=())
    differ = []
    commands = [command for command in faults.runnable(faults_test.COMMANDS) if command[0] != "completion"]  # computes nothing, and takes no --threads
    for name, arguments, outputs in commands:
        first = None
        for threads in ("1", "1", "2", "4"):
            done = faults.run(f"{arguments} --threads {threads}")
            if done.returncode != 0:
                sys.exit(f"{name}: {done.stderr.decode()}")
            now = dict(faults_test.content(faults.folder, outputs), **{"standard output": faults_test.without_speed(done.stdout)})
            first = first or now
            differ += [f"{name}, {threads} threads: {file}" for file in sorted(first.keys() | now.keys()) if first.get(file) != now.get(file)]
    shutil.rmtree(faults.folder)
    for line in differ:
        print("other bytes: " + line)
    print(f"{len(commands)} commands, {len(differ)} differ")
    return 1 if differ else 0


if __name__ == "__main__":
    sys.exit(main())
