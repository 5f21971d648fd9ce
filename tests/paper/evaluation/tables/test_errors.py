"""Tables of errors: the means asked for, beside the paper's numbers, in the paper's order."""

from collections.abc import Callable
from pathlib import Path

import pandas as pd
import pytest
from csv_files import GOLDEN, check_golden, read_table, write_rows

from experiments.evaluation.number.laws import fields_of
from experiments.evaluation.number.number import Number, published_row, published_value
from experiments.evaluation.tables.layout import GAP, RULE, Line
from experiments.evaluation.tables.paper.error_table import table_lines, write_error_table
from experiments.records.scores import Score
from experiments.settings.published import Floor
from experiments.settings.settings import Settings
from experiments.settings.tables import ErrorTable
from mobnet.core.errors import DataError

Make = Callable[..., Path]
Scores = Callable[..., list[Score]]


@pytest.fixture
def table_05(tmp_path: Path, make_table: Make) -> Callable[[list[Score]], Path]:
    """Write Table 5 of some scores: table_05(scores) -> its CSV."""

    def made(scores: list[Score]) -> Path:
        write_rows(tmp_path / "scores.csv", scores)
        return make_table("table_05", tmp_path / "out", scores=[tmp_path / "scores.csv"])

    return made


def test_cells_are_means_over_runs_beside_the_printed_numbers_in_the_papers_order(
    table_05: Make, make_scores: Scores, settings: Settings
) -> None:
    every = read_table(table_05(make_scores()))
    cells, raw = ([cell for cell in every if cell.metric == metric] for metric in ("rmse", "rmse_raw"))
    further = ["zero", "MOB-fric-load", "MOB-Kalman", "MOB-Net-gray"]
    assert [(cell.level, cell.method) for cell in cells[::7]] == [
        ("ideal", "MOB"), ("sensor_noise", "MOB"),
        *(("all_uncertainty", method) for method in ("MOB", "MOB-Net", "FTS-e2e", *further)),
    ]  # fmt: skip
    assert [cell.joint for cell in cells] == [*(f"LL{i}" for i in range(1, 7)), "avg"] * 9
    assert [cell.value for cell in raw if cell.joint == "avg"][3] == pytest.approx(6.5)
    assert {cell.published for cell in raw} == {None}
    net = next(cell for cell in cells if (cell.method, cell.joint) == ("MOB-Net", "avg"))
    assert (net.value, net.networks, net.walks) == (pytest.approx(1.5), 2, 3)
    assert net.low < net.value < net.high
    for cell in cells:
        printed = published_value(settings.published.tables["table_05"], cell.level, cell.method, cell.joint)
        assert cell.published == printed


def test_increase_over_sensor_noise_stands_at_the_average_as_printed(table_05: Make, make_scores: Scores) -> None:
    text = table_05(make_scores()).with_suffix(".md").read_text()
    for printed in ("19.30 (+18.08)", "1.31 (+0.09)", "1.51 (+0.29)", "19.00 (+17.80)", "2.50 (+1.30)"):
        assert printed in text
    assert "1.22 (" not in text


def test_one_run_has_no_interval_line(table_05: Make, make_scores: Scores) -> None:
    table = table_05(make_scores(1, 1))
    assert "[" not in table.with_suffix(".md").read_text()
    assert all(cell.low is None for cell in read_table(table))


def test_a_missing_method_is_named_and_nothing_is_written(tmp_path: Path, table_05: Make, make_scores: Scores) -> None:
    with pytest.raises(DataError, match="FTS-e2e"):
        table_05([row for row in make_scores() if row.method != "FTS-e2e"])
    assert not (tmp_path / "out").exists()


def test_another_order_of_scores_makes_the_same_table(table_05: Make, make_scores: Scores) -> None:
    assert table_05(make_scores()).read_text() == table_05(make_scores()[::-1]).read_text()


def test_table_05_is_the_golden_one(make_table: Make) -> None:
    check_golden(make_table("table_05", scores=[GOLDEN / "scores.csv"]))


