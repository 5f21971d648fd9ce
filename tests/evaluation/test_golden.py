"""Golden files: TeX of every table and numbers of every figure from frozen scores.

After a change that is meant to move them: `UPDATE_GOLDEN=1 python -m pytest tests/evaluation/test_golden.py`,
then read the diff.
"""

import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from mobnet.evaluation.claims import claims
from mobnet.evaluation.commands import commands, steps
from mobnet.evaluation.coverage import coverage
from mobnet.evaluation.data_sets import data
from mobnet.evaluation.gait import figure_05
from mobnet.evaluation.numbers import numbers
from mobnet.evaluation.spread import figure_19
from mobnet.evaluation.tables import table_05
from mobnet.evaluation.uncertainty import uncertainty

REPO = Path(__file__).parents[2]
GOLDEN = REPO / "tests/golden"


def check(produced: Path) -> None:
    """Compare a file with the golden one of its name, or make it the golden one."""
    golden = GOLDEN / produced.name
    if os.environ.get("UPDATE_GOLDEN"):
        golden.write_text(produced.read_text())
    assert produced.read_text() == golden.read_text()


@pytest.mark.parametrize("suffix", ["tex", "csv", "md"])
def test_table_05_is_the_golden_one(suffix: str, tmp_path: Path, config: dict[str, Any]) -> None:
    table_05(config, GOLDEN / "scores.csv", tmp_path)
    check(tmp_path / f"table_05.{suffix}")


def test_claims_and_numbers_are_the_golden_ones(tmp_path: Path, config: dict[str, Any]) -> None:
    table_05(config, GOLDEN / "scores.csv", tmp_path)
    claims(config, GOLDEN / "claims.yaml", GOLDEN / "scores.csv", tmp_path)
    numbers(config, tmp_path / "table_05.csv", tmp_path / "claims.csv", tmp_path / "numbers.tex")
    for name in ("claims.csv", "claims.tex", "claims.md", "numbers.tex"):
        check(tmp_path / name)


def test_figure_05_is_made_of_the_golden_numbers(
    tmp_path: Path, config: dict[str, Any], walk: Callable[..., dict[str, Any]]
) -> None:
    figure_05(config, [walk(-15.0, method="MOB"), walk(1.5)], tmp_path)
    check(tmp_path / "figure_05.csv")


def test_tables_of_the_data_are_the_golden_ones(
    tmp_path: Path, config: dict[str, Any], data_sets: dict[str, list[str]]
) -> None:
    sets = {name: data_sets[name] for name in ("walk", "motion")}
    data(config, sets, tmp_path)
    steps(config, {"walk": data_sets["walk"]}, tmp_path)
    commands(config, sets, tmp_path)
    uncertainty(config, {name: [f"{stem}_residual" for stem in stems] for name, stems in sets.items()}, tmp_path)
    tables = [f"{name}.{ending}" for name in ("data", "steps", "uncertainty") for ending in ("csv", "tex", "md")]
    for name in [*tables, "commands.csv"]:
        check(tmp_path / name)


def test_figure_19_and_coverage_are_the_golden_ones(
    tmp_path: Path, config: dict[str, Any], data_sets: dict[str, list[str]]
) -> None:
    training = {"with RTE": data_sets["walk"], "without RTE": data_sets["walk_plain"]}
    tests = [{"scenario": "walk_test", "level": "all_uncertainty", "recordings": data_sets["test"]}]
    figure_19(config, training, tests, tmp_path)
    coverage(config, training, tests, tmp_path)
    for name in ("figure_19.csv", "coverage.csv", "coverage.tex", "coverage.md"):
        check(tmp_path / name)
