"""The page of `marey measure --report`: one file without a network, sorted by its reader, with sprints, territories and numbers; opened in a browser.

Usage: report_test.py MAREY [unittest options]. Chromium is searched for.
"""

import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

MAREY = ""
CHROMIUM = shutil.which("chromium")


class Report(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="marey_report_"))
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        rows = ["frame,time,id,label,team,x,y"]
        for i in range(500):  # one sprints to and fro, others walk
            time = i / 25
            there = (8.5 * time) % 80
            rows.append(f"{i},{time},7,Seven,white,{10 + (there if there < 40 else 80 - there):.3f},20")
            rows.append(f"{i},{time},9,,white,{30 + time:.3f},40")
            rows.append(f"{i},{time},23,<b>,blue,80,{10 + time:.3f}")
        (cls.folder / "match.csv").write_text("\n".join(rows) + "\n")
        subprocess.run([MAREY, "measure", "match.csv", "-o", "figures.csv", "--report", "report", "-q"], cwd=cls.folder, check=True)
        cls.file = cls.folder / "report" / "report.html"
        cls.page = cls.file.read_text()

    def test_one_file_without_a_network(self):
        self.assertIsNone(re.search(r"(src|href)=\"(?!#)", self.page))
        self.assertNotIn("http", self.page.replace("http://www.w3.org", ""))
        self.assertNotIn("<b>", self.page)
        self.assertIn("&lt;b&gt;", self.page)

    def test_what_is_on_it(self):
        for part in ("<button>no.</button>", "Territories", "prefers-color-scheme: dark", "@media print", "class=\"sprint\"", "half of its time"):
            self.assertIn(part, self.page)
        self.assertRegex(self.page, r"<td class=\"n\" style=\"--w:100%\"")
        areas = [int(a) for a in re.findall(r"(?:white|blue), whole recording: (\d+) m²", self.page)]
        self.assertEqual(len(areas), 2)
        self.assertTrue(all(0 < area < 105 * 68 for area in areas))

    def browser(self, *words):
        if CHROMIUM is None:
            self.skipTest("chromium is not installed: apt install chromium")
        with tempfile.TemporaryDirectory() as profile:
            return subprocess.run([CHROMIUM, "--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={profile}", "--virtual-time-budget=3000", *words],
                                  capture_output=True, text=True, timeout=120, cwd=self.folder)

    def test_sorted_in_a_browser(self):
        press = self.folder / "press.html"
        press.write_text(self.page.replace("</body>", """<script>
          const head = [...document.querySelectorAll("th")].find(each => each.textContent === "top"), numbers = () =>
            [...head.closest("table").tBodies[0].rows].map(row => row.cells[0].textContent);
          head.firstChild.click(); const first = numbers(); head.firstChild.click();
          document.title = JSON.stringify([first, numbers(), head.getAttribute("aria-sort")]);</script></body>"""))
        dom = self.browser("--dump-dom", press.as_uri()).stdout
        first, second, sort = json.loads(re.search(r"<title>(.*?)</title>", dom).group(1))
        self.assertEqual((first[0], second[-1]), ("7", "7"))  # who sprinted; the others walked alike
        self.assertEqual(sorted(first), sorted(second))
        self.assertEqual(sort, "ascending")

    def test_what_is_empty_is_excluded(self):
        self.assertNotIn("The ball", self.page)
        rows = [f"{i},{i / 25},{p},{10 * p + i / 25:.3f},20,{team}\n" for i in range(100) for p, team in ((1, "a"), (2, "b"))]
        ball = [f"{i},{i / 25},3,90,60,\n" for i in range(100)]
        for name, more in (("plain", []), ("far", ball)):
            lines = [line[:-1] + ",\n" for line in rows] + [line[:-1] + ",ball\n" for line in more]
            (self.folder / f"{name}.csv").write_text("frame,time,id,x,y,team,label\n" + "".join(sorted(lines, key=lambda line: int(line.split(",")[0]))))
            subprocess.run([MAREY, "measure", f"{name}.csv", "-o", "figures.csv", "--report", name, "-q"], cwd=self.folder, check=True)
            page = (self.folder / name / "report.html").read_text()
            self.assertNotRegex(page, r"<tbody>\s*</tbody>", name)
            self.assertNotIn("<button>name</button>", page, "no person has a name")
            self.assertEqual("The ball" in page, name == "far")
            self.assertNotIn("Possession", page, "no person has it")

    def test_a_white_team_is_white(self):
        colours = {team: colour for colour, team in re.findall(r"<i style=\"--c:(#\w+)\"></i>(\w+)", self.page)}
        self.assertGreater(int(colours["white"][1:3], 16), 240)
        self.assertIn(f"stroke=\"{colours['white']}\"", self.page)

    def test_observed_and_printed(self):
        self.browser("--screenshot=light.png", "--window-size=1300,1800", self.file.as_uri())
        self.browser("--print-to-pdf=paper.pdf", self.file.as_uri())
        self.assertGreater((self.folder / "light.png").stat().st_size, 20_000)
        self.assertTrue((self.folder / "paper.pdf").read_bytes().startswith(b"%PDF"))


if __name__ == "__main__":
    MAREY = sys.argv.pop(1)
    unittest.main()
