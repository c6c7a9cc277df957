"""That script/check-names, script/check-layers and script/check-words catch what they are for: each fault is planted in a small separate tree.

Usage: checks_test.py PROJECT [unittest options].
"""

import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

PROJECT = pathlib.Path()


class Checks(unittest.TestCase):
    def setUp(self):
        self.root = pathlib.Path(tempfile.mkdtemp(prefix="marey_tree_"))
        self.addCleanup(shutil.rmtree, self.root)
        self.plant("src/marey/core/ids.h", "namespace marey {\nenum class TrackId : int {};\nnamespace {\nint local() { return 1; }\n}\n}\n")
        self.plant("src/marey/track/tracker.h", '#include "marey/core/ids.h"\nnamespace marey::track {\nclass Tracker { int step(); };\nint join(int);\n}\n')
        self.plant("src/marey/track/ground/mht.h", '#include "marey/track/tracker.h"\nnamespace marey::track::ground {\nint join(int);\nnamespace rules {\nint age();\n}\n}\n')
        self.plant("src/marey/detect/blob.cpp", "namespace marey::detect {\nnamespace {\nstruct Tracker {};\n}\nint blob() { return 2; }\n}\n")
        self.plant("apps/cli/main.cpp", '#include "marey/track/tracker.h"\nnamespace marey::cli {\nint run() { return 0; }\n}\nint main() { return 0; }\n')

    def plant(self, path, text):
        file = self.root / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)

    def check(self, script, expected, *words):
        done = subprocess.run([PROJECT / "script" / script, self.root], capture_output=True, text=True, timeout=60)
        self.assertEqual(done.returncode, expected, done.stdout + done.stderr)
        for word in words:
            self.assertIn(word, done.stdout)

    def test_a_tree_in_order_passes(self):
        self.check("check-names", 0)
        self.check("check-layers", 0)

    def test_a_class_that_two_folders_define_in_one_namespace(self):
        self.plant("src/marey/detect/tracker.h", "namespace marey::track {\nstruct Tracker {};\n}\n")
        self.check("check-names", 1, "marey::track::Tracker is defined in", "its folder is marey::detect")

    def test_a_class_that_two_sources_of_one_folder_define(self):
        self.plant("src/marey/track/other.cpp", "namespace marey::track {\nstruct Tracker { double x; };\n}\n")
        self.check("check-names", 1, "marey::track::Tracker is defined in")

    def test_a_free_function_in_headers_of_two_folders(self):
        self.plant("src/marey/detect/join.h", "namespace marey::track {\nint join(double);\n}\n")
        self.check("check-names", 1, "marey::track::join() is in headers of two folders")

    def test_pipelines_subfolders_have_an_order(self):
        self.plant("src/marey/pipeline/live/live.h", '#include "marey/pipeline/corridor/feed.h"\n')
        self.plant("src/marey/pipeline/corridor/feed.h", "#pragma once\n")
        self.check("check-layers", 0)
        self.plant("src/marey/pipeline/corridor/feed.h", '#include "marey/pipeline/live/live.h"\n')
        self.check("check-layers", 1, "pipeline/corridor may not include pipeline/live")
        self.plant("src/marey/pipeline/corridor/feed.h", "#pragma once\n")
        self.plant("src/marey/pipeline/attic/odds.h", '#include "marey/pipeline/corridor/feed.h"\n')
        self.check("check-layers", 1, "pipeline/attic has no place in the order")

    def test_unswept_constants_may_only_become_fewer(self):
        for folder in ("filter", "assign", "edit", "source/stabilise", "detect", "reconstruct", "calibrate", "solve", "analyse", "pipeline"):
            (self.root / "src/marey" / folder).mkdir(parents=True, exist_ok=True)
        self.plant("bench/tuning.md", "`kGate` was chosen among five.\n`kReach` is not swept.\n")
        self.plant("script/constants.txt", "# per folder\nfixed kPi\ntrack 2\n")
        self.plant("src/marey/track/gate.h", "constexpr double kGate = 3;\nconstexpr double kReach = 2;  // m\n"
                   "constexpr int kAxes = 3;  // by definition\nconstexpr double kPi = 3.14, kShare = 0.5;\n")
        self.check("check-constants", 0, "1 swept, 2 fixed, 2 unswept")
        self.plant("src/marey/track/more.cpp", "// How far a person reaches; unswept\nconstexpr double kArm = 0.7;\n")
        self.check("check-constants", 1, "track: 3 unswept constants, 2 allowed")
        self.plant("src/marey/track/more.cpp", "")
        self.plant("src/marey/track/gate.h", "constexpr double kReach = 2;\n")
        self.check("check-constants", 1, "fewer than the 2")

    def test_a_type_in_plain_marey_outside_core(self):
        self.plant("src/marey/detect/blob.h", "namespace marey {\nstruct Blob {};\n}\n")
        self.check("check-names", 1, "Blob is defined in marey; its folder is marey::detect")

    def test_a_subfolder_in_its_parents_namespace_and_the_reverse(self):
        self.plant("src/marey/track/ground/a.h", "namespace marey::track {\nstruct InnerAsOuter {};\n}\n")
        self.plant("src/marey/track/b.h", "namespace marey::track {\nnamespace ground {\nstruct OuterAsInner {};\n}\n}\n")
        self.check("check-names", 1, "InnerAsOuter is defined in marey::track;", "OuterAsInner is defined in marey::track::ground;")

    def test_a_type_in_the_global_namespace_and_one_in_an_inl(self):
        self.plant("src/marey/detect/blob.h", "struct Blob {};\n")
        self.plant("src/marey/detect/kernel.inl", "namespace marey {\nstruct Kernel {};\n}\n")
        self.check("check-names", 1, "Blob is defined in the global namespace", "Kernel is defined in marey;")

    def test_a_program_that_adds_to_a_folder(self):
        self.plant("apps/cli/more.cpp", "namespace marey::track {\nstruct More {};\n}\n")
        self.check("check-names", 1, "More is defined in marey::track, which is a folder of the library")

    def test_an_upward_include_of_each_kind(self):
        for file in ("a.h", "a.cpp", "a.inl", "a.inc", "inner/a.h"):
            with self.subTest(file=file):
                self.plant(f"src/marey/detect/{file}", '#include "marey/track/tracker.h"\n')
                self.check("check-layers", 1, f"src/marey/detect/{file}: detect may not include track")
                (self.root / "src/marey/detect" / file).unlink()

    def test_an_include_of_a_subfolder_of_another_step(self):
        self.plant("src/marey/detect/a.h", '#include "marey/track/ground/mht.h"\n')
        self.check("check-layers", 1, "detect may not include track")

    def test_a_library_that_includes_experiments(self):
        self.plant("src/marey/pipeline/a.h", '#include "experiments/trackers.h"\n')
        self.check("check-layers", 1, 'the library may not include "experiments/trackers.h"')

    def test_an_include_of_what_is_not_there_and_an_unknown_folder(self):
        self.plant("experiments/a.cpp", '#include "marey/track/gone.h"\n')
        self.plant("src/marey/attic/a.h", "")
        self.check("check-layers", 1, '"marey/track/gone.h" is not there', "attic is not a folder")

    def count_words(self, *rules):
        self.plant("script/words.txt", "\n".join(["allow  prose  look-up", *rules]) + "\n")
        subprocess.run(["git", "init", "-q", "."], cwd=self.root, check=True)
        subprocess.run(["git", "add", "-A"], cwd=self.root, check=True)

    def test_words_are_counted_in_every_scope(self):
        self.plant("src/marey/track/told.h", "// who looks\nnamespace marey::track {\nint kLongestGap();\nstruct ToldTrack {};\n}\n")
        self.plant("src/marey/track/told_test.cpp", 'TEST(Told, WhatIsNone) { f("a picture", "picture"); }\n')
        self.plant("docs/a.md", "An image, a inspection-up.\n```\npicture\n```\n`picture`\n")
        self.count_words("id 1 _told_  ->  x", "const 1 ^kLongest  ->  x", "path 2 ^told  ->  x", "prose 2 \\bpictures?\\b  ->  x", "prose 1 \\blook  ->  x",
                         "test 1 ^What  ->  x")
        self.check("check-words", 0, "1 id, 1 const, 2 path, 2 prose, 1 test")

    def test_a_count_that_rises_fails_and_names_the_rule(self):
        self.plant("docs/a.md", "A pic" "ture.\nAnother pic" "ture.\n")
        self.count_words("prose 1 \\bpicture\\b  ->  image")
        done = subprocess.run([PROJECT / "script/check-words", self.root], capture_output=True, text=True, timeout=60)
        self.assertEqual(done.returncode, 1, done.stdout)
        self.assertIn("rule 1: 2 hits, 1 before", done.stderr)
        subprocess.run([PROJECT / "script/check-words", "--update", self.root], capture_output=True, check=True, timeout=60)
        self.assertEqual((self.root / "script/words.txt").read_text().splitlines()[1], "prose 2 \\bpicture\\b  ->  image")

    def test_words_outside_a_working_tree_are_not_counted(self):
        self.plant("script/words.txt", "prose 1 image  ->  image\n")
        self.check("check-words", 77, "needs a git working tree")


if __name__ == "__main__":
    PROJECT = pathlib.Path(sys.argv.pop(1))
    unittest.main()
