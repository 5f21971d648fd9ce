"""Table of compute: how many jobs, hours and bytes each stage of the workflow took, from the jobs' own accounts.

It differs from run to run, so it stands beside the results and not among those that come out the same each time.
"""

from collections.abc import Iterator, Sequence
from itertools import accumulate
from pathlib import Path

from experiments.evaluation.number.number import Number
from experiments.evaluation.tables.layout import RULE, Line, Table, write_table
from experiments.running.accounts import Account, read_account
from experiments.settings.table_columns import COMPUTE
from experiments.settings.tables import Compute
from mobnet.core.errors import DataError

STAGES = {  # stage -> its rules; those of no stage make tables and figures
    "collect": ("motion", "collect", "observe"),
    "train": ("fit", "train_stack", "train"),
    "estimate": ("estimate",),
    "detect and react": ("detect", "watch", "react"),
    "score": ("score",),
    "tables and figures": (),
    "paper": ("numbers", "deviations", "paper", "manifest"),
}
REST = "tables and figures"
WHOLE = "all jobs"
ELAPSED = "elapsed"
HOUR_S = 3600.0
PERCENT = 100.0
HEADER = ["Stage", "Jobs", "CPU time [h]", "Wall time [h]", "Load [%]", "Peak memory [MiB]"]
Uses = dict[tuple[str, str], Number]  # stage (a name of `STAGES`, `WHOLE` or `ELAPSED`), quantity


def compute(settings: Compute, accounts: Path, out: Path) -> None:
    """Write compute.csv (`out`), .tex and .md: jobs, CPU and wall time [h] and peak memory [MiB] of each stage.

    Jobs that failed do not count.

    Raises:
        DataError: there is no account of a job, or a file is none.
    """
    jobs = [job for job in map(read_account, sorted(accounts.rglob("*.json"))) if job.succeeded]
    if not jobs:
        raise DataError(f"{accounts}: holds no account of a job; ./reproduce all makes them")
    uses: Uses = {}
    for stage, own in by_stage(jobs):
        uses |= uses_of(stage, own)
    uses |= whole_run(jobs, settings.pause_s)
    records = [(*of, use.value, use.unit) for of, use in uses.items()]
    write_table(out.with_suffix(""), Table(COMPUTE, records, HEADER, compute_lines(uses)))


def by_stage(jobs: Sequence[Account]) -> Iterator[tuple[str, Sequence[Account]]]:
    """Yield each stage that has jobs with them, then all of them."""
    for stage in STAGES:
        own = [job for job in jobs if stage_of(job.job) == stage]
        if own:
            yield stage, own
    yield WHOLE, jobs


def stage_of(job: str) -> str:
    """Return the stage of a job by the name of its account."""
    rule = job.split("/")[0]
    return next((stage for stage, rules in STAGES.items() if rule in rules), REST)


def uses_of(stage: str, jobs: Sequence[Account]) -> Uses:
    """Return what jobs took together [-, h, %, MiB]; the load is CPU time over wall time."""
    cpu_s = sum(job.cpu_s for job in jobs)
    wall_s = sum(job.wall_s for job in jobs)
    return {
        (stage, "jobs"): Number(len(jobs)),
        (stage, "CPU time"): Number(cpu_s / HOUR_S, unit="h"),
        (stage, "wall time"): Number(wall_s / HOUR_S, unit="h"),
        (stage, "load"): Number(PERCENT * cpu_s / wall_s if wall_s else 0.0, unit="%"),
        (stage, "peak memory"): Number(max(job.peak_mib for job in jobs), unit="MiB"),
    }


def whole_run(jobs: Sequence[Account], pause_s: float) -> Uses:
    """Return elapsed time [h], cores (the most jobs at once), the share of them with a job and that of CPU time [%].

    The jobs may be of several runs, one after another: a time without any job longer than `pause_s` [s] does not count.
    """
    cores = at_once(jobs)
    elapsed_s = elapsed(jobs, pause_s)
    shares = {"taken": sum(job.wall_s for job in jobs), "load": sum(job.cpu_s for job in jobs)}
    uses = {(ELAPSED, "wall time"): Number(elapsed_s / HOUR_S, unit="h"), (ELAPSED, "cores"): Number(cores)}
    for name, seconds in shares.items():
        share = PERCENT * seconds / (cores * elapsed_s) if elapsed_s else 0.0
        uses[ELAPSED, name] = Number(share, unit="%")
    return uses


def at_once(jobs: Sequence[Account]) -> int:
    """Return how many jobs ran at once at most."""
    changes = sorted([(job.end_s, -1) for job in jobs] + [(job.start_s, 1) for job in jobs])  # an end goes first
    return max(accumulate(change for _, change in changes))


def elapsed(jobs: Sequence[Account], pause_s: float) -> float:
    """Return the time [s] from the first job's start to the last one's end, without pauses beyond `pause_s` [s]."""
    whole = max(job.end_s for job in jobs) - min(job.start_s for job in jobs)
    return whole - sum(pauses(jobs, pause_s))


def pauses(jobs: Sequence[Account], pause_s: float) -> list[float]:
    """Return the times [s] longer than `pause_s` [s] in which no job ran, between the first job and the last."""
    in_order = sorted(jobs, key=lambda job: job.start_s)
    ends = accumulate((job.end_s for job in in_order), max)
    gaps = [job.start_s - end for job, end in zip(in_order[1:], ends, strict=False)]
    return [gap for gap in gaps if gap > pause_s]


def compute_lines(uses: Uses) -> list[Line]:
    """Return the rows of text: a stage each, all jobs, and the run from its first job to its last."""
    stages = list(dict.fromkeys(stage for stage, _ in uses if stage != ELAPSED))
    digits = {"jobs": 0, "CPU time": 2, "wall time": 2, "load": 0, "peak memory": 0}
    lines: list[Line] = []
    for stage in stages:
        lines.append([stage, *(uses[stage, name].text(k) for name, k in digits.items())])
    cores, taken, wall, load = (uses[ELAPSED, name] for name in ("cores", "taken", "wall time", "load"))
    name = f"{ELAPSED} (cores: {cores.text(0)}, taken: {taken.text(0)} %)"
    return [*lines[:-1], RULE, lines[-1], [name, "", "", wall.text(), load.text(0), ""]]
