"""Verdicts follow from intervals, statements from the worst of their claims, causes from what a number explains."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd
import pytest
from paper_settings import STATISTICS

from experiments.evaluation.measure.claims.cells import Evidence
from experiments.evaluation.measure.claims.verdicts import (
    WORST_FIRST,
    ClaimNumbers,
    Row,
    judged,
    numbers_of,
    rows_of,
    score_of,
    verdict_of,
    verdicts_of,
    worst,
)
from experiments.evaluation.number.number import Number
from experiments.intervals.crossed import RunGrid
from experiments.intervals.independent import wilson
from experiments.intervals.quantities import QUANTITIES, difference_of
from experiments.settings.claim_ranges import Ranges
from experiments.settings.claims import Claim
from experiments.settings.settings import Settings
from experiments.settings.verdicts import NOT_PRINTED, OURS, SCORED, VERDICTS

SIZE, SIGN = (1.0, 2.0), (0.5, None)
CAUSED: dict[str, Any] = {
    "quantity": "value", "cells": [{"table": "coverage", "where": {"joint": "LL1"}, "column": "ratio"}], "printed": "x",
    "says": "x", "unit": "-", "published": None, "rule": "bar", "bar": [0.5, 1.5],
    "cause": {
        "says": "Cold", "since": "2026-11-25", "seen": True,
        "without": {
            "quantity": "value", "cells": [{"table": "coverage", "where": {"joint": "LL2"}, "column": "ratio"}],
        },
    },
}  # fmt: skip
SHOWN = "Cold: 1.00 [0.90, 1.10] without it (named 2026-11-25, after results had been seen)."
CONFIDENCE = STATISTICS
Ends = tuple[str, str, str]


@pytest.mark.parametrize(
    ("ends", "size", "sign", "verdict"),
    [
        ((1.0, 2.0), "inside", "same", "reproduced"),
        ((1.5, 2.5), "open", "same", "sign at least"),
        ((3.0, 4.0), "outside", "same", "sign only"),
        ((0.4, 1.5), "open", "open", "open"),
        ((0.4, 0.6), "outside", "open", "not reproduced"),
        ((0.3, 0.4), "outside", "opposite", "not reproduced"),
        ((None, None), "open", "open", "open"),
    ],
)
def test_two_verdicts_follow_from_the_interval(
    ends: tuple[float | None, float | None], size: str, sign: str, verdict: str
) -> None:
    """A point within the bounds decides nothing."""
    ours = Number(1.5, *ends)
    assert verdicts_of(ClaimNumbers(ours, ours), Ranges(SIZE, SIGN)) == (size, sign, verdict)
    none = Number(None)
    assert verdicts_of(ClaimNumbers(none, none), Ranges(SIZE, SIGN)) == ("", "", "not measured")


@pytest.mark.parametrize(
    ("size", "sign", "verdict"),
    [
        ("inside", "", "reproduced"), ("outside", "", "not reproduced"), ("open", "", "open"),
        ("", "same", "reproduced"), ("", "opposite", "not reproduced"), ("", "open", "open"),
        ("inside", "open", "open"), ("inside", "opposite", "not reproduced"),
    ],
)  # fmt: skip
def test_one_verdict_may_stand_alone_and_the_worse_one_rules(size: str, sign: str, verdict: str) -> None:
    assert verdict_of(size, sign) == verdict


def test_the_sign_may_be_that_of_another_number() -> None:
    ours, signed = Number(1.5, 1.2, 1.8), Number(-0.2, -0.3, -0.1)
    assert verdicts_of(ClaimNumbers(ours, signed), Ranges(SIZE, (0.0, None))) == (
        "inside",
        "opposite",
        "not reproduced",
    )


@pytest.mark.parametrize(
    ("verdicts", "verdict"),
    [
        (["reproduced", "reproduced"], "reproduced"),
        (["reproduced", "sign at least"], "sign at least"),
        (["sign at least", "open"], "open"),
        (["open", "not measured"], "not measured"),
        (["not measured", "sign only"], "sign only"),
        (["sign only", "not reproduced", "reproduced"], "not reproduced"),
    ],
)
def test_a_statement_is_as_good_as_the_worst_of_its_claims(verdicts: Sequence[str], verdict: str) -> None:
    assert worst(verdicts) == verdict
    assert set(WORST_FIRST) == set(VERDICTS)


def test_joints_make_claims_of_the_same_statement_without_its_bar(settings: Settings) -> None:
    claim = settings.claims["mob-uncertain"]
    whole, *joints = rows_of({"mob-uncertain": claim})
    assert (whole.name, whole.statement, whole.joint) == ("mob-uncertain", "mob-uncertain", "")
    assert [row.joint for row in joints] == list(claim.by_joint)
    for row in joints:
        assert (row.statement, row.name) == ("mob-uncertain", f"mob-uncertain-{row.joint}")
        assert (row.claim.published, row.claim.bar) == (claim.by_joint[row.joint], None)
        assert [cell.joint for cell in row.claim.cells] == [row.joint]


def test_the_cause_of_a_joint_is_looked_at_at_that_joint(settings: Settings) -> None:
    name = "base-torque-noise"
    for row in rows_of({name: settings.claims[name]}):
        assert row.claim.cause is not None
        wanted = [row.joint] if row.joint else [("V4", "V5", "V6")]
        assert [cell.joint for cell in row.claim.cause.without.cells] == wanted


def test_statements_have_claims_of_one_score(settings: Settings) -> None:
    scores: dict[str, set[str]] = {}
    for row in rows_of(settings.claims):
        scores.setdefault(row.statement, set()).add(score_of(row.claim, settings.methods))
    assert {statement for statement, own in scores.items() if len(own) > 1} == set()
    assert set().union(*scores.values()) == set(SCORED)


def test_a_statement_of_the_paper_has_a_place_in_the_paper(settings: Settings) -> None:
    """What is not in the paper is ours, and nothing else is."""
    for row in rows_of(settings.claims):
        ours = score_of(row.claim, settings.methods) == OURS
        assert ours == (row.claim.printed == NOT_PRINTED), row.name
        assert ours or any(sign.isdigit() for sign in row.claim.printed), row.name


@pytest.mark.parametrize(
    ("name", "score"),
    [
        ("noise-floor", "observer"), ("mob-net-cut", "networks"), ("gru-validation", "no number"),
        ("step-mob", "networks"), ("zero-walk", "ours"), ("rte-coverage", "ours"),
    ],
)  # fmt: skip
def test_a_claim_counts_where_its_methods_say(name: str, score: str, settings: Settings) -> None:
    assert score_of(settings.claims[name], settings.methods) == score


@pytest.mark.parametrize(
    ("ours", "without", "text"),
    [
        (("2.0", "1.9", "2.1"), ("1.0", "0.9", "1.1"), SHOWN),
        (("2.0", "1.9", "2.1"), ("1.4", "1.3", "1.6"), ""),  # it changes the number, and does not explain it
        (("2.0", "1.9", "2.1"), ("0.1", "0.0", "0.2"), ""),  # past the bounds
        (("2.0", "1.9", "2.1"), ("1.0", "", ""), ""),
        (("1.0", "0.9", "1.1"), ("1.0", "0.9", "1.1"), ""),  # nothing fails
        (("1.5", "1.0", "2.0"), ("1.0", "0.9", "1.1"), ""),  # nor here, yet
        (("2.0", "1.9", "2.1"), ("", "", ""), ""),
    ],
)
def test_a_cause_brings_the_number_into_the_bounds_when_it_is_taken_away(
    ours: Ends, without: Ends, text: str, settings: Settings
) -> None:
    rows = [dict(zip(("ratio", "low", "high", "joint"), (*ends, name), strict=True))
            for name, ends in (("LL1", ours), ("LL2", without))]  # fmt: skip
    results = Evidence(settings.layout, {}, {}, pd.DataFrame(), {"coverage": rows})
    claim = Claim.model_validate(CAUSED)
    numbers = numbers_of(claim, results, CONFIDENCE)
    assert judged(Row("a", "a", claim), numbers, OURS, CONFIDENCE)["cause"] == text


def test_a_difference_of_shares_holds_what_it_says() -> None:
    """Simulated: of two detectors on other collisions, and on the same ones, where it is rather too long."""
    rng = np.random.default_rng(7)
    for first, second, is_paired in ((0.9, 0.8, False), (0.97, 0.55, False), (0.9, 0.8, True), (0.95, 0.9, True)):
        inside = 0
        draws, trials = 2000, 60
        for _ in range(draws):
            one = rng.random(trials)
            other = one if is_paired else rng.random(trials)
            found = difference_of(*(share_number(hits, p) for hits, p in ((one, first), (other, second))), "-")
            assert found.low is not None
            assert found.high is not None
            inside += found.low <= first - second <= found.high
        assert inside / draws >= 0.94, (first, second, is_paired)


def share_number(hits: np.ndarray, share: float) -> Number:
    """Return the share of hits below a probability [-], with Wilson's interval."""
    count = int((hits < share).sum())
    return Number(count / len(hits), *wilson(count / len(hits), len(hits), 0.95))


