"""The smallest force that is found lies where collisions begin to be found; without any it lies above all."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from csv_files import check_golden, read_table
from made_detections import write_detections

from mobnet.evaluation.measure.detection.smallest_force import smallest_force
from mobnet.settings.settings import Settings


def test_forces_are_between_what_is_missed_and_what_is_found(make_table: Callable[..., Path], tmp_path: Path) -> None:
    table = make_table("smallest_force", detections=write_detections(tmp_path / "detection"))
    rows = {(row.level, row.kind, row.detector, row.cell): row for row in read_table(table)}
    assert rows["robots", "largest", "MOB-Net-OR", "foot front"].count == 4
    text = table.with_suffix(".md").read_text()
    assert "| MOB-Net-OR | < 10 |" in text  # it finds all, 10 N and more
    assert "| MOB | > 80 |" in text  # it finds none, 80 N or less
    check_golden(table)


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
