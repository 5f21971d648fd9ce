"""Table of compute: how many jobs, hours and bytes each stage of the workflow took, from Snakemake's benchmark files.

It differs from run to run, so it stands beside the results and not among those that come out the same each time.
"""

from __future__ import annotations

import csv
import logging
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import accumulate
from pathlib import Path
from typing import Any

from mobnet.core.errors import DataError
from mobnet.core.files import write_text
from mobnet.evaluation.number.rows import write_rows
from mobnet.evaluation.tables.layout import RULE, Line, markdown_table, number, text_table

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
FIRST_S, FIRST_END_S, NEXT_S = 0.5, 15.0, 30.0  # Snakemake looks at a job every 0.5 s until 15 s, then every 30 s
EDGE_S = 2.0  # a job's last line in its log is written at most this long before its end
HOUR_S, PERCENT = 3600.0, 100.0
HEADER = ["Stage", "Jobs", "CPU time [h]", "Wall time [h]", "Load [%]", "Peak memory [MiB]"]


@dataclass(frozen=True)
class Job:
    """One job of the workflow.

    Attributes:
        rule: the rule's name.
        start: time of its start [s since 1970].
        end: time of its end [s since 1970].
        cpu_s: CPU time of all its processes [s].
        peak_mib: most memory that they held at once [MiB]; None where the job ended before it was looked at.
    """

    rule: str
    start: float
    end: float
    cpu_s: float
    peak_mib: float | None


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


def compute(config: Mapping[str, Any], bench_dir: Path, logs_dir: Path, out_dir: Path) -> None:
    """Write compute.csv, .tex and .md: jobs [-], CPU and wall time [h] and peak memory [MiB] of each stage.

    Args:
        config: resolved configuration: `evaluation.compute.pause_s`, the longest time without any job that still
            counts as part of the run [s].
        bench_dir: benchmark files, one a job, in a folder a rule or named by their rule.
        logs_dir: the jobs' logs, named as those are.
        out_dir: gets the three files.

    Raises:
        DataError: there is no benchmark file, or one lacks a number or its log.
    """
    names = [path.relative_to(bench_dir) for path in sorted(bench_dir.rglob("*.tsv"))]
    jobs = [read_job(bench_dir / name, (logs_dir / name).with_suffix(".log"), rule_of(name)) for name in names]
    if not jobs:
        raise DataError(f"{bench_dir}: holds no benchmark; ./reproduce all makes them")
    uses = [use for stage, own in by_stage(jobs) for use in uses_of(stage, own)]
    uses += whole_run(jobs, config["evaluation"]["compute"]["pause_s"])
    write_rows(out_dir / "compute.csv", Use, uses)
    lines = compute_lines(uses)
    write_text(out_dir / "compute.tex", text_table("l" + "r" * (len(HEADER) - 1), HEADER, lines))
    write_text(out_dir / "compute.md", markdown_table(HEADER, lines))
    log.info("%s: %d jobs", out_dir / "compute.csv", len(jobs))


def rule_of(name: Path) -> str:
    """Return the rule of a benchmark file, by its path below their folder."""
    return name.parts[0].removesuffix(".tsv")


def read_job(path: Path, log_path: Path, rule: str) -> Job:
    """Read a benchmark file of a rule; when the job ended is told by its log, which `snakemake --touch` leaves alone.

    Raises:
        DataError: a number or the log is missing.
    """
    with path.open(newline="", encoding="utf-8") as file:
        row = next(csv.DictReader(file, delimiter="\t"), {})
    try:
        wall_s, end = float(row["s"]), log_path.stat().st_mtime
        cpu_s, peak_mib = (None if row[key] in ("-", "NA") else float(row[key]) for key in ("cpu_time", "max_rss"))
    except FileNotFoundError:
        raise DataError(f"{log_path}: file is missing") from None
    except (KeyError, ValueError) as error:
        raise DataError(f"{path}: not a benchmark, {error}") from None
    return Job(rule, end - wall_s, end, whole_cpu_s(cpu_s or 0.0, wall_s), peak_mib)


def whole_cpu_s(cpu_s: float, wall_s: float) -> float:
    """Return a job's CPU time [s]: what came after Snakemake's last look counts at the load up to it.

    Args:
        cpu_s: CPU time at the last look [s].
        wall_s: how long the job took [s].
    """
    step, start = (FIRST_S, 0.0) if wall_s < FIRST_END_S else (NEXT_S, FIRST_END_S)
    seen_s = start + (wall_s - start) // step * step
    return cpu_s * wall_s / seen_s if seen_s else cpu_s


def by_stage(jobs: Sequence[Job]) -> Iterator[tuple[str, Sequence[Job]]]:
    """Yield each stage that has jobs with them, then all of them."""
    stage_of = {rule: stage for stage, rules in STAGES.items() for rule in rules}
    for stage in STAGES:
        own = [job for job in jobs if stage_of.get(job.rule, REST) == stage]
        if own:
            yield stage, own
    yield WHOLE, jobs


def uses_of(stage: str, jobs: Sequence[Job]) -> Iterator[Use]:
    """Yield what jobs took together [-, h, %, MiB]; the load is CPU time over wall time."""
    cpu_s, wall_s = sum(job.cpu_s for job in jobs), sum(job.end - job.start for job in jobs)
    yield Use(stage, "jobs", len(jobs), "-")
    yield Use(stage, "CPU time", cpu_s / HOUR_S, "h")
    yield Use(stage, "wall time", wall_s / HOUR_S, "h")
    yield Use(stage, "load", PERCENT * cpu_s / wall_s if wall_s else 0.0, "%")
    yield Use(stage, "peak memory", max((job.peak_mib or 0.0 for job in jobs), default=0.0), "MiB")


def whole_run(jobs: Sequence[Job], pause_s: float) -> Iterator[Use]:
    """Yield elapsed time [h], cores [-] (the most jobs at once), the share of them with a job and that of CPU time [%].

    Args:
        jobs: of the run, or of several, one after another.
        pause_s: longest time without any job that counts as part of the run [s].
    """
    cores, elapsed_s = at_once(jobs), elapsed(jobs, pause_s)
    shares = {"taken": sum(job.end - job.start for job in jobs), "load": sum(job.cpu_s for job in jobs)}
    yield Use(ELAPSED, "wall time", elapsed_s / HOUR_S, "h")
    yield Use(ELAPSED, "cores", cores, "-")
    for name, seconds in shares.items():
        yield Use(ELAPSED, name, PERCENT * seconds / (cores * elapsed_s) if elapsed_s else 0.0, "%")


def at_once(jobs: Sequence[Job]) -> int:
    """Return how many jobs ran at once at most; their ends, which logs tell a little early, are left out."""
    middles = [(job.start + EDGE_S, job.end - EDGE_S) for job in jobs if job.end - job.start > 2 * EDGE_S]
    changes = sorted([(end, -1) for _, end in middles] + [(start, 1) for start, _ in middles])
    running, most = 0, 1
    for _, change in changes:
        running += change
        most = max(most, running)
    return most


def elapsed(jobs: Sequence[Job], pause_s: float) -> float:
    """Return the time [s] from the first job's start to the last one's end, without pauses beyond `pause_s` [s]."""
    in_order = sorted(jobs, key=lambda job: job.start)
    ends = list(accumulate((job.end for job in in_order), max))
    gaps = [job.start - end for job, end in zip(in_order[1:], ends[:-1], strict=True)]
    return ends[-1] - in_order[0].start - sum(gap for gap in gaps if gap > pause_s)


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
