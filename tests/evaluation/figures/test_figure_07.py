"""Figure 7 shows the seconds and joints asked for, each with its unit."""

from __future__ import annotations

import csv
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from mobnet.evaluation.figures.figure_07 import figure_07

JOINTS = ["W2", "V3"]


def test_panels_hold_every_fifth_sample_of_the_stretch(
    tmp_path: Path, walk: Callable[..., dict[str, Any]], config: dict[str, Any]
) -> None:
    figure_07(config, [walk(-15.0, method="MOB", joints=JOINTS), walk(2.0, joints=JOINTS, std=0.5)], tmp_path)
    assert (tmp_path / "figure_07.pdf").read_bytes().startswith(b"%PDF")
    with (tmp_path / "figure_07.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert list(dict.fromkeys(row["panel"] for row in rows)) == ["W2 [N m]", "V3 [N]"]
    assert [float(row["time_s"]) for row in rows[:10]] == pytest.approx([0.5 + 0.05 * k for k in range(10)])
    assert len(rows) == 2 * 10
    for row in rows:
        assert float(row["MOB-Net"]) - float(row["truth"]) == pytest.approx(2.0, abs=1e-3)
        assert float(row["MOB-Net std"]) == 0.5
