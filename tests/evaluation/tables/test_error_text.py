"""How a table of errors is laid out: labels once, a rule where they change, ours above the interval and the paper's."""

from __future__ import annotations

from dataclasses import replace

from mobnet.evaluation.number.rows import Cell
from mobnet.evaluation.tables.error_text import Look, TableRow, table_lines, table_markdown, table_tex
from mobnet.evaluation.tables.layout import GAP, RULE

LOOK = Look(("Set", "Level"), False, None, 0.95)


def row(labels: tuple[str, ...], method: str = "MOB", *, value: float | None = 2.0, level: str = "ideal") -> TableRow:
    """Return a row of W1 [N m], V1 [N] and an average [N m], one more each."""
    cells = [
        Cell("walk", level, method, joint, 3, "rmse", value and value + k, 1.0, 9.0, unit, 0.5)
        for k, (joint, unit) in enumerate([("W1", "N m"), ("V1", "N"), ("avg", "N m")])
    ]
    return TableRow(labels, tuple(cells))


def test_a_label_stands_once_and_a_rule_where_the_first_changes() -> None:
    rows = [row(("a", "x")), row(("a", "x"), "MOB-Net"), row(("a", "y")), row(("b", "y"))]
    lines = table_lines(rows, LOOK)
    firsts = [line if isinstance(line, str) else line[:3] for line in lines if isinstance(line, str) or line[2]]
    assert firsts == [
        ["a", "x", "MOB"], GAP, ["", "", "MOB-Net"], GAP, ["", "y", "MOB"], RULE, ["b", "y", "MOB"],
    ]  # fmt: skip


def test_ours_stands_above_the_interval_and_the_papers_number() -> None:
    ours, interval, paper = table_lines([row(("a", "x"))], LOOK)
    assert ours == ["a", "x", "MOB", "ours", "2.00", "3.00", "4.00"]
    assert interval == ["", "", "", "95%", *["[1.00, 9.00]"] * 3]
    assert paper == ["", "", "", "paper", *["0.50"] * 3]


def test_numbers_of_a_robot_are_told_from_simulated_ones() -> None:
    text = table_markdown([row(("a", "x"))], replace(LOOK, robot=True))
    assert "| ours, simulated | 2.00" in text
    assert "| paper, robot | 0.50" in text


def test_only_averages_after_the_floor_carry_an_increase() -> None:
    floor = {"level": "noise", "method": "MOB"}
    rows = [row(("a", "x")), row(("a", "y"), level="noise"), row(("a", "z"), value=7.0)]
    texts = [line[-1] for line in table_lines(rows, replace(LOOK, floor=floor)) if line[3] in ("ours", "paper")]
    assert texts == ["4.00", "0.50", "4.00", "0.50", "9.00 (+5.00)", "0.50 (+0.00)"]


def test_a_number_that_is_missing_is_a_dash() -> None:
    lines = table_lines([row(("a", "x"), value=None)], replace(LOOK, floor={"level": "ideal", "method": "MOB"}))
    assert lines[0] == ["a", "x", "MOB", "ours", "-", "-", "-"]


def test_parts_of_a_wide_table_hold_every_column_once_and_stack_intervals() -> None:
    tex = table_tex([row(("a", "x"))], replace(LOOK, parts=("V1",)))
    heads = [line for line in tex.splitlines() if line.startswith("Set")]
    assert heads == [r"Set & Level & Method &  & W1 \\", r"Set & Level & Method &  & V1 [N] & avg \\"]
    assert r" &  &  & 95\% from & 1.00 & 1.00 \\" in tex
    assert r" &  &  & 95\% to & 9.00 & 9.00 \\" in tex
    assert "[1.00" not in tex
    assert tex.count(r"\begin{tabular}{llllr") == 2


def test_methods_may_be_called_otherwise_and_labels_be_none() -> None:
    look = replace(LOOK, header=(), names={"MOB-Net": "MOB-Net with RTE"})
    text = table_markdown([row((), "MOB-Net"), row((), "MOB")], look)
    assert "| MOB-Net with RTE | ours |" in text
    assert "| MOB | ours |" in text
