"""Figure 20 places every network at its own size, whatever its name says."""

from collections.abc import Callable, Hashable, Sequence
from pathlib import Path
from typing import Any

import pytest
from csv_files import check_golden, read_table
from paper_settings import STATISTICS

from experiments.evaluation.figures.paper.figure_20 import figure_20, growth_line, printed_place
from experiments.evaluation.measure.learning.sizes import sizes_of
from experiments.plan.runs import SweptSize

Write = Callable[..., Path]


def rows_in(sweeps: Sequence[SweptSize]) -> list[dict[Hashable, Any]]:
    """Return the sizes as rows."""
    return sizes_of(sweeps, STATISTICS).to_dict("records")


def test_rows_rise_with_the_size_that_their_panel_varies(tmp_path: Path, write_training: Write) -> None:
    swept = [
        SweptSize(panel, base, (write_training(f"{base}-{panel}-{k}", 0, -3.0 - k, **{panel: 10000 * k}),))
        for panel in ("parameters", "samples")
        for base in ("MOB-Net", "FTS-e2e")
        for k in (2, 1)
    ]
    figure_20(swept, STATISTICS, tmp_path / "out")
    rows = read_table(tmp_path / "out/figure_20.csv")
    assert len(rows) == 8
    for panel in ("parameters", "samples"):
        for base in ("MOB-Net", "FTS-e2e"):
            own = [row for row in rows if (row.panel, row.base) == (panel, base)]
            assert [getattr(row, panel) for row in own] == [10000, 20000]
            assert [row.loss for row in own] == [-4.0, -5.0]
            assert [row.ratio for row in own] == [pytest.approx(6.0 / 5.0, rel=1e-5), 1.0]  # of the largest data
    check_golden(tmp_path / "out/figure_20.csv")
    assert (tmp_path / "out/figure_20.png").read_bytes().startswith(b"\x89PNG")


def test_a_place_is_the_mean_of_its_sound_runs(write_training: Write) -> None:
    good, lost = (
        (write_training("a", 0, -4.0), write_training("a", 1, -3.0)),
        write_training("a", 2, 9.0, diverged=True),
    )
    (size,) = rows_in([SweptSize("samples", "MOB-Net", (*good, lost))])
    assert [size[name] for name in ("runs", "loss", "loss_low", "loss_high")] == [2, -3.5, -4.0, -3.0]
    assert [size[name] for name in ("rmse_nm", "rmse_low_nm", "rmse_high_nm")] == [6.5, 6.0, 7.0]
    assert rows_in([SweptSize("samples", "MOB-Net", (lost,))]) == []


def test_the_ratio_has_an_interval_where_there_are_several_networks_and_else_none(write_training: Write) -> None:
    several = [
        SweptSize("samples", "MOB-Net", tuple(write_training(name, k, loss + 0.1 * k, samples=n) for k in range(3)))
        for name, loss, n in (("small", -3.0, 1000), ("all", -4.0, 2000))
    ]
    small, printed = rows_in(several)
    assert small["ratio"] == pytest.approx(7.1 / 6.1)
    assert small["ratio_low"] < 7.1 / 6.1
    assert printed["ratio"] == 1.0
    (alone,) = rows_in([SweptSize("samples", "MOB-Net", several[1].folders[:1])])
    assert (alone["ratio"], alone["ratio_low"]) == (1.0, None)
    sizes = sizes_of(several, STATISTICS)
    assert printed_place(sizes, "samples") == 2.0
    assert printed_place(sizes, "parameters") is None


def test_line_is_the_error_over_thousands(write_training: Write) -> None:
    folders = (write_training("a", 0, -4.0, parameters=83712),)
    sizes = sizes_of([SweptSize("parameters", "MOB-Net", folders)], STATISTICS)
    line = growth_line(sizes, "parameters", "MOB-Net")
    assert line.x == pytest.approx([83.712])
    assert [number.value for number in line.numbers] == [6.0]
    assert growth_line(sizes[:0], "parameters", "MOB-Net").x == []
