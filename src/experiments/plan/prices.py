"""What a job will take in processor time, memory and time of a GPU, by the rates of the published run."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from experiments.plan.dry_run import PlannedJob
from experiments.plan.gpu import GpuRates
from experiments.plan.plan import Plan
from experiments.plan.work import SECONDS, OnGpu, Work, on_gpu, works_of
from mobnet.core.notes import Note, NotNegative, Positive, Text

RATES = Path("docs/results/rates.json")
JOB = "job"  # the amount that every job has once: its start
HELD = "held"
LIKE = {  # kind of jobs -> that whose rates count where it has none
    "train_stack": "train",  # both read and are prepared
    "falls": "collect",  # both walk robots
    "ten_first": "claims_summary",  # both read the table of claims
    "claims_tolerance": "claims_summary",  # both count what the table of claims holds
    "figure": "pages",  # any figure that the published run did not draw; both read tables
}
Rates = Mapping[str, float]  # amount -> what a unit of it takes


class Kind(Note):
    """What jobs of a kind take for each unit of an amount: processor time [s], and memory at its peak [MiB]."""

    cpu_s: dict[str, NotNegative]
    peak_mib: dict[str, NotNegative]


class RatesNote(Note):
    """The rates of each kind of job, the processor on which they were measured, and what that whole run took."""

    processor: Text
    scale: Text
    core_h: Positive
    peak_mib: Positive
    kinds: dict[str, Kind]


@dataclass(frozen=True)
class Priced:
    """A job with its price.

    Attributes:
        planned: the job.
        work: what it has to do; of a training on a GPU what a core does.
        cpu_s: processor time [s].
        peak_mib: peak of the memory [MiB].
        on_gpu: what a GPU does.
        gpu_s: time of the GPU [s].
    """

    planned: PlannedJob
    work: Work
    cpu_s: float
    peak_mib: float
    on_gpu: OnGpu | None = None
    gpu_s: float = 0.0


def kind_of(work: Work, kinds: Mapping[str, Kind]) -> Kind | None:
    """Return the rates of a job's kind, or of the one that is like it or its rule; None where there are none."""
    rule = work.job.partition("/")[0]
    return kinds.get(work.kind) or kinds.get(LIKE.get(work.kind, LIKE.get(rule, "")))


def priced(plan: Plan, rates: RatesNote, gpu: GpuRates | None, planned: Iterable[PlannedJob]) -> list[Priced]:
    """Return the jobs of a plan with their prices, none for those without a rate; without a GPU none learns there."""
    jobs = [job for job in planned if job.name != job.rule or job.outputs[0]]
    prices: list[Priced] = []
    for job, work in zip(jobs, works_of(plan, jobs), strict=True):
        there = on_gpu(plan, job) if gpu else None
        on_cpu = replace(work, amounts={SECONDS: work.amounts[SECONDS]}) if there else work
        kind = kind_of(on_cpu, rates.kinds)
        cpu_s, peak_mib = price(on_cpu, kind) if kind else (0.0, 0.0)
        prices.append(Priced(job, on_cpu, cpu_s, peak_mib, there, gpu.seconds(there) if gpu and there else 0.0))
    return prices


def price(work: Work, kind: Kind) -> tuple[float, float]:
    """Return the processor time [s] and the peak of the memory [MiB] that a job will take."""
    return _sum(kind.cpu_s, work.amounts), _sum(kind.peak_mib, {HELD: work.held})


def _sum(rates: Rates, amounts: Mapping[str, float]) -> float:
    return sum(rate * {JOB: 1.0, **amounts}.get(name, 0.0) for name, rate in rates.items())
