"""Errors of known spread are covered as they should be, as learned and scaled, with and without pushes."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from made_notes import training_note
from paper_settings import STATISTICS

from experiments.evaluation.measure.learning.calibration import (
    CASE,
    CRPS,
    STAGES,
    VALIDATION,
    case_of,
    held_out,
    in_tests,
    limb_columns,
)
from experiments.evaluation.number.frames import TRUSTED, rows_of, typed
from experiments.evaluation.tables.further.calibration_table import trust_of
from experiments.plan.runs import Run
from experiments.settings.evaluation import Evaluation
from experiments.settings.measures import CalibrationTest
from mobnet.core.errors import DataError
from mobnet.core.joints import JointLayout
from mobnet.learning.calibration import calibrate

SHARES = [0.5, 0.68]
Test = tuple[CalibrationTest, list[Run]]
Make = Callable[..., Test]
Measure = Callable[[Test], pd.DataFrame]


@pytest.fixture
def measure(layout: JointLayout, evaluation: Evaluation) -> Measure:
    """Return a function that measures one test."""
    return lambda made: in_tests(layout, evaluation.coverage, made[:1], made[1:], SHARES)


def stages(rows: pd.DataFrame) -> list[Any]:
    """Return coverage of the shares, likelihood and CRPS of one run, before and after the scaling (2, 4)."""
    return [rows_of(rows, stage=stage)["value"].to_numpy() for stage in STAGES]


def test_the_right_factor_gives_nominal_coverage(measure: Measure, predicted: Make) -> None:
    rows = measure(predicted(seed=1, scale=2.0))
    ((scenario, _, _, method, limb, unit),) = rows[CASE].drop_duplicates().to_numpy().tolist()
    assert (scenario, method, limb, unit) == ("walk_test", "MOB-Net", "LL", "N m")
    assert len(rows) == 2 * 4
    before, after = stages(rows)
    np.testing.assert_allclose(after[:2], SHARES, atol=0.03)
    assert (before[:2] < np.array(SHARES) - 0.1).all()
    assert (before[2:] > after[2:]).all()


def test_an_estimate_without_factors_is_the_same_before_and_after(measure: Measure, predicted: Make) -> None:
    before, after = stages(measure(predicted(seed=1, scale=None)))
    np.testing.assert_array_equal(before, after)


def test_only_samples_around_pushes_count(measure: Measure, predicted: Make) -> None:
    """Errors there are ten times larger than predicted."""
    everything, pushed = (measure(predicted(seed=1, pushed=joint)) for joint in (None, "LL3"))
    cases = [case_of(*rows[["scenario", "level", "pushed"]].iloc[0]) for rows in (everything, pushed)]
    assert cases == ["walk test", "knee swing, pushed"]
    assert stages(pushed)[1][1] < 0.15
    assert stages(everything)[1][1] > 0.5


def test_tests_without_pushes_and_other_limbs_are_left_out(
    layout: JointLayout, evaluation: Evaluation, predicted: Make
) -> None:
    test, runs = predicted(seed=1, pushed="LL3")
    calm = evaluation.coverage.model_copy(update={"push_nm": 1e6})
    assert in_tests(layout, calm, [test], [runs], SHARES).empty
    assert in_tests(layout, evaluation.coverage, [test.model_copy(update={"limbs": ("RL",)})], [runs], SHARES).empty


def test_an_estimate_without_standard_deviations_is_refused(
    layout: JointLayout, evaluation: Evaluation, predicted: Make, walk: Callable[..., Run]
) -> None:
    with pytest.raises(DataError, match=r"columns std\.<joint> are missing"):
        in_tests(layout, evaluation.coverage, [predicted(seed=1)[0]], [[walk(1.0)]], SHARES)


def test_the_virtual_joints_are_two_groups_by_unit(layout: JointLayout) -> None:
    columns = limb_columns(layout, ["LL2", *layout.limb("V"), "LL1"])
    assert columns == {("V", "N"): [1, 2, 3], ("V", "N m"): [4, 5, 6], ("LL", "N m"): [7, 0]}


def write_note(folder: Path, seed: int, diverged: bool = False) -> Path:
    """Write a training's note: sigma twice too small on two joints of the left leg; return its folder."""
    folder.mkdir(parents=True)
    std = np.full((4000, 2), 0.5)
    found = calibrate(2.0 * std * np.random.default_rng(seed).normal(size=std.shape), std, 0.68, SHARES)
    calibration = found.note(["LL1", "LL2"], SHARES)
    note = training_note(f"GRU-LL-s{seed}", [1.0], diverged=diverged, calibration=calibration)
    (folder / "run.json").write_text(json.dumps(note))
    return folder


def test_held_out_rows_come_from_the_notes_of_sound_trainings(tmp_path: Path, layout: JointLayout) -> None:
    folders = [write_note(tmp_path / f"s{seed}", seed, diverged=seed == 2) for seed in range(3)]
    rows = held_out(layout, {"robots": folders}, SHARES)
    ((scenario, level, _, method, limb, _),) = rows[CASE].drop_duplicates().to_numpy().tolist()
    assert (scenario, level, method, limb) == (VALIDATION, "robots", "GRU", "LL")
    networks = [stages(same) for _, same in rows.groupby("network_seed")]
    assert np.shape(networks) == (2, 2, 4)
    for before, after in networks:
        np.testing.assert_allclose(after[:2], SHARES, atol=0.03)
        assert before[1] < 0.45
    with pytest.raises(DataError, match=r"shares \[0.5, 0.68\], but \[0.9\]"):
        held_out(layout, {"robots": folders}, [0.9])


def test_a_network_that_misses_a_test_is_refused() -> None:
    place = dict.fromkeys([*CASE, "joint"], "")
    runs = [(0, 1), (0, 2), (1, 1)]
    rows: list[dict[str, Any]] = []
    for network, test in runs:
        for stage in STAGES:
            seeds = {"network_seed": network, "test_seed": test}
            rows.append({**place, **seeds, "stage": stage, "metric": CRPS, "value": 1.0})
    with pytest.raises(DataError, match="networks"):
        trust_of(typed(rows, TRUSTED), STATISTICS)
