"""Verdicts follow from intervals, statements from the worst of their claims, causes from numbers that are made."""

import re
from collections.abc import Sequence
from string import Formatter
from typing import Any

import pytest

from mobnet.core.columns import SCORED, VERDICTS
from mobnet.evaluation.measure.claims.bounds import Ranges
from mobnet.evaluation.measure.claims.cells import Evidence
from mobnet.evaluation.measure.claims.verdicts import cause_of, rows_of, score_of, verdict_of, worst
from mobnet.evaluation.number.number import Number
from mobnet.settings.claims import Claim
from mobnet.settings.evaluation import Statistics
from mobnet.settings.settings import Settings

RANGES = Ranges((1.0, 2.0), (0.5, None))
TYPED = re.compile(r"(?<![A-Za-z0-9-])\.?\d")


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


def test_no_number_is_typed_in_a_cause(settings: Settings) -> None:
    """Each is made by a rule; names of joints and methods may have digits."""
    for name, claim in settings.claims.items():
        typed = "".join(text for text, *_ in Formatter().parse(claim.cause))
        assert not TYPED.search(typed), name
        assert {field for _, field, *_ in Formatter().parse(claim.cause) if field} == claim.numbers.keys(), name


def test_a_cause_has_its_numbers_in_their_places_and_a_dash_where_there_is_none(settings: Settings) -> None:
    rows = [
        {"joint": "LL1", "ratio": "0.5", "low": "", "high": ""},
        {"joint": "LL2", "ratio": "", "low": "", "high": ""},
    ]
    results = Evidence(settings.layout, {}, {}, {}, {"coverage": rows})
    numbers: dict[str, Any] = {
        name: {"quantity": "value", "cells": [{"table": "coverage", "where": {"joint": joint}, "column": "ratio"}]}
        for name, joint in (("some", "LL1"), ("none", "LL2"), ("gone", "LL3"))
    }
    entry = {"quantity": "value", "cells": ["MOB"], "printed": "x", "says": "x", "unit": "-", "published": None}
    claim = Claim.model_validate(
        {**entry, "rule": "sign", "bar": [0.0, None], "cause": "{some:.0%}, {none:.1f}, {gone:.2f}", "numbers": numbers}
    )
    assert cause_of(claim, results, Statistics(confidence=0.95)) == "50%, -, -"
