"""Table of compute: how many jobs, hours and bytes each stage of the workflow took, from the jobs' own accounts.

It differs from run to run, so it stands beside the results and not among those that come out the same each time.
"""

from __future__ import annotations

import logging
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import accumulate
from pathlib import Path

from mobnet.core.errors import DataError
from mobnet.core.files import read_json, write_text
from mobnet.core.logs import Account
from mobnet.evaluation.number.rows import write_rows
from mobnet.evaluation.tables.layout import RULE, Line, markdown_table, number, text_table
from mobnet.settings.evaluation import Compute

log = logging.getLogger(__name__)

STAGES = {  # stage -> its rules; those of no stage make tables and figures
    "collect": ("motion", "collect"),
    "observe": ("observe",),
    "train": ("fit", "train"),
    "estimate": ("estimate",),
    "score": ("score",),
    "tables and figures": (),
    "paper": ("numbers", "deviations", "paper", "manifest"),
}
REST = "tables and figures"
WHOLE, ELAPSED = "all jobs", "elapsed"
HOUR_S, PERCENT = 3600.0, 100.0
HEADER = ["Stage", "Jobs", "CPU time [h]", "Wall time [h]", "Load [%]", "Peak memory [MiB]"]


@dataclass(frozen=True)
class Use:
    """One number of a stage: a row of compute.csv.

    Attributes:
        stage: a name of `STAGES`, `WHOLE` or `ELAPSED`.
        quantity: what is counted.
        value: the number [unit].
        unit: unit of the number.
    """

    stage: str
    quantity: str
    value: float
    unit: str


def compute(settings: Compute, accounts: Path, out: Path) -> None:
    """Write compute.csv, .tex and .md: jobs, CPU and wall time [h] and peak memory [MiB] of each stage.

    Args:
        settings: longest time without any job that still counts as part of the run.
        accounts: folder with an account of each job; those that failed do not count.
        out: compute.csv; the other two stand beside it.

    Raises:
        DataError: there is no account, or a file is none.
    """
    jobs = [job for job in map(read_account, sorted(accounts.rglob("*.json"))) if job.succeeded]
    if not jobs:
        raise DataError(f"{accounts}: holds no account of a job; ./reproduce all makes them")
    uses = [use for stage, own in by_stage(jobs) for use in uses_of(stage, own)]
    uses += whole_run(jobs, settings.pause_s)
    write_rows(out, Use, uses)
    lines = compute_lines(uses)
    write_text(out.with_suffix(".tex"), text_table("l" + "r" * (len(HEADER) - 1), HEADER, lines))
    write_text(out.with_suffix(".md"), markdown_table(HEADER, lines))
    log.info("%s: %d jobs", out, len(jobs))


def read_account(path: Path) -> Account:
    """Read what one job took.

    Raises:
        DataError: the file is not an account.
    """
    try:
        return Account(**read_json(path))
    except TypeError as error:
        raise DataError(f"{path}: not an account of a job, {error}") from None


def by_stage(jobs: Sequence[Account]) -> Iterator[tuple[str, Sequence[Account]]]:
    """Yield each stage that has jobs with them, then all of them."""
    stage_of = {rule: stage for stage, rules in STAGES.items() for rule in rules}
    for stage in STAGES:
        own = [job for job in jobs if stage_of.get(job.job.split("/")[0], REST) == stage]
        if own:
            yield stage, own
    yield WHOLE, jobs


def uses_of(stage: str, jobs: Sequence[Account]) -> Iterator[Use]:
    """Yield what jobs took together [-, h, %, MiB]; the load is CPU time over wall time."""
    cpu_s, wall_s = sum(job.cpu_s for job in jobs), sum(job.wall_s for job in jobs)
    yield Use(stage, "jobs", len(jobs), "-")
    yield Use(stage, "CPU time", cpu_s / HOUR_S, "h")
    yield Use(stage, "wall time", wall_s / HOUR_S, "h")
    yield Use(stage, "load", PERCENT * cpu_s / wall_s if wall_s else 0.0, "%")
    yield Use(stage, "peak memory", max(job.peak_mib for job in jobs), "MiB")


def whole_run(jobs: Sequence[Account], pause_s: float) -> Iterator[Use]:
    """Yield elapsed time [h], cores [-] (the most jobs at once), the share of them with a job and that of CPU time [%].

    Args:
        jobs: of the run, or of several, one after another.
        pause_s: longest time without any job that counts as part of the run [s].
    """
    cores, elapsed_s = at_once(jobs), elapsed(jobs, pause_s)
    shares = {"taken": sum(job.wall_s for job in jobs), "load": sum(job.cpu_s for job in jobs)}
    yield Use(ELAPSED, "wall time", elapsed_s / HOUR_S, "h")
    yield Use(ELAPSED, "cores", cores, "-")
    for name, seconds in shares.items():
        yield Use(ELAPSED, name, PERCENT * seconds / (cores * elapsed_s) if elapsed_s else 0.0, "%")


def at_once(jobs: Sequence[Account]) -> int:
    """Return how many jobs ran at once at most."""
    changes = sorted([(job.end_s, -1) for job in jobs] + [(job.start_s, 1) for job in jobs])  # an end goes first
    return max(accumulate(change for _, change in changes))


def elapsed(jobs: Sequence[Account], pause_s: float) -> float:
    """Return the time [s] from the first job's start to the last one's end, without pauses beyond `pause_s` [s]."""
    in_order = sorted(jobs, key=lambda job: job.start_s)
    ends = list(accumulate((job.end_s for job in in_order), max))
    gaps = [job.start_s - end for job, end in zip(in_order[1:], ends[:-1], strict=True)]
    return ends[-1] - in_order[0].start_s - sum(gap for gap in gaps if gap > pause_s)


def compute_lines(uses: Sequence[Use]) -> list[Line]:
    """Return the rows of text: a stage each, all jobs, and the run from its first job to its last."""
    values = {(use.stage, use.quantity): use.value for use in uses}
    stages = [stage for stage in dict.fromkeys(use.stage for use in uses) if stage != ELAPSED]
    lines: list[Line] = [
        [
            stage,
            number(values[stage, "jobs"], 0),
            *(number(values[stage, name]) for name in ("CPU time", "wall time")),
            *(number(values[stage, name], 0) for name in ("load", "peak memory")),
        ]
        for stage in stages
    ]
    cores, taken = values[ELAPSED, "cores"], values[ELAPSED, "taken"]
    last = [
        f"{ELAPSED} (cores: {cores:.0f}, taken: {taken:.0f} %)", "", "",
        number(values[ELAPSED, "wall time"]), number(values[ELAPSED, "load"], 0), "",
    ]  # fmt: skip
    return [*lines[:-1], RULE, lines[-1], last]
