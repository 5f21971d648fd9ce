"""Statements are counted once, by the worst verdict of their claims, and what counts against us stands first."""

from collections.abc import Callable
from pathlib import Path

import pytest
from csv_files import GOLDEN, check_golden_table, read_table

from experiments.evaluation.number.rows import write_csv
from experiments.evaluation.tables.further.claims_summary import USED

Counted = dict[tuple[str, str], tuple[float, float, float]]
Made = Callable[..., Counted]
COLUMNS = (
    *("statement", "score", "verdict", "published", "value", "low", "high", "cause", "quantity", "size", "sign"),
    *("beyond_reach", "with_zero", "with_mob", "with_shuffled"),
)


@pytest.fixture
def made(make_table: Callable[..., Path], tmp_path: Path) -> Made:
    """Write the summary of claims, which have the first of `COLUMNS` or all of them: made(*claims) -> counts."""

    def write(*claims: tuple[str, ...]) -> Counted:
        rows = [dict(zip(COLUMNS, (*row, *[""] * (len(COLUMNS) - len(row))), strict=True)) for row in claims]
        write_csv(tmp_path / "all.csv", USED, [[row[name] for name in USED] for row in rows])
        found = read_table(make_table("claims_summary", claims_csv=tmp_path / "all.csv"))
        return {(row.score, row.outcome): (row.statements, row.firsts, row.claims) for row in found}

    return write


def test_a_statement_counts_once_with_the_worst_of_its_verdicts(made: Made) -> None:
    counts = made(
        ("a", "observer", "reproduced"), ("a", "observer", "sign only"), ("b", "observer", "reproduced"),
        ("c", "networks", "open"), ("c", "networks", "not reproduced"), ("d", "no number", "not measured"),
    )  # fmt: skip
    assert counts["observer", "sign only"] == (1, 0, 1)
    assert counts["observer", "reproduced"] == (1, 2, 2)
    assert counts["networks", "not reproduced"] == (1, 0, 1)
    assert counts["networks", "open"] == (0, 1, 1)
    assert counts["paper", "reproduced"] == (1, 2, 2)
    assert counts["paper", "all"] == (4, 4, 6)


def test_the_table_is_the_golden_one(make_table: Callable[..., Path]) -> None:
    check_golden_table(make_table("claims_summary", claims_csv=GOLDEN / "claims.csv"))


def test_our_own_statements_are_none_of_the_papers(made: Made) -> None:
    counts = made(("a", "observer", "reproduced"), ("b", "ours", "reproduced"), ("c", "ours", "open"))
    assert counts["paper", "all"] == (1, 1, 1)
    assert counts["ours", "all"] == (2, 2, 2)
    assert ("all", "all") not in counts


def test_what_counts_against_us_stands_first(made: Made, tmp_path: Path) -> None:
    made(("a", "observer", "reproduced"))
    header, _, *lines = (tmp_path / "claims_summary.md").read_text().splitlines()
    assert header.strip("| ").split(" | ")[-2:] == ["the original's, all", "our own"]
    titles = [line.split(" | ")[0].strip("| ") for line in lines]
    assert titles[:3] == ["not reproduced", "sign only", "open"]
    assert lines[5] == "| reproduced | 1 (1) | 0 (0) | 0 (0) | 1 (1) | 0 (0) |"


def test_a_method_that_knows_nothing_has_to_pass_all_claims_of_a_statement(made: Made, tmp_path: Path) -> None:
    rest = [""] * 9
    counts = made(
        ("a", "networks", "description", *rest, "reproduced", "open"),
        ("a", "networks", "reproduced", *rest, "not reproduced", "open"),
        ("b", "networks", "description", *rest, "reproduced", ""),
        ("c", "observer", "reproduced"),
    )  # fmt: skip
    assert counts["networks", "reproduced with zero"] == (1, 2, 2)
    assert counts["networks", "judged with zero"] == (2, 2, 3)
    assert (counts["paper", "judged with MOB"][0], counts["paper", "reproduced with MOB"][0]) == (1, 0)
    lines = (tmp_path / "claims_summary.md").read_text().splitlines()
    assert "| reproduced with zero | - | 1 of 2 | - | 1 of 2 | - |" in lines
    assert "| reproduced with MOB-Net-shuffled | - | - | - | - | - |" in lines


def test_a_statement_is_beyond_reach_if_one_of_its_open_claims_is_and_nothing_worse_decides_it(made: Made) -> None:
    beyond = (*[""] * 8, "yes")
    counts = made(
        ("a", "networks", "open", *beyond), ("a", "networks", "reproduced"), ("b", "networks", "open"),
        ("c", "networks", "open", *beyond), ("c", "networks", "not reproduced"),
    )  # fmt: skip
    assert counts["networks", "beyond reach"] == (1, 1, 1)


def test_a_statement_fails_with_a_cause_if_each_of_its_claims_that_fail_has_one(made: Made) -> None:
    cause = ("", "", "", "", "It was cold")
    counts = made(
        ("a", "networks", "not reproduced", *cause), ("a", "networks", "sign only", *cause),
        ("b", "networks", "not reproduced", *cause), ("b", "networks", "not reproduced"), ("c", "networks", "open"),
    )  # fmt: skip
    assert counts["networks", "not reproduced"] == (2, 2, 3)
    assert counts["networks", "without a cause"] == (1, 0, 1)


def test_sizes_and_signs_are_counted(made: Made) -> None:
    rest = ("", "", "", "", "", "ratio")
    counts = made(
        ("a", "networks", "reproduced", *rest, "inside", "same"),
        ("b", "networks", "sign only", *rest, "outside", "same"),
        ("b", "networks", "not reproduced", *rest, "open", "opposite"),
    )  # fmt: skip
    assert [counts["paper", f"size {word}"][2] for word in ("inside", "outside", "open")] == [1, 1, 1]
    assert [counts["paper", f"sign {word}"][2] for word in ("same", "opposite", "open")] == [2, 1, 0]


def test_the_papers_number_is_counted_where_it_lies_in_an_interval_and_where_ours_is_near(
    made: Made, tmp_path: Path
) -> None:
    counts = made(
        ("a", "observer", "reproduced", "1.0", "1.0", "0.9", "1.1"),
        ("a", "observer", "open", "1.0", "1.6", "1.1", "1.7"),
        ("b", "networks", "reproduced", "2.0", "2.5", "2.0", "3.0"), ("b", "networks", "open", "2.0", "2.0"),
        ("c", "networks", "reproduced", "0.9", "0.8", "0.7", "0.85", "", "cut"),
        ("d", "no number", "reproduced", "", "0.5", "0.0", "1.0"),
    )  # fmt: skip
    assert [counts[score, "in our interval"][2] for score in ("observer", "networks", "no number", "paper")] == [
        1,
        1,
        0,
        2,
    ]
    assert [counts[score, "within a factor of 1.5"][2] for score in ("observer", "networks", "paper")] == [1, 1, 2]
    assert counts["paper", "printed"] == (3, 3, 4)
    held, near = (tmp_path / "claims_summary.md").read_text().splitlines()[-2:]
    assert held == "| claims in our interval | 1 of 2 | 1 of 2 | - | 2 of 4 | - |"
    assert near == "| claims within a factor of 1.5 | 1 of 2 | 1 of 2 | - | 2 of 4 | - |"