@pytest.mark.parametrize("name", ["table_06", "table_07", "table_08", "table_10", "table_11", "robot_parts"])
def test_tables_of_errors_are_the_golden_ones(
    name: str, make_table: Make, write_table_scores: Callable[..., list[Path]]
) -> None:
    errors = ["rmse", "rmse_pushed", *(f"rmse_push_{k}" for k in range(1, 5))]
    raw = [f"{metric}_raw" for metric in errors]
    check_golden(make_table(name, scores=write_table_scores(name, *errors, *raw, "r_rmse")))


def test_table_06_averages_joints_and_scores_hand_loads_while_they_act(
    make_table: Make, write_table_scores: Callable[..., list[Path]]
) -> None:
    table = make_table("table_06", scores=write_table_scores("table_06", "rmse", "rmse_pushed"))
    cells = {(c.scenario, c.level, c.method, c.joint): c for c in read_table(table)}
    upper = [*(f"W{k}" for k in range(1, 4)), *(f"LA{k}" for k in range(1, 9))]
    means = {"avg W+LA": upper, "avg V lin": ["V1", "V2", "V3"], "avg V ang": ["V4", "V5", "V6"]}
    for run in dict.fromkeys(key[:3] for key in cells):
        own = {key[3]: cell for key, cell in cells.items() if key[:3] == run}
        for name, joints in means.items():
            mean = sum(own[joint].value for joint in joints) / len(joints)
            assert own[name].value == pytest.approx(mean, rel=1e-5)
        assert {cell.metric for cell in own.values()} == {"rmse" if run[0] == "motion_test" else "rmse_pushed"}
        assert (own["avg V lin"].unit, own["avg V ang"].unit) == ("N", "N m")
    assert cells["hand_load_30", "all_uncertainty", "MOB-Net", "V6"].published == pytest.approx(2.68)


def test_table_11_has_a_column_a_push_and_averages_them(
    make_table: Make, write_table_scores: Callable[..., list[Path]]
) -> None:
    names = [f"rmse_push_{k}" for k in range(1, 5)]
    table = make_table("table_11", scores=write_table_scores("table_11", *names))
    *pushes, average = [cell for cell in read_table(table) if cell.method == "MOB-Net-plain"]
    assert [push.metric for push in pushes] == names
    assert average.value == pytest.approx(sum(push.value for push in pushes) / 4, rel=1e-5)
    assert (pushes[0].published, average.published) == pytest.approx((13.293, 13.431))


def test_a_run_too_short_for_a_push_leaves_a_dash_where_a_missing_run_is_refused(
    make_table: Make, write_table_scores: Callable[..., list[Path]]
) -> None:
    scores = write_table_scores("table_11", "rmse", "rmse_push_1")
    first, *others = [cell.value for cell in read_table(make_table("table_11", scores=scores))][:5]
    assert first is not None
    assert others == [None] * 4
    write_rows(scores[0], [])
    with pytest.raises(DataError, match="knee_swing"):
        make_table("table_11", scores=scores)


def test_tables_of_the_repository_label_every_row_and_find_its_printed_numbers(settings: Settings) -> None:
    for name, table in settings.evaluation.tables.items():
        for row in table.rows:
            assert len(row.labels) == len(table.header), name
            if published := settings.published.tables.get(name):
                for method in row.methods:  # `further` ones are not the paper's
                    assert published_row(published, row.paper or "", method), (name, method)


TABLE = ErrorTable.model_construct(header=("Set", "Level"))


def row(
    labels: tuple[str, ...], method: str = "MOB", *, value: float | None = 2.0, level: str = "ideal"
) -> pd.DataFrame:
    """Return the numbers of a line: W1 [N m], V1 [N] and an average [N m], one more each."""
    line = {"labels": labels, "scenario": "walk", "level": level, "method": method, "short": False, "truth": ""}
    rows: list[dict[str, object]] = []
    for k, (name, unit) in enumerate([("W1", "N m"), ("V1", "N"), ("avg", "N m")]):
        number = Number(value and value + k, 1.0, 9.0, unit, 0.5)
        rows.append({**line, "column": name, "joint": name, "metric": "rmse", **fields_of(number)})
    return pd.DataFrame(rows)


def table(*rows: pd.DataFrame) -> pd.DataFrame:
    """Return the numbers of a table, line by line."""
    return pd.concat([own.assign(line=k) for k, own in enumerate(rows)], ignore_index=True)


