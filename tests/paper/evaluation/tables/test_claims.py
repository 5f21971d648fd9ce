"""The table of claims: every claim is a row, also one that fails or could not be measured."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from csv_files import GOLDEN, check_golden_table, read_table
from made_detections import write_detections
from paper_settings import STATISTICS

from experiments.evaluation.measure.claims.cells import listed
from experiments.evaluation.measure.claims.verdicts import rows_of
from experiments.evaluation.measure.reaction.results import printed_of
from experiments.evaluation.number.number import published_row
from experiments.evaluation.number.rows import write_csv
from experiments.evaluation.tables.further.hourly import ALL, FLAG
from experiments.evaluation.tables.further.latency import MET
from experiments.intervals.crossed import RunGrid
from experiments.intervals.quantities import QUANTITIES
from experiments.settings.claims import Cause, Cell, Claim, MadeNumber
from experiments.settings.published import Published, PublishedTable
from experiments.settings.settings import Settings
from experiments.settings.table_columns import COVERAGE, HOURLY, LATENCY
from experiments.settings.verdicts import VERDICTS

BRANCHES = {"MOB": 19.0, "MOB-fric": 15.0, "MOB-fric-load": 3.0, "MOB-Net": 1.5, "FTS-e2e": 2.0, "MOB-Net-plain": 2.5,
            "MOB-Net-noimu": 1.6, "MOB-Net-noimu-plain": 1.7, "MOB-Net-noacc": 1.5, "FTS-e2e-noimu": 2.1}  # fmt: skip
MEANS = BRANCHES | {
    "MOB-fric-dahl": 2.8,
    "MOB-Kalman": 3.2,
    "MOB-Net-Single": 2.0,
    "MOB-Net-Single-2X": 2.1,
    "MOB-Net-gray": 1.4,
    "MOB-Net-pushed": 2.2,
    "FTS-e2e-pushed": 2.6,
    "zero": 5.0,
}
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
ON_ROBOT = ("motion-mob-fric", "wrench-mob-fric")  # of these Table 8 has all methods
Judge = Callable[..., dict[str, Any]]


def test_numbers_of_the_paper_are_those_that_it_prints(settings: Settings) -> None:
    for row in rows_of(settings.claims):
        claim = row.claim
        if claim.published is not None and row.statement not in IN_WORDS:
            on_robot = row.name.startswith(ON_ROBOT)
            means = [printed(cell, settings.published, on_robot) for cell in claim.cells]
            cells = [[RunGrid(np.array([[mean]]))] for mean in means]
            value = QUANTITIES[claim.quantity](cells, STATISTICS, "-").value
            assert value == pytest.approx(claim.published, abs=0.006), row.name


def printed(cell: Cell, published: Published, on_robot: bool) -> float:
    """Return what the paper prints in a cell, from the first of its tables that has the method and the column."""
    if cell.table == "table_09":
        return detected(cell, published.tables["table_09"])
    if cell.table == "safety":
        return float(printed_of(published.section_5_4, cell.where["case"], cell.where["measure"]) or 0.0)
    joint = "+".join(listed(cell.joint or ()))
    column = "avg" if cell.scenario == "knee_swing" else COLUMNS.get(joint, joint)
    tables = PLACES[cell.scenario or ""]
    for table, place in reversed(tables) if on_robot else tables:
        row = published_row(published.tables[table], place.format(cell.level), cell.method or "")
        if row.get(column) is not None:
            return float(row[column] or 0.0)
    raise AssertionError(f"the paper prints no {column} of {cell}")


def detected(cell: Cell, table: PublishedTable) -> float:
    """Return the share of collisions that a detector of the paper finds, or its mean delay over those [ms]."""
    name, column = cell.where["detector"], cell.where["cell"]
    counts, delays = (published_row(table, place, name) for place in ("detected", "delay_ms"))
    if cell.where["quantity"] == "found":
        return float(counts[column] or 0.0) / (60 if column == "all" else 10)
    cells = [own for own in counts if own != "all"] if column == "all" else [column]
    return sum((counts[own] or 0.0) * (delays[own] or 0.0) for own in cells) / sum(counts[own] or 0.0 for own in cells)


@pytest.fixture
def judge(
    settings: Settings, make_table: Callable[..., Path], write_results: Callable[..., Any], tmp_path: Path
) -> Judge:
    """Judge claims on made-up results: judge(names of some=(), pushes=True, **changes) -> name -> row."""

    def made(names: Sequence[str] = (), pushes: bool = True, **changes: Any) -> dict[str, Any]:
        some = {name: settings.claims[name].model_copy(update=changes) for name in names or settings.claims}
        (scores,), folders = write_results(list(some.values()), MEANS, pushes)
        tables = {"coverage": write_coverage(tmp_path / "coverage.csv"), "latency": tmp_path / "latency.csv"}
        write_csv(tables["latency"], LATENCY, [(MET, 1.0, 0.7, 1.0, "-")])
        tables["hourly"] = tmp_path / "hourly.csv"
        write_csv(tables["hourly"], HOURLY, [(FLAG, ALL, "MOB-Net", 4.0, 2, 0.5, 0.06, 1.8, "1/h")])
        tables |= {name: GOLDEN / f"{name}.csv" for name in ("safety", "sensorless")}
        detections = write_detections(tmp_path / "detection")
        for name in ("table_09", "found_by_rate", "false_alarms"):
            tables[name] = make_table(name, tmp_path, detections=detections)
        table = make_table("claims", claims=some, scores=[scores], folders=folders, tables=tables)
        return {row.claim: row for row in read_table(table)}

    return made


def write_coverage(path: Path) -> Path:
    """Write a table of coverage with what claims name."""
    of = "with RTE"
    rows = [(of, "knee_swing", "all_uncertainty", name, "all", 5, 2.0, 3.0, 0.67, 0.6, 0.7)
            for name in ("nearest, median", "nearest, 95 %")]  # fmt: skip
    measures = [f"torque range given {condition} [N m]" for condition in ("phase", "position and velocity")]
    rows += [(of, "training", None, name, joint, 0, 2.0, 1.0, 2.0, 1.5, 2.5)
             for name in (*measures, "visited cells, swing") for joint in ("LL1", "LL2", "all")]  # fmt: skip
    write_csv(path, COVERAGE, rows)
    return path


def test_every_claim_is_judged_by_its_interval_and_is_a_row_of_every_file(
    judge: Judge, tmp_path: Path, settings: Settings
) -> None:
    judged = judge()
    assert list(judged) == [row.name for row in rows_of(settings.claims)]
    assert {row.verdict for row in judged.values()} <= set(VERDICTS)
    for name, sign in (("claims.tex", " & "), ("claims.md", " | ")):
        text = (tmp_path / name).read_text().replace("~N\\,m", " N m").replace(r"\%", "%")
        assert all(f"{claim.says}{sign}" in text for claim in settings.claims.values())
    assert "noise floor" not in (tmp_path / "claims.tex").read_text()
    assert judged["mob-net-cut"].value == pytest.approx(1 - 1.5 / 19.0, rel=1e-4)
    assert judged["step-fts-e2e"].value == pytest.approx(2.0 / 1.5, rel=1e-4)
    assert judged["swing-best"].value == pytest.approx(0.5, rel=1e-4)
    assert judged["upper-uncertain"].value == pytest.approx(19.0)
    assert (judged["upper-uncertain"].networks, judged["mob-net-cut"].networks, judged["mob-net-cut"].walks) == (
        1,
        "3+1",
        2,
    )
    assert (judged["step-fts-e2e"].size, judged["step-fts-e2e"].sign) == ("outside", "same")
    assert judged["step-fts-e2e"].verdict == "sign only"
    assert judged["step-mob"].verdict == "reproduced"
    assert judged["mlp-500"].verdict == "open"  # two trainings decide nothing
    assert judged["rte-coverage"].verdict == "reproduced"
    assert (judged["rte-widens"].high, judged["rte-widens"].verdict) == (2.5, "reproduced")
    assert judged["rte-plane"].verdict == "reproduced"
    assert judged["noise-floor-LL1"].statement == "noise-floor"


def test_only_a_claim_that_fails_shows_its_cause(judge: Judge, tmp_path: Path, settings: Settings) -> None:
    without = MadeNumber(quantity="ratio", cells=settings.claims["step-mob"].cells)  # 12.67
    cause = Cause(says="The cold", since="2026-11-25", seen=False, without=without)
    judged = judge(("step-fts-e2e", "step-mob"), cause=cause)
    assert judged["step-fts-e2e"].cause is None  # without it the number lies beyond the paper's on the other side
    judged = judge(("step-fts-e2e", "step-mob"), cause=cause, published=10.5)
    assert (judged["step-fts-e2e"].cause or "").startswith("The cold: 12.67 [")
    assert (judged["step-fts-e2e"].cause or "").endswith("without it (named 2026-11-25, before results had been seen).")
    assert judged["step-mob"].cause is None
    for table in ("claims.md", "claims.tex"):
        assert (tmp_path / table).read_text().count("The cold: ") == 1


def test_a_test_too_short_for_its_push_is_not_measured_and_fails_nothing(judge: Judge) -> None:
    judged = judge(pushes=False)
    assert (judged["step-mob"].value, judged["step-mob"].verdict) == (None, "not measured")
    assert judged["walk-mob-fric"].verdict == "reproduced"


def test_claims_are_the_golden_ones(
    make_table: Callable[..., Path], write_training: Callable[..., Path], tmp_path: Path
) -> None:
    losses = {"GRU": -4.0, "LSTM": -3.8, "MLP": -3.0}
    folders = [write_training(kind, seed, loss + 0.05 * seed) for kind, loss in losses.items() for seed in range(2)]
    entries = yaml.safe_load((GOLDEN / "claims.yaml").read_text())
    claims = {name: Claim.model_validate(entry) for name, entry in entries.items()}
    tables = {"coverage": tmp_path / "coverage.csv"}
    write_csv(tables["coverage"], ["joint", "ratio", "low", "high"], [("LL1", 0.9, 0.8, 1.1), ("LL2", 0.5, 0.4, 0.6)])
    scores = [GOLDEN / "scores.csv"]
    check_golden_table(make_table("claims", claims=claims, scores=scores, folders=folders, tables=tables))
