"""The documentation is a site without a link that leads nowhere, its images are in the checkout, and every command line in the new pages is one that the
program takes. (`script/test --part gallery` makes the gallery's images again by its commands.)

Usage: docs_test.py ROOT MAREY.
"""

import importlib.machinery
import importlib.util
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(sys.argv[1])
MAREY = sys.argv[2]
FIRST_SCREEN = 30  # lines of Markdown
PROGRAMS = ("marey", "$", "script/model", "pip", "cmake", "import")  # that a first block begins with
# Names in the pages that are of other programs, of the system, or of a user's files.
SOURCES = (".cpp", ".h", ".py", ".ts", ".txt", ".toml", ".ipynb", ".yml", ".json", ".cmake", ".css", ".html", "")
OTHERS_NAMES = {"LeftShin", "LeftThigh", "PascalCase", "snake_case", "RssAnon", "batch_sched_delay", "camera_frame", "football_left", "left_accuracy", "left_ball", "left_json", "match_main_ptz",
                "match_metadata", "max_age", "max_iou_distance", "n_init", "pipeline_bodies_test", "rmem_max", "street_masks", "street_tracks", "today_r"}


def gallery():
    """script/gallery as a module."""
    loader = importlib.machinery.SourceFileLoader("gallery", str(ROOT / "script/gallery"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("gallery", loader))
    loader.exec_module(module)
    return module


def wrong_beginning(lines):
    """What lacks in the first screen of a page, None if nothing."""
    first_screen = lines[:FIRST_SCREEN]
    fences = [at for at, line in enumerate(first_screen) if line.startswith("```")]
    if len(fences) < 2:
        return "no commands in the first screen"
    block = [line for line in first_screen[fences[0] + 1 : fences[1]] if line.strip() and not line.startswith("#")]
    commands = [line for before, line in zip([""] + block, block) if not before.endswith("\\")]
    if not commands or commands[0].split()[0] not in PROGRAMS:
        return "no commands in the first screen"
    if len(commands) > 3:
        return f"{len(commands)} commands in the first block; three are enough"
    return None if any(line.startswith("![") for line in first_screen) else "no image in the first screen"


class Docs(unittest.TestCase):
    def test_site(self):
        # The notebooks are as they are here; python.notebooks runs them.
        done = subprocess.run([ROOT / "script/docs", "--quick"], env=os.environ | {"MAREY": MAREY}, capture_output=True, text=True, timeout=1500)
        if done.returncode == 77:
            self.skipTest(done.stderr.strip())
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        site = ROOT / "out/site"
        found = {page["location"].partition("#")[0] for page in json.loads((site / "search/search_index.json").read_text())["docs"]}
        self.assertLessEqual({"gallery.html", "reference/not_done.html", "examples/match.html", "examples/street_video.html", "examples/wand_to_c3d.html"}, found)
        shown = re.findall(r'src="(gallery/[^"]*)"', (site / "gallery.html").read_text())
        self.assertGreaterEqual(len(shown), 8)
        for picture in shown:
            self.assertIsNone(gallery().shows_nothing(site / picture), picture)

    def test_a_image_that_shows_nothing(self):
        shows_nothing = gallery().shows_nothing
        with tempfile.TemporaryDirectory(prefix="marey_docs_") as name:
            folder = pathlib.Path(name)
            self.assertEqual(shows_nothing(folder / "none.png"), "was not made")
            for pattern, said in (("color=gray", "is of one colour"), ("testsrc", None)):
                subprocess.run(["ffmpeg", "-v", "error", "-y", "-f", "lavfi", "-i", pattern, "-frames:v", "1", folder / "made.png"], check=True)
                wrong = shows_nothing(folder / "made.png")
                self.assertTrue(wrong is None if said is None else said in wrong, f"{pattern}: {wrong}")
            (folder / "empty.svg").write_text('<svg xmlns="http://www.w3.org/2000/svg"><rect/></svg>')
            self.assertEqual(shows_nothing(folder / "empty.svg"), "has 1 lines")

    def test_every_image_of_the_gallery_has_commands(self):
        for heading, (commands, pictures) in gallery().sections_of((ROOT / "docs/gallery.md").read_text()).items():
            self.assertTrue(pictures, heading)
            for picture in pictures:
                self.assertTrue([command for command in commands if picture in command], f"{heading}: no command makes {picture}")

    def test_links_within_the_checkout(self):
        for page in [ROOT / "README.md", ROOT / "ARCHITECTURE.md", ROOT / "CONTRIBUTING.md", ROOT / "bench/tuning.md", *sorted((ROOT / "docs").rglob("*.md"))]:
            for target in re.findall(r"\]\(([^)#\s]+)(?:#[^)]*)?\)", page.read_text()):
                if "://" not in target:
                    self.assertTrue((page.parent / target).exists(), f"{page.relative_to(ROOT)}: {target} is not there")

    def test_pages_are_short_and_begin_with_commands_and_an_image(self):
        """A page has at most 150 lines. One that is not reference begins with a block of at most three commands, and shows an image within its first screen."""
        for page in sorted((ROOT / "docs").glob("*.md")) + sorted((ROOT / "docs/reference").glob("*.md")):
            name, lines = page.relative_to(ROOT), page.read_text().splitlines()
            self.assertLessEqual(len(lines), 150, f"{name}: move what is longer to a page of its own in docs/reference")
            if page.parent.name == "docs":
                self.assertIsNone(wrong_beginning(lines), name)

    def test_a_page_that_begins_otherwise(self):
        block, image = ["```", "marey info a.c3d   # what is in it", "```"], ["![A walk](walk.jpg)"]
        text = ["# Title", ""] + ["words"] * 40
        self.assertIsNone(wrong_beginning(["# Title", ""] + block + image))
        self.assertIsNone(wrong_beginning(["# Title", "", "```", *["marey a \\", "  --b"] * 3, "```", *image]))
        for page, said in ((text, "no commands"), (text + block + image, "no commands"), (text[:2] + block + text[2:] + image, "no image"),
                           (["```", *["marey info a.c3d"] * 4, "```", *image], "4 commands"), (["```", "```", *image], "no commands")):
            self.assertIn(said, wrong_beginning(page) or "nothing is wrong")

    def test_every_page_is_listed(self):
        listed, site = (ROOT / "docs/pages.md").read_text(), (ROOT / "mkdocs.yml").read_text()
        for page in [*(ROOT / "docs").glob("*.md"), *(ROOT / "docs/reference").glob("*.md")]:
            name = str(page.relative_to(ROOT / "docs"))
            self.assertTrue(name in site, f"mkdocs.yml: {name} is not listed")
            if name != "pages.md":
                self.assertTrue(f"]({name}" in listed, f"docs/pages.md: {name} is not listed")

    def test_names_in_code_are_in_the_sources(self):
        listed = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True)
        if listed.returncode != 0:
            self.skipTest("not a checkout of git")
        files = [ROOT / name for name in listed.stdout.splitlines()]
        known = set(OTHERS_NAMES)
        for file in files:
            if file.suffix in SOURCES and file.name != "words.txt":
                known |= set(re.findall(r"\w+", file.read_text(errors="replace")))
        for page in files:
            if page.suffix != ".md" or page.name == "CHANGELOG.md":
                continue
            text = re.sub(r"```.*?```", "", page.read_text(), flags=re.S)
            for code in re.findall(r"`([^`\n]+)`", text):
                for name in re.findall(r"\b(k[A-Z]\w+|[A-Z][a-z]+[A-Z]\w+|[a-z]+(?:_[a-z0-9]+)+)\b", code):
                    self.assertTrue(name in known, f"{page.relative_to(ROOT)}: no source has {name}")

    def test_options_are_known(self):
        for file in [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]:
            page, text = file.name, file.read_text().replace("\\\n", "")
            for line in re.findall(r"`(marey [^`|]+)`|^(marey [^\n|>]+)$", text, re.M):
                words = "".join(line).split()[1:]
                options = [word.split("=")[0] for word in words if word.startswith("--")]
                command = []
                for word in words:
                    if not re.fullmatch(r"[a-z]+", word) or len(command) == 2:
                        break
                    command.append(word)
                said = subprocess.run([MAREY, *command, "--help"], capture_output=True, text=True)
                if said.returncode != 0:
                    said = subprocess.run([MAREY, command[0], "--help"], capture_output=True, text=True)
                self.assertEqual(said.returncode, 0, f"{page}: {line}")
                for option in options:
                    self.assertIn(option, said.stdout, f"{page}: {' '.join(words)}")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
