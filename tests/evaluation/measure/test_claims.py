"""Verdicts follow from intervals, statements from the worst of their claims, causes from what changes without them."""

from collections.abc import Sequence
from typing import Any

import pytest
from pydantic import ValidationError

from mobnet.core.columns import SCORED, VERDICTS
from mobnet.settings.claim_ranges import Ranges
from mobnet.evaluation.measure.claims.cells import Evidence
from mobnet.evaluation.measure.claims.verdicts import cause_of, rows_of, score_of, verdict_of, worst
from mobnet.evaluation.number.number import Number
from mobnet.settings.claims import Claim
from mobnet.settings.runs import Statistics
from mobnet.settings.settings import Settings

RANGES = Ranges((1.0, 2.0), (0.5, None))
CAUSED: dict[str, Any] = {
    "quantity": "value", "cells": ["MOB"], "printed": "x", "says": "x", "unit": "-", "published": None, "rule": "sign",
    "bar": [0.0, None], "cause": "Cold",
    "numbers": {
        name: {"quantity": "value", "cells": [{"table": "coverage", "where": {"joint": joint}, "column": "ratio"}]}
        for name, joint in (("given", "LL1"), ("without", "LL2"))
    },
}  # fmt: skip
SHOWN = "Cold: 2.00 [1.90, 2.10] with it, 1.00 [0.90, 1.10] without it."
Ends = tuple[str, str, str]


@pytest.mark.parametrize(
    ("ends", "verdict"),
    [
        ((1.0, 2.0), "reproduced"),
        ((1.5, 2.5), "direction"),
        ((3.0, 4.0), "direction"),
        ((0.4, 1.5), "inconclusive"),
        ((0.4, 0.5), "inconclusive"),
        ((0.3, 0.4), "not reproduced"),
        ((None, None), "inconclusive"),
    ],
)
def test_verdict_follows_from_the_interval(ends: tuple[float | None, float | None], verdict: str) -> None:
    """A point within the bounds decides nothing."""
    assert verdict_of(Number(1.5, *ends), RANGES) == verdict
    assert verdict_of(Number(None), RANGES) == "not measured"


@pytest.mark.parametrize(
    ("verdicts", "verdict"),
    [
        (["reproduced", "reproduced"], "reproduced"),
        (["reproduced", "direction"], "direction"),
        (["direction", "inconclusive"], "inconclusive"),
        (["inconclusive", "not measured"], "not measured"),
        (["not measured", "not reproduced", "reproduced"], "not reproduced"),
    ],
)
def test_a_statement_is_as_good_as_the_worst_of_its_claims(verdicts: Sequence[str], verdict: str) -> None:
    assert worst(verdicts) == verdict
    assert set(verdicts) <= set(VERDICTS)


def test_joints_make_claims_of_the_same_statement_without_its_bar(settings: Settings) -> None:
    claim = settings.claims["mob-uncertain"]
    whole, *joints = rows_of({"mob-uncertain": claim})
    assert (whole.name, whole.statement, whole.joint) == ("mob-uncertain", "mob-uncertain", "")
    assert [row.joint for row in joints] == list(claim.by_joint)
    for row in joints:
        assert (row.statement, row.name) == ("mob-uncertain", f"mob-uncertain-{row.joint}")
        assert (row.claim.published, row.claim.bar) == (claim.by_joint[row.joint], None)
        assert [cell.joint for cell in row.claim.cells] == [row.joint]


def test_statements_have_claims_of_one_score(settings: Settings) -> None:
    scores: dict[str, set[str]] = {}
    for row in rows_of(settings.claims):
        scores.setdefault(row.statement, set()).add(score_of(row.claim, settings.methods))
    assert {statement for statement, own in scores.items() if len(own) > 1} == set()
    assert set().union(*scores.values()) == set(SCORED)


@pytest.mark.parametrize(
    ("name", "score"),
    [("noise-floor", "observer"), ("mob-net-cut", "learned"), ("gru-validation", "sign only"), ("step-mob", "learned")],
)
def test_a_claim_counts_where_its_methods_say(name: str, score: str, settings: Settings) -> None:
    assert score_of(settings.claims[name], settings.methods) == score


@pytest.mark.parametrize(
    ("given", "without", "text"),
    [
        (("2.0", "1.9", "2.1"), ("1.0", "0.9", "1.1"), SHOWN),
        (("2.0", "1.9", "2.1"), ("1.9", "1.8", "2.0"), ""),
        (("2.0", "1.9", "2.1"), ("1.0", "", ""), ""),
        (("2.0", "", ""), ("1.0", "0.9", "1.1"), ""),
        (("2.0", "1.9", "2.1"), ("", "", ""), ""),
    ],
)
def test_a_cause_is_what_changes_the_number_when_it_is_taken_away(
    given: Ends, without: Ends, text: str, settings: Settings
) -> None:
    rows = [dict(zip(("ratio", "low", "high", "joint"), (*ends, name), strict=True))
            for name, ends in (("LL1", given), ("LL2", without))]  # fmt: skip
    results = Evidence(settings.layout, {}, {}, {}, {"coverage": rows})
    assert cause_of(Claim.model_validate(CAUSED), results, Statistics(confidence=0.95)) == text


@pytest.mark.parametrize(
    ("changes", "accepted"),
    [
        ({"numbers": {}}, "nothing is not accepted; accepted: given, without of a `cause`"),
        ({"cause": ""}, "given, without is not accepted"),
        ({"quantity": "difference", "cells": ["MOB", "zero"]}, "quantity of a cause: 'value' is not accepted"),
    ],
)
def test_a_cause_has_two_numbers_like_the_claims_own(changes: dict[str, Any], accepted: str) -> None:
    with pytest.raises(ValidationError, match=accepted):
        Claim.model_validate({**CAUSED, **changes})
