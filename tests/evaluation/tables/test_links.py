"""The confusion matrix counts what is named for what was hit."""

from collections.abc import Callable
from pathlib import Path

import pytest
from csv_files import check_golden, read_table
from made_detections import write_detections


def test_what_is_named_is_counted_for_what_was_hit(make_table: Callable[..., Path], tmp_path: Path) -> None:
    table = make_table("links", detections=write_detections(tmp_path / "detection"))
    rows = {(row.level, row.detector, row.cell, row.quantity): row for row in read_table(table)}
    assert rows["robots", "MOB-Net-OR", "knee side", "named knee side"].value == 4
    assert rows["robots", "MOB-Net-OR", "knee side", "named foot side"].value == 0
    whole = rows["robots", "MOB-Net-OR", "all", "right_link"]
    assert (whole.value, whole.count, whole.low) == (1.0, 24, pytest.approx(0.862, abs=1e-3))
    assert ("robots", "MOB", "all", "right_link") in rows
    assert rows["robots", "MOB", "all", "right_link"].value is None  # it finds nothing
    check_golden(table)
