"""Tables of errors: the means asked for, beside the paper's numbers, in the paper's order."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from mobnet.core.errors import DataError
from mobnet.evaluation.number.published import published_row, published_value, read_published
from mobnet.evaluation.number.rows import Cell, Score, read_rows, write_rows
from mobnet.evaluation.tables.errors import table


def test_cells_are_means_over_runs_beside_the_printed_numbers(
    tmp_path: Path, config: dict[str, Any], scores_csv: Path
) -> None:
    table(config, "table_05", {"forward_walk": scores_csv}, tmp_path)
    cells = read_rows(tmp_path / "table_05.csv", Cell)
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
    cells = read_rows(tmp_path / "table_05.csv", Cell)
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
    write_rows(tmp_path / "one.csv", Score, make_scores(1, 1))
    table(config, "table_05", {"forward_walk": tmp_path / "one.csv"}, tmp_path)
    assert "[" not in (tmp_path / "table_05.md").read_text()
    assert all(cell.low is None for cell in read_rows(tmp_path / "table_05.csv", Cell))


def test_a_missing_method_is_named_and_nothing_is_written(
    tmp_path: Path, config: dict[str, Any], make_scores: Callable[..., list[Score]]
) -> None:
    write_rows(tmp_path / "s.csv", Score, [row for row in make_scores() if row.method != "FTS-e2e"])
    with pytest.raises(DataError, match="FTS-e2e"):
        table(config, "table_05", {"forward_walk": tmp_path / "s.csv"}, tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_table_06_averages_joints_and_scores_hand_loads_while_they_act(
    tmp_path: Path, config: dict[str, Any], write_table_scores: Callable[..., dict[str, Path]]
) -> None:
    table(config, "table_06", write_table_scores("table_06", "rmse", "rmse_pushed"), tmp_path)
    cells = {(c.scenario, c.level, c.method, c.joint): c for c in read_rows(tmp_path / "table_06.csv", Cell)}
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
    *pushes, average = [c for c in read_rows(tmp_path / "table_11.csv", Cell) if c.method == "MOB-Net-plain"]
    assert [push.metric for push in pushes] == [f"rmse_push_{k}" for k in range(1, 5)]
    assert average.value == pytest.approx(sum(push.value or 0.0 for push in pushes) / 4, rel=1e-5)
    assert (pushes[0].published, average.published) == pytest.approx((13.293, 13.431))


def test_a_run_too_short_for_a_push_leaves_a_dash_where_a_missing_run_is_refused(
    tmp_path: Path, config: dict[str, Any], write_table_scores: Callable[..., dict[str, Path]]
) -> None:
    scores = write_table_scores("table_11", "rmse", "rmse_push_1")
    table(config, "table_11", scores, tmp_path)
    values = [cell.value for cell in read_rows(tmp_path / "table_11.csv", Cell)][:5]
    assert values[0] is not None
    assert values[1:] == [None] * 4
    write_rows(scores["knee_swing"], Score, [])
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
        write_rows(tmp_path / "s.csv", Score, make_scores()[::step])
        table(config, "table_05", {"forward_walk": tmp_path / "s.csv"}, tmp_path)
        texts.append((tmp_path / "table_05.csv").read_text())
    assert texts[0] == texts[1]
