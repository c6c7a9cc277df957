"""Takes that are edited in `marey view`, without a browser: what is shown, what is in the take, who may, what untrusted clients write. view_edit_test.py MAREY."""

import json
import random
import shutil
import unittest

import shown_page
from shown_page import Shown, WebSocket, marey


class Edit(unittest.TestCase):
    def setUp(self):
        self.take = shown_page.FOLDER / f"{self.id().split('.')[-1]}.marey"
        shutil.copy(shown_page.FOLDER / "walk.marey", self.take)

    def shown(self, *options):
        return Shown(shown_page.MAREY, "view", self.take, "--port", "0", "-q", *options)

    def answer(self, page, line):
        """What the page is reported that asked, and the words before."""
        page.send(line)
        before = []
        while not (heard := page.receive()).split()[0] in ("done", "refused"):
            before.append(heard)
        return heard, before

    def test_an_edit_is_shown_and_is_in_the_take(self):
        with self.shown("--edit") as shown:
            self.assertTrue(shown.scene()["can_edit"])
            page, other = WebSocket(shown), WebSocket(shown)
            a, b = (track["id"] for track in shown.scene()["tracks"][:2])
            before = {track: shown.request(f"/course?track={track}")[2] for track in (a, b)}
            self.assertEqual(json.loads(shown.request("/edits")[2]), {"edits": [], "head": 0, "newest": 0})
            said, told = self.answer(page, f"edit 0 0 swap #{a} #{b} 0:149")
            self.assertEqual(said, "done")
            self.assertEqual({other.receive(), other.receive()}, {"scene", "edits"})
            self.assertEqual(shown.request(f"/course?track={a}")[2], before[b])
            self.assertEqual([track["version"] for track in shown.scene()["tracks"][:3]], [1, 1, 0])
            history = json.loads(shown.request("/edits")[2])
            listed = json.loads(marey("edit", self.take, "--list", "--json").stdout)
            self.assertEqual((history["head"], history["edits"]), (listed["head"], listed["edits"]))
            self.assertEqual(self.answer(page, "undo 1 1")[0], "done")
            self.assertEqual(shown.request(f"/course?track={a}")[2], before[a])
            self.assertEqual(self.answer(page, "redo 0 1")[0], "done")
            self.assertEqual(self.answer(page, "go 1 1 0")[0], "done")

    def test_what_cannot_be_is_stated_as_on_the_command_line(self):
        with self.shown("--edit") as shown:
            a, b = (track["id"] for track in shown.scene()["tracks"][:2])
            page = WebSocket(shown)
            for edit in (f"join #{a} #{b}", f"swap #{a} nobody", f"delete #{a} 5:100000", "jump"):
                said = marey("edit", self.take, edit, code=1).stderr
                self.assertEqual(f"marey: {self.answer(page, f'edit 0 0 {edit}')[0].removeprefix('refused ')}\n", said)
        self.assertEqual(json.loads(marey("edit", self.take, "--list", "--json").stdout)["edits"], [])

    def test_an_edit_from_elsewhere_is_shown_and_kept(self):
        with self.shown("--edit") as shown:
            track = shown.scene()["tracks"][0]["id"]
            page = WebSocket(shown)
            marey("edit", self.take, f"rename #{track} hip", "-q")
            self.assertEqual({page.receive(), page.receive()}, {"scene", "edits"})
            self.assertEqual(shown.scene()["tracks"][0]["label"], "hip")
            marey("edit", self.take, "rename hip thigh", "-q")
            said, _ = self.answer(page, "edit 1 1 rename hip knee")
            self.assertIn("another program has edited it in the meantime", said)
            self.assertEqual(shown.scene()["tracks"][0]["label"], "thigh")

    def test_without_being_requested_for_nothing_can_be_changed(self):
        before = self.take.read_bytes()
        with self.shown() as shown:
            self.assertFalse(shown.scene()["can_edit"])
            self.assertEqual(shown.request("/edits")[0], 404)
            page = WebSocket(shown)
            for line in ("edit 0 0 filter all", "undo 0 0", "redo 0 0", "go 0 0 0"):
                self.assertIn("--edit", self.answer(page, line)[0])
        with self.shown("--edit") as shown:
            shown.scene()
            self.assertEqual(shown.request("/edits", token=False)[0], 401)
            self.assertEqual(shown.request("/edits", Origin="http://evil.example")[0], 403)
            self.assertEqual(shown.request("/edits", method="POST")[0], 405)
        self.assertEqual(self.take.read_bytes(), before)
        marey("convert", "walk.marey", "view_edit.csv", "-q")
        said = marey("view", "view_edit.csv", "--edit", code=1).stderr
        self.assertIn("is not a take, and only a take can be edited", said)
        self.assertEqual(said.count("\n"), 1)

    def test_lines_of_untrusted_change_nothing(self):
        seed = random.randrange(1 << 32)
        dice = random.Random(seed)
        with self.shown("--edit") as shown:
            shown.scene()
            before = shown.memory_mb()
            page = WebSocket(shown)
            good = ["edit 0 0 swap a b 1:2", "edit 0 0 fill nobody 1:2 rigid longest=1 within=5", "go 0 0 5", "undo 0 0", "edit 0 0 split nobody 7 \"x y\""]
            lines = ["edit", "edit 0", "edit 0 0", "edit 0 0 ", "edit -1 0 x", "undo", "go 0 0 99999999999999999999", "edit 0 0 " + "," * 4000, "edit 0 0 rename " + '"' * 4001,
                     "edit 0 0 delete " + "a," * 2000, "edit 0 0 swap \0 \x1b 1:2", "edit 0 0 filter nobody 1e999", "edit 0 0 fill nobody longest=nan"]
            for _ in range(200):
                bent = list(dice.choice(good))
                for _ in range(dice.randrange(1, 5)):
                    bent[dice.randrange(5, len(bent))] = chr(dice.randrange(1, 0x2FF))
                lines.append("".join(bent))
            for line in lines:
                said, _ = self.answer(page, line) if line.split(" ")[0] in ("edit", "undo", "redo", "go") else ("refused", [])
                stays = line.split() == ["go", "0", "0", "0"]  # bent into the one line that is no untrusted client's: the head goes where it is
                self.assertEqual(said.split(" ")[0].rstrip(":"), "done" if stays else "refused", f"{line!r}: {said!r}, seed {seed}")
                self.assertNotRegex(said, r"[\x00-\x1f]", f"{line!r}, seed {seed}")
            self.assertEqual(json.loads(shown.request("/edits")[2])["edits"], [])
            if not shown_page.SANITIZED:
                self.assertLess(shown.memory_mb() - before, 30, f"seed {seed}")


if __name__ == "__main__":
    shown_page.run_tests()
