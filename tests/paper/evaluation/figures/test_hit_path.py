"""By which inputs a hit enters a prediction: bars with the trial's means, robots and intervals."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from csv_files import read_table

from experiments.evaluation.figures.further.hit_path import draw_paths, hit_path
from experiments.evaluation.measure.learning.explained import ALL, PATH, read_why
from experiments.evaluation.number.frames import rows_of
from experiments.evaluation.number.rows import write_csv
from experiments.settings.settings import Settings
from experiments.settings.table_columns import WHY

FLEET = ("robot_1", "robot_2")


def path_rows(method: str, inputs: str, *values: float, ends: tuple[float, float]) -> list[tuple[Any, ...]]:
    """Return the rows of what inputs bring in, of each robot and of all."""
    place = ("why_walk", method, "", PATH, inputs)
    single = [(*place, robot, 1, value, None, None, "-") for robot, value in zip(FLEET, values, strict=False)]
    return [*single, (*place, ALL, None, float(np.mean(values)), *ends, "-")]


def test_bars_have_the_mean_and_the_robots(settings: Settings, tmp_path: Path) -> None:
    kept = tmp_path / "why.csv"
    made = path_rows("MOB-Net", "all inputs", 0.3, 0.5, ends=(0.1, 0.9))
    made += path_rows("MOB-Net-noimu", "all inputs", 0.2, 0.2, ends=(-2.0, 2.0))
    made.append(("why_walk", "MOB-Net", "soap", "share", "", "robot_1", 1, 0.5, None, None, "-"))
    write_csv(kept, WHY, made)
    hit_path(settings.evaluation.hit_path, kept, tmp_path)
    assert {row.measure for row in read_table(tmp_path / "hit_path.csv")} == {PATH}
    brought = rows_of(read_why(kept), measure=PATH)
    (axis,) = draw_paths(settings.evaluation.hit_path, brought).axes
    assert [patch.get_height() for patch in axis.patches] == pytest.approx([0.4, 0.2])  # type: ignore[attr-defined]
    drawn = [np.asarray(line.get_ydata()).tolist() for line in axis.lines]
    assert [0.3, 0.5, 0.2, 0.2] in drawn
