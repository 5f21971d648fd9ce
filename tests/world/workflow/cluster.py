"""A SLURM cluster of one node in a mount namespace of its own: Debian's slurmctld, slurmd and munge, as root."""

import os
import shutil
import socket
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import psutil
import pytest
from patience import wait_for

DAEMONS = ("slurmctld", "slurmd")
PROGRAMS = ("munged", *DAEMONS, "unshare", "nsenter")
CONFIGURATION = """
ClusterName=test
SlurmctldHost={node}
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket={folder}/munge/socket,cred_expire=20
SlurmctldPort={ports[0]}
SlurmdPort={ports[1]}
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/linux
JobAcctGatherFrequency=1
JobAcctGatherParams=OverMemoryKill
SelectType=select/cons_tres
SelectTypeParameters=CR_Core_Memory
SchedulerParameters=batch_sched_delay=0,sched_interval=1
MpiDefault=none
ReturnToService=2
SlurmdTimeout=10
KillWait=5
NodeName={node} CPUs=2 RealMemory={memory_mb} State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""
START = """
set -e
mount --bind {folder}/etc /etc/slurm
munged --force --key-file={folder}/munge/key --socket={folder}/munge/socket --pid-file={folder}/munge/pid \
  --log-file={folder}/munge/log --seed-file={folder}/munge/seed
touch {folder}/ready
exec sleep infinity
"""


@dataclass(frozen=True)
class Cluster:
    """The cluster's first process, seen from outside; commands run where its configuration is that of the machine."""

    process: int

    def words(self, *words: str) -> list[str]:
        """Return a command as one that runs in the cluster's namespaces, in the present folder."""
        return ["nsenter", "--mount", "--pid", f"--target={self.process}", f"--wd={Path.cwd()}", "--", *words]

    def ask(self, *words: str) -> str:
        return subprocess.run(self.words(*words), capture_output=True, text=True, check=True).stdout

    def start(self, daemon: str) -> None:
        self.ask(daemon)

    def kill(self, daemon: str) -> None:
        """Kill slurmctld or slurmd, as a machine that fails does; steps of jobs live on."""
        self.ask("pkill", "-KILL", "-x", daemon)

    def jobs(self) -> list[list[str]]:
        return [line.split("|") for line in self.ask("squeue", "--noheader", "--format=%i|%T").splitlines()]


@contextmanager
def cluster_in(folder: Path) -> Iterator[Cluster]:
    """Start a cluster, and end it with all that it runs.

    A job that its node lost waits until its credential ends, `cred_expire` [s], before it goes into the queue again.
    """
    missing = [name for name in PROGRAMS if shutil.which(name) is None]
    if missing or os.geteuid() != 0:
        pytest.skip(f"a cluster needs root and Debian's slurm-wlm and munge; missing: {', '.join(missing) or 'root'}")
    for name in ("etc", "munge", "state", "spool"):
        (folder / name).mkdir(parents=True)
    (folder / "munge").chmod(0o700)
    (folder / "munge" / "key").write_bytes(os.urandom(1024))
    (folder / "munge" / "key").chmod(0o400)
    memory_mb = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") // 2**20 * 9 // 10
    text = CONFIGURATION.format(node=socket.gethostname(), folder=folder, ports=free_ports(), memory_mb=memory_mb)
    (folder / "etc" / "slurm.conf").write_text(text)
    words = ["unshare", "--mount", "--pid", "--fork", "--kill-child", "--mount-proc", "bash", "-c"]
    with subprocess.Popen([*words, START.format(folder=folder)]) as holder:
        try:
            wait_for(lambda: (folder / "ready").exists() or holder.poll() is not None)
            if holder.poll() is not None:
                pytest.skip("a cluster needs namespaces of its own, which cannot be made here")
            cluster = Cluster(psutil.Process(holder.pid).children()[0].pid)
            for daemon in DAEMONS:
                cluster.start(daemon)
            wait_for(lambda: "idle" in cluster.ask("sinfo", "--noheader", "--format=%T"))
            yield cluster
        finally:
            holder.kill()


def free_ports() -> tuple[int, int]:
    """Return ports for slurmctld and slurmd that nobody uses, such as another cluster of this machine."""
    with socket.socket() as first, socket.socket() as second:
        for one in (first, second):
            one.bind(("", 0))
        return first.getsockname()[1], second.getsockname()[1]
