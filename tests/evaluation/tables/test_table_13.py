"""Table 13 has the threshold of each joint beside the paper's, means over robots."""

from collections.abc import Callable
from pathlib import Path

import pytest
from csv_files import check_golden, read_table
from made_detections import write_detections


def test_thresholds_stand_beside_the_papers(make_table: Callable[..., Path], tmp_path: Path) -> None:
    table = make_table("table_13", detections=write_detections(tmp_path / "detection"))
    rows = {(row.level, row.detector, row.kind, row.cell): row for row in read_table(table)}
    knee = rows["robots", "MOB", "largest", "mean.LL4 1"]
    assert (knee.value, knee.unit, knee.published) == (pytest.approx(6.0), "N m", 111.98)
    assert rows["robots", "MOB", "collision", "mean.LL4 1"].published is None
    assert "|  | MOB | ours | 1.50 | 3.00 | 4.50 | 6.00 | 7.50 | 9.00 |" in table.with_suffix(".md").read_text()
    assert "|  |  | paper | 19.25 | 60.28 | 114.62 | 111.98 | 38.94 | 15.62 |" in table.with_suffix(".md").read_text()
    check_golden(table)
