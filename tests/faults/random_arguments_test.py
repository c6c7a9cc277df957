"""Random command lines, made of the words that the help knows and of wild ones: each is refused or asks for a file that is not there,
in one sentence, with exit code 0, 1 or 2, and nothing is written.

Usage: random_arguments_test.py MAREY [--runs N] [--seed N]
"""

import argparse
import os
import pathlib
import random
import re
import resource
import shutil
import subprocess
import sys
import tempfile

WILD = ("", "-", "--", "nan", "-1", "1e999", "0", "99999999999999999999", "/dev/null", "/", ".", "a=b", "=", "--json=1", "-q5", "-o", "\t", "\n", "ä",
        "\udcff", "%s%n", "x" * 5000, "--" + "y" * 300, "-" * 40, "help", "--help", "--version", "[1,2]", "{}", "a,b;c", "'", '"', "*", "--limit",
        "tracks=0", "tracks=nan", "tracks", "--threads", "0.5")
# What begins to work without any input: made impossible by an option that is refused.
MAKERS = ("simulate", "experiment")


def words_of(marey, *command):
    """The subcommands and options that its help names."""
    text = subprocess.run([marey, *command, "--help"], capture_output=True, text=True, timeout=60).stdout
    commands = text.split("Commands:")[1] if "Commands:" in text else ""
    return re.findall(r"^  ([a-z]+) ", commands, re.MULTILINE), re.findall(r"(?<![\w-])(--?[a-z][a-z-]*)", text)


def line(random_, vocabulary):
    path = random_.choice(list(vocabulary))
    options = vocabulary[path]
    words = list(path)
    for _ in range(random_.randint(0, 8)):
        kind = random_.random()
        words.append(random_.choice(options) if kind < 0.5 and options else random_.choice(WILD) if kind < 0.85 else f"nothing{random_.randint(0, 3)}.csv")
    if path and path[0] in MAKERS:
        words += ["--no-such-option", "--nor-this-one"]  # an option before them takes one of them for its value
    if random_.random() < 0.1:
        random_.shuffle(words)
        words += ["--no-such-option", "--nor-this-one"]
    return [word.replace("\0", "") for word in words]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("marey")
    parser.add_argument("--runs", type=int, default=150)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    marey = os.path.abspath(options.marey)
    vocabulary = {(): words_of(marey)[1]}
    for command in words_of(marey)[0]:
        below, its_options = words_of(marey, command)
        vocabulary[(command,)] = its_options
        for each in below:
            vocabulary[(command, each)] = words_of(marey, command, each)[1]
    random_ = random.Random(options.seed)
    folder = pathlib.Path(tempfile.mkdtemp(prefix="marey_words_"))
    found = 0
    for run in range(options.runs):
        words = line(random_, vocabulary)
        done = subprocess.run([marey, *(os.fsencode(word) for word in words)], capture_output=True, cwd=folder, timeout=60, stdin=subprocess.DEVNULL,
                              preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CORE, (0, 0)))
        # A page's address is reported before its cameras are opened, and an option without effect before the input is read.
        said = "".join(text for text in done.stderr.decode(errors="replace").splitlines(True)
                       if not text.startswith(("marey: open http", "marey: warning: ")))
        left = sorted(path.name for path in folder.iterdir())
        wrong = []
        if done.returncode not in (0, 1, 2):
            wrong.append(f"exit code {done.returncode}")
        if done.returncode and not (said.startswith("marey: ") and len(said.splitlines()) == 1 or "Usage:" in said):
            wrong.append("not one sentence")
        if any(internal in said for internal in ("exception", "std::", "cv::", "CLI::", "terminate")):
            wrong.append("a library's internals")
        if left:
            wrong.append(f"left {left}")
        if wrong:
            found += 1
            print(f"FOUND {run}: {words}: {', '.join(wrong)}\n    {said[:500]}")
            for path in folder.iterdir():
                shutil.rmtree(path) if path.is_dir() else path.unlink()
    shutil.rmtree(folder)
    print(f"{options.runs} command lines of {len(vocabulary)} commands, {found} found (seed {options.seed})")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
