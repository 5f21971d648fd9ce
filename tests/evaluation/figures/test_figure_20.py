"""Figure 20 places every network at its own size, whatever its name says."""

from collections.abc import Callable
from pathlib import Path

import pytest
from csv_files import check_golden, read_table

from mobnet.evaluation.figures.paper.figure_20 import figure_20, growth_line, sizes_of
from mobnet.evaluation.number.number import Number
from mobnet.plan.runs import SweptSize

Write = Callable[..., Path]


def of_runs(mean: float, low: float, high: float, count: int) -> Number:
    """Return the mean of some trainings with the lowest and the highest."""
    return Number(mean, low, high, networks=(count,), walks=(1,))


def test_rows_rise_with_the_size_that_their_panel_varies(tmp_path: Path, write_training: Write) -> None:
    swept = [
        SweptSize(panel, base, (write_training(f"{base}-{panel}-{k}", 0, -3.0 - k, **{panel: 10000 * k}),))
        for panel in ("parameters", "samples")
        for base in ("MOB-Net", "FTS-e2e")
        for k in (2, 1)
    ]
    figure_20(swept, tmp_path / "out")
    rows = read_table(tmp_path / "out/figure_20.csv")
    assert len(rows) == 8
    for panel in ("parameters", "samples"):
        for base in ("MOB-Net", "FTS-e2e"):
            own = [row for row in rows if (row.panel, row.base) == (panel, base)]
            assert [getattr(row, panel) for row in own] == [10000, 20000]
            assert [row.loss for row in own] == [-4.0, -5.0]
    check_golden(tmp_path / "out/figure_20.csv")
    assert (tmp_path / "out/figure_20.png").read_bytes().startswith(b"\x89PNG")


def test_a_place_is_the_mean_of_its_sound_runs(write_training: Write) -> None:
    good, lost = (
        (write_training("a", 0, -4.0), write_training("a", 1, -3.0)),
        write_training("a", 2, 9.0, diverged=True),
    )
    (size,) = sizes_of(SweptSize("samples", "MOB-Net", (*good, lost)))
    assert (size.loss, size.rmse) == (of_runs(-3.5, -4.0, -3.0, 2), of_runs(6.5, 6.0, 7.0, 2))
    assert sizes_of(SweptSize("samples", "MOB-Net", (lost,))) == []


def test_line_is_drawn_over_thousands(write_training: Write) -> None:
    sizes = sizes_of(SweptSize("parameters", "MOB-Net", (write_training("a", parameters=83712),)))
    line = growth_line(sizes, "MOB-Net")
    assert line.x == pytest.approx([83.712])
    assert line.numbers == [of_runs(-4.0, -4.0, -4.0, 1)]
