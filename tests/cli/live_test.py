"""`marey track --live` on boxes of weak detectors: ahead of other trackers, honest about who was not observed.

Usage: live_test.py MAREY SOURCE_FOLDER [unittest options]. Scenes whose truth is not there (MAREY_DATA) are omitted, saying so.
"""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

MAREY, SOURCE = "", pathlib.Path()
# The best MOTA, IDF1 and HOTA of SORT, ByteTrack, OC-SORT and BoT-SORT (PyPI trackers 2.6.1) on the same boxes, as
# bench/live/live_peers.py prints them; PETS is the mean of five seeds.
BEST_PEER = {"TUD-Campus": (0.632, 0.745, 0.534), "TUD-Stadtmitte": (0.715, 0.790, 0.535), "PETS": (0.611, 0.454, 0.347)}


def walkers(frames, missing=()):
    """Boxes of two who walk; the first is not seen in the frames `missing`."""
    lines = []
    for frame in range(1, frames + 1):
        for person, top in enumerate((50, 300)):
            if person == 0 and frame in missing:
                continue
            lines.append(f"{frame},-1,{20 + 3 * frame},{top},40,100,0.9")
    return "\n".join(lines) + "\n"


class Live(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="marey_live_"))
        self.addCleanup(shutil.rmtree, self.folder)

    def marey(self, *arguments, code=0):
        done = subprocess.run([MAREY, *map(str, arguments)], capture_output=True, text=True, cwd=self.folder, timeout=300)
        self.assertEqual(done.returncode, code, f"{arguments}\n{done.stdout}\n{done.stderr}")
        return done

    def live(self, detections, *more):
        (self.folder / "boxes.txt").write_text(detections)
        self.marey("track", "--detections", "boxes.txt", "--rate", 10, "-o", "out.txt", "-q", "--live", *more)
        rows = [line.split(",") for line in (self.folder / "out.txt").read_text().splitlines()]
        return [(int(row[0]), int(row[1]), float(row[6])) for row in rows]

    def test_it_is_ahead_of_other_trackers(self):
        data = pathlib.Path(os.environ.get("MAREY_DATA") or SOURCE.parent / "shared" / "data")
        if not (data / "tud").is_dir() or not (data / "pets2009").is_dir():
            self.skipTest(f"{data} has no tud/ and pets2009/; set MAREY_DATA")
        sys.path.insert(0, str(SOURCE / "bench" / "live"))
        import live_peers
        figures = {}
        for scene, detections, truth, rate in live_peers.scenes(data, self.folder, "all"):
            self.marey("track", "--detections", detections, "--rate", rate, "-o", "live.txt", "-q", "--live")
            told = live_peers.evaluated(MAREY, truth, self.folder / "live.txt")
            figures.setdefault(scene.split(",")[0], []).append([told[name] for name in live_peers.FIGURES])
        for scene, best in BEST_PEER.items():
            ours = [sum(column) / len(figures[scene]) for column in zip(*figures[scene])]
            for name, own, peers in zip(live_peers.FIGURES, ours, best):
                self.assertGreater(own, peers, f"{scene}: {name}")

    def test_an_unobserved_person_has_no_confidence(self):
        missing = {frame for frame in range(15, 60) if frame % 5 == 0}
        rows = self.live(walkers(60, missing))
        unseen = [row for row in rows if row[2] == 0]
        self.assertTrue(unseen)
        self.assertLessEqual({frame for frame, _, _ in unseen}, missing)
        self.assertFalse([row for row in self.live(walkers(60, missing), "--measured-only") if row[2] == 0])

    def test_identify_has_gone_is_not_written_on(self):
        rows = self.live(walkers(60, set(range(31, 61))))
        gone = {person for frame, person, _ in rows if frame == 20} - {person for frame, person, _ in rows if frame == 60}
        self.assertEqual(len(gone), 1)
        self.assertLess(max(frame for frame, person, _ in rows if person in gone), 38)

    def test_a_delay_reports_all_from_the_beginning_and_fills_gaps(self):
        at_once = self.live(walkers(40, {20, 21}))
        later = self.live(walkers(40, {20, 21}), "--lag", 0.5)
        self.assertEqual(len([row for row in later if row[0] == 1]), 2)
        self.assertEqual(len([row for row in at_once if row[0] == 1]), 0)
        self.assertEqual(len([row for row in later if row[0] in (20, 21)]), 4)
        self.assertEqual({row[0] for row in later}, set(range(1, 41)))

    def test_what_a_delay_is_not_for_is_refused(self):
        (self.folder / "boxes.txt").write_text(walkers(5))
        given = ["track", "--detections", "boxes.txt", "-o", "out.txt"]
        self.assertIn("--live", self.marey(*given, "--lag", 1, code=2).stderr)
        self.marey(*given, "--live", "--lag", -1, code=2)
        self.assertFalse((self.folder / "out.txt").exists())


if __name__ == "__main__":
    MAREY, SOURCE = str(pathlib.Path(sys.argv.pop(1)).resolve()), pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main()
