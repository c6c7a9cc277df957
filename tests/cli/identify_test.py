"""`marey identify` as docs/identities.md has it: names go along tracks and over gaps, who was exchanged is found by location among the others, what is in
doubt is listed and answered, and lists that do not fit are refused in one sentence.

Usage: identify_test.py MAREY [unittest options]
"""

import csv
import json
import math
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

MAREY = ""
RATE = 5
SECONDS = 180
PEOPLE = 6
MET = 60  # s: 1 and 2 run side by side
ROSTER = "number,name,team\n1,Adams,Reds\n2,Brown,Reds\n3,Clark,Reds\n1,Davis,Blues\n2,Evans,Blues\n3,Foster,Blues\n"
NAMES = ["Adams", "Brown", "Clark", "Davis", "Evans", "Foster"]


def marey(*arguments, code=0):
    run = subprocess.run([MAREY, *map(str, arguments)], capture_output=True, text=True, timeout=120)
    assert run.returncode == code, f"{arguments}: {run.returncode}\n{run.stdout}{run.stderr}"
    return run


def location(who, t):
    """Where person 1 to 6 is: strolling about a home of its own; 1 and 2 meet."""
    home = (20 + 15.0 * ((who - 1) % 3), 15 + 20.0 * ((who - 1) // 3))
    x, y = home[0] + 4 * math.sin(t / 7 + who), home[1] + 4 * math.cos(t / 9 + 2 * who)
    if who > 2:
        return x, y
    near = math.exp(-(((t - MET) / 8) ** 4))
    return (1 - near) * x + near * 27.5, (1 - near) * y + near * (17 + 0.35 * (1 if who == 1 else -1))


class Identify(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="marey_who_"))
        self.addCleanup(shutil.rmtree, self.folder)
        self.take = self.folder / "match.marey"
        (self.folder / "squads.csv").write_text(ROSTER)
        self.record(lambda who, t: 3 - who if who < 3 and t >= MET else who)
        self.name([f"2,{who},{name}" for who, name in enumerate(NAMES, 1)])

    def record(self, shown, seconds=SECONDS, left_out=lambda track, t: False, moved=None):
        """A take in which track n shows the person shown(n, t)."""
        rows = ["frame,time,id,label,team,x,y,vx,vy,state,cameras"]
        for frame in range(seconds * RATE):
            t = frame / RATE
            for track in range(1, PEOPLE + 1):
                if left_out(track, t):
                    continue
                x, y = location(shown(track, t), t)
                id = moved(track, t) if moved else track
                rows.append(f"{frame},{t:.4f},{id},,,{x:.3f},{y:.3f},,,observed,cam1")
        (self.folder / "places.csv").write_text("\n".join(rows) + "\n")
        marey("convert", self.folder / "places.csv", self.take, "-q")

    def name(self, rows):
        (self.folder / "names.csv").write_text("time,id,name\n" + "\n".join(rows) + "\n")

    def identify(self, *options, code=0):
        return marey("identify", self.take, "--squads", self.folder / "squads.csv", "--annotations", self.folder / "names.csv", "--review",
                     self.folder / "doubts.csv", *options, code=code)

    def refused(self, *words):
        said = self.identify(code=1).stderr
        self.assertEqual(said.count("\n"), 1, said)
        for word in words:
            self.assertIn(word, said)
        self.assertIn("nothing was edited", marey("edit", self.take, "--list").stdout)
        self.assertFalse((self.folder / "doubts.csv").exists())

    def right(self):
        """Share of person-time whose name is right."""
        marey("convert", self.take, self.folder / "now.csv", "-q")
        right = 0
        with open(self.folder / "now.csv", newline="") as file:
            for row in csv.DictReader(file):
                for who, name in enumerate(NAMES, 1):
                    if row["label"] == f"{(who - 1) % 3 + 1} {name}":
                        x, y = location(who, float(row["time"]))
                        right += math.dist((x, y), (float(row["x"]), float(row["y"]))) < 0.3
                        self.assertEqual(row["team"], "Reds" if who < 4 else "Blues")
        return right / (SECONDS * RATE * PEOPLE)

    def ambiguities(self):
        with open(self.folder / "doubts.csv", newline="") as file:
            return list(csv.DictReader(file))

    def answer(self, answers, code=0):
        rows = self.ambiguities()
        for row, given in zip(rows, answers):
            row["answer"] = given
        with open(self.folder / "answers.csv", "w", newline="") as file:
            writer = csv.DictWriter(file, rows[0].keys())
            writer.writeheader()
            writer.writerows(rows)
        return marey("identify", self.take, "--answers", self.folder / "answers.csv", code=code)

    def numbers(self, rows, *options, code=0):
        """identify by shirt numbers, id,number,probability,readings,time."""
        (self.folder / "numbers.csv").write_text("id,number,probability,readings,time\n" + "".join(f"{row}\n" for row in rows))
        return marey("identify", self.take, "--squads", self.folder / "squads.csv", "--numbers", self.folder / "numbers.csv", *options, code=code)

    def with_teams(self):
        """The same take with the teams by which equal numbers are distinguished."""
        for track in range(1, PEOPLE + 1):
            marey("edit", self.take, f"team #{track} {'Reds' if track < 4 else 'Blues'}")

    def test_shirt_numbers_name_people(self):
        self.record(lambda who, t: who)
        self.with_teams()
        told = json.loads(self.numbers([f"{who},{(who - 1) % 3 + 1},0.99,5,{2 * who}" for who in range(1, PEOPLE + 1)], "--json").stdout)
        self.assertEqual(told["numbered"], PEOPLE)
        self.assertEqual(told["unused_numbers"], [])
        self.assertEqual({person["label"] for person in told["people"]}, {f"{who % 3 + 1} {name}" for who, name in enumerate(NAMES)})
        self.assertGreater(self.right(), 0.97)

    def test_shirt_numbers_that_decide_nothing(self):
        self.record(lambda who, t: who)
        self.with_teams()
        rows = ["1,1,0.99,5,2", "2,1,0.99,5,2",  # two people with one number
                "3,34,0.99,5,2",  # a number that the squads lack
                "4,1,0.90,5,2",  # not certain enough
                "5,2,0.99,5,2"]
        told = json.loads(self.numbers(rows, "--json").stdout)
        self.assertEqual([person["label"] for person in told["people"]], ["2 Evans"])
        self.assertEqual(len(told["unused_numbers"]), 3)
        self.assertIn("number 34", " ".join(told["unused_numbers"]))
        marey("edit", self.take, "--undo-to", 0)
        said = self.numbers(["1,1,0.99,5,2"], code=1).stderr  # without teams: 1 Adams or 1 Davis
        self.assertIn("1 Adams and 1 Davis", said)
        self.assertEqual(said.count("\n"), 1, said)
        for rows, words in ((["77,1,0.99,5,2"], "#77"), (["1,x,0.99,5,2"], "numbers.csv:2"), (["1,1,7,5,2"], "numbers.csv:2"), ([], "no number")):
            said = self.numbers(rows, code=1).stderr
            self.assertEqual(said.count("\n"), 1, said)
            self.assertIn(words, said)

    def test_annotations_count_more_than_numbers(self):
        self.record(lambda who, t: who)
        self.with_teams()
        self.name(["2,1,Brown"])
        told = json.loads(self.numbers(["1,1,0.99,5,2", "2,2,0.99,5,2"], "--annotations", self.folder / "names.csv", "--json").stdout)
        self.assertEqual([(person["label"], person["track"]) for person in told["people"]], [("2 Brown", 1)])
        self.assertEqual(told["numbered"], 0)

    def test_two_identify_were_swapped_get_their_own_names_back(self):
        told = json.loads(self.identify("--json", "-q").stdout)
        self.assertEqual(len(told["people"]), PEOPLE)
        self.assertGreater(self.right(), 0.97)
        marey("edit", self.take, "--undo-to", "0", "-q")
        self.assertEqual(self.right(), 0, "all of it can be taken back")

    def test_review_lists_of_earlier_versions_are_read(self):
        self.identify("--min-probability", "0", "-q")
        self.answer(["yes" if row["kind"] == "swap" else "" for row in self.ambiguities()])
        wanted = self.converted()
        marey("edit", self.take, "--undo", "-q")
        text = (self.folder / "answers.csv").read_text()
        for today, before in (("track_a,track_b", "a,b"), ("base_edit", "edit"), (",swap,", ",exchange,"), (",continuity,", ",same,"), (",identity,", ",who,")):
            text = text.replace(today, before)
        (self.folder / "answers.csv").write_text(text)
        marey("identify", self.take, "--answers", self.folder / "answers.csv")
        self.assertEqual(self.converted(), wanted)

    def test_names_go_over_gaps(self):
        self.record(lambda who, t: who, left_out=lambda track, t: track == 5 and 100 < t < 106,
                    moved=lambda track, t: 7 if track == 5 and t > 100 else track)
        self.identify("-q")
        self.assertGreater(self.right(), 0.97)

    def test_what_is_in_ambiguity_is_listed_and_answers_are_edits(self):
        self.identify("--min-probability", "0", "-q")
        rows = [row for row in self.ambiguities() if row["kind"] == "swap"]
        self.assertTrue(any("Adams" in row["question"] and "Brown" in row["question"] for row in rows), rows)
        before = self.right()
        asked = self.ambiguities()
        wrongly = ["yes" if "Adams" in row["question"] and row["kind"] == "swap" else "" for row in asked]
        only = wrongly.index("yes")
        self.answer(["yes" if i == only else "" for i in range(len(asked))])
        self.assertLess(self.right(), before - 0.15, "they were exchanged though they should not have been")
        marey("edit", self.take, "--undo", "-q")
        self.assertAlmostEqual(self.right(), before, msg="and back")
        said = marey("identify", self.take, "--answers", self.folder / "doubts.csv").stdout
        self.assertIn("0 answered", said)

    def test_answers_that_were_applied_before_are_left_alone(self):
        self.identify("--min-probability", "0", "-q")
        asked = self.ambiguities()
        exchanges = [i for i, row in enumerate(asked) if row["kind"] == "swap"]
        first = next(i for i in exchanges if "Adams" in asked[i]["question"])
        answers = ["yes" if i == first else "" for i in range(len(asked))]
        self.assertIn("1 answered, ", self.answer(answers).stdout)
        done = self.converted()
        said = self.answer(answers).stdout
        self.assertIn("1 answered (1 applied before)", said)
        self.assertIn("0 edits", said)
        self.assertEqual(self.converted(), done)
        marey("edit", self.take, "--undo", "-q")
        self.assertIn("1 edit\n", self.answer(answers).stdout, "what was undone is applied again")
        self.assertEqual(self.converted(), done)

        marey("edit", self.take, "--undo", "-q")
        a, b = (asked[first][column].split(" ")[0] for column in ("track_a", "track_b"))
        marey("edit", self.take, f"swap {a} {b} {int(asked[first]['frame']) + 5}:", "-q")
        by_hand = self.converted()
        self.assertIn("(1 applied before)", self.answer(answers).stdout)
        self.assertEqual(self.converted(), by_hand)

    def test_a_row_given_twice_is_applied_once(self):
        self.identify("--min-probability", "0", "-q")
        rows = self.ambiguities()
        row = next(row for row in rows if row["kind"] == "swap")
        row["answer"] = "yes"
        with open(self.folder / "answers.csv", "w", newline="") as file:
            writer = csv.DictWriter(file, row.keys())
            writer.writeheader()
            writer.writerows([row, row])
        said = marey("identify", self.take, "--answers", self.folder / "answers.csv").stdout
        self.assertIn("2 answered (1 applied before), 0 left open; 1 edit\n", said)

    def converted(self):
        marey("convert", self.take, self.folder / "now.csv", "-q")
        return (self.folder / "now.csv").read_text()

    def test_an_answer_that_no_longer_fits_is_refused_and_nothing_is_done(self):
        self.identify("--min-probability", "0", "-q")
        asked = self.ambiguities()
        self.assertIn("is no answer", self.answer(["perhaps"] * len(asked), code=1).stderr)
        marey("edit", self.take, "--undo-to", "0", "-q")
        said = self.answer(["yes"] * len(asked), code=1).stderr
        self.assertIn("answers.csv:2: ", said)
        self.assertIn("list the doubts again", said)
        self.assertEqual(self.right(), 0)

    def test_identify_is_not_named_is_requested_for(self):
        self.name([f"2,{who},{name}" for who, name in enumerate(NAMES, 1) if who != 6])
        self.identify("-q")
        asked = self.ambiguities()
        nobody = [i for i, row in enumerate(asked) if row["kind"] == "identity"]
        self.assertEqual(len(nobody), 1, asked)
        self.assertEqual(float(asked[nobody[0]]["probability"]), 1, "Foster is in the roster, and no person was called so")
        rows = ["" if i != nobody[0] else "Foster" for i in range(len(asked))]
        self.assertIn("with --squads", self.answer(rows, code=1).stderr)
        marey("identify", self.take, "--answers", self.folder / "answers.csv", "--squads", self.folder / "squads.csv", "-q")
        self.assertGreater(self.right(), 0.97)
        said = marey("identify", self.take, "--answers", self.folder / "answers.csv", "--squads", self.folder / "squads.csv").stdout
        self.assertIn("1 answered (1 applied before)", said)

    def test_a_ambiguity_is_listed_only_where_its_answer_changes_the_result(self):
        """1 and 2 meet, and then are lost: the less is left of them, the less an exchange changes, until it need not be asked for."""
        changed = []
        for end in (61, 59, 58.4, 58.2):
            self.take.unlink(missing_ok=True)
            self.record(lambda who, t: who, seconds=61, left_out=lambda track, t: track < 3 and t > end)
            self.name([f"2,{who},{name}" for who, name in enumerate(NAMES, 1)])
            told = json.loads(self.identify("--min-probability", "0", "--json", "-q").stdout)["review"]
            exchanges = [one for one in told if one["kind"] == "swap" and one["time"] > 58]
            self.assertEqual(len(exchanges), 0 if end < 58.3 else 1, f"lost at {end} s: {told}")
            if not exchanges:
                continue
            before = self.labels()
            rows = self.ambiguities()
            self.answer(["yes" if row["kind"] == "swap" and float(row["time"]) > 58 else "" for row in rows])
            now = self.labels()
            self.assertAlmostEqual(sum(now[key] != before[key] for key in before) / RATE, exchanges[0]["changes_s"])
            changed.append(exchanges[0]["changes_s"])
        self.assertEqual(changed, sorted(changed, reverse=True))

    def test_what_is_gained_max_by_is_requested_first(self):
        self.identify("--min-probability", "0", "-q")
        told = json.loads(self.again("--min-probability", "0", "--json", "-q").stdout)["review"]
        gains = [one["probability"] * one["changes_s"] for one in told]
        self.assertTrue(gains)
        self.assertEqual(gains, sorted(gains, reverse=True))

    def again(self, *options):
        marey("edit", self.take, "--undo-to", "0", "-q")
        return self.identify(*options)

    def labels(self):
        marey("convert", self.take, self.folder / "now.csv", "-q")
        with open(self.folder / "now.csv", newline="") as file:
            return {(row["frame"], row["x"], row["y"]): row["label"] for row in csv.DictReader(file)}

    def test_lists_that_do_not_fit_are_refused_in_one_message(self):
        squads = self.folder / "squads.csv"
        squads.write_text(ROSTER + "3,Gray,Reds\n")
        self.refused("squads.csv:8", "number 3 is there twice", "3 Clark", "3 Gray")
        squads.write_text("number,who\n1,Adams\n")
        self.refused("squads.csv:1", "\"name\" is missing")
        squads.write_text(ROSTER.replace("Foster,Blues", "Foster,Blues,5") )
        self.refused("squads.csv:7", "4 fields")
        squads.write_text("number,name,team,in\n1,Adams,Reds,2\n")
        self.name(["60,1,Adams"])
        self.refused("names.csv:2", "comes in at 2:00.0")
        squads.write_text(ROSTER)
        for row, words in {
            "2,1,Adamson": ("no person in the roster is called", "Adamson"),
            "2,1,3": ("may be 3 Clark (Reds) or 3 Foster (Blues)",),
            "2,9,Adams": ("which is not a track of the take", "#1"),
            "9:59,1,Adams": ("#1",),
            "soon,1,Adams": ("is not a time",),
            "2,one,Adams": ("is no number of a track",),
            "2,1,Adams\n2,2,Adams": ("1 Adams is #2 here and", "#1 at the same time"),
            "2,1,Adams\n2,1,Brown": ("#1 is 2 Brown here and", "1 Adams at the same time"),
        }.items():
            if row.startswith("9:59"):
                continue
            self.name([row])
            self.refused("names.csv:", *words)

    def test_identify_is_not_there_is_reported_with_those_identify_are(self):
        self.record(lambda who, t: who, left_out=lambda track, t: track == 5 and t > 100)
        self.name(["2:00,5,Evans"])
        self.refused("#5", "from 0:00.0 to 1:40.0", "the nearest first")

    def test_a_naming_that_the_tracks_contradict_is_named_with_its_line(self):
        self.record(lambda who, t: who)
        self.name([f"2,{who},{name}" for who, name in enumerate(NAMES, 1)] + ["1:40,6,Clark"])
        self.refused("names.csv:8: 3 Clark is #6 at 1:40.0 here", "names.csv:4, #3 at 0:02.0")

    def test_person_identify_is_not_in_the_roster_is_requested_for_as_probable_as_it_is(self):
        squads = self.folder / "squads.csv"
        squads.write_text("\n".join(ROSTER.split("\n")[:-2]) + "\n")
        self.name([f"2,{who},{name}" for who, name in enumerate(NAMES, 1) if who != 6])
        self.identify("--min-probability", "1", "-q")
        self.assertEqual([row for row in self.ambiguities() if row["kind"] == "identity"], [])

    def test_what_is_deleted_is_counted(self):
        self.record(lambda who, t: who, left_out=lambda track, t: track == 5 and t > 103)
        path = self.folder / "places.csv"
        rows = path.read_text()
        for frame in range(100 * RATE, SECONDS * RATE):
            x, y = location(5, frame / RATE)
            rows += f"{frame},{frame / RATE:.4f},7,,,{x + 0.3:.3f},{y:.3f},,,observed,cam1\n"
        path.write_text(rows)
        marey("convert", path, self.take, "-q")
        before = self.converted().count("\n")
        excluded = json.loads(self.identify("--json", "-q").stdout)["excluded"]
        self.assertGreater(excluded, 0)
        self.assertEqual(excluded, before - self.converted().count("\n"))

    def test_names_are_given_once(self):
        self.identify("-q")
        said = self.identify(code=1).stderr
        self.assertIn("called 1 Adams already", said)
        self.assertIn("--undo-to 0", said)

    def test_images_have_no_ground(self):
        (self.folder / "boxes.txt").write_text("".join(f"{f},1,10,20,30,40,1,-1,-1,-1\n" for f in range(1, 30)))
        marey("convert", self.folder / "boxes.txt", self.folder / "boxes.marey", "-q")
        said = marey("identify", self.folder / "boxes.marey", "--squads", self.folder / "squads.csv", "--annotations", self.folder / "names.csv",
                     code=1).stderr
        self.assertEqual(said.count("\n"), 1, said)

    def test_a_short_match(self):
        match = self.folder / "short"
        marey("simulate", "match", "--cameras", "2", "--seconds", "30", "--rate", "10", "--boxes", "--seed", "4", "-o", match, "-q")
        marey("track", match / "rig.toml", "--targets", "people", "--ground", "-o", self.take, "-q")
        marey("convert", self.take, self.folder / "raw.csv", "-q")
        truth, raw = {}, {}
        for path, rows in ((match / "truth.csv", truth), (self.folder / "raw.csv", raw)):
            with open(path, newline="") as file:
                for row in csv.DictReader(file):
                    rows.setdefault(int(row["frame"]), {})[int(row["id"])] = (float(row["x"]), float(row["y"]))
        names, roster = ["time,id,name"], ["number,name,team,role"]
        for person, at in truth[20].items():
            track = min(raw[20], key=lambda id: math.dist(raw[20][id], at))
            names.append(f"2.0,{track},P{person}")
            roster.append(f"{person},P{person},{'' if person > 22 else 'Home' if person < 12 else 'Away'},"
                          f"{'referee' if person > 22 else 'keeper' if person in (1, 12) else 'player'}")
        (self.folder / "names.csv").write_text("\n".join(names) + "\n")
        (self.folder / "squads.csv").write_text("\n".join(roster) + "\n")
        told = json.loads(self.identify("--json", "-q").stdout)
        self.assertEqual(len(told["people"]), 25)
        marey("convert", self.take, self.folder / "now.csv", "-q")
        right = total = referees = 0
        with open(self.folder / "now.csv", newline="") as file:
            for row in csv.DictReader(file):
                if row["label"]:
                    total += 1
                    person = int(row["label"].split(" ")[0])
                    right += math.dist(truth[int(row["frame"])][person], (float(row["x"]), float(row["y"]))) < 2
                    referees += row["team"] == "Referees"
        self.assertGreater(right / total, 0.9)
        self.assertGreater(referees, 500)


if __name__ == "__main__":
    MAREY = sys.argv.pop(1)
    unittest.main()
