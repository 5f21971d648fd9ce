"""What a unit of work takes in processor time and memory: fitted to the accounts of a run, it prices other runs."""

import platform
import re
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import nnls

from experiments.evaluation.report.compute import HOUR_S
from experiments.plan.prices import HELD, JOB, Kind, RatesNote
from experiments.plan.work import Work
from experiments.running.accounts import Account
from mobnet.core.errors import DataError
from mobnet.learning.precision import PROCESSOR


def measured(scale: str, works: Sequence[Work], jobs: Iterable[Account]) -> RatesNote:
    """Return the rates of a run of a scale on this processor, from what its jobs had to do and from their accounts.

    Raises:
        DataError: a job has no account.
    """
    accounts = {job.job: job for job in jobs if job.succeeded}
    kinds = fitted(works, accounts)
    own = [accounts[work.job] for work in works]
    return RatesNote(
        processor=processor(PROCESSOR),
        scale=scale,
        core_h=sum(account.cpu_s for account in own) / HOUR_S,
        peak_mib=max(account.peak_mib for account in own),
        kinds=kinds,
    )


def processor(described: Path) -> str:
    """Return the name of a processor as Linux describes it, or of its architecture."""
    text = described.read_text(encoding="utf-8") if described.exists() else ""
    found = re.search(r"^model name\s*:\s*(.+)$", text, re.MULTILINE)
    return found[1].strip() if found else platform.machine()


def fitted(works: Iterable[Work], accounts: Mapping[str, Account]) -> dict[str, Kind]:
    """Return the rates that fit the accounts of jobs best, none of them below zero.

    Raises:
        DataError: a job has no account.
    """
    kinds: dict[str, list[Work]] = {}
    for work in works:
        if work.job not in accounts:
            raise DataError(f"{work.job}: there is no account of this job; ./reproduce all writes it")
        kinds.setdefault(work.kind, []).append(work)
    rates: dict[str, Kind] = {}
    for kind, own in kinds.items():
        rates[kind] = _kind(own, [accounts[work.job] for work in own])
    return rates


def _kind(works: Sequence[Work], accounts: Sequence[Account]) -> Kind:
    cpu_s = _rates([work.amounts for work in works], [account.cpu_s for account in accounts])
    peak_mib = _rates([{HELD: work.held} for work in works], [account.peak_mib for account in accounts])
    return Kind(cpu_s=cpu_s, peak_mib=peak_mib)


def _rates(amounts: Sequence[Mapping[str, float]], taken: Sequence[float]) -> dict[str, float]:
    """Return what a unit of each amount takes; jobs of a kind that all do as much have no start of their own."""
    names: list[str] = []
    for own in amounts:
        names += [name for name, amount in own.items() if amount and name not in names]
    are_alike = all(own == amounts[0] for own in amounts)
    names = names if are_alike and names else [JOB, *names]
    rows: list[list[float]] = []
    for own in amounts:
        known = {JOB: 1.0, **own}
        rows.append([known.get(name, 0.0) for name in names])
    columns = np.array(rows)
    largest = columns.max(axis=0)  # amounts of 1 and of 1e12 beside each other would be lost in rounding
    found: NDArray[np.float64] = nnls(columns / largest, np.array(taken))[0] / largest
    return {name: float(rate) for name, rate in zip(names, found, strict=True) if rate > 0}
