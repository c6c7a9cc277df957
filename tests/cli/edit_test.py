"""`marey edit` as docs/edit.md has it: nothing recorded is changed, each edit can be undone, all of a script is done or nothing.

Usage: edit_test.py MAREY [unittest options]
"""

import json
import pathlib
import random
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

MAREY = ""
FRAMES = 200


def marey(*arguments, code=0, **how):
    run = subprocess.run([MAREY, *map(str, arguments)], capture_output=True, text=True, timeout=120, **how)
    assert run.returncode == code, f"{arguments}: {run.returncode}\n{run.stdout}{run.stderr}"
    return run


class Edit(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="marey_edit_"))
        self.addCleanup(shutil.rmtree, self.folder)
        rows = ["frame,time,id,label,x,y,z"]
        for frame in range(FRAMES):
            for number, label in enumerate(("A", "B", "C"), 1):
                if not (label == "C" and 50 <= frame < 55):
                    rows.append(f"{frame},{frame / 100:.2f},{number},{label},{number}.0,{frame / 100:.4f},{0.5 * number:.4f}")
        (self.folder / "walk.csv").write_text("\n".join(rows) + "\n")
        self.take = self.folder / "walk.marey"
        marey("convert", self.folder / "walk.csv", self.take, "-q")
        self.before = self.exported("before.csv")

    def exported(self, name, *options):
        marey("convert", self.take, self.folder / name, "-q", *options)
        return (self.folder / name).read_bytes()

    def positions(self, label):
        """The x of a label, by frame."""
        lines = self.exported("now.csv").decode().splitlines()
        names = lines[0].split(",")
        rows = [dict(zip(names, line.split(","))) for line in lines[1:]]
        return {int(row["frame"]): float(row["x"]) for row in rows if row["label"] == label}

    def test_what_is_exported_has_the_edits_and_the_recording_does_not(self):
        marey("edit", self.take, "swap A B 20:29", "rename C knee")
        self.assertEqual({frame: x for frame, x in self.positions("A").items() if x == 2}, {frame: 2 for frame in range(20, 30)})
        self.assertEqual(len(self.positions("knee")), FRAMES - 5)
        self.assertEqual(self.exported("raw.csv", "--without-edits"), self.before)

    def test_info_states_what_the_edits_have_left_and_what_they_are(self):
        marey("edit", self.take, "rename A ankle", "delete B", "fill all", "rename C hip")
        self.assertIn("undone:    4  rename C to hip\n", marey("edit", self.take, "--undo").stderr)
        said = json.loads(marey("info", self.take, "--json").stdout)
        self.assertEqual([(track["label"], track["measured"], track["filled"]) for track in said["tracks"]], [("ankle", FRAMES, 0), ("C", FRAMES - 5, 5)])
        self.assertEqual([edit["active"] for edit in said["edits"]], [True, True, True, False])
        self.assertEqual(said["edits"][0]["description"], "rename A to ankle")
        shown = marey("info", self.take).stdout
        self.assertIn("rename A to ankle\n", shown)
        self.assertIn("rename C to hip (does not count)", shown)
        self.assertNotIn("{", shown)
        marey("edit", self.take, "--undo-to", 0)
        said = json.loads(marey("info", self.take, "--json").stdout)
        self.assertEqual([track["label"] for track in said["tracks"]], ["A", "B", "C"])

    def test_the_line_for_those_identify_come_from_elsewhere(self):
        """As docs/reference/coming_from.md has it, on a take that has these markers and gaps."""
        page = (pathlib.Path(__file__).resolve().parent.parent.parent / "docs/reference/coming_from.md").read_text()
        line = next(line for line in page.splitlines() if "`marey edit walk.marey" in line and "swap" in line)
        words = shlex.split(line[line.index("marey edit"):].split("`")[0])
        marey("edit", self.take, "rename A LKNE", "rename B RKNE")
        said = marey(*words[1:], cwd=self.folder).stderr
        self.assertIn("5 edits count", said)
        self.assertEqual(len(self.positions("C")), FRAMES)
        self.assertAlmostEqual(self.positions("LKNE")[150], 2, places=2)

    def test_a_copy_keeps_the_edits_to_be_undone(self):
        marey("edit", self.take, "rename A ankle")
        copy = self.folder / "copy.marey"
        marey("convert", self.take, copy, "-q")
        marey("edit", copy, "--undo")
        marey("convert", copy, self.folder / "copy.csv", "-q")
        self.assertEqual((self.folder / "copy.csv").read_bytes(), self.before)

    def test_undo_redo_and_going_to_an_edit(self):
        marey("edit", self.take, "rename A one", "rename one two")
        both = self.exported("both.csv")
        marey("edit", self.take, "--undo")
        self.assertIn("one", self.exported("one.csv").decode())
        marey("edit", self.take, "--redo")
        self.assertEqual(self.exported("again.csv"), both)
        marey("edit", self.take, "--undo-to", 0)
        self.assertEqual(self.exported("none.csv"), self.before)
        self.assertIn("nothing to be undone", marey("edit", self.take, "--undo", code=1).stderr)
        self.assertIn("no edit 7", marey("edit", self.take, "--undo-to", 7, code=1).stderr)
        listed = json.loads(marey("edit", self.take, "--list", "--json").stdout)
        self.assertEqual([edit["active"] for edit in listed["edits"]], [False, False])

    def test_a_script_is_done_whole_or_not_at_all(self):
        script = self.folder / "edits.txt"
        script.write_text("# knees\nrename A left\n\nswap left rihgt 3:4\n")
        run = marey("edit", self.take, "--script", script, code=1)
        self.assertIn("edits.txt:4: there is no track called \"rihgt\"; nothing was changed", run.stderr)
        self.assertEqual(self.exported("now.csv"), self.before)
        script.write_text("rename A left # the \"left\" one\nrename B \"right # 2\" #\nrename \"right # 2\" right\n")
        marey("edit", self.take, "--script", script)
        self.assertEqual(len(self.positions("right")), FRAMES)

    def test_a_gap_is_filled_and_states_how_far_it_may_be_off(self):
        run = marey("edit", self.take, "fill C", "--json")
        gap = json.loads(run.stdout)["edits"][0]["gaps"][0]
        self.assertEqual((gap["first"], gap["last"], gap["track"]), (50, 54, "C"))
        self.assertLess(gap["expected_mm"], 1)
        self.assertEqual(len(self.positions("C")), FRAMES)

    def test_a_fill_without_a_gap_is_no_error_and_states_so(self):
        marey("edit", self.take, "fill C")
        script = self.folder / "edits.txt"
        script.write_text("fill all\nrename A knee\nfill all\n")
        run = marey("edit", self.take, "--script", script)
        self.assertEqual(run.stderr.count("there is no gap to fill; nothing was filled"), 2, run.stderr)
        self.assertEqual(len(self.positions("knee")), FRAMES)
        before = self.take.read_bytes()
        run = marey("edit", self.take, "fill all")
        self.assertIn("\"fill all\": there is no gap to fill; nothing was filled\n", run.stderr)
        self.assertEqual(self.take.read_bytes(), before)
        self.assertEqual(json.loads(marey("edit", self.take, "fill all", "--json").stdout)["edits"], [])
        marey("edit", self.take, "delete knee 80:95")
        run = marey("edit", self.take, "fill all longest=0.1")
        self.assertIn("1 gap stays open: 1 longer than 0.1 s (longest=); nothing was filled\n", run.stderr)
        self.assertIn("\"fill nobody\": there is no track", marey("edit", self.take, "fill nobody", code=1).stderr)

    def test_what_cannot_be_is_a_message(self):
        for arguments, sentence in (((self.folder / "walk.csv", "rename A B"), "not a take"), ((self.folder / "none.marey",), "no such file"),
                                    ((self.take, "jump A"), "\"jump\" is not an edit")):
            run = marey("edit", *arguments, code=1)
            self.assertIn(sentence, run.stderr)
            self.assertEqual(len(run.stderr.strip().splitlines()), 1, run.stderr)
        marey("edit", self.take, "rename A B", "--undo", code=2)

    def test_thousands_of_edits_all_undone_give_the_bytes_of_before(self):
        chance = random.Random(7)
        lines = []
        for _ in range(3000):
            first = chance.randrange(FRAMES - 20)
            a, b = chance.sample("ABC", 2)
            lines.append(f"swap {a} {b} {first}:{first + chance.randrange(20)}")
        script = self.folder / "many.txt"
        script.write_text("\n".join(lines) + "\n")
        marey("edit", self.take, "--script", script, "-q")
        self.assertNotEqual(self.exported("many.csv"), self.before)
        marey("edit", self.take, "--undo-to", 0)
        self.assertEqual(self.exported("none.csv"), self.before)

    def test_killed_between_edits_nothing_is_lost(self):
        for round_number in range(10):
            run = subprocess.Popen([MAREY, "edit", self.take, f"rename #1 name{round_number}", "swap A B" if round_number < 0 else "filter all 6"],
                                   stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
            time.sleep(0.002 * round_number)
            run.send_signal(signal.SIGKILL)
            run.wait()
            listed = json.loads(marey("edit", self.take, "--list", "--json").stdout)["edits"]
            self.assertEqual(len(listed) % 2, 0, "both edits of a command, or none")
        self.assertEqual(self.exported("raw.csv", "--without-edits"), self.before)


if __name__ == "__main__":
    MAREY = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main()
