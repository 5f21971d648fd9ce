"""Rates are found again from accounts that follow them, and price other work."""

from pathlib import Path

import pytest

from experiments.plan.prices import price
from experiments.plan.work import Work
from experiments.running.accounts import Account
from experiments.site.rates import fitted, processor
from mobnet.core.errors import DataError

START_S, PER_SECOND, PER_STEP, BASE_MIB, PER_NUMBER = 2.0, 0.1, 3e-6, 300.0, 2e-5


def trained(name: str, seconds: float, steps: float) -> Work:
    """Return the work of a made-up training."""
    return Work(name, "train", {"s": seconds, "GRU step": steps}, seconds * 1e4)


def account(work: Work) -> Account:
    """Return what work takes at the rates above."""
    cpu_s = START_S + PER_SECOND * work.amounts["s"] + PER_STEP * work.amounts["GRU step"]
    return Account(work.job, 0.0, cpu_s, cpu_s, cpu_s, BASE_MIB + PER_NUMBER * work.held, succeeded=True)


WORKS = [trained(f"train/{i}", 100.0 * i, steps) for i, steps in enumerate((1e6, 5e6, 2e7, 1e6), start=1)]
ACCOUNTS = {work.job: account(work) for work in WORKS}


def test_rates_are_found_again_and_price_a_longer_run() -> None:
    kinds = fitted(WORKS, ACCOUNTS)
    longer = trained("train/longer", 3600.0, 7e8)
    cpu_s, peak_mib = price(longer, kinds["train"])
    assert cpu_s == pytest.approx(account(longer).cpu_s, rel=1e-6)
    assert peak_mib == pytest.approx(account(longer).peak_mib, rel=1e-6)


def test_no_rate_is_below_zero() -> None:
    """The longest job took the least."""
    works = [Work(f"observe/{i}", "observe", {"s": 100.0 * i}, 0.0) for i in (1, 2, 3)]
    took = {work.job: Account(work.job, 0.0, 1.0, 1.0, 9.0 - work.amounts["s"] / 50, 1.0, True) for work in works}
    assert fitted(works, took)["observe"].cpu_s == {"job": pytest.approx(5.0)}


@pytest.mark.parametrize(("amounts", "twice"), [({}, 7.0), ({"s": 50.0}, 14.0)])
def test_a_single_job_grows_with_what_it_reads_and_else_stays(amounts: dict[str, float], twice: float) -> None:
    one = Work("coverage", "coverage", amounts, 0.0)
    kinds = fitted([one], {"coverage": Account("coverage", 0.0, 7.0, 7.0, 7.0, 100.0, succeeded=True)})
    larger = Work("coverage", "coverage", {name: 2 * amount for name, amount in amounts.items()}, 0.0)
    assert price(larger, kinds["coverage"]) == (pytest.approx(twice), pytest.approx(100.0))


def test_jobs_that_all_do_as_much_grow_with_it() -> None:
    """As detectors of robots do: nothing else tells what they take at another scale."""
    works = [Work(f"detect/{robot}", "detect", {"s": 50.0}, 30.0) for robot in range(3)]
    took = {work.job: Account(work.job, 0.0, 7.0, 7.0, 7.0, 90.0, succeeded=True) for work in works}
    larger = Work("detect/0", "detect", {"s": 100.0}, 60.0)
    assert price(larger, fitted(works, took)["detect"]) == (pytest.approx(14.0), pytest.approx(180.0))


def test_a_job_without_an_account_is_named() -> None:
    with pytest.raises(DataError, match=r"^train/2: there is no account of this job; ./reproduce all writes it"):
        fitted(WORKS, {"train/1": ACCOUNTS["train/1"]})


def test_the_processor_has_the_name_that_linux_gives_it(tmp_path: Path) -> None:
    path = tmp_path / "cpuinfo"
    assert processor(path)
    path.write_text("processor\t: 0\nmodel name\t: Made-up 9 CPU\nflags\t: fpu\n")
    assert processor(path) == "Made-up 9 CPU"
