"""Table 9 counts found collisions cell by cell, and averages delays as the paper and as a reader would."""

from collections.abc import Callable
from pathlib import Path

import pytest
from csv_files import check_golden, read_table
from made_detections import write_detections

from mobnet.settings.settings import Settings


@pytest.fixture
def table(make_table: Callable[..., Path], tmp_path: Path) -> Path:
    """The table of made-up detectors."""
    return make_table("table_09", detections=write_detections(tmp_path / "detection"))


def test_shares_delays_and_the_paper_stand_in_the_csv(table: Path) -> None:
    rows = {(row.level, row.detector, row.cell, row.quantity): row for row in read_table(table)}
    whole = rows["robots", "MOB-Net-OR", "all", "found"]
    assert (whole.value, whole.count, whole.published) == (1.0, 24, 1.0)
    assert (whole.low, whole.high) == (pytest.approx(0.862, abs=1e-3), 1.0)  # Wilson's, of 24 of 24
    sigma = rows["robots", "MOB-Net-sigma", "foot front", "found"]
    assert (sigma.value, sigma.count, sigma.published) == (0.5, 4, 1.0)
    # delays of 20 to 23 ms, from the first contact and from 3 ms later
    assert rows["robots", "MOB-Net-OR", "all", "delay"].value == pytest.approx(21.5)
    assert rows["robots", "MOB-Net-OR", "all", "delay_onset"].value == pytest.approx(18.5)
    assert rows["robots", "MOB-Net-OR", "all", "perfect_delay"].value == pytest.approx(15.0)
    cells = rows["robots", "MOB-Net-OR", "cells", "delay"]
    assert (cells.value, cells.published) == (pytest.approx(21.5), pytest.approx(11.9))
    assert rows["robots", "MOB", "all", "delay"].value is None
    check_golden(table)


def test_the_text_has_counts_beside_the_paper(table: Path) -> None:
    text = table.with_suffix(".md").read_text()
    lines = [[cell.strip() for cell in line.split("|")[1:-1]] for line in text.splitlines()]
    ours, paper = next(
        (line, lines[k + 1]) for k, line in enumerate(lines) if line[:3] == ["robots", "MOB-Net-sigma", "ours"]
    )
    assert ours[3:10] == ["2", "2", "2", "2", "2", "2", "12/24"]
    assert paper[3:10] == ["10", "10", "9", "10", "9", "10", "58/60"]
    assert paper[-3] == "13.5"  # the mean over detections of the paper's delays
    assert "Kendall's tau of the order of the found totals against the paper's: 1.00 (all uncertainty)" in text


def test_a_plant_stands_for_itself_and_robots_together(make_table: Callable[..., Path], tmp_path: Path) -> None:
    detections = write_detections(tmp_path / "detection", ("all_uncertainty", "robot_1", "robot_2"))
    table = make_table("table_09", detections=detections)
    rows = {(row.level, row.detector, row.cell, row.quantity): row.count for row in read_table(table)}
    assert rows["all_uncertainty", "MOB", "all", "found"] == 24
    assert rows["robots", "MOB", "all", "found"] == 48


def test_only_detectors_that_were_tried_are_shown(table: Path, settings: Settings) -> None:
    shown = {row.detector for row in read_table(table)}
    assert shown == {"MOB-Net-OR", "MOB-Net-sigma", "MOB"} < set(settings.evaluation.table_09.detectors)
