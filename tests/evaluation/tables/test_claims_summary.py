"""Statements are counted once, by the worst verdict of their claims, and what counts against us stands first."""

from collections.abc import Callable
from pathlib import Path

import pytest
from csv_files import read_table

from mobnet.evaluation.number.files import write_csv
from mobnet.evaluation.tables.further.claims_summary import USED

Made = Callable[..., dict[tuple[str, str], tuple[float, float]]]


@pytest.fixture
def made(make_table: Callable[..., Path], tmp_path: Path) -> Made:
    """Write the summary of claims, which have the first columns or all of `USED`: made(*claims) -> counts."""

    def write(*claims: tuple[str, ...]) -> dict[tuple[str, str], tuple[float, float]]:
        write_csv(tmp_path / "all.csv", USED, [(*row, *[""] * (len(USED) - len(row))) for row in claims])
        rows = read_table(make_table("claims_summary", claims_csv=tmp_path / "all.csv"))
        return {(row.score, row.outcome): (row.statements, row.claims) for row in rows}

    return write


def test_a_statement_counts_once_with_the_worst_of_its_verdicts(made: Made) -> None:
    counts = made(
        ("a", "observer", "reproduced"), ("a", "observer", "direction"), ("b", "observer", "reproduced"),
        ("c", "learned", "inconclusive"), ("c", "learned", "not reproduced"), ("d", "sign only", "not measured"),
    )  # fmt: skip
    assert counts["observer", "direction"] == (1, 1)
    assert counts["observer", "reproduced"] == (1, 2)
    assert counts["learned", "not reproduced"] == (1, 1)
    assert counts["learned", "inconclusive"] == (0, 1)
    assert counts["all", "reproduced"] == (1, 2)
    assert counts["all", "all"] == (4, 6)


def test_what_counts_against_us_stands_first(made: Made, tmp_path: Path) -> None:
    made(("a", "observer", "reproduced"))
    header, _, *lines = (tmp_path / "claims_summary.md").read_text().splitlines()
    assert header.split(" | ")[1:5] == ["not reproduced", "of these without a cause", "inconclusive", "direction"]
    assert [line.split(" | ")[0].strip("| ") for line in lines] == ["observer", "learned", "sign only", "all"]


def test_a_statement_that_fails_has_a_cause_if_one_of_its_claims_has_one(made: Made) -> None:
    counts = made(
        ("a", "learned", "not reproduced"), ("a", "learned", "not reproduced", "", "", "", "It was cold"),
        ("b", "learned", "not reproduced"), ("b", "learned", "direction"), ("c", "learned", "direction"),
    )  # fmt: skip
    assert counts["learned", "not reproduced"] == (2, 3)
    assert counts["learned", "without a cause"] == (1, 1)


def test_the_papers_number_is_counted_where_it_lies_in_an_interval(made: Made, tmp_path: Path) -> None:
    counts = made(
        ("a", "observer", "reproduced", "1.0", "0.9", "1.1"), ("a", "observer", "direction", "1.0", "1.1", "1.2"),
        ("b", "learned", "reproduced", "2.0", "2.0", "3.0"), ("b", "learned", "inconclusive", "2.0"),
        ("c", "sign only", "reproduced", "", "0.0", "1.0"),
    )  # fmt: skip
    assert [counts[score, "inside"][1] for score in ("observer", "learned", "sign only", "all")] == [1, 1, 0, 2]
    assert counts["all", "printed"] == (2, 3)
    assert "| 2 of 3 |" in (tmp_path / "claims_summary.md").read_text().splitlines()[-1]
