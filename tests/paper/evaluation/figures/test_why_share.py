"""The share of a hit over the error in walking: networks of the trial's table at their numbers, with apart texts."""

from itertools import pairwise
from pathlib import Path
from typing import Any

import pandas as pd
import pytest
from csv_files import read_table
from matplotlib.axes import Axes
from matplotlib.text import Annotation
from paper_settings import STATISTICS

from experiments.evaluation.figures.further.why_share import dots_of, draw_why, marks_of, why_share
from experiments.evaluation.measure.learning.explained import by_robot, over_shown_robots, read_why
from experiments.evaluation.measure.learning.taught import SHARE_OF_HIT, WALKING
from experiments.evaluation.number.rows import write_csv
from experiments.settings.settings import Settings
from experiments.settings.table_columns import WHY

FLEET = ("robot_1", "robot_2", "robot_3")
CHANGED = ("why_late", "why_dry", "why_soft", "why_law")


def rows_of(data: str, method: str, way: str, walking: float, share: float, robots: int = 2) -> list[tuple[Any, ...]]:
    """Return the rows of networks on robots of which each next one has a tenth more of both."""
    rows: list[tuple[Any, ...]] = []
    for k, robot in enumerate(FLEET[:robots]):
        for measure, value, unit in ((WALKING, walking, "N m"), (SHARE_OF_HIT, share, "-")):
            rows.append((data, method, way, measure, "", robot, 1, value * 1.1**k, None, None, unit))
    return rows


@pytest.fixture
def kept(tmp_path: Path) -> Path:
    """A table with the networks of all panels."""
    rows = rows_of("why_walk", "MOB-Net", "soap", 4.0, 0.5, robots=3)
    rows += rows_of("why_walk", "MOB-Net-noimu", "soap", 5.0, 0.8, robots=3)
    rows += rows_of("why_walk", "FTS-e2e", "noacc", 4.4, 0.1, robots=3)
    rows += rows_of("why_plain", "MOB-Net", "soap", 4.8, 0.6, robots=3)
    for data in CHANGED:
        rows += rows_of(data, "MOB-Net", "soap", 3.0, 0.4)
        rows += rows_of(data, "MOB-Net-noimu", "soap", 3.6, 0.7)
    rows += rows_of("why_walk", "MOB-Net", "longer", 3.0, 0.3)
    write_csv(tmp_path / "why.csv", WHY, rows)
    return tmp_path / "why.csv"


def test_errors_are_those_over_the_original_s_inputs_on_the_same_robots(
    settings: Settings, kept: Path, tmp_path: Path
) -> None:
    why_share(settings.evaluation.why_share, STATISTICS, kept, tmp_path)
    shown = {(row.panel, row.data, row.method, row.way): row for row in read_table(tmp_path / "why_share.csv")}
    blind = shown["inputs", "why_walk", "MOB-Net-noimu", "soap"]
    assert (blind.robots, blind.ends, blind.error_ratio) == (3, "interval", 1.25)
    assert blind.share_low < 0.8 * 1.1 < blind.share_high
    assert shown["inputs", "why_plain", "MOB-Net", "soap"].error_ratio == 1.2  # over the set with random torque
    assert shown["inputs", "why_walk", "FTS-e2e", "noacc"].network == "FTS-e2e, no acceleration"
    late = shown["drives and sensor", "why_late", "MOB-Net-noimu", "soap"]
    assert (late.robots, late.ends, late.error_ratio) == (2, "robots", 1.2)  # over the same drives and sensor
    assert (late.share_low, late.share_high) == pytest.approx((0.7, 0.77))
    assert shown["drives and sensor", "why_walk", "MOB-Net", "soap"].robots == 2  # those of the others
    assert shown["learning", "why_walk", "MOB-Net", "longer"].error_ratio == 0.75
    assert (tmp_path / "why_share.png").read_bytes().startswith(b"\x89PNG")


def test_an_interval_is_over_the_robots_unless_these_are_two(kept: Path) -> None:
    shares = by_robot(read_why(kept), SHARE_OF_HIT)
    many = next(own for cell, own in shares.items() if len(own) == len(FLEET))
    three = over_shown_robots([many], FLEET, STATISTICS)
    two = over_shown_robots([many], FLEET[:2], STATISTICS)
    assert three.low is not None
    assert three.low < min(many.values())  # Student's law with two degrees of freedom reaches beyond the robots
    assert (two.low, two.high) == (many["robot_1"], many["robot_2"])


def texts(axis: Axes) -> list[Annotation]:
    return [text for text in axis.texts if isinstance(text, Annotation)]


def test_texts_of_dots_do_not_overlap(settings: Settings, kept: Path) -> None:
    """They stand in a column right of the axis, apart also where dots lie on each other."""
    section = settings.evaluation.why_share
    rows = read_why(kept)
    numbers = by_robot(rows, WALKING), by_robot(rows, SHARE_OF_HIT)
    panels = [dots_of(section, STATISTICS, *panel, *numbers) for panel in section.panels.items()]
    figure = draw_why(section.networks, pd.concat(panels, ignore_index=True))
    figure.draw_without_rendering()
    for axis in figure.axes:
        boxes = sorted((text.get_window_extent() for text in texts(axis)), key=lambda box: box.y0)
        for below, above in pairwise(boxes):
            assert above.y0 >= below.y1 - 1.0  # pixels, of a hundred in an inch
    assert len(texts(figure.axes[1])) == 2 * len(CHANGED)


def test_networks_that_see_less_have_marks_with_less_colour(settings: Settings) -> None:
    marks = marks_of(settings.evaluation.why_share.networks)
    for method in ("MOB-Net", "FTS-e2e"):
        own = [mark for name, mark in marks.items() if name.startswith(method)]
        assert [mark["fillstyle"] for mark in own] == ["full", "left", "none"]
        assert len({(mark["marker"], mark["color"]) for mark in own}) == 1
