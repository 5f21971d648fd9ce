"""What would decide an open claim: closed forms, and that so many runs decide and one fewer does not."""

from typing import Any

import pytest
from paper_settings import STATISTICS

from experiments.evaluation.measure.claims.deciding import AFFORDABLE, Effort, effort_of, text_of
from experiments.evaluation.measure.claims.verdicts import (
    NO_CAUSE,
    TO_MEASURE,
    ClaimNumbers,
    Row,
    judged,
    rows_of,
    score_of,
)
from experiments.evaluation.number.number import Number
from experiments.intervals.crossed import quantile_of
from experiments.intervals.independent import wilson
from experiments.settings.claims import Claim, MadeNumber
from experiments.settings.counts import HOURS, TRIALS
from experiments.settings.settings import Settings
from experiments.settings.verdicts import (
    DESCRIPTION,
    NOT_MEASURED,
    NOT_REPRODUCED,
    OPEN,
    OURS,
    SIGN_AT_LEAST,
    SIGN_ONLY,
)

CONFIDENCE = STATISTICS
SHARES = next(iter(TRIALS))  # a table of shares
RATES = next(iter(HOURS))  # a table of events in an hour
CELL: dict[str, Any] = {"scenario": "walk_test", "level": "robots", "method": "MOB-Net", "joint": "LL"}
DIFFERENCE: dict[str, Any] = {"quantity": "difference", "cells": [CELL, {**CELL, "method": "MOB"}]}
FALLS: dict[str, Any] = {
    "quantity": "value", "cells": [{"table": SHARES, "where": {"measure": "falls"}, "column": "value"}],
}  # fmt: skip
RATE: dict[str, Any] = {
    "quantity": "value", "cells": [{"table": RATES, "where": {"event": "falls"}, "column": "value"}],
}  # fmt: skip


def effort(made: dict[str, Any], number: Number, low: float | None, high: float | None) -> Effort:
    """Return what decides whether the size of a number lies between two bounds."""
    return effort_of(MadeNumber.model_validate(made), number, (low, high), "size", CONFIDENCE)


def reach(robots: int) -> float:
    """Return how far an interval over robots reaches, of a spread of 1."""
    return quantile_of(robots - 1, 0.95) / robots**0.5


def test_so_many_robots_decide_and_one_fewer_does_not() -> None:
    """A closed form: Student's quantile over the root of the robots falls below the distance from the bound."""
    number = Number(1.0, 1.0 - reach(3), 1.0 + reach(3), networks=(3, 3), walks=(6,))
    found = effort(DIFFERENCE, number, 0.0, None)
    assert found.text == "7 robots (here 3) decide the size, for the claim"
    assert reach(7) < 1.0 < reach(6)
    assert effort(DIFFERENCE, number, 2.0, None).text == "7 robots (here 3) decide the size, against the claim"
    assert not found.is_beyond


def test_more_than_a_hundred_runs_are_told_to_two_digits() -> None:
    """A number that was stored with six digits needs as many as the number itself."""
    texts = set[str]()
    for value in (1.0, 1.0000004):
        number = Number(value, value - reach(3), value + reach(3), networks=(3, 3), walks=(6,))
        texts.add(effort(DIFFERENCE, number, 0.9, None).text)
    (text,) = texts
    assert reach(390) < 0.1 < reach(380)
    assert text.startswith("390 robots (here 3) decide the size")


def test_what_costs_too_much_says_so() -> None:
    number = Number(1.0, 1.0 - reach(3), 1.0 + reach(3), networks=(3, 3), walks=(6,))
    found = effort(DIFFERENCE, number, 0.6, None)
    assert reach(16) > 0.4 > reach(27)
    assert found.is_beyond
    assert found.text.endswith(": more than is affordable")
    at_bound = effort(DIFFERENCE, number, 1.0, None)
    assert at_bound == Effort("no number of runs decides the size, as it lies at a bound", is_beyond=True)


def test_a_share_without_an_event_needs_as_many_trials_as_have_wilsons_end_below_the_bound() -> None:
    number = Number(0.0, *wilson(0.0, 18, 0.95))
    assert effort(FALLS, number, None, 0.1).text.startswith("35 independent trials (here 18) decide")
    assert wilson(0.0, 35, 0.95)[1] < 0.1 < wilson(0.0, 34, 0.95)[1]


