"""Errors of known spread are covered as they should be, as learned and scaled, with and without pushes."""

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from made_notes import training_note

from experiments.evaluation.measure.learning.calibration import (
    VALIDATION,
    CoverageGrid,
    grid_of,
    held_out,
    in_tests,
    limb_columns,
)
from experiments.plan.runs import Run
from experiments.settings.evaluation import Evaluation
from experiments.settings.measures import CalibrationTest
from mobnet.core.errors import DataError
from mobnet.core.joints import JointLayout
from mobnet.learning.calibration import calibrate

SHARES = [0.5, 0.68]
Test = tuple[CalibrationTest, list[Run]]
Make = Callable[..., Test]


@pytest.fixture
def measure(layout: JointLayout, evaluation: Evaluation) -> Callable[[Test], list[CoverageGrid]]:
    """Return a function that measures one test."""
    return lambda made: in_tests(layout, evaluation.coverage, made[:1], made[1:], SHARES)


def test_the_right_factor_gives_nominal_coverage(
    measure: Callable[[Test], list[CoverageGrid]], predicted: Make
) -> None:
    (grid,) = measure(predicted(seed=1, scale=2.0))
    assert (grid.test, grid.method, grid.limb, grid.unit) == ("walk_test", "MOB-Net", "LL", "N m")
    assert grid.values.shape == (1, 1, 2, 4)
    before, after = grid.values[0, 0]
    np.testing.assert_allclose(after[:2], SHARES, atol=0.03)
    assert (before[:2] < np.array(SHARES) - 0.1).all()
    assert (before[2:] > after[2:]).all()


def test_an_estimate_without_factors_is_the_same_before_and_after(
    measure: Callable[[Test], list[CoverageGrid]], predicted: Make
) -> None:
    before, after = measure(predicted(seed=1, scale=None))[0].values[0, 0]
    np.testing.assert_array_equal(before, after)


def test_only_samples_around_pushes_count(measure: Callable[[Test], list[CoverageGrid]], predicted: Make) -> None:
    """Errors there are ten times larger than predicted."""
    (everything,), (pushed,) = (measure(predicted(seed=1, pushed=joint)) for joint in (None, "LL3"))
    assert (everything.case, pushed.case) == ("walk test", "knee swing, pushed")
    assert pushed.values[0, 0, 1, 1] < 0.15
    assert everything.values[0, 0, 1, 1] > 0.5


def test_tests_without_pushes_and_other_limbs_are_left_out(
    layout: JointLayout, evaluation: Evaluation, predicted: Make
) -> None:
    test, runs = predicted(seed=1, pushed="LL3")
    calm = evaluation.coverage.model_copy(update={"push_nm": 1e6})
    assert in_tests(layout, calm, [test], [runs], SHARES) == []
    assert in_tests(layout, evaluation.coverage, [test.model_copy(update={"limbs": ("RL",)})], [runs], SHARES) == []


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
    (grid,) = held_out(layout, {"robots": folders}, SHARES)
    assert (grid.test, grid.level, grid.method, grid.limb) == (VALIDATION, "robots", "GRU", "LL")
    assert grid.values.shape == (2, 1, 2, 4)
    np.testing.assert_allclose(grid.values[:, 0, 1, :2], [SHARES, SHARES], atol=0.03)
    assert (grid.values[:, 0, 0, 1] < 0.45).all()
    with pytest.raises(DataError, match=r"shares \[0.5, 0.68\], but \[0.9\]"):
        held_out(layout, {"robots": folders}, [0.9])


def test_a_network_that_misses_a_test_is_refused() -> None:
    cell = np.zeros((2, 3))
    assert grid_of({(0, 1): cell, (0, 2): cell}).shape == (1, 2, 2, 3)
    with pytest.raises(DataError, match="networks"):
        grid_of({(0, 1): cell, (0, 2): cell, (1, 1): cell})