def lines(*rows: pd.DataFrame, floor: Floor | None = None) -> list[Line]:
    """Return the lines of text of a table."""
    return table_lines(TABLE, table(*rows), False, floor, 0.95)


def text(folder: Path, ending: str, *rows: pd.DataFrame, settings: ErrorTable = TABLE, robot: bool = False) -> str:
    """Return a table's text."""
    write_error_table(folder / "t", table(*rows), settings, robot, None, 0.95)
    return (folder / f"t.{ending}").read_text()


def test_a_label_stands_once_and_a_rule_where_the_first_changes() -> None:
    shown = lines(row(("a", "x")), row(("a", "x"), "MOB-Net"), row(("a", "y")), row(("b", "y")))
    firsts = [line if isinstance(line, str) else line[:3] for line in shown if isinstance(line, str) or line[2]]
    assert firsts == [
        ["a", "x", "MOB"], GAP, ["", "", "MOB-Net"], GAP, ["", "y", "MOB"], RULE, ["b", "y", "MOB"],
    ]  # fmt: skip


def test_ours_stands_above_the_interval_and_the_papers_number() -> None:
    ours, interval, paper = lines(row(("a", "x")))
    assert ours == ["a", "x", "MOB", "ours", "2.00", "3.00", "4.00"]
    assert interval == ["", "", "", "95%", *["[1.00, 9.00]"] * 3]
    assert paper == ["", "", "", "original", *["0.50"] * 3]


def test_errors_against_the_raw_truth_stand_above_the_papers_and_further_methods_have_no_interval() -> None:
    full = row(("a", "x"))
    raw = full.assign(truth="_raw", value=7.0)
    first = pd.concat([full, raw])
    shown = lines(first, first.assign(short=True))
    assert [line[3] for line in shown if not isinstance(line, str)] == [
        "ours", "95%", "raw truth", "original", "ours", "raw truth", "original",
    ]  # fmt: skip
    assert shown[2] == ["", "", "", "raw truth", "7.00", "7.00", "7.00"]


def test_numbers_of_a_robot_are_told_from_simulated_ones(tmp_path: Path) -> None:
    made = text(tmp_path, "md", row(("a", "x")), robot=True)
    assert "| ours, simulated | 2.00" in made
    assert "| original, robot | 0.50" in made


def test_only_averages_after_the_floor_carry_an_increase() -> None:
    floor = Floor(level="noise", method="MOB")
    rows = [row(("a", "x")), row(("a", "y"), level="noise"), row(("a", "z"), value=7.0)]
    texts = [line[-1] for line in lines(*rows, floor=floor) if line[3] in ("ours", "original")]
    assert texts == ["4.00", "0.50", "4.00", "0.50", "9.00 (+5.00)", "0.50 (+0.00)"]


def test_a_number_that_is_missing_is_a_dash() -> None:
    shown = lines(row(("a", "x"), value=None), floor=Floor(level="ideal", method="MOB"))
    assert shown[0] == ["a", "x", "MOB", "ours", "-", "-", "-"]


def test_parts_of_a_wide_table_hold_every_column_once_and_stack_intervals(tmp_path: Path) -> None:
    tex = text(tmp_path, "tex", row(("a", "x")), settings=TABLE.model_copy(update={"parts": ("V1",)}))
    heads = [line for line in tex.splitlines() if line.startswith("Set")]
    assert heads == [r"Set & Level & Method &  & W1 \\", r"Set & Level & Method &  & V1 [N] & avg \\"]
    assert r" &  &  & 95\% from & 1.00 & 1.00 \\" in tex
    assert r" &  &  & 95\% to & 9.00 & 9.00 \\" in tex
    assert "[1.00" not in tex
    assert tex.count(r"\begin{tabular}{llllr") == 2


def test_methods_may_be_called_otherwise_and_labels_be_none(tmp_path: Path) -> None:
    settings = TABLE.model_copy(update={"header": (), "names": {"MOB-Net": "MOB-Net with RTE"}})
    made = text(tmp_path, "md", row((), "MOB-Net"), row((), "MOB"), settings=settings)
    assert "| MOB-Net with RTE | ours |" in made
    assert "| MOB | ours |" in made
