"""The ten statements that stand first: each has claims and a picture, and shows what the table of claims says."""

from collections import Counter
from collections.abc import Callable
from pathlib import Path

import pandas as pd
import pytest

from experiments.evaluation.number.rows import write_csv
from experiments.settings.claims import MOST_FIRST
from experiments.settings.settings import Settings
from experiments.settings.table_columns import CLAIMS


@pytest.fixture
def made(make_table: Callable[..., Path], settings: Settings, tmp_path: Path) -> pd.DataFrame:
    """The table of claims that all have a verdict and an interval."""
    number = {"value": "1.5", "low": "1.2", "high": "1.9", "unit": "-", "verdict": "open", "remark": "Too few robots."}
    rows = [{**dict.fromkeys(CLAIMS, ""), "claim": name, **number} for name in settings.claims]
    rows[0]["value"] = "7"  # of a claim that does not stand first
    write_csv(tmp_path / "all.csv", CLAIMS, [list(row.values()) for row in rows])
    return pd.read_csv(make_table("ten_first", claims_csv=tmp_path / "all.csv"), keep_default_na=False)


def test_there_are_ten_and_each_has_one_picture(settings: Settings) -> None:
    first = [claim for claim in settings.claims.values() if claim.first]
    assert {claim.first for claim in first} == {*range(1, MOST_FIRST + 1)}
    pictures = Counter(claim.first for claim in first if claim.picture)
    assert set(pictures.values()) == {1}
    assert pictures.keys() == {claim.first for claim in first}
    drawn = {*settings.evaluation.figures, *type(settings.evaluation).model_fields}
    assert {claim.picture for claim in first if claim.picture} <= drawn


def test_rows_are_those_of_the_table_of_claims_in_order(made: pd.DataFrame, settings: Settings) -> None:
    assert list(made["place"]) == sorted(made["place"])
    assert {*made["claim"]} == {name for name, claim in settings.claims.items() if claim.first}
    assert set(made["value"]) == {1.5}


def test_a_reader_sees_number_interval_verdict_and_cause(made: pd.DataFrame, tmp_path: Path) -> None:
    lines = (tmp_path / "ten_first.md").read_text().splitlines()
    assert len(lines) == 2 + len(made)
    assert "| 1.50 | [1.20, 1.90] | open | Too few robots. | [figure_05](figure_05.png) |" in lines[2]
    assert r"\addlinespace" in (tmp_path / "ten_first.tex").read_text()
