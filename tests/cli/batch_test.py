"""`marey batch`: many recordings by a loop, GNU parallel and a real Slurm, and what happens to tasks that fail, are killed, or run twice.

Usage: batch_test.py MAREY [unittest options]. GNU parallel and Slurm are searched for; what is not there is skipped.
"""

import concurrent.futures
import csv
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import slurm_nodes

MAREY = ""
VIDEOS = 4


class Videos(unittest.TestCase):
    """Some videos, and what is done with them."""

    @classmethod
    def setUpClass(cls):
        cls.films = pathlib.Path(tempfile.mkdtemp(prefix="marey_films_"))
        cls.addClassCleanup(shutil.rmtree, cls.films)
        for number in range(VIDEOS):
            where = cls.films / f"day{number % 2}"
            where.mkdir(exist_ok=True)
            scene = cls.films / "scene"
            subprocess.run([MAREY, "simulate", "people", "--people", "2", "--frames", "30", "--seed", str(number), "-o", scene, "-q"], check=True)
            shutil.move(scene / "video.mp4", where / f"clip {number}.mp4")
            shutil.rmtree(scene)

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="marey_batch_"))
        self.addCleanup(shutil.rmtree, self.folder)
        shutil.copytree(self.films, self.folder / "films")

    def marey(self, *arguments, code=0):
        done = subprocess.run([MAREY, *map(str, arguments)], capture_output=True, text=True, cwd=self.folder, timeout=300)
        self.assertEqual(done.returncode, code, f"{arguments}\n{done.stdout}\n{done.stderr}")
        return done

    def plan(self, *more):
        self.marey("batch", "plan", "films", "-o", "plan.tsv", "-q", *more)

    def its_task(self, run):
        """The process of the task that a run does, as soon as there is one."""
        children = pathlib.Path(f"/proc/{run.pid}/task/{run.pid}/children")
        while not (tasks := children.read_text().split()):
            self.assertIsNone(run.poll(), "it ended before a task began")
            time.sleep(0.002)
        return int(tasks[0])

    def results(self):
        root = self.folder / "plan.tsv.results"
        return {str(p.relative_to(root)): p.read_bytes() for p in sorted(root.rglob("*.csv"))}


