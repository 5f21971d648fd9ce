"""Claims: bounds decide on the number alone, a failing claim is a row, one that could not be measured too."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
import yaml
from csv_files import read_table
from mobnet.evaluation.number.claim import Claim, read_claims

from mobnet.evaluation.number.number import Number
from mobnet.evaluation.tables.claims import VERDICTS, claims, differs, verdict_of

CLAIMS = Path(__file__).parents[3] / "configs/claims.yaml"
BRANCHES = {"MOB": 19.0, "MOB-fric": 15.0, "MOB-Net": 1.5, "FTS-e2e": 2.0, "MOB-Net-plain": 2.5}
NETWORKS = {"MOB-Net-Single": 2.0, "MOB-Net-Single-2X": 2.1}


def summary(value: float, low: float | None = None, high: float | None = None) -> Number:
    """A number, with its interval or without."""
    return Number(value, low, high, 3)


@pytest.mark.parametrize(("value", "verdict"), [(1.5, "reproduced"), (2.5, "direction only"), (9.0, "not reproduced")])
def test_verdict_follows_the_bounds_whatever_the_interval(value: float, verdict: str) -> None:
    claim = Claim("a", "", "", "value", ({},), "N m", None, (1.0, 2.0), (None, 3.0))
    assert verdict_of(summary(value), claim) == verdict_of(summary(value, -99.0, 99.0), claim) == verdict
    assert verdict_of(summary(value), replace(claim, reproduced=(None, None))) == "reproduced"
    assert verdict_of(Number(None), claim) == "not measured"


@pytest.mark.parametrize(
    ("ours", "equality", "text"),
    [
        (summary(1.2, 1.1, 1.3), 1.0, "yes"),
        (summary(0.8, 0.7, 0.9), 1.0, "yes"),
        (summary(1.2, 1.0, 1.3), 1.0, "no"),
        (summary(1.2, 1.1, 1.3), None, ""),
        (summary(1.2), 1.0, ""),
        (Number(None), 1.0, ""),
    ],
)
def test_an_interval_beyond_equality_differs(ours: Number, equality: float | None, text: str) -> None:
    assert differs(ours, equality) == text


@pytest.fixture
def judged(tmp_path: Path, config: dict[str, Any], write_results: Callable[..., Any]) -> dict[str, Any]:
    """The repository's claims on made-up results."""
    scores, folders = write_results(read_claims(CLAIMS), BRANCHES | NETWORKS)
    claims(config, CLAIMS, scores, folders, tmp_path)
    return {row.claim: row for row in read_table(tmp_path / "claims.csv")}


def test_every_claim_is_judged_and_is_a_row_of_every_file(judged: dict[str, Any], tmp_path: Path) -> None:
    known = read_claims(CLAIMS)
    assert list(judged) == [claim.name for claim in known]
    assert {row.verdict for row in judged.values()} <= set(VERDICTS[:3])
    for name, sign in (("claims.tex", " & "), ("claims.md", " | ")):
        text = (tmp_path / name).read_text()
        assert all(f"{claim.says}{sign}" in text.replace("~N\\,m", " N m") for claim in known)


def test_numbers_are_made_of_means_over_runs(judged: dict[str, Any]) -> None:
    assert judged["mob-net-cut"].value == pytest.approx(1 - 1.5 / 19.0, rel=1e-4)
    assert judged["step-fts-e2e"].value == pytest.approx(2.0 / 1.5, rel=1e-4)
    assert judged["swing-best"].value == pytest.approx(0.5, rel=1e-4)
    assert judged["upper-uncertain"].value == pytest.approx(19.0)
    assert (judged["upper-uncertain"].seed_count, judged["mob-net-cut"].seed_count) == (2, 6)
    assert judged["step-fts-e2e"].verdict == "direction only"
    assert judged["step-mob"].verdict == "reproduced"
    assert judged["gru-validation"].differs == "yes"
    assert judged["mlp-500"].verdict == "not reproduced"


def test_only_a_claim_that_fails_shows_its_cause(
    tmp_path: Path, config: dict[str, Any], write_results: Callable[..., Any]
) -> None:
    entries = yaml.safe_load(CLAIMS.read_text())
    few = {name: entries[name] | {"cause": "it was cold"} for name in ("step-fts-e2e", "step-mob")}
    (tmp_path / "c.yaml").write_text(yaml.safe_dump(few))
    scores, folders = write_results(read_claims(tmp_path / "c.yaml"), BRANCHES)
    claims(config, tmp_path / "c.yaml", scores, folders, tmp_path)
    assert [row.cause for row in read_table(tmp_path / "claims.csv")] == ["it was cold", None]
    for table in ("claims.md", "claims.tex"):
        assert (tmp_path / table).read_text().count("it was cold") == 1


def test_a_test_too_short_for_its_push_is_not_measured_and_fails_nothing(
    tmp_path: Path, config: dict[str, Any], write_results: Callable[..., Any]
) -> None:
    scores, folders = write_results(read_claims(CLAIMS), BRANCHES | NETWORKS, pushes=False)
    claims(config, CLAIMS, scores, folders, tmp_path)
    rows = {row.claim: row for row in read_table(tmp_path / "claims.csv")}
    assert (rows["step-mob"].value, rows["step-mob"].verdict) == (None, "not measured")
    assert rows["walk-mob"].verdict == "reproduced"
