"""Rates of false alarms are counts over hours with Poisson's interval, beside what was promised."""

from collections.abc import Callable
from pathlib import Path

import pytest
from csv_files import check_golden, read_table
from made_detections import write_detections


def test_rates_are_counted_and_compared_with_what_was_promised(make_table: Callable[..., Path], tmp_path: Path) -> None:
    table = make_table("false_alarms", detections=write_detections(tmp_path / "detection"))
    rows = {(row.level, row.detector, row.kind, row.cell, row.quantity): row for row in read_table(table)}

    def number(kind: str, cell: str, quantity: str) -> tuple[float, float]:
        row = rows["robots", "MOB", kind, cell, quantity]
        return row.value, row.count

    # of 100 swings in 0.1 h one lies above the threshold; half of the threshold is that for contacts
    assert number("collision", "random", "measured") == (pytest.approx(10.0), 1)
    assert number("collision", "all", "promised") == (1.0, 100)
    assert number("contact", "random", "measured") == (pytest.approx(500.0), 50)
    assert [number("contact", f"random on {ground}", "measured")[1] for ground in ("checks", "flat")] == [25, 25]
    assert number("largest", "in place", "measured") == (0.0, 0)
    assert number("largest", "random", "measured") == (pytest.approx(1000.0), 100)
    assert number("contact", "random", "within")[0] == 0.0
    interval = rows["robots", "MOB", "largest", "in place", "measured"]
    assert (interval.low, interval.high) == (0.0, pytest.approx(36.9, abs=0.1))  # of none in 0.1 h (Garwood)
    check_golden(table)
