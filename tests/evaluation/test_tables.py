"""Table 5: the means asked for, beside the paper's numbers, in the paper's order."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from mobnet.core.errors import DataError
from mobnet.evaluation.published import published_value, read_published
from mobnet.evaluation.rows import Cell, Score, read_rows, write_rows
from mobnet.evaluation.tables import table


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
