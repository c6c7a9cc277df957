#!/usr/bin/env python3
"""How right names are after ten minutes of a simulated match in which every person was named once: `marey identify`, evaluated by the truth.

    bench/identify.py build/release/marey [--seconds 600] [--seeds 1,2,3] [--stands 4,2,football] [--work FOLDER]

For each match: simulated boxes of cameras, tracked on the ground; every person is named at the first moment at which the track is
alone within 3 m and lies within 1 m of the true place. Then `marey identify`, and once more after its doubts were answered by the
truth. `right` is the share of the true person-time whose name is right: at a true place, within 2 m, there is that name. `real`
are the instants at which a named track goes over to another person permanently, `listed` how many of these have a row within 5 s with
the name of either; `rows` is how long the list is. `before` is what names would be right if tracks were simply kept.
"""

import argparse
import collections
import csv
import json
import math
import pathlib
import subprocess
import sys

NEAR, ALONE, SURE = 2.0, 3.0, 1.0  # m
SETTLED = 1.0  # s that a track must show a person, to count as that one's


def run(*command):
    subprocess.run([str(word) for word in command], check=True, stdout=subprocess.DEVNULL)


def locations(path):
    """By frame: by id (x, y, label)."""
    frames = collections.defaultdict(dict)
    with open(path, newline="") as file:
        for row in csv.DictReader(file):
            frames[int(row["frame"])][int(row["id"])] = (float(row["x"]), float(row["y"]), row["label"])
    return frames


def people_of_tracks(truth, tracks):
    """By track: by frame the true person; who was followed stays so while within reach, others go to the nearest who is free."""
    shown = collections.defaultdict(dict)
    last = {}
    for frame in sorted(tracks):
        here, true = tracks[frame], truth.get(frame, {})
        taken = {}
        for track, person in last.items():
            if track in here and person in true and math.dist(here[track][:2], true[person][:2]) < NEAR:
                if person not in taken:
                    taken[person] = track
        left = sorted((math.dist(here[t][:2], p[:2]), t, person) for t in here if t not in taken.values()
                      for person, p in true.items() if person not in taken)
        given = set(taken.values())
        for distance, track, person in left:
            if distance < NEAR and track not in given and person not in taken:
                taken[person] = track
                given.add(track)
        for person, track in taken.items():
            last[track] = person
            shown[track][frame] = person
    return shown


def runs_of(shown, rate):
    """By track: [person, first, last] of each stretch that lasts."""
    runs = {}
    for track, people in shown.items():
        found = []
        for frame in sorted(people):
            if found and found[-1][0] == people[frame]:
                found[-1][2] = frame
            else:
                found.append([people[frame], frame, frame])
        kept = []
        for one in found:
            if one[2] - one[1] < SETTLED * rate:
                continue
            if kept and kept[-1][0] == one[0]:
                kept[-1][2] = one[2]
            else:
                kept.append(one)
        runs[track] = kept
    return runs


def first_clear_time_steps(truth, tracks):
    """By person: (frame, track)."""
    clear = {}
    for frame in sorted(tracks):
        here = tracks[frame]
        for person, place in truth[frame].items():
            if person in clear:
                continue
            near = sorted((math.dist(place[:2], p[:2]), track) for track, p in here.items())
            if not near or near[0][0] > SURE or (len(near) > 1 and near[1][0] < ALONE):
                continue
            if sum(math.dist(place[:2], other[:2]) < ALONE for other in truth[frame].values()) > 1:
                continue
            clear[person] = (frame, near[0][1])
        if len(clear) == len(truth[frame]):
            break
    return clear


def name(person):
    return f"P{person:02d}"


def label(person):
    return f"{person} {name(person)}"


def write_lists(folder, truth, tracks, rate):
    first = truth[min(truth)]
    with open(folder / "squads.csv", "w") as file:
        file.write("number,name,team,role\n")
        for person in sorted(first):
            role = "keeper" if person in (1, 12) else "referee" if person > 22 else "player"
            team = "" if person > 22 else "Home" if person <= 11 else "Away"
            file.write(f"{person},{name(person)},{team},{role}\n")
    with open(folder / "names.csv", "w") as file:
        file.write("time,id,name\n")
        clear = first_clear_time_steps(truth, tracks)
        for person, (frame, track) in sorted(clear.items()):
            file.write(f"{frame / rate:.2f},{track},{name(person)}\n")
    return clear


def right_fraction(truth, tracks):
    right = total = 0
    for frame, people in truth.items():
        by_name = {p[2]: p for p in tracks.get(frame, {}).values() if p[2]}
        for person, place in people.items():
            total += 1
            there = by_name.get(label(person))
            right += there is not None and math.dist(there[:2], place[:2]) < NEAR
    return right / total


def names_of_tracks(tracks):
    return {track: p[2] for people in tracks.values() for track, p in people.items()}


def real_changes(runs, names):
    """(frame, name) where a named track goes over to another person permanently."""
    changes = []
    for track, found in runs.items():
        for before, after in zip(found, found[1:]):
            if names.get(track):
                changes.append((after[1], names[track]))
    return changes


def listed(changes, doubts, rate):
    def has(frame, who):
        return any(abs(int(row["frame"]) - frame) < 5 * rate and (row["track_a"].endswith(who) or row["track_b"].endswith(who))
                   for row in doubts)
    return sum(has(frame, who) for frame, who in changes)


def person_before(runs, track, frame):
    """Whom the track showed last before the frame."""
    return next((person for person, first, last in reversed(runs.get(track, [])) if first < frame - 12), None)


