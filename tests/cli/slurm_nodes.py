"""A real Slurm of two nodes on this host, with daemons, ports and a key of its own: no systemd, no cgroup.

    with SlurmNodes() as slurm:
        subprocess.run(["sbatch", ...], env=slurm.environment)
        slurm.wait_until_empty()
"""

import os
import pathlib
import shutil
import subprocess
import tempfile
import time

CONFIGURATION = """
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
SlurmctldPort={port}
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
"""
NODE = "NodeName={name} NodeHostname={host} NodeAddr=127.0.0.1 Port={port} CPUs={cpus} RealMemory=4000 State=UNKNOWN\n"
PARTITION = "PartitionName=main Nodes=d1,d2 Default=YES MaxTime=INFINITE State=UP\n"
NODES = ("d1", "d2")
PATH = os.environ["PATH"] + ":/usr/sbin"


def available():
    """Whether Debian's packages are installed, and this is root."""
    return os.geteuid() == 0 and all(shutil.which(program, path=PATH) for program in ("slurmctld", "slurmd", "sbatch", "munged"))


class SlurmNodes:
    """Runs from `with` to its end."""

    def __init__(self, cpus=2):
        self.cpus = cpus  # of each node
        self.daemons = {}

    def __enter__(self):
        self.place = pathlib.Path(tempfile.mkdtemp(prefix="marey_slurm_", dir="/var/tmp"))
        self.environment = os.environ | {"SLURM_CONF": str(self.place / "slurm.conf"), "PATH": PATH}
        try:
            self._configure()
            self._start_all()
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        for daemon in reversed(self.daemons.values()):
            daemon.terminate()
        for daemon in self.daemons.values():
            try:
                daemon.wait(15)
            except subprocess.TimeoutExpired:
                daemon.kill()
                daemon.wait()
        shutil.rmtree(self.place, ignore_errors=True)

    def output_of(self, *words):
        """What a command of Slurm's says."""
        return subprocess.run(words, env=self.environment, capture_output=True, text=True, timeout=60).stdout.strip()

    def wait_for(self, true, seconds):
        end = time.monotonic() + seconds
        while not true():
            if time.monotonic() > end:
                log = self.place / "log" / "ctld"
                raise AssertionError("Slurm does not come to it:\n" + (log.read_text()[-3000:] if log.exists() else ""))
            time.sleep(0.1)

    def wait_until_empty(self, seconds=240):
        """Until no job is left in the queue."""
        self.wait_for(lambda: self.output_of("squeue", "-h", "-o", "%i") == "", seconds)

    def lose(self, node):
        """As if the machine went down: its tasks with it."""
        self.daemons[node].kill()
        self.daemons[node].wait()

    def restore(self, node):
        self.output_of("scontrol", "update", f"NodeName={node}", "State=DOWN", "Reason=lost")
        self._start_node(node)
        self.output_of("scontrol", "update", f"NodeName={node}", "State=RESUME")

    def _configure(self):
        for name in ("munge", "ctld", "log", *NODES):
            (self.place / name).mkdir()
        os.chmod(self.place, 0o755)
        os.chmod(self.place / "munge", 0o711)
        key = self.place / "munge" / "key"
        key.write_bytes(os.urandom(128))
        os.chmod(key, 0o400)
        port = 20000 + os.getpid() % 20000
        host = os.uname().nodename.split(".")[0]
        nodes = (NODE.format(name=name, host=host, port=port + number, cpus=self.cpus) for number, name in enumerate(NODES, 1))
        (self.place / "slurm.conf").write_text(CONFIGURATION.format(host=host, run=self.place, port=port) + "".join(nodes) + PARTITION)

    def _start_all(self):
        munge = self.place / "munge"
        self._start("munged", "munged", "-F", f"--key-file={munge}/key", f"--socket={munge}/sock", f"--pid-file={munge}/pid",
                    f"--log-file={munge}/log", f"--seed-file={munge}/seed", "--force", "--num-threads=1")
        self._start("slurmctld", "slurmctld", "-D")
        for node in NODES:
            self._start_node(node)
        self.wait_for(lambda: self.output_of("sinfo", "-h", "-o", "%D %t") == "2 idle", 60)

    def _start_node(self, node):
        self._start(node, "slurmd", "-D", "-N", node)

    def _start(self, name, *words):
        with (self.place / "log" / f"{name}.out").open("ab") as log:
            self.daemons[name] = subprocess.Popen(words, env=self.environment, stdout=log, stderr=log)
