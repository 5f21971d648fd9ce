"""Rows survive a round trip, and a damaged file is named."""

from collections.abc import Callable
from pathlib import Path

import pytest
from csv_files import write_rows

from experiments.evaluation.number.number import Number
from experiments.evaluation.number.rows import read_numbers, write_csv
from experiments.records.scores import Score
from experiments.settings.table_columns import ERRORS
from mobnet.core.errors import DataError
from mobnet.core.rows import read_rows

ROW = ("walk", "ideal", "MOB", "LL1", "rmse", 0.25, None, None, "1", "1", None, None, "N m", None)


def test_rows_survive_a_round_trip(tmp_path: Path, make_scores: Callable[..., list[Score]]) -> None:
    write_rows(tmp_path / "a.csv", make_scores())
    once = read_rows(tmp_path / "a.csv", Score)
    write_rows(tmp_path / "b.csv", once)
    assert read_rows(tmp_path / "b.csv", Score) == once
    assert [row.value for row in once] == pytest.approx([row.value for row in make_scores()], rel=1e-5)


def test_none_is_an_empty_field_and_comes_back_as_none(tmp_path: Path) -> None:
    """Writing and reading are a round trip."""
    write_csv(tmp_path / "a.csv", ERRORS, [ROW])
    assert (tmp_path / "a.csv").read_text().splitlines()[1] == "walk,ideal,MOB,LL1,rmse,0.25,,,1,1,,,N m,"
    ((of, number),) = read_numbers(tmp_path / "a.csv")
    assert (of["joint"], number) == ("LL1", Number(0.25, unit="N m"))


def test_the_sign_of_zero_does_not_reach_a_file(tmp_path: Path) -> None:
    write_csv(tmp_path / "a.csv", ["x"], [[-0.0]])
    assert (tmp_path / "a.csv").read_text() == "x\n0\n"


@pytest.mark.parametrize(
    ("damage", "says"),
    [
        (lambda text: text.replace("value", "wert"), "column 'value' is missing"),
        (lambda text: text.replace("0.25", "abc"), "'abc' is not accepted"),
        (lambda text: text.replace("ideal,MOB,LL1,rmse,0.25,,,1,1,,,N m,", "ideal"), "cut off"),
    ],
)
def test_damage_is_named(tmp_path: Path, damage: Callable[[str], str], says: str) -> None:
    path = tmp_path / "a.csv"
    write_csv(path, ERRORS, [ROW])
    path.write_text(damage(path.read_text()))
    with pytest.raises(DataError, match=says):
        read_numbers(path)


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(DataError, match=r"none\.csv: file is missing"):
        read_rows(tmp_path / "none.csv", Score)
