"""The share of a long push that is held is drawn over time, in swing and in stance."""

from collections.abc import Callable
from pathlib import Path

import pytest
from csv_files import check_golden, read_table

from mobnet.evaluation.figures.further.drift import drift
from mobnet.settings.evaluation import Evaluation, LimbRuns
from mobnet.settings.settings import Settings


def test_bins_stand_at_the_middle_of_their_time_and_those_without_a_phase_are_left_out(
    tmp_path: Path, settings: Settings, evaluation: Evaluation, write_measured: Callable[..., list[Path]]
) -> None:
    name, test = next(iter(evaluation.drift.tests.items()))
    test = test.model_copy(update={"methods": ("MOB", "MOB-Net")})
    section = evaluation.drift.model_copy(update={"tests": {name: test}})
    runs = LimbRuns(scenario=test.scenario, level=test.level, methods=test.methods, limbs=(section.limb,))
    metrics = {"held_swing_1": (0.9, "-"), "held_swing_3": (0.6, "-"), "held_stance_2": (-0.2, "-")}
    drift(section, evaluation.statistics, write_measured([runs], metrics), tmp_path)
    rows = read_table(tmp_path / "drift.csv")
    own = [(row.phase, row.time_s, row.share) for row in rows if row.method == "MOB"]
    assert own == [
        ("swing", 0.25, pytest.approx(0.9)), ("swing", 1.25, pytest.approx(0.6)), ("stance", 0.75, pytest.approx(-0.2)),
    ]  # fmt: skip
    assert {path.suffix for path in tmp_path.glob("drift.*")} == {".csv", ".pdf", ".svg", ".png"}
    check_golden(tmp_path / "drift.csv")