def test_a_difference_of_numbers_without_intervals_has_none() -> None:
    assert difference_of(Number(2.0, 1.0, 3.0), Number(1.0), "ms") == Number(1.0, unit="ms")
    assert difference_of(Number(None), Number(1.0, 0.0, 2.0), "ms") == Number(None, unit="ms")
    found = difference_of(Number(2.0, 1.7, 2.3), Number(1.0, 0.6, 1.4), "ms")
    assert found.with_ends == pytest.approx((1.0, 0.5, 1.5))


def grids(*means: float, spread: float = 0.1) -> list[list[RunGrid]]:
    """Return cells of one grid of four trainings each around a mean."""
    offsets = spread * np.array([-1.0, -0.5, 0.5, 1.0])
    return [[RunGrid((mean + offsets * (-1.0) ** k)[:, None], f"kind {k}")] for k, mean in enumerate(means)]


def test_a_ratio_of_gaps_has_no_interval_where_the_gap_below_may_be_none() -> None:
    apart = QUANTITIES["gap ratio"](grids(1.0, 2.0, 1.0, 5.0), CONFIDENCE, "-")
    assert apart.value == pytest.approx(0.25)
    assert apart.low is not None
    near = QUANTITIES["gap ratio"](grids(1.0, 2.0, 1.0, 1.1), CONFIDENCE, "-")
    assert (near.low, near.high) == (None, None)
    difference = QUANTITIES["gap difference"](grids(1.0, 2.0, 1.0, 1.1), CONFIDENCE, "-")
    assert difference.value == pytest.approx(0.9)
    assert difference.low is not None
    assert difference.low > 0.0
