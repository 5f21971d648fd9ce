"""Rows that are written once: the CSV file has them all, and a view shows those that its columns pick."""

from pathlib import Path

from experiments.evaluation.number.number import Number
from experiments.evaluation.tables.layout import RULE
from experiments.evaluation.tables.rows import Rows, View, ViewColumn, field_text

LABELS = {"level": "Level", "method": "Method"}


def made() -> Rows:
    """Return rows of two methods at two levels, and one that is shown only."""
    rows = Rows(("level", "method", "part", "value", "low", "high", "count", "unit"))
    for level in ("no_noise", "all"):
        for method in ("A_1", "B"):
            rows.add(Number(1.0, 0.5, 1.5, "N m"), level=level, method=method, part="whole", count=3)
    rows.show(Number(7.0), level="all", method="B", part="swing")
    rows.add(Number(9.0), level="all", method="hidden", part="other", count=1)
    return rows


def test_the_file_has_the_rows_and_the_text_what_columns_pick(tmp_path: Path) -> None:
    columns = [ViewColumn("whole", {"part": "whole"}, ends="95%"), ViewColumn("swing", {"part": "swing"}, digits=0)]
    made().write(tmp_path / "t", View(LABELS, columns, blocks=("level",)))
    lines = (tmp_path / "t.csv").read_text().splitlines()
    assert lines[1] == "no_noise,A_1,whole,1,0.5,1.5,3,N m"
    assert len(lines) == 6
    assert (tmp_path / "t.md").read_text().splitlines() == [
        "| Level | Method | whole | 95% | swing |",
        "| --- | --- | ---: | ---: | ---: |",
        "| no noise | A_1 | 1.00 | [0.50, 1.50] | - |",
        "|  | B | 1.00 | [0.50, 1.50] | - |",
        "| all | A_1 | 1.00 | [0.50, 1.50] | - |",
        "|  | B | 1.00 | [0.50, 1.50] | 7 |",
    ]


def test_rules_stand_between_blocks_and_fields_may_be_shown() -> None:
    view = View(LABELS, [ViewColumn("walks", {"part": "whole"}, text=field_text("count"))], blocks=("level",))
    assert made().lines(view)[1:4] == [["", "B", "3"], RULE, ["all", "A_1", "3"]]


def test_a_row_without_a_label_is_in_no_line() -> None:
    rows = made()
    rows.add(Number(2.0), level="all", part="whole", count=0)
    view = View(LABELS, [ViewColumn("whole", {"part": "whole"})])
    assert rows.lines(view) == made().lines(view)
    assert rows.number(level="all", part="swing").value == 7.0
    assert rows.number(level="none").value is None
