#!/usr/bin/env python3
"""`marey edit` on a long take: what an edit costs behind a fill of all gaps; random edits, all undone; killed in between.

Usage: editing.py MAREY [--minutes 30] [--markers 15] [--edits 10000] [--kills 50] [--seed 1] [--work FOLDER]

Makes a take of `minutes` at 100 Hz with gaps, and prints:
  one edit    seconds of a command with one edit (rename, swap over a second) before and after `fill all`; the program's start is in it
  a script    milliseconds an edit of a script of 200 swaps and renames
  undone      `edits` random edits in scripts of 500, then `--undo-to 0`: whether what is exported has the bytes of before
  killed      commands with two edits each, killed (SIGKILL) after a random time: takes that lost an edit or have half a command
"""
import argparse
import json
import math
import pathlib
import random
import signal
import subprocess
import tempfile
import time

RATE = 100


def write_take(marey, folder, minutes, markers, chance):
    file = folder / "long.csv"
    hidden = [0] * markers
    with open(file, "w") as out:
        out.write("frame,time,id,label,x,y,z\n")
        for frame in range(int(60 * minutes * RATE)):
            t = frame / RATE
            for m in range(markers):
                if hidden[m] > 0:
                    hidden[m] -= 1
                    continue
                if chance.random() < 0.0008:
                    hidden[m] = chance.randint(2, 30)
                a = 4 * t + m
                out.write(f"{frame},{t:.2f},{m + 1},M{m + 1},{math.cos(0.3 * t) + 0.1 * math.cos(a):.5f},"
                          f"{math.sin(0.3 * t) + 0.1 * math.sin(a):.5f},{1 + 0.05 * m + 0.02 * math.sin(5 * t + m):.5f}\n")
    take = folder / "long.marey"
    subprocess.run([marey, "convert", file, take, "-q"], check=True)
    file.unlink()
    return take, int(60 * minutes * RATE)


def exported(marey, take, *options):
    out = take.with_suffix(".export.csv")
    subprocess.run([marey, "convert", take, out, "-q", *options], check=True)
    return out.read_bytes()


def seconds_of(marey, take, *edits):
    begin = time.perf_counter()
    subprocess.run([marey, "edit", take, *edits, "-q"], check=True)
    return time.perf_counter() - begin


def edits_of(markers, frames, chance, count):
    """Edits that are legal whatever came before: they name tracks by number and use none up."""
    for _ in range(count):
        a, b = chance.sample(range(1, markers + 1), 2)
        first = chance.randrange(frames - 200)
        kind = chance.random()
        if kind < 0.5:
            yield f"swap #{a} #{b} {first}:{first + chance.randint(1, 150)}"
        elif kind < 0.9:
            yield f"rename #{a} N{chance.getrandbits(48):x}"
        else:
            yield f"filter #{a} 6 {first}:{first + 150}"


def print_costs(marey, take, chance, markers, frames):
    for when in ("before", "behind"):
        if when == "behind":
            print(f"fill all: {seconds_of(marey, take, 'fill all'):.2f} s")
        named = min(seconds_of(marey, take, f"rename #1 {when}{i}") for i in range(5))
        swapped = min(seconds_of(marey, take, f"swap #1 #2 {100 * i}:{100 * i + 99}") for i in range(5))
        print(f"one edit {when} the fill: rename {named:.3f} s, swap {swapped:.3f} s")
    script = take.with_suffix(".txt")
    script.write_text("\n".join(edits_of(markers, frames, chance, 200)) + "\n")
    print(f"a script: {5 * seconds_of(marey, take, '--script', script):.2f} ms an edit")


def print_undone(marey, take, chance, markers, frames, count):
    before = exported(marey, take, "--without-edits")
    done, spent, script = 0, 0.0, take.with_suffix(".txt")
    while done < count:
        some = list(edits_of(markers, frames, chance, min(500, count - done)))
        script.write_text("\n".join(some) + "\n")
        spent += seconds_of(marey, take, "--script", script)
        done += len(some)
    changed = exported(marey, take) != before
    subprocess.run([marey, "edit", take, "--undo-to", "0", "-q"], check=True)
    same = exported(marey, take) == before
    print(f"{done} random edits, {1e3 * spent / max(done, 1):.2f} ms each: {'changed it' if changed else 'CHANGED NOTHING'}; undone: "
          f"{'the same bytes' if same else 'OTHER BYTES'}")


def print_killed(marey, take, chance, kills):
    lost = halves = counted = 0
    for i in range(kills):
        run = subprocess.Popen([marey, "edit", take, f"rename #1 a{i}", f"rename #2 b{i}", "-q"], stderr=subprocess.DEVNULL)
        time.sleep(chance.uniform(0, 0.3))
        run.send_signal(signal.SIGKILL)
        run.wait()
        listed = len(json.loads(subprocess.run([marey, "edit", take, "--list", "--json"], check=True, capture_output=True).stdout)["edits"])
        lost += listed < counted
        halves += (listed - counted) not in (0, 2) if i else 0
        counted = listed
    print(f"{kills} commands killed: {lost} lost an edit that was there, {halves} left half a command")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("marey")
    parser.add_argument("--minutes", type=float, default=30)
    parser.add_argument("--markers", type=int, default=15)
    parser.add_argument("--edits", type=int, default=10000)
    parser.add_argument("--kills", type=int, default=50)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--work", type=pathlib.Path)
    options = parser.parse_args()
    chance = random.Random(options.seed)
    folder = options.work or pathlib.Path(tempfile.mkdtemp(prefix="marey_editing_"))
    take, frames = write_take(options.marey, folder, options.minutes, options.markers, chance)
    print(f"{options.minutes:g} minutes, {options.markers} markers, seed {options.seed}")
    print_costs(options.marey, take, chance, options.markers, frames)
    print_undone(options.marey, take, chance, options.markers, frames, options.edits)
    print_killed(options.marey, take, chance, options.kills)


if __name__ == "__main__":
    main()