def test_a_rate_without_an_event_needs_the_time_of_a_closed_form() -> None:
    """No event in T hours has the upper end 3.689 / T (Garwood 1936): 4 an hour need 0.92 hours."""
    number = Number(0.0, 0.0, 3.689 / 0.2)
    assert effort(RATE, number, None, 4.0).text.startswith("0.9 hours of walking (here 0.2) decide")


def test_a_ratio_and_a_cut_shrink_on_their_log_scales() -> None:
    """What a cut leaves is a ratio: both need as much."""
    ratio = Number(0.5, 0.25, 1.0, networks=(1, 1), walks=(1,))
    cut = Number(0.5, 0.0, 0.75, networks=(1, 1), walks=(1,))
    texts = [
        effort({**DIFFERENCE, "quantity": name}, number, *bounds).text
        for name, number, bounds in (("ratio", ratio, (0.4, None)), ("cut", cut, (None, 0.6)))
    ]
    assert texts[0] == texts[1]
    assert texts[0].startswith("9.6 times as much data decide")  # (ln 2 / ln 1.25)^2
    assert AFFORDABLE["times as much data"] < 9.6


def test_a_number_without_an_interval_needs_more_runs() -> None:
    assert effort(DIFFERENCE, Number(1.0), 0.0, None).text.startswith("more runs")


def test_a_claim_that_is_decided_has_nothing_to_say() -> None:
    assert text_of([], ["paper"]) == ""


def test_what_decides_size_and_sign_alike_is_said_once() -> None:
    effort = Effort("more runs decide it", is_beyond=False)
    assert text_of([effort, effort], []) == "Open: if the number stays, more runs decide it."


@pytest.mark.parametrize(
    ("ends", "verdict", "begins"),
    [
        ((1.5, 1.0, 2.0), "reproduced", ""), ((1.5, 0.9, 2.5), SIGN_AT_LEAST, "Open: if"),
        ((0.6, 0.4, 1.5), OPEN, "Open: if"), ((3.0, 2.5, 3.5), SIGN_ONLY, NO_CAUSE),
        ((0.2, 0.1, 0.3), NOT_REPRODUCED, NO_CAUSE), ((None, None, None), NOT_MEASURED, TO_MEASURE),
    ],
)  # fmt: skip
def test_every_verdict_but_a_good_one_has_a_remark(ends: tuple[float | None, ...], verdict: str, begins: str) -> None:
    """The rule of the table, for any run."""
    claim = Claim.model_validate(
        {**DIFFERENCE, "printed": "x", "says": "x", "unit": "N m", "published": None, "rule": "bar",
         "bar": [1.0, 2.0], "sign": [0.5, None]}
    )  # fmt: skip
    number = Number(*ends, networks=(3, 3), walks=(6,))
    made = judged(Row("a", "a", claim), ClaimNumbers(number, number), OURS, CONFIDENCE)
    assert (made["verdict"], bool(made["remark"])) == (verdict, bool(begins))
    assert made["remark"].startswith(begins)


def test_no_claim_of_the_configuration_is_open_or_outside_without_a_remark(settings: Settings) -> None:
    """Whatever a run finds: numbers on, beside and around the bounds, with and without an interval."""
    made = (
        Number(1.0, -3.0, 5.0, networks=(3,), walks=(6,)), Number(-2.0, -2.1, -1.9), Number(500.0, 499.0, 501.0),
        Number(0.5), Number(0.5, 0.0, 1.0), Number(None),
    )  # fmt: skip
    for row in rows_of(settings.claims):
        for number in made:
            score = score_of(row.claim, settings.methods)
            check_remark(judged(row, ClaimNumbers(number, number), score, CONFIDENCE))


def check_remark(claim: dict[str, Any]) -> None:
    """Check that what is open or outside says what would decide it, its cause or that there is none."""
    if claim["verdict"] in (NOT_REPRODUCED, SIGN_ONLY):
        assert claim["remark"] == NO_CAUSE or claim["remark"].startswith("Cause: ")
    elif claim["verdict"] == NOT_MEASURED:
        assert claim["remark"] == TO_MEASURE
    elif claim["remark"].startswith("Described, not judged: "):
        assert claim["verdict"] == DESCRIPTION
    else:
        assert claim["remark"].startswith("Open: ") == (OPEN in (claim["size"], claim["sign"])), claim["claim"]
        assert OPEN not in (claim["size"], claim["sign"]) or "decide" in claim["remark"]
