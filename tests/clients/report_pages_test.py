"""The pages of `marey measure --report`, `marey batch reduce --report` and `marey gait --report` in Chromium: at 1,400 px, on a phone and on paper
no column is cut off, nothing is wider than its box, and every figure of every table is there.

    report_pages_test.py MAREY [FOLDER]      exits 77 (skipped) where Node, the viewer's packages or Chromium are not here

Screenshots and PDFs are left in FOLDER. The page of a walk needs the test data, and is omitted without them.
"""
import csv
import io
import os
import pathlib
import subprocess
import sys
import tempfile

from viewer_test import PAGE, ROOT, skip_where_absent

DATA = pathlib.Path(os.environ.get("MAREY_DATA") or ROOT.parent / "shared" / "data")
NAMES = ("Neuer", "Lahm", "Schwarzenbeck-Oberhuber", "Kim", "Beckenbauer", "Breitner", "Müller", "Wu", "Maximilian von Hohenstein", "Özil", "Rahn")


def named(text):
    """Names with the simulator's numbers, and a ball at one foot after the other's."""
    rows = list(csv.DictReader(text.splitlines()))
    out = io.StringIO()
    named_rows = csv.DictWriter(out, rows[0], lineterminator="\n")
    named_rows.writeheader()
    for row in rows:
        if row["label"].isdigit():
            row["label"] += " " + NAMES[(int(row["id"]) * 7) % len(NAMES)]
        named_rows.writerow(row)
        if int(row["id"]) == 1 + int(row["frame"]) // 50 % 22:
            named_rows.writerow(row | {"id": 99, "label": "ball", "team": ""})
    return out.getvalue()


def make_pages(marey, folder):
    """Paths of the pages, by name."""

    def run(*arguments):
        subprocess.run([marey, *map(str, arguments), "-q"], cwd=folder, check=True)

    (folder / "matches").mkdir(exist_ok=True)
    for seed in (1, 2, 3):
        run("simulate", "match", "--layout", "football", "--seconds", 60, "--seed", seed, "--no-boxes", "-o", "scene")
        text = named((folder / "scene/truth.csv").read_text())
        (folder / f"matches/2026-0{seed}-14 Sportfreunde Oberwiesenfeld against Wanderers, match {seed}.csv").write_text(text)
        (folder / "match.csv").write_text(text)
    run("measure", "match.csv", "-o", "figures.csv", "--report", "match")
    run("batch", "plan", "matches", "--job", "measure", "-o", "plan.tsv")
    run("batch", "run", "plan.tsv")
    run("batch", "reduce", "plan.tsv", "-o", "season.csv", "--report", "season")
    pages = {"match": folder / "match/report.html", "season": folder / "season/report.html"}
    walks = DATA / "gait_children"
    walk = next(iter(sorted(walks.rglob("straight*.c3d"))), None)
    if walk is None:
        print(f"no page of a walk: {walks} is not here")
        return pages
    static = next(iter(sorted(walk.parent.glob("static*.c3d"))))
    run("gait", walk, "--static-trial", static, "-o", "cycles.csv", "--report", "gait.html")
    run("gait", walk, "--static-trial", static, "--reference", walks, "--before", next(iter(sorted(walk.parent.glob("turn*.c3d")))), "--before-static", static, "--report", "compared.html")
    return pages | {"gait": folder / "gait.html", "compared": folder / "compared.html"}


def main(marey, folder):
    pages = make_pages(marey, folder)
    script = pathlib.Path(__file__).with_name("report_pages.mjs")
    for name, path in pages.items():
        subprocess.run(["node", script, PAGE, folder, name, path.as_uri()], check=True, timeout=200)


if __name__ == "__main__":
    skip_where_absent()
    with tempfile.TemporaryDirectory() as temporary:
        chosen = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else temporary)
        chosen.mkdir(exist_ok=True)
        main(str(pathlib.Path(sys.argv[1]).resolve()), chosen.resolve())
