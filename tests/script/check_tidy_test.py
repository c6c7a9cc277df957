"""That script/check-tidy reads what ships, once: with a build and a clang-tidy that only pretend.

Usage: check_tidy_test.py PROJECT [unittest options].
"""

import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

PROJECT = pathlib.Path()

# Says what it is asked to read, and finds something in what is named faulty.
PRETENDED_TIDY = """#!/bin/sh
for unit; do :; done
basename "$unit" >> "$READ"
case $unit in *faulty*) echo "$unit:1:1: error: a finding"; exit 1;; esac
"""


class CheckTidy(unittest.TestCase):
    def setUp(self):
        self.root = pathlib.Path(tempfile.mkdtemp(prefix="marey_tidy_"))
        self.addCleanup(shutil.rmtree, self.root)
        (self.root / "script").mkdir()
        shutil.copy(PROJECT / "script/check-tidy", self.root / "script")
        self.build = self.root / "build"
        self.build.mkdir()
        tidy = self.root / "clang-tidy-19"
        tidy.write_text(PRETENDED_TIDY)
        tidy.chmod(0o755)
        self.entries = []
        self.unit("room_unit_0.cpp", "src/marey/track/join.cpp", "src/marey/track/swap.cpp")
        self.unit("room_test_unit_0.cpp", "src/marey/track/join_test.cpp")
        self.compile("apps/cli/main.cpp")
        self.compile("bench/sweep/sweep.cpp")

    def unit(self, name, *sources):
        (self.build / name).write_text("".join(f'#include "../{source}"\n' for source in sources))
        self.entries.append({"directory": str(self.build), "file": str(self.build / name), "command": "c++"})

    def compile(self, source):
        self.entries.append({"directory": str(self.build), "file": str(self.root / source), "command": "c++"})

    def check(self, expected, *sources):
        """What was read."""
        (self.build / "compile_commands.json").write_text(json.dumps(self.entries))
        read = self.root / "read"
        read.write_text("")
        done = subprocess.run([self.root / "script/check-tidy", self.build, *sources], capture_output=True, text=True, timeout=600,
                              env=dict(os.environ, PATH=f"{self.root}:{os.environ['PATH']}", READ=str(read)))
        self.assertEqual(done.returncode, expected, done.stdout + done.stderr)
        self.said = done.stdout
        return sorted(read.read_text().split())

    def test_what_ships_is_read_in_units(self):
        self.assertEqual(self.check(0), ["main.cpp", "room_unit_0.cpp"])

    def test_of_changed_sources_only_their_units(self):
        self.assertEqual(self.check(0, "src/marey/track/swap.cpp"), ["room_unit_0.cpp"])

    def test_a_finding_is_reported(self):
        self.unit("faulty_unit_0.cpp", "src/marey/draw/plot.cpp")
        self.check(1)
        self.assertIn("error: a finding", self.said)
        self.assertIn("3 units, 1 with findings", self.said)

    def test_nothing_read_is_no_success(self):
        self.entries = []
        self.check(1)


if __name__ == "__main__":
    PROJECT = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main()
