"""What kloppy and floodlight read from the matches that `marey convert` writes: the same places to 1 cm; and what
Marey and kloppy read from files of vendors.

    match_formats_test.py PROGRAM      PROGRAM is marey; exits 77 (skipped) where the readers are not installed

kloppy turns the y of Metrica's CSV over when it reads it, and calls the result Metrica's frame, which it then is not: what it reads
is compared as it gives it (1 - y of the file), which is y of our ground divided by the width.
"""
import csv
import json
import os
import pathlib
import random
import subprocess
import sys
import tempfile
import warnings

try:
    import numpy as np
    import kloppy.metrica
    import kloppy.sportec
    import kloppy.statsperform
    import kloppy.tracab
    from floodlight.io.tracab import read_position_data_dat
except ImportError as missing:
    print(f"skipped: {missing}; script/setup installs it")
    sys.exit(77)

warnings.simplefilter("ignore")
ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
DATA = pathlib.Path(os.environ.get("MAREY_DATA", ROOT / "../shared/data")) / "football_files"
LENGTH, WIDTH = 105.0, 68.0
HALVES = ((0, 40), (100, 139))


def made_up(path, seed):
    """Two teams of eleven and a referee over two halves, people missing now and then; returns places by (frame, team, shirt)."""
    dice = random.Random(seed)
    places, rows = {}, []
    for first, last in HALVES:
        for frame in range(first, last + 1):
            for person in range(1, 24):
                team, shirt = ("white", person) if person <= 11 else ("blue", person - 11) if person <= 22 else ("referee", 0)
                if person > 1 and dice.random() < 0.1:
                    continue
                x, y = round(dice.uniform(-2, LENGTH + 2), 3), round(dice.uniform(-2, WIDTH + 2), 3)
                places[frame, team, shirt] = x, y
                rows.append([frame, f"{frame / 25:.4f}", person, shirt if shirt else "", team, x, y, 3.0, 4.0, "observed", "left", "", ""])
            if ball_at(frame):
                x, y, z = ball_at(frame)
                rows.append([frame, f"{frame / 25:.4f}", 99, "ball", "", x, y, 0, 0, "observed", "left", z, 0])
    with open(path, "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow("frame time id label team x y vx vy state cameras z vz".split())
        writer.writerows(rows)
    return places


def ball_at(frame):
    """Where the ball is in the made up match, m; nowhere in every third frame."""
    return None if frame % 3 == 0 else (10 + 0.5 * frame, 50 - 0.3 * frame, 0.11 + 0.02 * frame)


def expect_ball(name, data, place, shift=0):
    """kloppy has the ball where it was, and nowhere else."""
    found = 0
    for record in data.records:
        wanted, ball = ball_at(record.frame_id + shift), record.ball_coordinates
        if wanted is None:
            continue
        at = place(ball)
        assert abs(at[0] - wanted[0]) <= 0.01 and abs(at[1] - wanted[1]) <= 0.01, (name, record.frame_id, at, wanted)
        if len(at) > 2:
            assert abs(at[2] - wanted[2]) <= 0.01, (name, record.frame_id, at, wanted)
        found += 1
    assert found > 50, (name, found)
    print(f"{name}: the ball at {found} instants")


def convert(program, *arguments):
    subprocess.run([program, "convert", *map(str, arguments), "--quiet"], check=True, stderr=subprocess.DEVNULL)


def expect_same(name, found, wanted):
    """Places by key, to 1 cm; no more and no fewer people."""
    assert found.keys() == wanted.keys(), f"{name}: {len(found.keys() ^ wanted.keys())} places are too many or missing, of {len(wanted)}"
    error = max(max(abs(found[key][0] - wanted[key][0]), abs(found[key][1] - wanted[key][1])) for key in wanted)
    print(f"{name}: {len(wanted)} places, largest error {100 * error:.2f} cm")
    assert error <= 0.01, (name, error)


def by_kloppy(data, place, frame_shift=0):
    """Places by (frame, team, shirt); `place` turns kloppy's coordinates into metres from the corner."""
    found = {}
    for record in data.records:
        for player, what in record.players_data.items():
            point = what.coordinates
            if point is not None and not np.isnan(point.x):
                found[record.frame_id + frame_shift, player.team.name, player.jersey_no] = place(point)
    return found


def expect_halves(name, data, shift=0):
    frames = {}
    for record in data.records:
        frames.setdefault(record.period.id, []).append(record.frame_id + shift)
    assert {i + 1: half for i, half in enumerate(HALVES)} == {p: (min(f), max(f)) for p, f in frames.items()}, (name, frames)


def check_written(program, folder, seed):
    print(f"seed {seed}")
    source = folder / "match.csv"
    wanted = made_up(source, seed)
    halves = [option for half in HALVES for option in ("--period", f"{half[0]}-{half[1]}")]
    players = {key: place for key, place in wanted.items() if key[1] != "referee"}

    convert(program, source, folder / "match.dat", *halves)
    tracab = kloppy.tracab.load(meta_data=str(folder / "match.xml"), raw_data=str(folder / "match.dat"), coordinates="tracab", only_alive=False)
    expect_same("TRACAB, kloppy", by_kloppy(tracab, lambda p: (p.x / 100 + LENGTH / 2, p.y / 100 + WIDTH / 2)), players)
    expect_halves("TRACAB", tracab)
    expect_ball("TRACAB, kloppy", tracab, lambda p: (p.x / 100 + LENGTH / 2, p.y / 100 + WIDTH / 2, p.z / 100))
    assert tracab.metadata.frame_rate == 25
    assert abs(tracab.records[0].players_data[tracab.metadata.teams[0].players[0]].speed - 5.0) < 1e-9, "3, 4 m/s are 5 m/s"
    xy, _, _, sheets, pitch = read_position_data_dat(str(folder / "match.dat"), str(folder / "match.xml"))
    assert (pitch.length, pitch.width) == (LENGTH, WIDTH)
    found = {}
    for half, (first, last) in enumerate(HALVES):
        for side, team in (("Home", "white"), ("Away", "blue")):
            for shirt, column in sheets[side].get_links("jID", "xID").items():
                for i, (x, y) in enumerate(xy[f"HT{half + 1}"][side].xy[:, 2 * column:2 * column + 2]):
                    if not np.isnan(x):
                        found[first + i, team, shirt] = x / 100 + LENGTH / 2, y / 100 + WIDTH / 2
    expect_same("TRACAB, floodlight", found, players)

    convert(program, source, folder / "match_home.csv", *halves)
    metrica = kloppy.metrica.load_tracking_csv(home_data=str(folder / "match_home.csv"), away_data=str(folder / "match_away.csv"))
    expect_same("Metrica, kloppy", by_kloppy(metrica, lambda p: (p.x * LENGTH, p.y * WIDTH), -1), players)
    expect_halves("Metrica", metrica, -1)
    expect_ball("Metrica, kloppy", metrica, lambda p: (p.x * LENGTH, p.y * WIDTH), -1)

    (folder / "epts").mkdir()
    convert(program, source, folder / "epts/match.xml", *halves)
    epts = kloppy.metrica.load_tracking_epts(meta_data=str(folder / "epts/match.xml"), raw_data=str(folder / "epts/match.txt"))
    expect_same("EPTS, kloppy", by_kloppy(epts, lambda p: (p.x * LENGTH, (1 - p.y) * WIDTH)), players)
    expect_halves("EPTS", epts)
    expect_ball("EPTS, kloppy", epts, lambda p: (p.x * LENGTH, (1 - p.y) * WIDTH))
    assert (epts.metadata.pitch_dimensions.pitch_length, epts.metadata.pitch_dimensions.pitch_width) == (LENGTH, WIDTH)
    convert(program, source, folder / "match.json")
    game = json.loads((folder / "match.json").read_text())
    found = {}
    balls = [one for one in game["predictions"] if one["category_id"] == 4]
    assert len(balls) == sum(ball_at(frame) is not None for first, last in HALVES for frame in range(first, last + 1))
    assert all(one["attributes"]["role"] == "ball" for one in balls)
    for one in game["predictions"]:
        if one["category_id"] == 4:
            continue
        team = {"left": "white", "right": "blue", None: "referee"}[one["attributes"]["team"]]
        place = one["bbox_pitch"]
        found[int(one["image_id"][-6:]) - 1, team, int(one["attributes"]["jersey"] or 0)] = (
            place["x_bottom_middle"] + LENGTH / 2, WIDTH / 2 - place["y_bottom_middle"])
        assert one["attributes"]["role"] == ("referee" if team == "referee" else "player")
    expect_same("SoccerNet, by its description", found, wanted)

    convert(program, source, folder / "match.txt")
    found = {}
    for line in (folder / "match.txt").read_text().splitlines():
        fields = line.split(",")
        person = int(fields[1])
        team, shirt = ("white", person) if person <= 11 else ("blue", person - 11) if person <= 22 else ("referee", 0)
        found[int(fields[0]) - 1, team, shirt] = float(fields[7]), float(fields[8])
    expect_same("MOT with world coordinates", found, wanted)


def by_marey(program, folder, path):
    convert(program, path, folder / "read.csv")
    with open(folder / "read.csv") as file:
        return [(int(row["frame"]), row["team"], row["label"], float(row["x"]), float(row["y"])) for row in csv.DictReader(file)
                if row["label"] != "ball"]


def compare_positions(name, ours, theirs):
    """Sets of places by frame, the one who they are of, to 1 cm: names and ids differ."""
    def by_frame(rows):
        frames = {}
        for frame, x, y in rows:
            frames.setdefault(frame, []).append((x, y))
        return {frame: sorted(places) for frame, places in frames.items()}
    ours, theirs = by_frame(ours), by_frame(theirs)
    assert theirs, name
    for frame, places in theirs.items():
        mine = ours.get(frame, [])
        assert len(mine) == len(places), f"{name}: frame {frame} has {len(mine)} people, kloppy {len(places)}"
        for a, b in zip(mine, places):
            assert abs(a[0] - b[0]) <= 0.01 and abs(a[1] - b[1]) <= 0.01, (name, frame, a, b)
    print(f"{name}: {sum(map(len, theirs.values()))} places as kloppy has them")


def rows_of(data, place):
    return [(record.frame_id, *place(what.coordinates)) for record in data.records for what in record.players_data.values()
            if what.coordinates is not None and not np.isnan(what.coordinates.x)]


def check_read(program, folder):
    ours = by_marey(program, folder, DATA / "tracab_raw.dat")
    data = kloppy.tracab.load(meta_data=str(DATA / "tracab_meta.xml"), raw_data=str(DATA / "tracab_raw.dat"), coordinates="tracab", only_alive=False)
    compare_positions("tracab_raw.dat", [(f, x, y) for f, team, _, x, y in ours if team not in ("", "referee")],
                   rows_of(data, lambda p: (p.x / 100 + LENGTH / 2, p.y / 100 + WIDTH / 2)))
    ours = by_marey(program, folder, DATA / "epts_metrica_tracking.txt")
    data = kloppy.metrica.load_tracking_epts(meta_data=str(DATA / "epts_metrica_metadata.xml"), raw_data=str(DATA / "epts_metrica_tracking.txt"))
    compare_positions("epts_metrica_tracking.txt", [(f, x, y) for f, _, _, x, y in ours], rows_of(data, lambda p: (p.x * LENGTH, (1 - p.y) * WIDTH)))
    ours = by_marey(program, folder, DATA / "metrica_home.csv")
    data = kloppy.metrica.load_tracking_csv(home_data=str(DATA / "metrica_home.csv"), away_data=str(DATA / "metrica_away.csv"))
    compare_positions("metrica_home.csv", [(f + 1, x, y) for f, _, _, x, y in ours], rows_of(data, lambda p: (p.x * LENGTH, p.y * WIDTH)))
    ours = by_marey(program, folder, DATA / "sportec_positional.xml")
    data = kloppy.sportec.load_tracking(meta_data=str(DATA / "sportec_meta.xml"), raw_data=str(DATA / "sportec_positional.xml"),
                                        coordinates="sportec", only_alive=False)
    compare_positions("sportec_positional.xml", [(f, x, y) for f, _, _, x, y in ours], rows_of(data, lambda p: (p.x + 50, p.y + WIDTH / 2)))
    ours = by_marey(program, folder, DATA / "statsperform_tracking_ma25.txt")
    data = kloppy.statsperform.load_tracking(ma1_data=str(DATA / "statsperform_tracking_ma1.json"), ma25_data=str(DATA / "statsperform_tracking_ma25.txt"),
                                             tracking_system="sportvu", pitch_length=LENGTH, pitch_width=WIDTH, coordinates="sportvu", only_alive=False)
    start = data.records[0].frame_id
    compare_positions("statsperform_tracking_ma25.txt", [(f, x, y) for f, team, _, x, y in ours if team != "referee"],
                   [(round((f - start) / 100), x, y) for f, x, y in rows_of(data, lambda p: (p.x, WIDTH - p.y))])


def main(program):
    with tempfile.TemporaryDirectory() as name:
        check_written(program, pathlib.Path(name), random.SystemRandom().randrange(2**32))
        if DATA.exists():
            check_read(program, pathlib.Path(name))
        else:
            print(f"{DATA} is not here: files of vendors are not tried")


main(sys.argv[1])
