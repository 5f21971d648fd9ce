"""Curves go over the rates of false alarms that thresholds have, and areas are those of a rank test."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from csv_files import check_golden, read_table
from made_detections import HOURS, write_detections
from matplotlib.colors import to_hex

from experiments.evaluation.figures.further.detection_curves import (
    area_of,
    detection_curves,
    draw_courses,
    looks_of,
    shaded,
)
from experiments.evaluation.figures.style import LOOKS
from experiments.settings.settings import Settings


def test_curves_and_areas_follow_from_the_files(settings: Settings, tmp_path: Path) -> None:
    evaluation = settings.evaluation
    section = evaluation.detection_curves.model_copy(update={"detectors": ("MOB-Net-OR", "MOB")})
    detections = write_detections(tmp_path / "detection")
    detection_curves(section, settings.detection, evaluation.statistics, detections, tmp_path)
    rows = read_table(tmp_path / "detection_curves.csv")
    found = [row for row in rows if (row.panel, row.detector) == ("found collisions", "MOB-Net-OR")]
    assert [row.x for row in found] == sorted((row.x for row in found), reverse=True)
    assert found[-1].x == 0.0  # the lowest threshold without a false alarm ends the curve
    assert all(row.x <= 1000.0 for row in found)
    forces = [row for row in rows if (row.panel, row.detector) == ("found by force", "MOB-Net-OR")]
    assert [row.value for row in forces] == [1.0] * len(forces)
    assert {row.panel for row in rows if row.unit == "ms"} == {"delay", "delay at 1/h"}
    # at the thresholds for one false alarm an hour, at the rate that was counted
    (promised,) = (row for row in rows if (row.panel, row.detector) == ("found collisions at 1/h", "MOB-Net-OR"))
    assert (promised.value, promised.x) == (1.0, pytest.approx(1.0 / HOURS))  # one of the swings lies above them
    (quiet,) = (row for row in rows if (row.panel, row.detector) == ("found without a hit", "MOB-Net-OR"))
    assert quiet.value == 1.0  # every swing between collisions lies above the paper's thresholds
    assert sum(row.panel == "area" for row in rows) == 2
    check_golden(tmp_path / "detection_curves.csv")
    assert {path.suffix for path in tmp_path.glob("detection_curves.*")} == {".csv", ".pdf", ".svg", ".png"}


def test_the_area_is_the_probability_that_a_hit_lies_higher(settings: Settings) -> None:
    statistics = settings.evaluation.statistics
    assert area_of(np.array([2.0, 3.0]), np.array([0.0, 1.0]), statistics).value == 1.0
    assert area_of(np.array([1.0, 1.0]), np.array([1.0, 1.0]), statistics).value == pytest.approx(0.5)
    held = 0
    for seed in range(200):  # normal numbers that differ by 1: the area is Phi(1 / sqrt 2)
        rng = np.random.default_rng(seed)
        number = area_of(rng.normal(1.0, 1.0, 60), rng.normal(0.0, 1.0, 300), statistics)
        assert number.low is not None
        assert number.high is not None
        held += number.low <= 0.7602 <= number.high
    assert held >= 0.90 * 200
    assert area_of(np.array([]), np.array([1.0]), statistics).value is None


def test_a_detector_has_the_look_of_its_method_and_those_of_a_method_differ(settings: Settings) -> None:
    found = looks_of(settings.evaluation.detection_curves.detectors)
    assert found["MOB-Net-ratio"] == LOOKS["MOB-Net"]
    assert found["FTS-e2e-mean"] == LOOKS["FTS-e2e"]
    same = [look for name, look in found.items() if name.startswith("MOB-Net")]
    assert len({look.marker for look in same}) == len(same) == 3
    assert found["MOB-Net-OR"].colour == shaded(LOOKS["MOB-Net"].colour, -0.35)


def test_a_shade_lies_between_a_colour_and_black_or_white() -> None:
    assert [shaded("#804020", lightness) for lightness in (-1.0, -0.5, 0.5, 1.0)] == [
        "#000000", "#402010", "#c0a090", "#ffffff",
    ]  # fmt: skip


def test_the_legend_has_all_detectors_and_the_first_and_the_last_have_their_intervals() -> None:
    points: list[dict[str, object]] = []
    for name in ("MOB", "MOB-Net-OR", "MOB-fric-dahl"):
        place = {"panel": "found collisions", "detector": name, "count": 5}
        points.append({**place, "x": 10.0, "value": 0.9, "low": 0.8, "high": 0.95})
        points.append({**place, "x": 0.0, "value": 0.5, "low": 0.4, "high": 0.6})
    figure = draw_courses(pd.DataFrame(points))
    (key,) = figure.legends
    assert [text.get_text() for text in key.get_texts()] == ["MOB", "MOB-Net-OR", "MOB-fric-dahl"]
    bands = figure.axes[0].collections
    assert [to_hex(band.get_facecolor()[0]) for band in bands] == [  # type: ignore[index]
        to_hex(LOOKS[name].colour) for name in ("MOB", "MOB-fric-dahl")
    ]
