"""What a reader sees of a frame: lines of labels, of each the numbers that columns pick."""

from pathlib import Path

import pandas as pd

from experiments.evaluation.number.laws import fields_of, number_from
from experiments.evaluation.number.number import Number
from experiments.evaluation.tables.layout import RULE
from experiments.evaluation.tables.look import ShownColumn, TableLook, column, lines_of, write_look

LABELS = {"level": "Level", "method": "Method"}


def made() -> pd.DataFrame:
    """Return rows of two methods at two levels, one of another part, and one of a part that nobody shows."""
    rows: list[dict[str, object]] = []
    for level in ("no_noise", "all"):
        for method in ("A_1", "B"):
            number = fields_of(Number(1.0, 0.5, 1.5, "N m"))
            rows.append({"level": level, "method": method, "part": "whole", "count": 3, **number})
    rows.append({"level": "all", "method": "B", "part": "swing", "count": 0, **fields_of(Number(7.0))})
    rows.append({"level": "all", "method": "hidden", "part": "other", "count": 1, **fields_of(Number(9.0))})
    return pd.DataFrame(rows)


def test_the_file_has_the_rows_and_the_text_what_columns_pick(tmp_path: Path) -> None:
    shown = [ShownColumn("whole", {"part": "whole"}, ends="95%"), ShownColumn("swing", {"part": "swing"}, digits=0)]
    columns = ("level", "method", "part", "value", "low", "high", "count", "unit")
    rows = made()
    write_look(
        tmp_path / "t", rows, columns, TableLook(LABELS, shown, blocks=("level",)), rows[rows["part"] != "swing"]
    )
    lines = (tmp_path / "t.csv").read_text().splitlines()
    assert lines[1] == "no_noise,A_1,whole,1,0.5,1.5,3,N m"
    assert lines[5] == "all,hidden,other,9,,,1,-"
    assert len(lines) == 6
    assert (tmp_path / "t.md").read_text().splitlines() == [
        "| Level | Method | whole | 95% | swing |",
        "| --- | --- | ---: | ---: | ---: |",
        "| no noise | A_1 | 1.00 | [0.50, 1.50] | - |",
        "|  | B | 1.00 | [0.50, 1.50] | - |",
        "| all | A_1 | 1.00 | [0.50, 1.50] | - |",
        "|  | B | 1.00 | [0.50, 1.50] | 7 |",
    ]


def test_rules_stand_between_blocks_and_columns_may_be_shown() -> None:
    look = TableLook(LABELS, [ShownColumn("walks", {"part": "whole"}, text=column("count"))], blocks=("level",))
    assert lines_of(made(), look)[1:4] == [["", "B", "3"], RULE, ["all", "A_1", "3"]]


def test_a_row_without_a_label_is_in_no_line() -> None:
    rows = made()
    lacking = rows.iloc[:1].assign(method=None)
    look = TableLook(LABELS, [ShownColumn("whole", {"part": "whole"})])
    assert lines_of(pd.concat([rows, lacking]), look) == lines_of(rows, look)


def test_a_number_comes_back_from_its_columns_as_it_was() -> None:
    for number in (Number(1.0, 0.5, 1.5, "N m", 2.0, (2, 1), (3,), 0.1), Number(None)):
        (row,) = pd.DataFrame([fields_of(number)]).to_dict("records")
        assert number_from(row) == number