def person_after(runs, track, frame):
    return next((person for person, first, last in runs.get(track, []) if last > frame + 12), None)


def swaps(runs, rate):
    """(frame, tracks) where two tracks go over to each other's person."""
    found = []
    for track, own in runs.items():
        for before, after in zip(own, own[1:]):
            frame = after[1]
            for other in runs:
                if other != track and person_before(runs, other, frame) == after[0] != person_after(runs, other, frame + 2 * rate):
                    found.append((frame, {track, other}))
    return found


def track_in(text):
    return int(text.split(" ")[0][1:])


def swapped_rows(rows, runs, rate):
    """The rows that a person would say yes to who looks at the seconds round each: of an exchange the nearest row of those two."""
    yes = set()
    for frame, two in swaps(runs, rate):
        near = [(abs(int(row["frame"]) - frame), i) for i, row in enumerate(rows)
                if row["kind"] == "swap" and {track_in(row["track_a"]), track_in(row["track_b"])} == two]
        if near and min(near)[0] < 6 * rate:
            yes.add(min(near)[1])
    return yes


def answer(row, runs):
    frame, a = int(row["frame"]), track_in(row["track_a"])
    if row["kind"] == "continuity":
        before, after = person_before(runs, a, frame), person_after(runs, a, frame)
        if after is None or before is None:
            return ""
        return "yes" if after == before else name(after)
    found = runs.get(a, [])
    return name(found[0][0]) if found else ""


def answer_all(path, runs, rate):
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    yes = swapped_rows(rows, runs, rate)
    for i, row in enumerate(rows):
        row["answer"] = ("yes" if i in yes else "no") if row["kind"] == "swap" else answer(row, runs)
    write_rows(path, rows)
    return rows


def apply_all(marey, take, squads, doubts, rows):
    """Answers that are refused are omitted, as a person would who reads what is said of them."""
    for _ in rows:
        done = subprocess.run([str(word) for word in (marey, "identify", take, "--squads", squads, "--answers", doubts, "-q")],
                              stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        if done.returncode == 0:
            return
        print(done.stderr.strip(), file=sys.stderr)
        line = int(done.stderr.split(":")[1])
        rows[line - 2]["answer"] = ""
        write_rows(doubts, rows)


def write_rows(path, rows):
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, rows[0].keys() if rows else ["time"])
        writer.writeheader()
        writer.writerows(rows)


def assess(marey, folder, truth, rate):
    run(marey, "convert", folder / "match.marey", folder / "now.csv", "-q")
    tracks = locations(folder / "now.csv")
    return tracks, right_fraction(truth, tracks)


def one_match(marey, stand, seed, seconds, work):
    folder = work / f"{stand}-{seed}-{seconds}"
    take = folder / "match.marey"
    if not take.exists():
        where = ["--layout", stand] if not stand.isdigit() else ["--cameras", stand]
        run(marey, "simulate", "match", *where, "--seconds", seconds, "--boxes", "--seed", seed, "-o", folder, "-q")
        run(marey, "track", folder / "rig.toml", "--targets", "people", "--ground", "-o", take, "-q")
    else:
        subprocess.run([str(marey), "edit", str(take), "--undo-to", "0", "-q"], stderr=subprocess.DEVNULL)
    truth = locations(folder / "truth.csv")
    frames = sorted(truth)
    rate = len(frames) / seconds
    run(marey, "convert", take, folder / "raw.csv", "-q")
    raw = locations(folder / "raw.csv")
    clear = write_lists(folder, truth, raw, rate)
    kept = {track: label(person) for person, (_, track) in clear.items()}
    before = right_fraction(truth, {f: {t: (p[0], p[1], kept.get(t, "")) for t, p in here.items()} for f, here in raw.items()})
    doubts = folder / "doubts.csv"
    found = subprocess.run([str(word) for word in (marey, "identify", take, "--squads", folder / "squads.csv", "--annotations",
                                                   folder / "names.csv", "--review", doubts, "--json", "-q")],
                           check=True, stdout=subprocess.PIPE)
    named = len(json.loads(found.stdout)["people"])
    tracks, once = assess(marey, folder, truth, rate)
    runs, names = runs_of(people_of_tracks(truth, tracks), rate), names_of_tracks(tracks)
    changes = real_changes(runs, names)
    rows = answer_all(doubts, runs, rate)
    apply_all(marey, take, folder / "squads.csv", doubts, rows)
    answered = assess(marey, folder, truth, rate)[1]
    yes = sum(row["answer"] == "yes" and row["kind"] == "swap" for row in rows)
    return before, named, once, len(changes), listed(changes, rows, rate), len(rows), yes, answered


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("marey", type=pathlib.Path)
    parser.add_argument("--seconds", type=int, default=600)
    parser.add_argument("--seeds", default="1,2,3")
    parser.add_argument("--stands", default="4,2,football")
    parser.add_argument("--work", type=pathlib.Path, default=pathlib.Path("who_bench"))
    options = parser.parse_args()
    print("| stand | seed | before | named | right | real | listed | rows | yes | right, answered |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |")
    for stand in options.stands.split(","):
        for seed in options.seeds.split(","):
            before, named, once, real, told, rows, yes, answered = one_match(options.marey, stand, seed, options.seconds, options.work)
            print(f"| {stand} | {seed} | {100 * before:.1f} % | {named} | {100 * once:.1f} % | {real} | {told} | {rows} | {yes} "
                  f"| {100 * answered:.1f} % |", flush=True)


if __name__ == "__main__":
    main()
