"""Tables of detectors: counts, delays, rates and forces follow from the files of made-up robots, beside the paper's."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from csv_files import check_golden, markdown_cells, read_table
from made_detections import write_detections

from experiments.evaluation.measure.detection.results import (
    ALL,
    CELLS,
    hits_of,
    only_one,
    sign_test,
    smallest_force,
    with_all,
)
from experiments.evaluation.number.frames import HITS, rows_of
from experiments.evaluation.tables.further.found_by_rate import chance_text, found_by_rate, gain_text
from experiments.records.collisions import READINGS
from experiments.settings.settings import Settings
from mobnet.core.detections import COLLISION, WALKING
from mobnet.core.errors import DataError

Make = Callable[..., Path]


@pytest.fixture
def made(make_table: Make, tmp_path: Path) -> Make:
    """Write a table of made-up detectors, which is the golden one: made(name) -> its CSV."""

    def write(name: str) -> Path:
        table = make_table(name, detections=write_detections(tmp_path / "detection"))
        check_golden(table)
        return table

    return write


def test_shares_delays_and_the_paper_stand_in_the_csv(made: Make) -> None:
    rows = judged_rows(made("table_09"))
    whole = rows["robots", "MOB-Net-OR", "all", "found"]
    assert (whole.value, whole.count, whole.published) == (1.0, 24, 1.0)
    assert (whole.low, whole.high) == (None, None)  # collisions in one walk of one robot
    sigma = rows["robots", "MOB-Net-sigma", "foot front", "found"]
    assert (sigma.value, sigma.count, sigma.published) == (0.5, 4, 1.0)
    # delays of 20 to 23 ms, from the first contact and from 3 ms later
    assert rows["robots", "MOB-Net-OR", "all", "delay"].value == pytest.approx(21.5)
    assert rows["robots", "MOB-Net-OR", "all", "delay_onset"].value == pytest.approx(18.5)
    assert rows["robots", "MOB-Net-OR", "all", "perfect_delay"].value == pytest.approx(15.0)
    cells = rows["robots", "MOB-Net-OR", "cells", "delay"]
    assert (cells.value, cells.published) == (pytest.approx(21.5), pytest.approx(11.9))
    assert rows["robots", "MOB", "all", "delay"].value is None
    # A sweep has 10 to 80 N: of it MOB-Net-OR finds all, MOB-Net-sigma 40 N and more, MOB nothing.
    halves = {name: rows["robots", name, "all", "half_force"] for name in ("MOB-Net-OR", "MOB-Net-sigma", "MOB")}
    assert (halves["MOB-Net-OR"].value, halves["MOB-Net-OR"].low, halves["MOB-Net-OR"].high) == (None, 10.0, None)
    assert 20.0 < (halves["MOB-Net-sigma"].value or 0.0) < 40.0
    assert (halves["MOB"].value, halves["MOB"].high, halves["MOB"].count) == (None, 80.0, 24)


def judged_rows(table: Path) -> dict[tuple[str, ...], Any]:
    """Return the rows of Table 9 by the reading that judges."""
    found: dict[tuple[str, ...], Any] = {}
    for row in read_table(table):
        if row.kind == WALKING:
            found[row.level, row.detector, row.cell, row.quantity] = row
    return found


def test_both_readings_of_normal_walking_stand_in_the_table(made: Make) -> None:
    table = made("table_09")
    kinds = {row.kind for row in read_table(table)}
    assert kinds == set(READINGS)
    levels = {line[0] for line in markdown_cells(table) if line}
    assert {"robots, random walking", "robots, in place"} <= levels


def test_the_text_has_counts_beside_the_paper(made: Make) -> None:
    table = made("table_09")
    lines, text = markdown_cells(table), table.with_suffix(".md").read_text()
    start = ["robots, random walking", "MOB-Net-sigma", "ours"]
    ours, paper = next((line, lines[k + 1]) for k, line in enumerate(lines) if line[:3] == start)
    assert ours[3:10] == ["2", "2", "2", "2", "2", "2", "12/24"]
    assert paper[3:10] == ["10", "10", "9", "10", "9", "10", "58/60"]
    assert paper[-3] == "13.5"  # the mean over detections of the paper's delays
    assert "order of the found totals against the original's: 1.00 (all uncertainty, random walking)" in text
    assert "of the forces of which half are found: 1.00 (all uncertainty, random walking)" in text
    assert ours[11] == "29"


def test_a_plant_stands_for_itself_and_robots_together(make_table: Make, tmp_path: Path) -> None:
    detections = write_detections(tmp_path / "detection", ("all_uncertainty", "robot_1", "robot_2"))
    table = make_table("table_09", detections=detections)
    rows = judged_rows(table)
    assert rows["all_uncertainty", "MOB", "all", "found"].count == 24
    robots = rows["robots", "MOB-Net-OR", "all", "found"]
    assert (robots.value, robots.count, robots.high) == (1.0, 48, 1.0)
    assert robots.low == pytest.approx(0.707)  # of two robots; Wilson's of 48 independent collisions ends at .926


def test_only_detectors_that_were_tried_are_shown(made: Make, settings: Settings) -> None:
    shown = {row.detector for row in read_table(made("table_09"))}
    assert shown == {"MOB-Net-OR", "MOB-Net-sigma", "MOB"} < set(settings.evaluation.table_09.detectors)


def test_thresholds_stand_beside_the_papers(made: Make) -> None:
    table = made("table_13")
    rows = {(row.level, row.detector, row.kind, row.cell): row for row in read_table(table)}
    knee = rows["robots", "MOB", "largest", "mean.LL4 1"]
    assert (knee.value, knee.unit, knee.published) == (pytest.approx(6.0), "N m", 111.98)
    assert rows["robots", "MOB", "collision", "mean.LL4 1"].published is None
    lines = [line[1:] for line in markdown_cells(table)]
    assert ["MOB", "random walking", "3.00", "6.00", "9.00", "12.00", "15.00", "18.00", "0.20"] in lines
    assert ["", "in place", "1.50", "3.00", "4.50", "6.00", "7.50", "9.00", "0.10"] in lines
    assert ["", "original", "19.25", "60.28", "114.62", "111.98", "38.94", "15.62", ""] in lines
    ratios = [line for line in markdown_cells(table) if line[2] == "ratio"]
    assert ratios == [["", "", "ratio", "0.08*", "0.05*", "0.04*", "0.05*", "0.19*", "0.58", ""]] * 2


def test_rates_are_counted_and_compared_with_what_was_promised(made: Make) -> None:
    table = made("false_alarms")
    rows = {(row.level, row.detector, row.kind, row.cell, row.quantity): row for row in read_table(table)}

    def number(kind: str, cell: str, quantity: str) -> tuple[float, float]:
        row = rows["robots", "MOB", kind, cell, quantity]
        return row.value, row.count

    # of 100 swings in 0.1 h one lies above the threshold; half of the threshold is that for contacts on each robot
    assert number("collision", "random", "measured") == (pytest.approx(10.0), 1)
    assert number("collision", "all", "promised") == (1.0, 100)
    assert number("contact", "random", "measured") == (pytest.approx(500.0), 50)
    assert [number("contact", f"random on {ground}", "measured")[1] for ground in ("checks", "flat")] == [25, 25]
    assert number("largest", "in place", "measured") == (0.0, 0)
    assert number("largest", "random", "measured") == (pytest.approx(1000.0), 100)
    assert number("walking", "random", "measured") == (0.0, 0)
    assert number("contact", "random", "within")[0] == 0.0
    # random walking and the swings between pushes together: 2 alarms in 200 swings
    assert number("collision", "held out", "measured") == (pytest.approx(10.0), 2)
    assert number("collision", "held out", "within") == (1.0, 200)
    # Poisson's interval of 2 in 0.2 h begins above the promised one an hour
    assert number("collision", "held out", "kept") == (0.0, 200)
    interval = rows["robots", "MOB", "largest", "in place", "measured"]
    assert (interval.low, interval.high) == (0.0, pytest.approx(36.9, abs=0.1))  # of none in 0.1 h (Garwood)


def test_rates_of_false_alarms_have_what_is_found_and_a_sentence(made: Make) -> None:
    table = made("found_by_rate")
    rows = {(row.level, row.detector, row.kind, row.quantity): row for row in read_table(table)}
    half = rows["robots", "MOB-Net-sigma", "bump", "found"]
    assert (half.value, half.count) == (0.5, 24)
    assert rows["robots", "MOB-Net-OR", "collision", "delay"].value == pytest.approx(21.5)
    sentence = (
        "Robots: whoever accepts 0.16, 1, 10 or 60 false alarms of a leg in an hour of random walking finds "
        "100.0, 100.0, 100.0 or 100.0 % of these collisions with MOB-Net-OR, the detector that finds most at 0.16"
    )
    assert sentence in table.with_suffix(".md").read_text()


@pytest.fixture
def hits(settings: Settings, tmp_path: Path) -> pd.DataFrame:
    """What detectors say of the collisions of two made-up robots."""
    section = settings.evaluation.found_by_rate.model_copy(update={"levels": ("robots",)})
    return hits_of(section, write_detections(tmp_path / "d", ("robot_1", "robot_2")), "collisions", [COLLISION])


def test_the_same_collisions_are_compared_pair_by_pair(hits: pd.DataFrame) -> None:
    first, second, third = (rows_of(hits, detector=name) for name in ("MOB-Net-OR", "MOB-Net-sigma", "MOB"))
    twelve = {"first": 12, "second": 0}
    assert only_one(first, second).to_dict("index") == {"robot_1": twelve, "robot_2": twelve}
    twelve = {"first": 0, "second": 12}
    assert only_one(third, second).to_dict("index") == {"robot_1": twelve, "robot_2": twelve}


def test_hits_have_the_columns_of_their_schema_and_cells_keep_their_order_with_all_of_them(hits: pd.DataFrame) -> None:
    assert {name: str(hits[name].dtype) for name in HITS if name not in ("detector", "kind")} == {
        name: kind for name, (kind, _, _) in HITS.items() if name not in ("detector", "kind")
    }
    every = with_all(hits)
    assert [cell for cell, _ in every.groupby("cell", observed=False)] == [*CELLS, ALL]
    assert len(rows_of(every, cell=ALL)) == len(hits)


def test_a_detector_of_a_collision_that_is_not_there_is_refused(settings: Settings, tmp_path: Path) -> None:
    detections = write_detections(tmp_path / "d", ("robot_1",))
    kept = detections["robot_1"]["collisions"].read_text().splitlines()[:-1]
    detections["robot_1"]["collisions"].write_text("\n".join(kept) + "\n")
    with pytest.raises(DataError, match=r"detected.csv: number: 24 is not accepted; accepted: collisions of walk 101"):
        hits_of(settings.evaluation.links, detections, "collisions", [COLLISION])


def test_a_difference_of_pairs_has_an_exact_probability() -> None:
    assert sign_test(0, 0) == 1.0
    assert sign_test(5, 0) == pytest.approx(2 / 32)
    assert sign_test(3, 3) == pytest.approx(1.0)
    assert chance_text(sign_test(27, 0)) == "< 0.01"


def test_pairs_and_shares_at_a_counted_rate_stand_in_the_table(settings: Settings, tmp_path: Path) -> None:
    section = settings.evaluation.found_by_rate.model_copy(update={"reference": "MOB-Net-OR"})
    found_by_rate(
        section,
        settings.detection,
        settings.evaluation.statistics,
        write_detections(tmp_path / "d", ["robot_1"]),
        tmp_path,
    )
    rows = {(row.detector, row.kind, row.cell, row.quantity): row for row in read_table(tmp_path / "found_by_rate.csv")}
    assert rows["MOB-Net-sigma", "collision", "robot_1", "reference alone"].value == 12
    assert rows["MOB-Net-sigma", "collision", "all", "this alone"].value == 0
    assert rows["MOB-Net-sigma", "collision", "all", "sign test"].value == pytest.approx(2.0**-11)
    assert rows["MOB-Net-sigma", "collision", "all", "reference's share"].value == 1.0
    assert ("MOB-Net-OR", "collision", "all", "this alone") not in rows
    # ratios of quiet swings end at 1.0098 of the threshold: at most 2 of 200 lie above it, 10 an hour in 0.2 h
    assert rows["MOB-Net-OR", "counted", "all", "found at a counted rate"].value == pytest.approx(1.0)


def test_the_sentence_names_the_best_detector_beside_the_papers() -> None:
    shares = {"other": [0.5, 0.9], "paper": [0.25, 1.0]}
    text = gain_text([1.0, 10.0], shares, "paper")
    assert "finds 50.0 or 90.0 % of these collisions with other, the detector that finds most at 1" in text
    assert text.endswith("; paper finds 25.0 or 100.0 %.")


def test_what_is_named_is_counted_for_what_was_hit(made: Make) -> None:
    table = made("links")
    rows = {(row.level, row.detector, row.cell, row.quantity): row for row in read_table(table)}
    assert rows["robots", "MOB-Net-OR", "knee side", "named knee side"].value == 4
    assert rows["robots", "MOB-Net-OR", "knee side", "named foot side"].value == 0
    whole = rows["robots", "MOB-Net-OR", "all", "right_link"]
    assert (whole.value, whole.count, whole.low) == (1.0, 24, None)
    assert ("robots", "MOB", "all", "right_link") in rows
    assert rows["robots", "MOB", "all", "right_link"].value is None  # it finds nothing


def test_forces_are_between_what_is_missed_and_what_is_found(made: Make) -> None:
    table = made("smallest_force")
    rows = {(row.level, row.kind, row.detector, row.cell): row for row in read_table(table)}
    assert rows["robots", "walking", "MOB-Net-OR", "foot front"].count == 4
    text = table.with_suffix(".md").read_text()
    assert "| MOB-Net-OR | < 10 |" in text  # it finds all, 10 N and more
    assert "| MOB | > 80 |" in text  # it finds none, 80 N or less


@pytest.mark.parametrize("half_n", [15.0, 60.0])
def test_a_known_law_is_found_and_its_interval_holds_it(settings: Settings, half_n: float) -> None:
    section, statistics = settings.evaluation.smallest_force, settings.evaluation.statistics
    wanted, held, values = half_n * 19.0 ** (1.0 / 8.0), 0, []
    for seed in range(60):
        rng = np.random.default_rng(seed)
        force = np.exp(rng.uniform(np.log(4.0), np.log(200.0), 60))
        found = rng.uniform(size=60) < 1.0 / (1.0 + (half_n / force) ** 8.0)
        number = smallest_force(force, found.astype(float), section, statistics)
        assert number.low is not None
        assert number.high is not None
        held += number.low <= wanted <= number.high
        values.append(number.value)
    assert held >= 0.90 * 60
    assert np.median(values) == pytest.approx(wanted, rel=0.15)
