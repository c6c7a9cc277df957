"""`marey batch`: many recordings by a loop, GNU parallel and a real Slurm, and what becomes of tasks that fail, are killed, or run twice.

Usage: batch_test.py MAREY [unittest options]. GNU parallel and Slurm are looked for; what is not there is skipped.
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

MAREY = ""
FILMS = 4


class Films(unittest.TestCase):
    """Some films, and what is done with them."""

    @classmethod
    def setUpClass(cls):
        cls.films = pathlib.Path(tempfile.mkdtemp(prefix="marey_films_"))
        cls.addClassCleanup(shutil.rmtree, cls.films)
        for number in range(FILMS):
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

    def results(self):
        root = self.folder / "plan.tsv.results"
        return {str(p.relative_to(root)): p.read_bytes() for p in sorted(root.rglob("*.csv"))}


class Batch(Films):
    def test_loop(self):
        said = self.marey("batch", "plan", "films", "-o", "plan.tsv").stdout
        self.assertIn(f"{FILMS} tasks", said)
        self.assertIn("sbatch --parsable", said)
        rows = list(csv.DictReader((self.folder / "plan.tsv").read_text().splitlines(), delimiter="\t"))
        self.assertEqual([r["name"] for r in rows], sorted(r["name"] for r in rows))
        self.assertEqual(rows[0]["name"], "day0/clip 0")
        counts = json.loads(self.marey("batch", "run", "plan.tsv", "--json").stdout)
        self.assertEqual(counts, {"done": FILMS, "done_before": 0, "failed": 0})
        single = self.folder / "alone.csv"
        self.marey("track", "films/day0/clip 2.mp4", "-o", single, "-q")
        self.assertEqual(self.results()["day0/clip 2.csv"], single.read_bytes())
        counts = json.loads(self.marey("batch", "run", "plan.tsv", "--json").stdout)
        self.assertEqual(counts, {"done": 0, "done_before": FILMS, "failed": 0})
        reduced = json.loads(self.marey("batch", "reduce", "plan.tsv", "-o", "season.csv", "--report", "page", "--json").stdout)
        self.assertEqual((reduced["done"], reduced["failures"]), (FILMS, []))
        table = list(csv.DictReader((self.folder / "season.csv").read_text().splitlines()))
        self.assertEqual({r["recording"] for r in table}, {r["name"] for r in rows})
        self.assertEqual(len(table), reduced["rows"])
        self.assertIn("day1/clip 3", (self.folder / "page" / "report.html").read_text())

    def test_parts_are_the_whole(self):
        self.plan()
        for part in (1, 2, 3):
            self.marey("batch", "run", "plan.tsv", "-q", "--part", f"{part}/3")
        self.assertEqual(json.loads(self.marey("batch", "run", "plan.tsv", "--json").stdout)["done_before"], FILMS)
        for wrong in (("--part", "4/3"), ("--part", "3"), ("--task", FILMS + 1), ("--task", 1, "--part", "1/2")):
            self.marey("batch", "run", "plan.tsv", *wrong, code=2)

    def test_options_and_tables(self):
        (self.folder / "list.csv").write_text("input,name,options\nfilms/day0/clip 0.mp4,first,--seen-only\nfilms/day1/clip 1.mp4,second,\n")
        self.marey("batch", "plan", "list.csv", "-o", "plan.tsv", "-q", "--ending", ".txt", "--options", "--live")
        self.marey("batch", "run", "plan.tsv", "-q")
        self.marey("track", "films/day0/clip 0.mp4", "-o", "alone.txt", "-q", "--live", "--seen-only")
        self.assertEqual((self.folder / "plan.tsv.results/first.txt").read_bytes(), (self.folder / "alone.txt").read_bytes())
        (self.folder / "list.csv").write_text("input,name\nfilms/day0/clip 0.mp4,same\nfilms/day1/clip 1.mp4,same\n")
        self.assertIn('called "same"', self.marey("batch", "plan", "list.csv", "-o", "other.tsv", code=1).stderr)
        (self.folder / "list.csv").write_text("film\na.mp4\n")
        self.assertIn('no column "input"', self.marey("batch", "plan", "list.csv", "-o", "other.tsv", code=1).stderr)
        self.assertIn("holds nothing that measure reads", self.marey("batch", "plan", "films", "--do", "measure", "-o", "m.tsv", code=1).stderr)

    def test_what_fails_is_told(self):
        (self.folder / "films" / "day0" / "broken.mp4").write_bytes(b"no film at all" * 100)
        self.plan()
        said = self.marey("batch", "run", "plan.tsv", code=1)
        self.assertIn("broken.mp4", said.stderr)
        self.assertIn(f"{FILMS} done, 0 were done before, 1 failed", said.stdout)
        reduced = json.loads(self.marey("batch", "reduce", "plan.tsv", "-o", "season.csv", "--json", code=1).stdout)
        self.assertEqual([f["name"] for f in reduced["failures"]], ["day0/broken"])
        self.assertIn("broken.mp4", reduced["failures"][0]["why"])
        self.assertEqual(reduced["done"], FILMS)

    def test_inputs_that_changed(self):
        self.plan()
        self.marey("batch", "run", "plan.tsv", "-q")
        film, other = self.folder / "films/day0/clip 0.mp4", self.folder / "films/day1/clip 1.mp4"
        os.utime(film)  # touched alone: its bytes are the same
        self.assertEqual(json.loads(self.marey("batch", "run", "plan.tsv", "--json").stdout)["done_before"], FILMS)
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
        self.assertIn("plan.tsv:1: this is no plan", self.marey("batch", "run", "plan.tsv", code=1).stderr)
        (self.folder / "plan.tsv").unlink()
        self.plan()
        text = (self.folder / "plan.tsv").read_text()
        (self.folder / "plan.tsv").write_text(text.replace("\ttrack\t", "\t", 1))
        self.assertIn("plan.tsv:2: 7 columns", self.marey("batch", "run", "plan.tsv", code=1).stderr)
        self.marey("batch", "run", "missing.tsv", code=1)

    def test_plans_of_strangers_write_to_their_results_alone(self):
        (self.folder / "precious.csv").write_text("1")
        self.plan()
        text = (self.folder / "plan.tsv").read_text()
        for there, then, words in (("plan.tsv.results/day0/clip 0.csv", "precious.csv", "outside of plan.tsv.results"),
                                   ("plan.tsv.results/day0/", "plan.tsv.results/../", "outside of plan.tsv.results"),
                                   ("\ttrack\t", "\tdoctor\t", '"doctor" is no job'), ("\n1\t", "\n4294967297\t", "within 0 and")):
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
        self.assertIn("is an input too", self.marey("batch", "plan", "list.tsv", "--do", "measure", "-o", "list.tsv", code=2).stderr)
        self.marey("batch", "plan", "list.tsv", "--do", "measure", "-o", "plan.tsv", "-q")
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
        self.assertEqual(len(self.results()), FILMS)

    def test_killed_in_the_middle(self):
        self.plan()
        run = subprocess.Popen([MAREY, "batch", "run", "plan.tsv", "-q"], cwd=self.folder)
        time.sleep(0.3)
        run.send_signal(signal.SIGKILL)
        run.wait()
        time.sleep(0.5)
        root = self.folder / "plan.tsv.results"
        self.marey("batch", "reduce", "plan.tsv", "-o", "season.csv", "-q", code=1)
        self.marey("batch", "run", "plan.tsv", "-q")
        self.assertEqual(len(self.results()), FILMS)
        self.assertEqual([p for p in root.rglob("*.part")], [])
        self.marey("batch", "reduce", "plan.tsv", "-o", "season.csv", "-q")

    def test_stopped_by_ctrl_c(self):
        self.plan()
        run = subprocess.Popen([MAREY, "batch", "run", "plan.tsv", "-q"], cwd=self.folder, stderr=subprocess.PIPE, text=True)
        time.sleep(0.25)
        run.send_signal(signal.SIGINT)
        said = run.communicate(timeout=60)[1]
        self.assertIn(run.returncode, (0, 130), said)
        self.marey("batch", "run", "plan.tsv", "-q")
        self.assertEqual(len(self.results()), FILMS)

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
            self.assertEqual(reduced["done"] + len(reduced["failures"]), FILMS)
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
        self.marey("batch", "submit", "plan.tsv", "--to", "parallel")
        self.assertEqual(self.results(), expected)
        self.assertEqual(json.loads(self.marey("batch", "run", "plan.tsv", "--json").stdout)["done_before"], FILMS)

    def test_ten_thousand(self):
        """A finished plan of ten thousand is looked through in two seconds; one match under ten thousand names."""
        many, match = self.folder / "many", self.folder / "match.csv"
        match.write_text("frame,time,id,x,y\n" + "".join(f"{i},{i / 25},1,{i / 10},20\n" for i in range(50)))
        many.mkdir()
        for number in range(10_000):
            os.link(match, many / f"{number:05}.csv")
        self.marey("batch", "plan", "many", "--do", "measure", "-o", "plan.tsv", "-q")
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
        self.marey("batch", "plan", "many", "--do", "measure", "-o", "plan.tsv", "-q")
        print(f"\n10,000 tasks that are done: run {elapsed:.2f} s, plan again {time.monotonic() - begin:.2f} s", file=sys.stderr)
        self.assertLess(elapsed, 10)


SLURM = """
ClusterName=test
SlurmctldHost={host}(127.0.0.1)
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket={run}/munge/sock
CryptoType=crypto/munge
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
ReturnToService=2
SlurmctldPort={port0}
SlurmctldTimeout=10
SlurmdTimeout=10
StateSaveLocation={run}/ctld
SlurmdSpoolDir={run}/%n
SlurmctldPidFile={run}/ctld.pid
SlurmdPidFile={run}/%n.pid
SlurmctldLogFile={run}/log/ctld
SlurmdLogFile={run}/log/%n
MailProg=/bin/true
SwitchType=switch/none
MpiDefault=none
NodeName=d1 NodeHostname={host} NodeAddr=127.0.0.1 Port={port1} CPUs=2 RealMemory=4000 State=UNKNOWN
NodeName=d2 NodeHostname={host} NodeAddr=127.0.0.1 Port={port2} CPUs=2 RealMemory=4000 State=UNKNOWN
PartitionName=main Nodes=d1,d2 Default=YES MaxTime=INFINITE State=UP
"""


@unittest.skipUnless(
    os.geteuid() == 0 and all(shutil.which(p, path=os.environ["PATH"] + ":/usr/sbin") for p in ("slurmctld", "slurmd", "sbatch", "munged")),
    "Slurm is not installed, or this is not root: apt install slurmctld slurmd slurm-client munge",
)
class Slurm(Films):
    """Two nodes on this host, with daemons, ports and a key of their own."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.place = pathlib.Path(tempfile.mkdtemp(prefix="marey_slurm_", dir="/var/tmp"))
        cls.addClassCleanup(shutil.rmtree, cls.place, ignore_errors=True)
        for name in ("munge", "ctld", "d1", "d2", "log"):
            (cls.place / name).mkdir()
        os.chmod(cls.place, 0o755)
        os.chmod(cls.place / "munge", 0o711)
        key = cls.place / "munge" / "key"
        key.write_bytes(os.urandom(128))
        os.chmod(key, 0o400)
        base = 20000 + os.getpid() % 20000
        host = os.uname().nodename.split(".")[0]
        (cls.place / "slurm.conf").write_text(SLURM.format(host=host, run=cls.place, port0=base, port1=base + 1, port2=base + 2))
        cls.environment = os.environ | {"SLURM_CONF": str(cls.place / "slurm.conf"), "PATH": os.environ["PATH"] + ":/usr/sbin"}
        cls.daemons = {}
        cls.addClassCleanup(cls.stop_all)
        cls.start("munged", "-F", f"--key-file={key}", f"--socket={cls.place}/munge/sock", f"--pid-file={cls.place}/munge/pid",
                  f"--log-file={cls.place}/munge/log", f"--seed-file={cls.place}/munge/seed", "--force", "--num-threads=1")
        cls.start("slurmctld", "-D")
        for node in ("d1", "d2"):
            cls.start_node(node)
        cls.wait_for(lambda: cls.slurm("sinfo", "-h", "-o", "%D %t") == "2 idle", 60)

    @classmethod
    def start(cls, *words, name=None):
        with (cls.place / "log" / f"{name or words[0]}.out").open("ab") as log:
            cls.daemons[name or words[0]] = subprocess.Popen(words, env=cls.environment, stdout=log, stderr=log)

    @classmethod
    def start_node(cls, node):
        cls.start("slurmd", "-D", "-N", node, name=node)

    @classmethod
    def stop_all(cls):
        for daemon in reversed(cls.daemons.values()):
            daemon.terminate()
        for daemon in cls.daemons.values():
            try:
                daemon.wait(15)
            except subprocess.TimeoutExpired:
                daemon.kill()
                daemon.wait()

    @classmethod
    def slurm(cls, *words):
        return subprocess.run(words, env=cls.environment, capture_output=True, text=True, timeout=60).stdout.strip()

    @classmethod
    def wait_for(cls, true, seconds):
        end = time.monotonic() + seconds
        while not true():
            if time.monotonic() > end:
                log = cls.place / "log" / "ctld"
                raise AssertionError("Slurm does not come to it:\n" + (log.read_text()[-3000:] if log.exists() else ""))
            time.sleep(0.25)

    def submit(self):
        done = subprocess.run([MAREY, "batch", "submit", "plan.tsv", "--to", "slurm", "--json"], capture_output=True, text=True,
                              cwd=self.folder, env=self.environment, timeout=60)
        self.assertEqual(done.returncode, 0, done.stderr)
        return json.loads(done.stdout)

    def ended(self, jobs):
        self.wait_for(lambda: self.slurm("squeue", "-h", "-o", "%i") == "", 240)

    def test_array_and_reduce(self):
        (self.folder / "films" / "day0" / "broken.mp4").write_bytes(b"no film at all" * 100)
        self.plan()
        self.marey("batch", "run", "plan.tsv", "-q", code=1)
        expected = self.results()
        shutil.rmtree(self.folder / "plan.tsv.results")
        self.plan()
        begin = time.monotonic()
        self.ended(self.submit())
        print(f"\n{FILMS + 1} tasks by Slurm: {time.monotonic() - begin:.1f} s", file=sys.stderr)
        self.assertEqual(self.results(), expected)
        table = list(csv.DictReader((self.folder / "plan.tsv.csv").read_text().splitlines()))  # the dependent job's, although a task failed
        self.assertEqual(len({r["recording"] for r in table}), FILMS)
        said = (self.folder / "plan.tsv.results/log/reduce.txt").read_text()
        self.assertIn("broken", said)

    def test_a_node_is_lost(self):
        self.plan("--options", "--threads 1")
        jobs = self.submit()
        self.wait_for(lambda: "d2" in self.slurm("squeue", "-h", "-t", "R", "-o", "%N") or self.slurm("squeue", "-h") == "", 30)
        self.daemons["d2"].kill()  # as if the machine went down: its tasks with it
        self.daemons["d2"].wait()
        time.sleep(1)
        self.slurm("scontrol", "update", "NodeName=d2", "State=DOWN", "Reason=lost")
        self.start_node("d2")
        self.slurm("scontrol", "update", "NodeName=d2", "State=RESUME")
        self.ended(jobs)
        counts = json.loads(self.marey("batch", "run", "plan.tsv", "--json").stdout)
        self.assertEqual(counts["failed"], 0)
        self.assertEqual(len(self.results()), FILMS)
        root = self.folder / "plan.tsv.results"
        self.assertEqual([p for p in root.rglob("*.part")], [])


if __name__ == "__main__":
    MAREY = sys.argv.pop(1)
    unittest.main()
