"""Runs of the smoke scale, and what they made."""

import subprocess
import sys

SMOKE = ("--config", "scale=smoke")
FIGURES = ("figures/smoke/drift.csv", "tables/smoke/coverage.csv", "tables/smoke/table_11.csv")
LOST = (  # walks of a test and walks that a network learns from: jobs of most kinds run again
    "results/smoke/plant/recordings/foot_hold",
    "results/smoke/robot_1/recordings/robot_walk_plain",
    "results/smoke/robot_1/networks/MOB-Net-plain-LL-s101",
    "results/smoke/scores/foot_hold",
    *FIGURES,
)
LIVE = "wandb_live"  # folder of trainings that are under way, beside that of all runs
MADE = ("results", "tables", "figures", "paper", ".snakemake")


def reproduce(folder, *words, command="all"):
    started = [sys.executable, str(folder / "reproduce"), command, *SMOKE, *words]
    with (folder / "out.log").open("ab") as out:
        return subprocess.Popen(started, cwd=folder, stdout=out, stderr=out, start_new_session=True)


def told(folder):
    """Return the end of what the runs in a folder have said, and their errors, which may stand far above it."""
    said = (folder / "out.log").read_text()
    errors = [line for line in said.splitlines() if "rror" in line]
    return "\n".join([said[-5000:], "errors:", *errors[-20:]])


def products(folder):
    found = [*(folder / "tables" / "smoke").iterdir(), *(folder / "figures" / "smoke").glob("*.csv")]
    return {path.name: path.read_bytes() for path in found}


def manifest_of(folder):
    """Return the list of results with their hashes; two runs of the same code have the same."""
    return (folder / "results" / "smoke" / "MANIFEST.sha256").read_text()


def names(folder):
    """Return the names of all files but those that only some runs have: Snakemake's own, reports, caches, live logs.

    A training of the smoke scale takes a second or two: whether it is logged while it goes on is a matter of time.
    """
    places = ("results", "tables", "figures", "paper", ".snakemake/scripts", ".cache/tmp")
    paths = [path.relative_to(folder) for place in places for path in (folder / place).rglob("*")]
    return {str(path) for path in paths if LIVE not in path.parts[:-1]}


def accounts(folder):
    return list((folder / "results" / "smoke" / "logs").rglob("*.json"))
