"""What a job asks of a cluster, in memory and time: a multiple of what it is priced with (experiments.plan.prices)."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any

from experiments.plan.dry_run import PlannedJob
from experiments.plan.gpu import GPU_RATES, GpuNote, GpuRates, fitted
from experiments.plan.plan import Plan
from experiments.plan.prices import RATES, Priced, RatesNote, kind_of, priced
from mobnet.core.code import ROOT
from mobnet.core.notes import read_note

MARGIN = 2.0  # prices are those of one processor, and what a job takes differs from the average of its kind
GPU_MARGIN = 4.0  # those of a GPU are of a prototype on an H200, and most GPUs are half as fast or slower
SNAKEMAKE_MB = 300.0  # what Snakemake itself holds beside a job: twice 210 MB, of which 140 are shared
LEAST_MIN = 10  # a job may wait for a slow disk at its start, and compile for minutes
LEAST_MB = 2000  # most clusters give so much with a core, and jobs of a kind differ: a score takes 260 to 640 MB
LEAST_GPU_MB = 12_000  # CUDA and its libraries, which nobody measured here
UNPRICED_S, UNPRICED_MB = 1800.0, 2000.0  # of jobs that the published run did not have: trials and films
MINUTE_S = 60.0
MB_OF_MIB = 2**20 / 1e6
Resources = dict[str, Callable[..., int]]  # resource -> what a job asks for, from its wildcards and its attempt


@dataclass(frozen=True)
class JobLimits:
    """The limits of the jobs of a plan; without rates of a GPU, no network learns there."""

    plan: Plan
    rates: RatesNote
    gpu: GpuRates | None

    def of(self, name: str) -> Resources:
        """Return what jobs ask for in a rule, at each attempt as much more.

        Args:
            name: the kind of the jobs, or the name of a product, which may contain the rule's wildcards.
        """

        @cache
        def first(wildcards: tuple[tuple[str, str], ...]) -> tuple[int, int]:
            """Return the memory [MB] and the time [min] of the first attempt: Snakemake asks many times."""
            return self.asked(name, dict(wildcards))

        def memory_mb(w: Any, attempt: int) -> int:
            return attempt * first(tuple(w.items()))[0]

        def minutes(w: Any, attempt: int) -> int:
            return attempt * first(tuple(w.items()))[1]

        return {"mem_mb": memory_mb, "runtime": minutes}

    def asked(self, name: str, wildcards: Mapping[str, str]) -> tuple[int, int]:
        """Return the memory [MB] and the time [min] that a job asks for at first."""
        price = self._price(name.format_map(wildcards), wildcards)
        if kind_of(price.work, self.rates.kinds) is None:
            cpu_s, held_mb = UNPRICED_S, UNPRICED_MB
        else:
            cpu_s, held_mb = price.cpu_s, price.peak_mib * MB_OF_MIB
        minutes = (MARGIN * cpu_s + GPU_MARGIN * price.gpu_s) / MINUTE_S
        memory_mb = MARGIN * (held_mb + SNAKEMAKE_MB)
        least_mb = LEAST_GPU_MB if price.on_gpu else LEAST_MB
        return max(least_mb, math.ceil(memory_mb)), max(LEAST_MIN, math.ceil(minutes))

    def _price(self, name: str, wildcards: Mapping[str, str]) -> Priced:
        """Return a job of a kind, or of a product, with its price."""
        job = PlannedJob(rule=name, name=name, wildcards=wildcards, outputs=(name,), resources={})
        return priced(self.plan, self.rates, self.gpu, [job])[0]


def limits(plan: Plan) -> JobLimits:
    """Return the limits of the jobs of a plan, by the rates of the published run.

    Raises:
        DataError: rates are missing or damaged.
    """
    gpu = fitted(read_note(ROOT / GPU_RATES, GpuNote)) if plan.settings.stacks.side_by_side else None
    return JobLimits(plan, read_note(ROOT / RATES, RatesNote), gpu)
