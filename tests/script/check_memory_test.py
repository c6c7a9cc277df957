"""That script/check-memory counts what was checked: with tests and a valgrind that only pretend, so that each kind of end is there.

Usage: check_memory_test.py PROJECT [unittest options].
"""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

PROJECT = pathlib.Path()

PRETENDED_VALGRIND = """#!/bin/sh
while [ "${1#-}" != "$1" ]; do shift; done
exec "$@"
"""

# Tests are named by what they do.
PRETENDED_TESTS = """#!/usr/bin/env python3
import os, sys
for name in next(word for word in sys.argv if word.startswith("--gtest_filter=")).partition("=")[2].split(":"):
    print("[ RUN      ] " + name, flush=True)
    if name == "A.Hangs":
        while True:
            pass
    if name == "A.Reads":
        print("==1== Invalid read of size 4", file=sys.stderr, flush=True)
    if name == "A.Crashes":
        os.abort()
    print("[       OK ] " + name + " (0 ms)", flush=True)
"""


class CheckMemory(unittest.TestCase):
    def setUp(self):
        self.root = pathlib.Path(tempfile.mkdtemp(prefix="marey_memory_"))
        self.addCleanup(shutil.rmtree, self.root)
        self.program("valgrind", PRETENDED_VALGRIND)

    def program(self, name, text):
        path = self.root / name
        path.write_text(text)
        path.chmod(0o755)
        return path

    def check(self, expected, *names):
        """What it says of these tests of one program."""
        program = self.program("room_test", PRETENDED_TESTS)
        (self.root / "CTestTestfile.cmake").write_text("".join(f'add_test(room.{name} "{program}" "--gtest_filter={name}")\n' for name in names))
        done = subprocess.run([PROJECT / "script/check-memory", self.root, "--limit", "0.3"], capture_output=True, text=True, timeout=600,
                              env=dict(os.environ, PATH=f"{self.root}:{os.environ['PATH']}"))
        self.assertEqual(done.returncode, expected, done.stdout + done.stderr)
        return done.stdout

    def test_clean_ones_of_one_process(self):
        self.assertIn("3 tests clean, 0 findings, 0 not through", self.check(0, "A.One", "A.Two", "A.Three"))

    def test_a_finding_is_reported_with_what_ran(self):
        said = self.check(1, "A.One", "A.Reads")
        self.assertIn("Invalid read", said)
        self.assertIn("A.One:A.Reads", said)

    def test_one_that_takes_too_long_is_named_and_the_rest_goes_on(self):
        said = self.check(0, "A.One", "A.Hangs", "A.Two")
        self.assertIn("A.Hangs: not through", said)
        self.assertIn("2 tests clean, 0 findings, 1 not through", said)

    def test_a_program_that_ends_before_its_tests_do_is_a_finding(self):
        self.assertIn("in ['A.Crashes']", self.check(1, "A.One", "A.Crashes", "A.Two"))

    def test_nothing_checked_is_no_success(self):
        self.check(1)


if __name__ == "__main__":
    PROJECT = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main()