class Batch(Videos):
    def test_loop(self):
        said = self.marey("batch", "plan", "films", "-o", "plan.tsv").stdout
        self.assertIn(f"{VIDEOS} tasks", said)
        self.assertIn("sbatch --parsable", said)
        rows = list(csv.DictReader((self.folder / "plan.tsv").read_text().splitlines(), delimiter="\t"))
        self.assertEqual([r["name"] for r in rows], sorted(r["name"] for r in rows))
        self.assertEqual(rows[0]["name"], "day0/clip 0")
        counts = json.loads(self.marey("batch", "run", "plan.tsv", "--json").stdout)
        self.assertEqual(counts, {"done": VIDEOS, "done_before": 0, "failed": 0})
        self.marey("batch", "plan", "films", "-o", "imm.tsv", "-q", "--job-options", "--filter imm --measured-only")
        self.marey("batch", "run", "imm.tsv", "-q")
        for tracks in (self.folder / "imm.tsv.results").rglob("*.csv"):
            self.assertGreater(len(tracks.read_text().splitlines()), 15, f"{tracks}: people in the documentation's own example")
        single = self.folder / "alone.csv"
        self.marey("track", "films/day0/clip 2.mp4", "-o", single, "-q")
        self.assertEqual(self.results()["day0/clip 2.csv"], single.read_bytes())
        counts = json.loads(self.marey("batch", "run", "plan.tsv", "--json").stdout)
        self.assertEqual(counts, {"done": 0, "done_before": VIDEOS, "failed": 0})
        reduced = json.loads(self.marey("batch", "reduce", "plan.tsv", "-o", "season.csv", "--report", "page", "--json").stdout)
        self.assertEqual((reduced["done"], reduced["failures"]), (VIDEOS, []))
        table = list(csv.DictReader((self.folder / "season.csv").read_text().splitlines()))
        self.assertEqual({r["recording"] for r in table}, {r["name"] for r in rows})
        self.assertEqual(len(table), reduced["rows"])
        self.assertIn("day1/clip 3", (self.folder / "page" / "report.html").read_text())

    def test_parts_are_the_whole(self):
        self.plan()
        for part in (1, 2, 3):
            self.marey("batch", "run", "plan.tsv", "-q", "--shard", f"{part}/3")
        self.assertEqual(json.loads(self.marey("batch", "run", "plan.tsv", "--json").stdout)["done_before"], VIDEOS)
        for wrong in (("--shard", "4/3"), ("--shard", "3"), ("--task", VIDEOS + 1), ("--task", 1, "--shard", "1/2")):
            self.marey("batch", "run", "plan.tsv", *wrong, code=2)

    def test_options_and_tables(self):
        (self.folder / "list.csv").write_text("input,name,options\nfilms/day0/clip 0.mp4,first,--measured-only\nfilms/day1/clip 1.mp4,second,\n")
        self.marey("batch", "plan", "list.csv", "-o", "plan.tsv", "-q", "--extension", ".txt", "--job-options", "--live")
        self.marey("batch", "run", "plan.tsv", "-q")
        self.marey("track", "films/day0/clip 0.mp4", "-o", "alone.txt", "-q", "--live", "--measured-only")
        self.assertEqual((self.folder / "plan.tsv.results/first.txt").read_bytes(), (self.folder / "alone.txt").read_bytes())
        (self.folder / "list.csv").write_text("input,name\nfilms/day0/clip 0.mp4,same\nfilms/day1/clip 1.mp4,same\n")
        self.assertIn('called "same"', self.marey("batch", "plan", "list.csv", "-o", "other.tsv", code=1).stderr)
        (self.folder / "list.csv").write_text("film\na.mp4\n")
        self.assertIn('no column "input"', self.marey("batch", "plan", "list.csv", "-o", "other.tsv", code=1).stderr)
        self.assertIn("holds nothing that measure reads", self.marey("batch", "plan", "films", "--job", "measure", "-o", "m.tsv", code=1).stderr)

    def test_options_are_checked_and_written_in_one_notation(self):
        options = []
        for number, words in enumerate(("--rate 25 --filter imm", "--rate=25.0 --filter=imm", "--rate 2.5e1 --filter imm")):
            self.marey("batch", "plan", "films", "-o", f"p{number}.tsv", "-q", "--job-options", words)
            options.append({row["options"] for row in csv.DictReader((self.folder / f"p{number}.tsv").read_text().splitlines(), delimiter="\t")})
        self.assertEqual(options, [{"--rate|25|--filter|imm"}] * 3)
        for words, named in (("--rate fast", "--rate: "), ("--filter none", "--filter: "), ("--measured-only --rate", "--rate: has no value")):
            self.assertIn(named, self.marey("batch", "plan", "films", "-o", "never.tsv", "--job-options", words, code=2).stderr)
        self.assertIn("use one of track, ground", self.marey("batch", "plan", "films", "-o", "never.tsv", "--job", "dig", code=2).stderr)
        self.assertFalse((self.folder / "never.tsv").exists())

    def test_a_seasons_page(self):
        (self.folder / "matches").mkdir()
        for match, speed in ((1, 2.0), (2, 3.0)):
            rows = [f"{i},{i / 25},7,Seven,white,{speed * i / 25:.3f},20\n" for i in range(250)]
            (self.folder / "matches" / f"match{match}.csv").write_text("frame,time,id,label,team,x,y\n" + "".join(rows))
        self.marey("batch", "plan", "matches", "--job", "measure", "-o", "plan.tsv", "-q")
        self.marey("batch", "run", "plan.tsv", "-q")
        self.marey("batch", "reduce", "plan.tsv", "-o", "season.csv", "--report", "page", "-q")
        page = (self.folder / "page" / "report.html").read_text()
        totals = page[page.index("Totals") : page.index("Everybody")]
        self.assertIn("Seven, white", totals)
        self.assertRegex(totals, r">0\.05<")  # km, of 19.9 and 29.9 m
        self.assertEqual(totals.count("<svg"), 2)
        self.assertIn("Top speed from recording to recording", totals)

    def test_what_fails_is_reported(self):
        (self.folder / "films" / "day0" / "broken.mp4").write_bytes(b"no video at all" * 100)
        self.plan()
        said = self.marey("batch", "run", "plan.tsv", code=1)
        self.assertIn("broken.mp4", said.stderr)
        self.assertIn(f"{VIDEOS} done, 0 were done before, 1 failed", said.stdout)
        reduced = json.loads(self.marey("batch", "reduce", "plan.tsv", "-o", "season.csv", "--json", code=1).stdout)
        self.assertEqual([f["name"] for f in reduced["failures"]], ["day0/broken"])
        self.assertIn("broken.mp4", reduced["failures"][0]["why"])
        self.assertEqual(reduced["done"], VIDEOS)

    def test_inputs_that_changed(self):
        self.plan()
        self.marey("batch", "run", "plan.tsv", "-q")
        film, other = self.folder / "films/day0/clip 0.mp4", self.folder / "films/day1/clip 1.mp4"
        os.utime(film)  # touched alone: its bytes are the same
        self.assertEqual(json.loads(self.marey("batch", "run", "plan.tsv", "--json").stdout)["done_before"], VIDEOS)
        shutil.copy(other, film)
        self.assertIn("is another file than when the plan was made", self.marey("batch", "run", "plan.tsv", code=1).stderr)
        other.unlink()
        said = self.marey("batch", "run", "plan.tsv", code=1).stderr
        self.assertIn("is not there any more", said)
        self.plan()  # what is as it was is not done again
        counts = json.loads(self.marey("batch", "run", "plan.tsv", "--json").stdout)
        self.assertEqual(counts["failed"], 0)

    def test_plans_that_are_none(self):
        (self.folder / "plan.tsv").write_text("task\tname\n1\ta\n")
        self.assertIn("plan.tsv:1: this is not a plan", self.marey("batch", "run", "plan.tsv", code=1).stderr)
        (self.folder / "plan.tsv").unlink()
        self.plan()
        text = (self.folder / "plan.tsv").read_text()
        (self.folder / "plan.tsv").write_text(text.replace("\ttrack\t", "\t", 1))
        self.assertIn("plan.tsv:2: 8 columns", self.marey("batch", "run", "plan.tsv", code=1).stderr)
        self.marey("batch", "run", "missing.tsv", code=1)

    def test_plans_of_untrusted_write_to_their_results_alone(self):
        (self.folder / "precious.csv").write_text("1")
        self.plan()
        text = (self.folder / "plan.tsv").read_text()
        for there, then, words in (("plan.tsv.results/day0/clip 0.csv", "precious.csv", "outside of plan.tsv.results"),
                                   ("plan.tsv.results/day0/", "plan.tsv.results/../", "outside of plan.tsv.results"),
                                   ("\ttrack\t", "\tdoctor\t", '"doctor" is not a job'), ("\n1\t", "\n4294967297\t", "within 0 and")):
            self.assertIn(there, text)
            (self.folder / "plan.tsv").write_text(text.replace(there, then, 1))
            said = self.marey("batch", "run", "plan.tsv", code=1).stderr
            self.assertIn("plan.tsv:2: ", said)
            self.assertIn(words, said)
        self.assertEqual((self.folder / "precious.csv").read_text(), "1")
        for name in ("../../precious", "/precious"):
            (self.folder / "list.csv").write_text(f"input,name\nfilms/day0/clip 0.mp4,{name}\n")
            self.assertIn("outside of other.tsv.results", self.marey("batch", "plan", "list.csv", "-o", "other.tsv", code=1).stderr)

    def test_no_output_is_an_input(self):
        rows = "frame,time,id,x,y\n" + "".join(f"{i},{i / 25:.2f},1,{i / 10},3\n" for i in range(100))
        for name in ("places.csv", "list.tsv"):
            (self.folder / name).write_text("input\nplaces.csv\n" if name == "list.tsv" else rows)
        self.assertIn("is an input too", self.marey("batch", "plan", "list.tsv", "--job", "measure", "-o", "list.tsv", code=2).stderr)
        self.marey("batch", "plan", "list.tsv", "--job", "measure", "-o", "plan.tsv", "-q")
        self.marey("batch", "run", "plan.tsv", "-q")
        for output in ("places.csv", "plan.tsv.results/places.csv"):
            before = (self.folder / output).read_bytes()
            self.assertIn("is an input too", self.marey("batch", "reduce", "plan.tsv", "-o", output, code=2).stderr)
            self.assertEqual((self.folder / output).read_bytes(), before)

    def test_two_runs_of_one_task(self):
        self.plan()
        with concurrent.futures.ThreadPoolExecutor(2) as both:
            runs = [both.submit(subprocess.run, [MAREY, "batch", "run", "plan.tsv", "--task", "1"], capture_output=True, text=True, cwd=self.folder)
                    for _ in range(2)]
        codes = sorted(run.result().returncode for run in runs)
        self.assertIn(codes, ([0, 0], [0, 1]))
        for run in runs:
            if run.result().returncode:
                self.assertIn("another run", run.result().stderr)
        self.marey("batch", "run", "plan.tsv", "-q")
        self.assertEqual(len(self.results()), VIDEOS)

    def test_killed_in_the_middle(self):
        self.plan()
        run = subprocess.Popen([MAREY, "batch", "run", "plan.tsv", "-q"], cwd=self.folder)
        self.its_task(run)
        run.send_signal(signal.SIGKILL)
        run.wait()
        time.sleep(0.5)
        root = self.folder / "plan.tsv.results"
        self.marey("batch", "reduce", "plan.tsv", "-o", "season.csv", "-q", code=1)
        self.marey("batch", "run", "plan.tsv", "-q")
        self.assertEqual(len(self.results()), VIDEOS)
        self.assertEqual([p for p in root.rglob("*.part")], [])
        self.marey("batch", "reduce", "plan.tsv", "-o", "season.csv", "-q")

    def test_stopped_by_ctrl_c(self):
        self.plan()
        run = subprocess.Popen([MAREY, "batch", "run", "plan.tsv", "-q"], cwd=self.folder, stderr=subprocess.PIPE, text=True)
        self.its_task(run)
        run.send_signal(signal.SIGINT)
        said = run.communicate(timeout=60)[1]
        self.assertIn(run.returncode, (0, 130), said)
        self.marey("batch", "run", "plan.tsv", "-q")
        self.assertEqual(len(self.results()), VIDEOS)

    def test_a_task_is_killed(self):
        """The task alone, not who waits for it: that is what the kernel does when memory is short."""
        self.plan()
        run = subprocess.Popen([MAREY, "batch", "run", "plan.tsv", "-q", "--task", "1"], cwd=self.folder, stderr=subprocess.PIPE, text=True)
        os.kill(self.its_task(run), signal.SIGKILL)
        self.assertIn("ended by signal 9", run.communicate(timeout=60)[1])
        self.assertEqual((run.returncode, self.results()), (1, {}))
        reduced = json.loads(self.marey("batch", "reduce", "plan.tsv", "-o", "season.csv", "--json", code=1).stdout)
        self.assertIn("signal 9", reduced["failures"][0]["why"])
        self.marey("batch", "run", "plan.tsv", "-q")
        self.assertEqual(len(self.results()), VIDEOS)

    def test_a_folder_that_cannot_be_written(self):
        if os.geteuid() != 0:
            self.skipTest("a folder that is read-only also for root is made by mounting one, as root")
        self.plan()
        results = self.folder / "plan.tsv.results"
        results.mkdir()
        if subprocess.run(["mount", "-t", "tmpfs", "-o", "ro", "none", results], capture_output=True).returncode:
            self.skipTest("nothing can be mounted here")
        try:
            said = self.marey("batch", "run", "plan.tsv", code=1)
            self.assertIn("0 done, 0 were done before, 4 failed", said.stdout)
            self.assertRegex(said.stderr, "task 1 .*plan.tsv.results/.*[Rr]ead-only")
            reduced = json.loads(self.marey("batch", "reduce", "plan.tsv", "-o", "season.csv", "--json", code=1).stdout)
            self.assertEqual(len(reduced["failures"]), VIDEOS)
        finally:
            subprocess.run(["umount", results], check=True)
        self.marey("batch", "run", "plan.tsv", "-q")
        self.assertEqual(len(self.results()), VIDEOS)

    def memory(self, job, recording):
        """What `plan` says of a task, and what it took, MB."""
        (self.folder / "one.csv").write_text(f"input,name\n{recording},one\n")
        self.marey("batch", "plan", "one.csv", "--job", job, "-o", "one.tsv", "-q")
        self.marey("batch", "run", "one.tsv", "-q", "--task-threads", 1)
        with open(self.folder / "one.tsv") as rows:
            said = int(next(csv.DictReader(rows, delimiter="\t"))["memory_mb"])
        record = dict(line.split("\t", 1) for line in (self.folder / "one.tsv.results/tasks/000001.tsv").read_text().splitlines())
        shutil.rmtree(self.folder / "one.tsv.results")
        print(f"\nmemory of {job}, {recording}: {said} MB said, {record['peak_mb']} MB taken", file=sys.stderr)
        return said, int(record["peak_mb"])

    def test_memory_is_stated_beforehand(self):
        """Short and long videos: the background is learned from up to 30 frames, one in ten."""
        cases = [("track", "people", "--people", 5, "--frames", 20, "--size", 320, 240), ("track", "people", "--people", 5, "--frames", 120, "--size", 640, 480),
                 ("ground", "match", "--render", "--seconds", 2, "--cameras", 2, "--size", 480, 270), ("reconstruct", "room", "--render", "--frames", 20, "--cameras", 3)]
        for number, (job, *words) in enumerate(cases):
            self.marey("simulate", *words, "-o", f"scene{number}", "-q")
            said, taken = self.memory(job, f"scene{number}/" + ("video.mp4" if job == "track" else "rig.toml"))
            if not os.environ.get("MAREY_SANITIZE"):  # sanitizers take several times as much
                self.assertGreater(said, 0.95 * taken, "Slurm is asked for 1.3 times as much")
                self.assertLess(said, 1.3 * taken)

    def test_full_disk(self):
        if os.geteuid() != 0:
            self.skipTest("a full disk is made by mounting one, as root")
        small = self.folder / "plan.tsv.results"
        small.mkdir()
        if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=16k", "none", small], capture_output=True).returncode:
            self.skipTest("nothing can be mounted here")
        try:
            self.plan()
            said = self.marey("batch", "run", "plan.tsv", code=1).stderr
            self.assertRegex(said, "[Nn]o space|full")
            reduced = json.loads(self.marey("batch", "reduce", "plan.tsv", "-o", "season.csv", "--json", code=1).stdout)
            self.assertEqual(reduced["done"] + len(reduced["failures"]), VIDEOS)
            self.assertEqual([p for p in small.rglob("*.part")], [])
        finally:
            subprocess.run(["umount", small], check=True)

    def test_parallel(self):
        if shutil.which("parallel") is None:
            self.skipTest("GNU parallel is not installed: apt install parallel")
        self.plan()
        self.marey("batch", "run", "plan.tsv", "-q")
        expected = self.results()
        shutil.rmtree(self.folder / "plan.tsv.results")
        self.plan()
        self.marey("batch", "submit", "plan.tsv", "--engine", "parallel")
        self.assertEqual(self.results(), expected)
        self.assertEqual(json.loads(self.marey("batch", "run", "plan.tsv", "--json").stdout)["done_before"], VIDEOS)

    def test_ten_thousand(self):
        """A finished plan of ten thousand is looked through in two seconds; one match under ten thousand names."""
        many, match = self.folder / "many", self.folder / "match.csv"
        match.write_text("frame,time,id,x,y\n" + "".join(f"{i},{i / 25},1,{i / 10},20\n" for i in range(50)))
        many.mkdir()
        for number in range(10_000):
            os.link(match, many / f"{number:05}.csv")
        self.marey("batch", "plan", "many", "--job", "measure", "-o", "plan.tsv", "-q")
        self.marey("batch", "run", "plan.tsv", "--task", 1, "-q")
        results = self.folder / "plan.tsv.results"
        record, result = (results / "tasks/000001.tsv").read_text(), results / "00000.csv"
        for number in range(1, 10_000):
            (results / f"tasks/{number + 1:06}.tsv").write_text(record)
            os.link(result, results / f"{number:05}.csv")
        begin = time.monotonic()
        counts = json.loads(self.marey("batch", "run", "plan.tsv", "--json").stdout)
        elapsed = time.monotonic() - begin
        self.assertEqual(counts, {"done": 0, "done_before": 10_000, "failed": 0})
        begin = time.monotonic()
        self.marey("batch", "plan", "many", "--job", "measure", "-o", "plan.tsv", "-q")
        print(f"\n10,000 tasks that are done: run {elapsed:.2f} s, plan again {time.monotonic() - begin:.2f} s", file=sys.stderr)
        self.assertLess(elapsed, 10)


