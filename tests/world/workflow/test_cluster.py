"""The workflow on a real SLURM cluster: what fails there ends with the same files or with one clear line."""

import re
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from patience import HANGS_S, wait_for

from mobnet.core.files import METRICS, RUN, WEIGHTS

from .cluster import cluster_in

SMOKE = ("--config", "scale=smoke")
SOON = ("--slurm-init-seconds-before-status-checks", "1", "--latency-wait", "5")  # jobs take seconds here
PROFILE = ("--profile", "workflow/profiles/slurm", *SOON)
NETWORK = Path("results/smoke/plant/networks/MOB-Net-LA-s0")
TARGETS = tuple(str(NETWORK / name) for name in (WEIGHTS, METRICS, RUN))
COLLECTED = "results/smoke/plant/recordings/random_walk/all_uncertainty"
JOB = f"plant/{NETWORK.name}"

pytestmark = [pytest.mark.slow, pytest.mark.sim]


@pytest.fixture(scope="module")
def cluster(tmp_path_factory):
    with cluster_in(tmp_path_factory.mktemp("cluster")) as running:
        yield running


@pytest.fixture(scope="module")
def trained(make_project, cluster):
    """A project in which one network was trained without a cluster."""
    folder = make_project("trained")
    words = [sys.executable, str(folder / "reproduce"), *TARGETS, *SMOKE]
    subprocess.run(words, cwd=folder, check=True, capture_output=True)
    return folder


@pytest.fixture
def project(make_project, trained):
    """A copy of the project with the data of the network, which is not trained."""
    folder = make_project("project")
    for part in ("recordings", "residuals"):
        subprocess.run(["cp", "-a", "--parents", f"results/smoke/plant/{part}", str(folder)], cwd=trained, check=True)
    subprocess.run(["cp", "-a", ".snakemake", str(folder)], cwd=trained, check=True)
    return folder


def start(cluster, folder, *words):
    """Start ./reproduce on the cluster; what it says is in out.log."""
    command = [sys.executable, str(folder / "reproduce"), *(words or TARGETS), *SMOKE, *PROFILE]
    with (folder / "out.log").open("a") as out:
        return subprocess.Popen(cluster.words(*command), cwd=folder, stdout=out, stderr=out, text=True)


def told(folder):
    return (folder / "out.log").read_text()


def wait_for_training(cluster, folder):
    log = folder / "results" / "smoke" / "logs" / "train" / f"{JOB}.log"
    wait_for(lambda: log.exists() and "epoch" in log.read_text())
    return next(job for job, state in cluster.jobs() if state == "RUNNING")


def ended(run, cluster, folder):
    """Wait for the end of a run; return its status. Nothing of it is left in the queue, and no file is half written."""
    status = run.wait(HANGS_S)
    wait_for(lambda: not cluster.jobs())
    assert not list(folder.glob("results/**/.partial.*"))
    return status


def assert_ends_the_same(run, cluster, folder, trained):
    """Check that a run succeeds, with the network that was trained without a cluster."""
    assert ended(run, cluster, folder) == 0, told(folder)
    for name in (WEIGHTS, METRICS):
        assert (folder / NETWORK / name).read_bytes() == (trained / NETWORK / name).read_bytes()


def test_a_cancelled_training_is_sent_again_and_ends_the_same(cluster, project, trained):
    run = start(cluster, project)
    cluster.ask("scancel", wait_for_training(cluster, project))
    assert_ends_the_same(run, cluster, project, trained)
    assert "begins again: train plant, MOB-Net-LA-s0" in told(project)


def test_a_node_that_fails_and_returns_does_not_lose_its_job(cluster, project, trained):
    run = start(cluster, project)
    wait_for_training(cluster, project)
    cluster.kill("slurmd")
    wait_for(lambda: "down" in cluster.ask("sinfo", "--noheader", "--format=%T"))
    cluster.start("slurmd")
    assert_ends_the_same(run, cluster, project, trained)


def test_a_controller_that_fails_and_returns_is_waited_for(cluster, project, trained):
    run = start(cluster, project)
    wait_for_training(cluster, project)
    cluster.kill("slurmctld")
    cluster.start("slurmctld")
    assert_ends_the_same(run, cluster, project, trained)


def test_a_killed_run_started_again_ends_the_same(cluster, project, trained):
    run = start(cluster, project)
    wait_for_training(cluster, project)
    cluster.ask("pkill", "-KILL", "-f", "snakemake --cores")
    run.wait(HANGS_S)
    cluster.ask("scancel", "--user", "root")
    again = start(cluster, project)
    assert_ends_the_same(again, cluster, project, trained)


def test_ctrl_c_empties_the_queue(cluster, project):
    run = start(cluster, project)
    wait_for_training(cluster, project)
    cluster.ask("pkill", "-INT", "-f", "snakemake --cores")
    assert ended(run, cluster, project) == 128 + signal.SIGINT
    said = told(project)
    assert re.fullmatch(r"stopped; \d+ of \d+ jobs are made; the same command goes on from here", said.splitlines()[-1])
    assert f"train ({JOB}): " not in said


def test_a_job_over_its_memory_is_named_with_a_remedy(cluster, project):
    run = start(cluster, project, *TARGETS, "--set-resources", "train:mem_mb=500")
    assert ended(run, cluster, project) != 0
    said = [line.split(" (log: ")[0] for line in told(project).splitlines() if "--set-resources" in line]
    limit = "ended by SLURM above its 500 MB; give it more with --set-resources train:mem_mb=1000"
    assert said == [f"train ({JOB}): {limit}"]


def test_a_full_disk_is_told_in_one_line(cluster, project):
    target = str(project / "results")
    cluster.ask("mount", "-t", "tmpfs", "-o", "size=1M", "none", target)
    try:
        run = start(cluster, project, COLLECTED)
        assert ended(run, cluster, project) != 0
    finally:
        cluster.ask("umount", target)
    assert told(project).count("too little space") == 1
