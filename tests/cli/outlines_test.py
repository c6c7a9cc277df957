"""The commands of docs/outlines.md, as written there, on simulated people; and what their files hold.

Usage: outlines_test.py MAREY [unittest options]
"""

import json
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

MAREY = ""
PAGE = pathlib.Path(__file__).resolve().parents[2] / "docs" / "outlines.md"

STREET = pathlib.Path("/usr/share/doc/opencv-doc/examples/data/vtest.avi")


def commands_of(page):
    """Lines of the page's code blocks that begin with marey."""
    blocks = [block for language, block in re.findall(r"^```(\w*)\n(.*?)^```$", page.read_text(), re.M | re.S) if not language]
    return [line for block in blocks for line in block.splitlines() if line.startswith("marey ")]


def basis(order, t):
    """The values at t of the uniform B-spline of this order: Cox and de Boor's recursion. It is symmetric round 0."""
    if order == 1:
        return 1.0 if -0.5 <= t < 0.5 else 0.0
    half = order / 2
    return ((half + t) * basis(order - 1, t + 0.5) + (half - t) * basis(order - 1, t - 0.5)) / (order - 1)


def curve_of(outline, per_span=4):
    """Points of the closed curve."""
    points, order = outline["control_points"], outline["order"]
    reach = order // 2 + 1
    curve = []
    for k in range(per_span * len(points)):
        u = k / per_span
        weights = [(i, basis(order, u - i)) for i in range(int(u) - reach, int(u) + reach + 1)]
        curve.append(tuple(sum(weight * points[i % len(points)][axis] for i, weight in weights) for axis in (0, 1)))
    return curve


def crosses_itself(curve):
    """Whether two edges of the closed polygon cross that do not follow each other."""

    def side(a, b, p):
        return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])

    edges = list(zip(curve, curve[1:] + curve[:1]))
    for i, (a, b) in enumerate(edges):
        left, right = min(a[0], b[0]), max(a[0], b[0])
        for c, d in edges[i + 2 : len(edges) - (i == 0)]:
            if min(c[0], d[0]) > right or max(c[0], d[0]) < left:
                continue
            if side(a, b, c) * side(a, b, d) < 0 and side(c, d, a) * side(c, d, b) < 0:
                return True
    return False


def cut_off(rows):
    """How many outlines there are, and how many end more than 15 % of their box's height within it: legs or heads are missing."""
    count = cut = 0
    for row in rows:
        if "outline" not in row:
            continue
        ys = [y for _, y in curve_of(row["outline"])]
        top, height = row["top"] - 0.5, row["height"]
        count += 1
        cut += top + height - max(ys) > 0.15 * height or min(ys) - top > 0.15 * height
    return count, cut


class WholeBodies(unittest.TestCase):
    """Contours over seconds reach from head to feet: an error of one frame must not become the shape of the next."""

    def tracked(self, folder, video):
        done = subprocess.run([MAREY, "track", str(video), "--contour", "--live", "-o", "out.jsonl", "-q"], cwd=folder, capture_output=True, text=True, timeout=600)
        self.assertEqual(done.returncode, 0, done.stderr)
        return cut_off([json.loads(line) for line in (folder / "out.jsonl").read_text().splitlines()])

    def test_of_simulated_walkers(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            made = subprocess.run([MAREY, *"simulate people --situation crowd --people 8 --frames 150 --seed 1 -o people -q".split()], cwd=folder, timeout=600)
            self.assertEqual(made.returncode, 0)
            count, cut = self.tracked(folder, folder / "people" / "video.mp4")
            self.assertGreater(count, 900)
            self.assertLess(cut, 0.08 * count)  # 66 of 1035; more than 200 before

    @unittest.skipUnless(STREET.exists() and shutil.which("ffmpeg"), f"{STREET} or ffmpeg is not there")
    def test_of_people_in_a_street(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            subprocess.run(["ffmpeg", "-v", "error", "-t", "8", "-i", STREET, "-c", "copy", folder / "street.avi"], check=True)
            count, cut = self.tracked(folder, folder / "street.avi")
            self.assertGreater(count, 300)
            self.assertLess(cut, 0.06 * count)  # 15 of 339; 39 before


class Outlines(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="marey_outlines_"))
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        for command in commands_of(PAGE):
            done = subprocess.run([MAREY, *shlex.split(command)[1:]], capture_output=True, text=True, cwd=cls.folder, timeout=600)
            if done.returncode != 0:
                raise AssertionError(f"{command}\n{done.stdout}\n{done.stderr}")

    def rows(self, name):
        return [json.loads(line) for line in (self.folder / name).read_text().splitlines()]

    def test_every_outline_is_whole(self):
        for name in ("match.jsonl", "live.jsonl"):
            rows = self.rows(name)
            outlined = [row for row in rows if "outline" in row]
            self.assertGreater(len(outlined), 0.7 * len(rows), name)
            for row in outlined:
                outline = row["outline"]
                self.assertIn(outline["state"], ("seen", "partly", "held"))
                self.assertGreaterEqual(len(outline["control_points"]), outline["order"])
                self.assertEqual(len(outline["control_points"]), len(outline["deviations"]))
                for x, y in outline["deviations"]:
                    self.assertGreaterEqual(min(x, y), 0)
                for name_of_pair in ("centre", "velocity", "centre_deviation", "velocity_deviation"):
                    self.assertEqual(len(outline[name_of_pair]), 2)

    def test_no_curve_crosses_itself(self):
        for name in ("match.jsonl", "live.jsonl", "quadratic.jsonl"):
            outlines = [row["outline"] for row in self.rows(name) if "outline" in row]
            crossed = [outline for outline in outlines[::3] if crosses_itself(curve_of(outline))]
            self.assertEqual(crossed, [], name)

    def test_an_outline_belongs_to_its_box(self):
        near = count = 0
        for row in self.rows("match.jsonl"):
            if "outline" not in row:
                continue
            count += 1
            x, y = row["outline"]["centre"]
            near += abs(x - row["x"]) < row["width"] and abs(y - row["y"]) < row["height"] / 2
        self.assertGreater(near, 0.97 * count)

    def test_what_was_requested_of_the_spline(self):
        outlines = [row["outline"] for row in self.rows("quadratic.jsonl") if "outline" in row]
        self.assertGreater(len(outlines), 20)
        for outline in outlines:
            self.assertEqual(outline["order"], 3)
            self.assertEqual(len(outline["control_points"]), 16)

    def test_the_plot_has_a_trajectory_for_each_person(self):
        svg = xml.etree.ElementTree.parse(self.folder / "match.svg").getroot()
        people = {row["id"] for row in self.rows("match.jsonl")}
        circles = svg.findall("{http://www.w3.org/2000/svg}circle")
        self.assertEqual(len(circles), len(people))

    def test_the_video_is_there_and_nothing_else_is_left(self):
        names = {path.name for path in self.folder.iterdir()}
        self.assertIn("match_tracks.mp4", names)
        self.assertFalse([name for name in names if name.endswith(".part") or "outlines-" in name])


if __name__ == "__main__":
    MAREY = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main()
