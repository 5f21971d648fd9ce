"""The share of a long push that is held is drawn step by step, in swing and in stance."""

from collections.abc import Callable
from pathlib import Path

import pandas as pd
import pytest
from csv_files import check_golden, read_table

from experiments.evaluation.figures.further.drift import beyond, drift
from experiments.settings.evaluation import Evaluation
from experiments.settings.runs import LimbRuns
from experiments.settings.settings import Settings


def test_steps_stand_at_their_number_and_those_that_no_push_has_are_left_out(
    tmp_path: Path, settings: Settings, evaluation: Evaluation, write_measured: Callable[..., list[Path]]
) -> None:
    name, test = next(iter(evaluation.drift.tests.items()))
    test = test.model_copy(update={"methods": ("MOB", "MOB-Net")})
    section = evaluation.drift.model_copy(update={"tests": {name: test}})
    runs = LimbRuns(scenario=test.scenario, level=test.level, methods=test.methods, limbs=(section.limb,))
    metrics = {"held_swing_1": (0.9, "-"), "held_swing_3": (0.6, "-"), "held_stance_2": (-0.2, "-")}
    drift(section, evaluation.statistics, write_measured([runs], metrics), tmp_path)
    rows = read_table(tmp_path / "drift.csv")
    own = [(row.phase, row.step, row.share) for row in rows if row.method == "MOB"]
    assert own == [
        ("swing", 1, pytest.approx(0.9)), ("swing", 3, pytest.approx(0.6)), ("stance", 2, pytest.approx(-0.2)),
    ]  # fmt: skip
    assert {path.suffix for path in tmp_path.glob("drift.*")} == {".csv", ".pdf", ".svg", ".png"}
    check_golden(tmp_path / "drift.csv")


def test_shares_beyond_the_axis_are_written_in_the_panel() -> None:
    held = pd.DataFrame({"method": ["MOB", "MOB", "MOB", "MOB-Net"], "value": [1.62, 1.0, -0.2, 0.9]})
    assert beyond(held) == "beyond: MOB 1.62, -0.20"
    assert beyond(pd.DataFrame({"method": ["MOB", "MOB"], "value": [1.3, 0.0]})) == ""