@unittest.skipUnless(slurm_nodes.available(), "Slurm is not installed, or this is not root: apt install slurmctld slurmd slurm-client munge")
class Slurm(Videos):
    """Two nodes on this host."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.slurm = cls.enterClassContext(slurm_nodes.SlurmNodes())

    def submit(self):
        done = subprocess.run([MAREY, "batch", "submit", "plan.tsv", "--engine", "slurm", "--json"], capture_output=True, text=True,
                              cwd=self.folder, env=self.slurm.environment, timeout=60)
        self.assertEqual(done.returncode, 0, done.stderr)
        return json.loads(done.stdout)

    def test_array_and_reduce(self):
        (self.folder / "films" / "day0" / "broken.mp4").write_bytes(b"no video at all" * 100)
        self.plan()
        self.marey("batch", "run", "plan.tsv", "-q", code=1)
        expected = self.results()
        shutil.rmtree(self.folder / "plan.tsv.results")
        self.plan()
        begin = time.monotonic()
        self.submit()
        self.slurm.wait_until_empty()
        print(f"\n{VIDEOS + 1} tasks by Slurm: {time.monotonic() - begin:.1f} s", file=sys.stderr)
        self.assertEqual(self.results(), expected)
        table = list(csv.DictReader((self.folder / "plan.tsv.csv").read_text().splitlines()))  # the dependent job's, although a task failed
        self.assertEqual(len({r["recording"] for r in table}), VIDEOS)
        said = (self.folder / "plan.tsv.results/log/reduce.txt").read_text()
        self.assertIn("broken", said)

    def test_a_node_is_lost(self):
        self.plan("--job-options", "--threads 1")
        self.submit()
        self.slurm.wait_for(lambda: "d2" in self.slurm.ask("squeue", "-h", "-t", "R", "-o", "%N") or self.slurm.ask("squeue", "-h") == "", 30)
        self.slurm.lose("d2")
        time.sleep(1)
        self.slurm.restore("d2")
        self.slurm.wait_until_empty()
        counts = json.loads(self.marey("batch", "run", "plan.tsv", "--json").stdout)
        self.assertEqual(counts["failed"], 0)
        self.assertEqual(len(self.results()), VIDEOS)
        root = self.folder / "plan.tsv.results"
        self.assertEqual([p for p in root.rglob("*.part")], [])


if __name__ == "__main__":
    MAREY = sys.argv.pop(1)
    unittest.main()
