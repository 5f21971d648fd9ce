"""Claims: bounds decide on the number alone, a failing claim is a row, one that could not be measured too."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from csv_files import GOLDEN, check_golden, read_table

from mobnet.core.columns import VERDICTS
from mobnet.evaluation.measure.metrics import METRICS, PUSH, PUSHED
from mobnet.evaluation.measure.results import listed
from mobnet.evaluation.measure.trainings import MEASURES
from mobnet.evaluation.number.number import Number, published_row
from mobnet.evaluation.number.quantities import QUANTITIES
from mobnet.evaluation.tables.claims import differs, inside, rule_text, verdict_of
from mobnet.settings.claims import Cell, Claim
from mobnet.settings.published import Published
from mobnet.settings.settings import Settings

BRANCHES = {"MOB": 19.0, "MOB-fric": 15.0, "MOB-Net": 1.5, "FTS-e2e": 2.0, "MOB-Net-plain": 2.5}
MEANS = BRANCHES | {"MOB-Net-Single": 2.0, "MOB-Net-Single-2X": 2.1}
PLACES = {  # scenario -> tables of the paper and places of its methods there
    "forward_walk": [("table_05", "{}")],
    "hip_pitch_step": [("figure_06", "{}")],
    "motion_test": [("table_06", "collision_free_motion.{}"), ("table_08", "collision_free_motion")],
    "hand_load_10": [("table_06", "left_hand_load_10n.{}")],
    "hand_load_30": [("table_06", "left_hand_load_30n.{}")],
    "walk_test": [("table_07", "rmse_nm"), ("table_10", "rmse_nm")],
    "knee_swing": [("table_11", "rmse_nm"), ("figure_10", "knee_swing")],
    "hand_wrench": [("table_08", "external_wrench_on_hand")],
}
COLUMNS = {"LL": "avg", "W+LA": "avg W+LA", "W+RA": "avg W+RA", "V1+V2+V3": "avg V lin", "V4+V5+V6": "avg V ang"}
IN_WORDS = {"support-mob-net-growth", "support-fts-e2e-growth"}  # "approximately 1 Nm"
IN_WORDS |= {"size-mob-net", "size-fts-e2e", "data-mob-net", "data-fts-e2e"}  # "decreases as"
Judge = Callable[..., dict[str, Any]]


def test_bounds_of_a_claim_lie_within_each_other_and_hold_what_the_paper_prints(settings: Settings) -> None:
    for name, claim in settings.claims.items():
        (low, high), (lowest, highest) = claim.reproduced, claim.direction
        assert lowest is None or (low is not None and low >= lowest), name
        assert highest is None or (high is not None and high <= highest), name
        assert claim.published is None or inside(claim.published, claim.reproduced), name
        if claim.published is not None and name not in IN_WORDS:
            means = np.array([printed(cell, settings.published) for cell in claim.cells])
            assert QUANTITIES[claim.quantity].made(means) == pytest.approx(claim.published, abs=0.006), name


def printed(cell: Cell, published: Published) -> float:
    """Return what the paper prints in a cell, from the first of its tables that has the method and the column."""
    joint = "+".join(listed(cell.joint or ()))
    column = "avg" if cell.scenario == "knee_swing" else COLUMNS.get(joint, joint)
    for table, place in PLACES[cell.scenario or ""]:
        row = published_row(published.tables[table], place.format(cell.level), cell.method or "")
        if row.get(column) is not None:
            return float(row[column] or 0.0)
    raise AssertionError(f"the paper prints no {column} of {cell}")


def test_every_metric_of_a_claim_is_one_that_is_made(settings: Settings) -> None:
    known = {*METRICS, *MEASURES, PUSHED, *(PUSH.format(k) for k in range(1, 7))}
    cells = [cell for claim in settings.claims.values() for cell in claim.cells]
    assert known.issuperset(name for cell in cells for name in listed(cell.metric or ()))


def test_bounds_are_closed_and_read_aloud() -> None:
    assert inside(1.0, (1.0, 1.0))
    assert not inside(1.01, (None, 1.0))
    assert inside(-9.0, (None, 1.0))
    bounds = [(None, 2.0), (1.0, None), (1.0, 2.5), (None, None)]
    assert [rule_text(each) for each in bounds] == ["at most 2", "at least 1", "1 to 2.5", "any"]


@pytest.mark.parametrize(("value", "verdict"), [(1.5, "reproduced"), (2.5, "direction only"), (9.0, "not reproduced")])
def test_verdict_follows_the_bounds_whatever_the_interval(value: float, verdict: str) -> None:
    claim = Claim.model_construct(reproduced=(1.0, 2.0), direction=(None, 3.0))
    assert verdict_of(Number(value), claim) == verdict_of(Number(value, -99.0, 99.0), claim) == verdict
    assert verdict_of(Number(value), claim.model_copy(update={"reproduced": (None, None)})) == "reproduced"
    assert verdict_of(Number(None), claim) == "not measured"


@pytest.mark.parametrize(
    ("ours", "equality", "text"),
    [
        (Number(1.2, 1.1, 1.3), 1.0, "yes"),
        (Number(0.8, 0.7, 0.9), 1.0, "yes"),
        (Number(1.2, 1.0, 1.3), 1.0, "no"),
        (Number(1.2, 1.1, 1.3), None, ""),
        (Number(1.2), 1.0, ""),
        (Number(None), 1.0, ""),
    ],
)
def test_an_interval_beyond_equality_differs(ours: Number, equality: float | None, text: str) -> None:
    assert differs(ours, equality) == text


@pytest.fixture
def judge(settings: Settings, make_table: Callable[..., Path], write_results: Callable[..., Any]) -> Judge:
    """Judge claims on made-up results: judge(names of some=(), pushes=True, **changes) -> name -> row."""

    def made(names: Sequence[str] = (), pushes: bool = True, **changes: Any) -> dict[str, Any]:
        some = {name: settings.claims[name].model_copy(update=changes) for name in names or settings.claims}
        (scores,), folders = write_results(list(some.values()), MEANS, pushes)
        table = make_table("claims", claims=some, scores={"all": scores}, folders=folders)
        return {row.claim: row for row in read_table(table)}

    return made


def test_every_claim_is_judged_by_means_over_runs_and_is_a_row_of_every_file(
    judge: Judge, tmp_path: Path, settings: Settings
) -> None:
    judged = judge()
    assert list(judged) == list(settings.claims)
    assert {row.verdict for row in judged.values()} <= set(VERDICTS[:3])
    for name, sign in (("claims.tex", " & "), ("claims.md", " | ")):
        text = (tmp_path / name).read_text().replace("~N\\,m", " N m")
        assert all(f"{claim.says}{sign}" in text for claim in settings.claims.values())
    assert judged["mob-net-cut"].value == pytest.approx(1 - 1.5 / 19.0, rel=1e-4)
    assert judged["step-fts-e2e"].value == pytest.approx(2.0 / 1.5, rel=1e-4)
    assert judged["swing-best"].value == pytest.approx(0.5, rel=1e-4)
    assert judged["upper-uncertain"].value == pytest.approx(19.0)
    assert (judged["upper-uncertain"].seed_count, judged["mob-net-cut"].seed_count) == (2, 6)
    assert judged["step-fts-e2e"].verdict == "direction only"
    assert judged["step-mob"].verdict == "reproduced"
    assert judged["gru-validation"].differs == "yes"
    assert judged["mlp-500"].verdict == "not reproduced"


def test_only_a_claim_that_fails_shows_its_cause(judge: Judge, tmp_path: Path) -> None:
    judged = judge(("step-fts-e2e", "step-mob"), cause="it was cold")
    assert [row.cause for row in judged.values()] == ["it was cold", None]
    for table in ("claims.md", "claims.tex"):
        assert (tmp_path / table).read_text().count("it was cold") == 1


def test_a_test_too_short_for_its_push_is_not_measured_and_fails_nothing(judge: Judge) -> None:
    judged = judge(pushes=False)
    assert (judged["step-mob"].value, judged["step-mob"].verdict) == (None, "not measured")
    assert judged["walk-mob"].verdict == "reproduced"


def test_claims_are_the_golden_ones(make_table: Callable[..., Path], write_training: Callable[..., Path]) -> None:
    losses = {"GRU": -4.0, "LSTM": -3.8, "MLP": -3.0}
    folders = [write_training(kind, seed, loss + 0.05 * seed) for kind, loss in losses.items() for seed in range(2)]
    entries = yaml.safe_load((GOLDEN / "claims.yaml").read_text())
    claims = {name: Claim.model_validate(entry) for name, entry in entries.items()}
    check_golden(make_table("claims", claims=claims, scores={"all": GOLDEN / "scores.csv"}, folders=folders))
