"""The table of tolerances judges every printed number within one factor, and signs as they are."""

from collections.abc import Callable
from pathlib import Path

import pytest
from csv_files import GOLDEN, check_golden_table

from experiments.evaluation.number.rows import csv_text
from experiments.evaluation.tables.further.claims_tolerance import range_within, verdict_within
from mobnet.core.files import write_text
from mobnet.core.rows import read_texts

NAMES = ("statement", "score", "quantity", "published", "from", "to", "low", "high", "sign", "verdict")


def row(*fields: str) -> dict[str, str]:
    return dict(zip(NAMES, fields, strict=True))


def test_the_table_is_the_golden_one(make_table: Callable[..., Path]) -> None:
    check_golden_table(make_table("claims_tolerance", claims_csv=GOLDEN / "claims.csv"))


def test_a_range_is_that_of_the_number_or_of_what_a_cut_leaves() -> None:
    assert range_within(row("a", "observer", "value", "2.0", "1", "4", "", "", "", "open"), 2.0) == (1.0, 4.0)
    assert range_within(row("a", "observer", "cut", "0.9", "1", "4", "", "", "", "open"), 2.0) == pytest.approx(
        (0.8, 0.95)
    )
    assert range_within(row("a", "observer", "value", "0.01", "", "0.02", "", "", "", "open"), 3.0) == (None, 0.03)


@pytest.mark.parametrize(
    ("low", "high", "sign", "verdict", "expected"),
    [
        ("1.5", "2.5", "same", "open", "reproduced"), ("3.5", "5.0", "same", "open", "sign at least"),
        ("5.0", "6.0", "same", "reproduced", "sign only"), ("1.5", "2.5", "opposite", "open", "not reproduced"),
        ("", "", "same", "open", "sign at least"), ("1.5", "2.5", "", "description", "description"),
        ("", "", "", "not measured", "not measured"),
    ],
)  # fmt: skip
def test_the_interval_decides_within_a_factor_of_two(
    low: str, high: str, sign: str, verdict: str, expected: str
) -> None:
    assert verdict_within(row("a", "networks", "value", "2.0", "1", "4", low, high, sign, verdict), 2.0) == expected


def test_a_wider_tolerance_never_reproduces_less(make_table: Callable[..., Path], tmp_path: Path) -> None:
    rows = [
        row("a", "observer", "value", "2.0", "1", "4", "2.0", "2.1", "", "reproduced"),
        row("a", "observer", "value", "2.0", "1", "4", "3.2", "3.3", "", "not reproduced"),
        row("b", "networks", "ratio", "2.0", "1", "4", "4.4", "4.6", "same", "sign only"),
        row("c", "ours", "ratio", "", "1", "4", "1.0", "2.0", "same", "reproduced"),
    ]
    write_text(tmp_path / "all.csv", csv_text(NAMES, [list(one.values()) for one in rows]))
    found = read_texts(make_table("claims_tolerance", claims_csv=tmp_path / "all.csv"))
    counts = {
        (one["tolerance"], one["outcome"]): tuple(int(one[name]) for name in ("statements", "firsts", "claims"))
        for one in found
    }
    reproduced = [counts[factor, "reproduced"][0] for factor in ("1.1", "1.25", "1.5", "2", "2.5", "3")]
    assert reproduced == [0, 0, 0, 1, 2, 2]
    assert counts["1.1", "reproduced"] == (0, 1, 1)
    assert counts["the claims' own", "sign only"] == (1, 1, 1)
