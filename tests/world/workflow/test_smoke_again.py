"""The smoke scale goes on where a part of it is lost, on a cluster; and not from damaged files.

What was made is compared with a copy of the unbroken run that no test changes.
"""

import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

import pytest

from experiments.running.accounts import read_account

from .cluster import cluster_in
from .conftest import with_losses
from .smoke import FIGURES, LOST, SMOKE, accounts, manifest_of, products, told

WHOLE_CLUSTER, LONGER = "MOBNET_WHOLE_CLUSTER", 1.5  # asks for the whole line on a cluster; its time by the local one

pytestmark = [pytest.mark.slow, pytest.mark.sim]


@pytest.fixture(scope="module")
def unbroken(smoke_run):
    """The project in which the smoke scale ran, as it was at the end of the run."""
    return smoke_run / "kept"


def test_damaged_recording_stops_with_one_line_and_nothing_half_written(unbroken, make_project, snakemake):
    folder = make_project("damaged", unbroken)
    own = Path("results") / "smoke" / "plant"
    place = own / "recordings" / "forward_walk" / "ideal"
    for made in (place, own / "residuals" / "forward_walk" / "ideal"):
        shutil.copytree(unbroken / made, folder / made)
    whole = (unbroken / place / "s101.parquet").read_bytes()
    (folder / place / "s101.parquet").write_bytes(whole[: len(whole) // 2])
    target = str(own / "estimates" / "forward_walk" / "ideal")
    done = snakemake("--cores", "1", *SMOKE, "--rerun-triggers", "mtime", "--", target, folder=folder)
    assert done.returncode != 0
    assert (done.stdout + done.stderr).count(f"{place}/s101.parquet: truncated or damaged") == 1
    assert not (folder / target).exists()


def run_on_cluster(folder, place, *targets):
    """Make targets of a project on a cluster of this machine, whose files go to a place; return how long it took [s].

    At this scale trainings take seconds, so that they go into the queue together too.
    """
    groups = (
        "motions=20", "walks=25", "residuals=25", "fits=10", "networks=33", "estimates=120", "scores=20", "tables=100",
    )  # fmt: skip
    words = ["--profile", "workflow/profiles/slurm", "--cores", "1"]
    command = [sys.executable, str(folder / "reproduce"), *targets, *SMOKE, *words, "--group-components", *groups]
    with cluster_in(place) as cluster, (folder / "out.log").open("w") as out:
        before = time.monotonic()
        done = subprocess.run(cluster.words(*command), cwd=folder, stdout=out, stderr=out, check=False)
    assert done.returncode == 0, told(folder)
    return time.monotonic() - before


def numbers_below(place):
    """Return the content of a file, or of all files of a folder but notes, which tell when and where they were made."""
    found = place.rglob("*") if place.is_dir() else [place]
    return {path.name: path.read_bytes() for path in found if path.is_file() and path.suffix != ".json"}


def test_a_cluster_makes_the_same_files(unbroken, make_project, tmp_path_factory):
    folder = with_losses(make_project, unbroken, "on_cluster")
    run_on_cluster(folder, tmp_path_factory.mktemp("cluster"), *FIGURES)
    for place in LOST:
        assert numbers_below(folder / place) == numbers_below(unbroken / place) != {}
    assert products(folder) == products(unbroken)


if WHOLE_CLUSTER in os.environ:  # it takes as long as all other tests together

    def test_a_cluster_makes_all_files_in_half_as_much_time_again(unbroken, make_project, tmp_path_factory):
        folder = make_project("all_on_cluster", unbroken)
        took_s = run_on_cluster(folder, tmp_path_factory.mktemp("cluster"), "all")
        assert products(folder) == products(unbroken)
        assert manifest_of(folder) == manifest_of(unbroken)
        jobs = [read_account(path) for path in accounts(unbroken)]
        assert took_s <= LONGER * (max(job.end_s for job in jobs) - min(job.start_s for job in jobs))
