"""Tables of errors: the means asked for, beside the paper's numbers, in the paper's order."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from csv_files import read_table, write_rows

from mobnet.core.columns import Score
from mobnet.core.errors import DataError
from mobnet.evaluation.measure.averages import Column
from mobnet.evaluation.number.number import Number
from mobnet.evaluation.number.published import published_row, published_value, read_published
from mobnet.evaluation.tables.errors import Look, TableRow, table, table_lines, write_error_table
from mobnet.evaluation.tables.layout import GAP, RULE


def test_cells_are_means_over_runs_beside_the_printed_numbers(
    tmp_path: Path, config: dict[str, Any], scores_csv: Path
) -> None:
    table(config, "table_05", {"forward_walk": scores_csv}, tmp_path)
    cells = read_table(tmp_path / "table_05.csv")
    entry = read_published(Path(config["published"]), "table_05")
    assert len(cells) == 5 * 7
    net = next(cell for cell in cells if (cell.method, cell.joint) == ("MOB-Net", "avg"))
    assert net.value == pytest.approx(1.5)
    assert net.seed_count == 6
    assert net.low is not None
    assert net.high is not None
    assert net.low < net.value < net.high
    for cell in cells:
        assert cell.published == published_value(entry, cell.level, cell.method, cell.joint)


def test_rows_stand_in_the_papers_order(tmp_path: Path, config: dict[str, Any], scores_csv: Path) -> None:
    table(config, "table_05", {"forward_walk": scores_csv}, tmp_path)
    cells = read_table(tmp_path / "table_05.csv")
    rows = list(dict.fromkeys((cell.level, cell.method) for cell in cells))
    assert rows == [
        ("ideal", "MOB"), ("sensor_noise", "MOB"),
        ("all_uncertainty", "MOB"), ("all_uncertainty", "MOB-Net"), ("all_uncertainty", "FTS-e2e"),
    ]  # fmt: skip
    assert [cell.joint for cell in cells[:7]] == [*(f"LL{i}" for i in range(1, 7)), "avg"]


def test_increase_over_sensor_noise_stands_at_the_average_as_printed(
    tmp_path: Path, config: dict[str, Any], scores_csv: Path
) -> None:
    table(config, "table_05", {"forward_walk": scores_csv}, tmp_path)
    text = (tmp_path / "table_05.md").read_text()
    for printed in ("19.30 (+18.08)", "1.31 (+0.09)", "1.51 (+0.29)", "19.00 (+17.80)"):
        assert printed in text
    assert "1.22 (" not in text


def test_one_run_has_no_interval_line(
    tmp_path: Path, config: dict[str, Any], make_scores: Callable[..., list[Score]]
) -> None:
    write_rows(tmp_path / "one.csv", make_scores(1, 1))
    table(config, "table_05", {"forward_walk": tmp_path / "one.csv"}, tmp_path)
    assert "[" not in (tmp_path / "table_05.md").read_text()
    assert all(cell.low is None for cell in read_table(tmp_path / "table_05.csv"))


def test_a_missing_method_is_named_and_nothing_is_written(
    tmp_path: Path, config: dict[str, Any], make_scores: Callable[..., list[Score]]
) -> None:
    write_rows(tmp_path / "s.csv", [row for row in make_scores() if row.method != "FTS-e2e"])
    with pytest.raises(DataError, match="FTS-e2e"):
        table(config, "table_05", {"forward_walk": tmp_path / "s.csv"}, tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_table_06_averages_joints_and_scores_hand_loads_while_they_act(
    tmp_path: Path, config: dict[str, Any], write_table_scores: Callable[..., dict[str, Path]]
) -> None:
    table(config, "table_06", write_table_scores("table_06", "rmse", "rmse_pushed"), tmp_path)
    cells = {(c.scenario, c.level, c.method, c.joint): c for c in read_table(tmp_path / "table_06.csv")}
    for run in dict.fromkeys(key[:3] for key in cells):
        own = {key[3]: cell for key, cell in cells.items() if key[:3] == run}
        upper = [*(f"W{k}" for k in range(1, 4)), *(f"LA{k}" for k in range(1, 9))]
        for name, joints in {
            "avg W+LA": upper,
            "avg V lin": ["V1", "V2", "V3"],
            "avg V ang": ["V4", "V5", "V6"],
        }.items():
            mean = sum(own[joint].value or 0.0 for joint in joints) / len(joints)
            assert own[name].value == pytest.approx(mean, rel=1e-5)
        assert {cell.metric for cell in own.values()} == {"rmse" if run[0] == "motion_test" else "rmse_pushed"}
        assert (own["avg V lin"].unit, own["avg V ang"].unit) == ("N", "N m")
    assert cells["hand_load_30", "all_uncertainty", "MOB-Net", "V6"].published == pytest.approx(2.68)


def test_table_11_has_a_column_a_push_and_averages_them(
    tmp_path: Path, config: dict[str, Any], write_table_scores: Callable[..., dict[str, Path]]
) -> None:
    table(config, "table_11", write_table_scores("table_11", *(f"rmse_push_{k}" for k in range(1, 5))), tmp_path)
    *pushes, average = [c for c in read_table(tmp_path / "table_11.csv") if c.method == "MOB-Net-plain"]
    assert [push.metric for push in pushes] == [f"rmse_push_{k}" for k in range(1, 5)]
    assert average.value == pytest.approx(sum(push.value or 0.0 for push in pushes) / 4, rel=1e-5)
    assert (pushes[0].published, average.published) == pytest.approx((13.293, 13.431))


def test_a_run_too_short_for_a_push_leaves_a_dash_where_a_missing_run_is_refused(
    tmp_path: Path, config: dict[str, Any], write_table_scores: Callable[..., dict[str, Path]]
) -> None:
    scores = write_table_scores("table_11", "rmse", "rmse_push_1")
    table(config, "table_11", scores, tmp_path)
    values = [cell.value for cell in read_table(tmp_path / "table_11.csv")][:5]
    assert values[0] is not None
    assert values[1:] == [None] * 4
    write_rows(scores["knee_swing"], [])
    with pytest.raises(DataError, match="knee_swing"):
        table(config, "table_11", scores, tmp_path)


def test_tables_of_the_repository_label_every_row_and_find_its_printed_numbers(config: dict[str, Any]) -> None:
    for name, spec in config["evaluation"]["tables"].items():
        entry = read_published(Path(config["published"]), name)
        for row in spec["rows"]:
            assert len(row["labels"]) == len(spec["header"]), name
            for method in row["methods"]:
                assert published_row(entry, row["paper"], method), (name, method)


def test_another_order_of_scores_makes_the_same_table(
    tmp_path: Path, config: dict[str, Any], make_scores: Callable[..., list[Score]]
) -> None:
    texts = []
    for step in (1, -1):
        write_rows(tmp_path / "s.csv", make_scores()[::step])
        table(config, "table_05", {"forward_walk": tmp_path / "s.csv"}, tmp_path)
        texts.append((tmp_path / "table_05.csv").read_text())
    assert texts[0] == texts[1]


LOOK = Look(("Set", "Level"), False, None, 0.95)


def row(labels: tuple[str, ...], method: str = "MOB", *, value: float | None = 2.0, level: str = "ideal") -> TableRow:
    """Return a row of W1 [N m], V1 [N] and an average [N m], one more each."""
    numbers = {
        Column(name, unit, ()): Number(value and value + k, 1.0, 9.0, 3, unit, 0.5)
        for k, (name, unit) in enumerate([("W1", "N m"), ("V1", "N"), ("avg", "N m")])
    }
    return TableRow(labels, ("walk", level, method), "rmse", numbers)


def text(folder: Path, ending: str, rows: list[TableRow], look: Look) -> str:
    """Return a table's text."""
    write_error_table(folder / "t", [], rows, look)
    return (folder / f"t.{ending}").read_text()


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


