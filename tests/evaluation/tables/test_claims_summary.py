"""Statements are counted once, by the worst verdict of their claims, and what counts against us stands first."""

from collections.abc import Callable
from pathlib import Path

import pytest
from csv_files import read_table

from mobnet.evaluation.number.files import write_csv

Made = Callable[..., dict[tuple[str, str], tuple[float, float]]]


@pytest.fixture
def made(make_table: Callable[..., Path], tmp_path: Path) -> Made:
    """Write the summary of claims (statement, score, verdict): made(*claims) -> counts."""

    def write(*claims: tuple[str, str, str]) -> dict[tuple[str, str], tuple[float, float]]:
        write_csv(tmp_path / "all.csv", ["statement", "score", "verdict"], claims)
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
    assert header.split(" | ")[1:4] == ["not reproduced", "inconclusive", "direction"]
    assert [line.split(" | ")[0].strip("| ") for line in lines] == ["observer", "learned", "sign only", "all"]
