#!/usr/bin/env python3
"""Repeats the measured tables of the documentation, and shows where a page differs from what its command prints.

A measured table is a fenced block with the word `measured`, one command in it, and the table that the command prints below it:

    ```measured
    marey experiment trackers --videos 20 --seed 1 --markdown   # 40 s
    ```

    | method | ... |

A command is one of `marey`, a script of bench/ or a program of build/release/bench/. It prints a Markdown table and nothing else on standard output, and
the same table at each run: times of a machine are not measured tables. It contains its seed, unless it measures recordings alone. `$MAREY_DATA` is the folder of
test data; where the variable is not set, or a program is not built, the table is skipped with a message. The comment is how long the command takes.

Usage: figures.py [PAGE ...] [--write] [--only WORDS] [--within SECONDS] [--list] [--marey PROGRAM] [--root FOLDER]
  PAGE      pages (default: all of docs/ and bench/)
  --write   writes the new tables into the pages
  --only    repeats only tables whose command contains this
  --within  repeats only tables whose command takes at most that time by its comment
  --list    prints page, line and command of each table, and runs nothing
  --marey   the program (default: build/release/marey)
  --root    the checkout (default: this one)

Exits with 1 if a table differs or cannot be repeated, with 0 otherwise.
"""
import argparse
import dataclasses
import difflib
import os
import pathlib
import re
import shlex
import subprocess
import sys
import time

BLOCK = re.compile(r"^```measured\n(?P<command>.*?)^```\n\n?(?P<table>(?:^\|[^\n]*\n)*)", re.M | re.S)
UNITS = {"s": 1, "min": 60, "h": 3600}


class Trouble(Exception):
    """One sentence: why a table cannot be repeated."""


class Skipped(Exception):
    """One sentence: what is not here."""


@dataclasses.dataclass(frozen=True)
class Measured:
    """One measured table of a page."""

    page: pathlib.Path
    line: int  # of the block, from 1
    command: str  # without its comment
    takes_s: float | None  # by the comment
    table: str

    def __str__(self):
        return f"{self.page.name}:{self.line}: {self.command}"


def measured_tables(page: pathlib.Path) -> list[Measured]:
    text = page.read_text()
    tables = []
    for block in BLOCK.finditer(text):
        command, _, comment = block["command"].replace("\\\n", " ").strip().partition("  #")
        takes = re.fullmatch(r"\s*([\d.]+) (s|min|h)", comment)
        tables.append(Measured(page, text.count("\n", 0, block.start()) + 1, re.sub(r" +", " ", command.strip()),
                               float(takes[1]) * UNITS[takes[2]] if takes else None, block["table"]))
    return tables


def words_of(table: Measured, root: pathlib.Path, marey: pathlib.Path) -> list[str]:
    """The command's words, with the program and the data put in. Throws Trouble or Skipped."""
    words = shlex.split(table.command)
    if not words or "\n" in table.command:
        raise Trouble("the block does not hold one command")
    data = os.environ.get("MAREY_DATA")
    if "$MAREY_DATA" in table.command and not (data and pathlib.Path(data).is_dir()):
        raise Skipped("needs the folder of test data, and MAREY_DATA does not name one")
    words = [word.replace("$MAREY_DATA", data or "") for word in words]
    program = pathlib.Path(words[0])
    if words[0] == "marey":
        words[0] = str(marey)
    elif program.parts[:3] == ("build", "release", "bench"):
        words[0] = str(root / program)
    elif program.parts[:1] == ("bench",) and program.suffix == ".py":
        words[:1] = [sys.executable, str(root / program)]
        words = [str(marey) if word == "marey" else word for word in words]
        if not (root / program).exists():
            raise Trouble(f"there is no {program}")
    else:
        raise Trouble(f"{words[0]} is not marey, a script of bench/ or a program of build/release/bench/")
    if not pathlib.Path(words[0]).exists():
        raise Skipped(f"{program} is not built")
    return words


def repeat(table: Measured, root: pathlib.Path, marey: pathlib.Path) -> str:
    """What the command prints now. Throws Trouble or Skipped."""
    done = subprocess.run(words_of(table, root, marey), cwd=root, capture_output=True, text=True)
    if done.returncode != 0:
        raise Trouble(f"ended with {done.returncode}: {(done.stderr.strip().splitlines() or ['without a word'])[-1]}")
    if not re.fullmatch(r"(\|.*\n)+", done.stdout):
        raise Trouble("did not print a Markdown table and nothing else")
    return done.stdout


def write(table: Measured, new: str):
    text = table.page.read_text()
    for block in BLOCK.finditer(text):
        if text.count("\n", 0, block.start()) + 1 == table.line:
            table.page.write_text(text[: block.start()] + f"```measured\n{block['command']}```\n\n{new}" + text[block.end() :])
            return


def check(tables: list[Measured], options) -> int:
    """Counts and tells what differs; the exit code."""
    same = differing = skipped = failed = 0
    printed = {}
    for table in reversed(tables):  # a page from its end, so that lines stay where they are while it is written
        begun = time.monotonic()
        try:
            if table.command not in printed:
                printed[table.command] = repeat(table, options.root, options.marey)
            new = printed[table.command]
        except Skipped as why:
            print(f"{table}\n  skipped: {why}", flush=True)
            skipped += 1
            continue
        except Trouble as why:
            print(f"{table}\n  {why}", flush=True)
            failed += 1
            continue
        took = time.monotonic() - begun
        if new == table.table:
            print(f"{table}\n  the same ({took:.0f} s)", flush=True)
            same += 1
            continue
        differing += 1
        print(f"{table}\n  {'written' if options.write else 'differs'} ({took:.0f} s)", flush=True)
        for line in list(difflib.unified_diff(table.table.splitlines(), new.splitlines(), n=0, lineterm=""))[2:]:
            if not line.startswith("@@"):
                print(f"  {line}", flush=True)
        if options.write:
            write(table, new)
    print(f"{same} the same, {differing} {'written' if options.write else 'differ'}, {skipped} skipped, {failed} failed")
    return int(failed > 0 or (differing > 0 and not options.write))


def main() -> int:
    here = pathlib.Path(__file__).resolve().parent.parent
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("pages", nargs="*", type=pathlib.Path, metavar="PAGE")
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--only", default="", metavar="WORDS")
    parser.add_argument("--within", type=float, metavar="SECONDS")
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--marey", type=pathlib.Path)
    parser.add_argument("--root", type=pathlib.Path, default=here)
    options = parser.parse_args()
    options.root = options.root.resolve()
    options.marey = (options.marey or options.root / "build/release/marey").resolve()
    pages = options.pages or [*sorted((options.root / "docs").rglob("*.md")), *sorted((options.root / "bench").glob("*.md"))]
    for page in pages:
        if not page.is_file():
            parser.error(f"{page}: there is no such page")
    tables = [table for page in pages for table in measured_tables(page)]
    tables = [table for table in tables if options.only in table.command]
    if options.within is not None:
        tables = [table for table in tables if table.takes_s is not None and table.takes_s <= options.within]
    if not options.list:
        return check(tables, options)
    for table in tables:
        print(table)
    return 0


if __name__ == "__main__":
    sys.exit(main())
