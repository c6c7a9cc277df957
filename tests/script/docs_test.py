"""The documentation is a site without a link that leads nowhere, and every command line in the new pages is one that the program takes.

Usage: docs_test.py ROOT MAREY.
"""

import pathlib
import re
import shlex
import subprocess
import sys
import unittest

ROOT = pathlib.Path(sys.argv[1])
MAREY = sys.argv[2]
PAGES = ("batch.md", "install.md", "coming_from.md")


class Docs(unittest.TestCase):
    def test_site(self):
        done = subprocess.run([ROOT / "script/docs"], capture_output=True, text=True, timeout=300)
        if done.returncode == 77:
            self.skipTest(done.stderr.strip())
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn("marey", (ROOT / "out/site/search/search_index.json").read_text())

    def test_links_within_the_checkout(self):
        for page in [ROOT / "README.md", ROOT / "ARCHITECTURE.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").rglob("*.md"))]:
            for target in re.findall(r"\]\(([^)#\s]+)(?:#[^)]*)?\)", page.read_text()):
                if "://" not in target:
                    self.assertTrue((page.parent / target).exists(), f"{page.relative_to(ROOT)}: {target} is not there")

    def test_options_are_known(self):
        for page in PAGES:
            for line in re.findall(r"`(marey [^`|]+)`|^(marey [^\n|>]+)$", (ROOT / "docs" / page).read_text(), re.M):
                words = shlex.split("".join(line))[1:]
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
