"""The measured tables of the documentation: bench/figures.py finds them, repeats them and shows what differs; each table in docs/ has a command that exists
and contains its seed, and the quick ones are what their commands print.

Usage: figures_test.py ROOT MAREY.
"""

import importlib.util
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(sys.argv[1]).resolve()
MAREY = pathlib.Path(sys.argv[2]).resolve()
QUICK_S = 30  # by the comment behind the command; several of them run in this test

spec = importlib.util.spec_from_file_location("figures", ROOT / "bench/figures.py")
figures = importlib.util.module_from_spec(spec)
sys.modules["figures"] = figures
spec.loader.exec_module(figures)

# Prints one row a word.
ROWS = """import sys
for word in sys.argv[1:]:
    print(f"| {word} |")
"""


class Script(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="marey_figures_")
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        (self.root / "bench").mkdir()
        (self.root / "docs").mkdir()
        (self.root / "bench/rows.py").write_text(ROWS)

    def page(self, command, table, name="page.md"):
        path = self.root / "docs" / name
        path.write_text(f"# Title\n\n```measured\n{command}\n```\n\n{table}\nThe end.\n")
        return path

    def run_it(self, code, *options, **environment):
        done = subprocess.run([sys.executable, ROOT / "bench/figures.py", "--root", self.root, *options], capture_output=True, text=True, timeout=60,
                              env={key: value for key, value in (os.environ | environment).items() if value is not None})
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done.stdout

    def test_a_table_that_reproduces(self):
        self.page("bench/rows.py 1 2  # 2 min", "| 1 |\n| 2 |\n")
        self.assertIn("1 the same, 0 differ, 0 skipped, 0 failed", self.run_it(0))
        self.assertIn("0 the same", self.run_it(0, "--within", "60"))
        self.assertIn("1 the same", self.run_it(0, "--within", "120"))
        self.assertIn("0 the same", self.run_it(0, "--only", "another"))
        self.assertEqual(self.run_it(0, "--list"), "page.md:3: bench/rows.py 1 2\n")

    def test_a_table_that_differs_is_shown_and_written_on_demand(self):
        page = self.page("bench/rows.py 1 3", "| 1 |\n| 2 |\n")
        before = page.read_text()
        printed = self.run_it(1)
        self.assertIn("page.md:3: bench/rows.py 1 3", printed)
        self.assertIn("-| 2 |", printed)
        self.assertIn("+| 3 |", printed)
        self.assertNotIn("-| 1 |", printed)
        self.assertEqual(page.read_text(), before)
        self.run_it(0, "--write")
        self.assertEqual(page.read_text(), before.replace("| 2 |", "| 3 |"))
        self.run_it(0)

    def test_several_tables_of_a_page_are_written(self):
        page = self.page("bench/rows.py 1", "")
        page.write_text(page.read_text() + "```measured\nbench/rows.py 2 3\n```\n\n| 5 |\n\nMore.\n")
        self.run_it(0, "--write")
        self.assertEqual(page.read_text(), "# Title\n\n```measured\nbench/rows.py 1\n```\n\n| 1 |\n\nThe end.\n"
                                           "```measured\nbench/rows.py 2 3\n```\n\n| 2 |\n| 3 |\n\nMore.\n")

    def test_what_is_not_here_is_skipped_with_a_message(self):
        self.page("bench/rows.py $MAREY_DATA", "| here |\n")
        self.assertIn("skipped: needs the folder of test data", self.run_it(0, MAREY_DATA=None))
        self.assertIn(f"+| {self.root} |", self.run_it(1, MAREY_DATA=str(self.root)))
        self.page("build/release/bench/gone --seed 1", "| 1 |\n")
        self.assertIn("skipped: build/release/bench/gone is not built", self.run_it(0))

    def test_commands_that_fail_or_print_something_else(self):
        for command, words in (("bench/gone.py 1", "there is no bench/gone.py"), ("rm -r docs", "rm is not marey"), ("bench/rows.py", "did not print a Markdown table"),
                               ("bench/rows.py 1\nbench/rows.py 2", "does not hold one command")):
            with self.subTest(command):
                self.page(command, "| 1 |\n")
                self.assertIn(words, self.run_it(1))
        (self.root / "bench/rows.py").write_text("raise SystemExit('no such scene')\n")
        self.page("bench/rows.py 1", "| 1 |\n")
        self.assertIn("ended with 1: no such scene", self.run_it(1))


class Docs(unittest.TestCase):
    def setUp(self):
        self.tables = [table for page in [*sorted((ROOT / "docs").rglob("*.md")), *sorted((ROOT / "bench").glob("*.md"))] for table in figures.measured_tables(page)]

    def test_every_command_exists(self):
        self.assertTrue(self.tables)
        programs = re.findall(r"^marey_table\((?:\w+/)?(\w+)\.cpp", (ROOT / "bench/CMakeLists.txt").read_text(), re.M)
        for table in self.tables:
            words = shlex.split(table.command)
            with self.subTest(str(table)):
                self.assertIsNotNone(table.takes_s, "a comment states how long the command takes, as '  # 40 s'")
                self.assertTrue(table.table, "the table stands below its command")
                if words[0].startswith("build/release/bench/"):
                    self.assertIn(pathlib.Path(words[0]).name, programs)
                elif words[0].startswith("bench/"):
                    self.assertTrue((ROOT / words[0]).is_file())
                else:
                    self.assertEqual(words[0], "marey")
                    command = words[1 : next(i for i, word in enumerate(words) if word.startswith("-"))]
                    usage = subprocess.run([MAREY, *command, "--help"], capture_output=True, text=True, check=True).stdout
                    for option in (word for word in words if word.startswith("--")):
                        self.assertIn(option, usage)

    def test_every_command_contains_its_seed(self):
        for table in self.tables:
            with self.subTest(str(table)):
                self.assertTrue("$MAREY_DATA" in table.command or re.search(r"seeds?[ =]\d", table.command))

    def test_quick_tables_reproduce(self):
        done = subprocess.run([sys.executable, ROOT / "bench/figures.py", "--within", str(QUICK_S), "--marey", MAREY], capture_output=True, text=True, timeout=1200)
        print(done.stdout)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