def test_numbers_of_a_robot_are_told_from_simulated_ones(tmp_path: Path) -> None:
    made = text(tmp_path, "md", [row(("a", "x"))], replace(LOOK, robot=True))
    assert "| ours, simulated | 2.00" in made
    assert "| paper, robot | 0.50" in made


def test_only_averages_after_the_floor_carry_an_increase() -> None:
    floor = {"level": "noise", "method": "MOB"}
    rows = [row(("a", "x")), row(("a", "y"), level="noise"), row(("a", "z"), value=7.0)]
    texts = [line[-1] for line in table_lines(rows, replace(LOOK, floor=floor)) if line[3] in ("ours", "paper")]
    assert texts == ["4.00", "0.50", "4.00", "0.50", "9.00 (+5.00)", "0.50 (+0.00)"]


def test_a_number_that_is_missing_is_a_dash() -> None:
    lines = table_lines([row(("a", "x"), value=None)], replace(LOOK, floor={"level": "ideal", "method": "MOB"}))
    assert lines[0] == ["a", "x", "MOB", "ours", "-", "-", "-"]


def test_parts_of_a_wide_table_hold_every_column_once_and_stack_intervals(tmp_path: Path) -> None:
    tex = text(tmp_path, "tex", [row(("a", "x"))], replace(LOOK, parts=("V1",)))
    heads = [line for line in tex.splitlines() if line.startswith("Set")]
    assert heads == [r"Set & Level & Method &  & W1 \\", r"Set & Level & Method &  & V1 [N] & avg \\"]
    assert r" &  &  & 95\% from & 1.00 & 1.00 \\" in tex
    assert r" &  &  & 95\% to & 9.00 & 9.00 \\" in tex
    assert "[1.00" not in tex
    assert tex.count(r"\begin{tabular}{llllr") == 2


def test_methods_may_be_called_otherwise_and_labels_be_none(tmp_path: Path) -> None:
    look = replace(LOOK, header=(), names={"MOB-Net": "MOB-Net with RTE"})
    made = text(tmp_path, "md", [row((), "MOB-Net"), row((), "MOB")], look)
    assert "| MOB-Net with RTE | ours |" in made
    assert "| MOB | ours |" in made
