"""Errors of known spread are covered as they should be, as learned and scaled, with and without pushes."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mobnet.core.errors import DataError
from mobnet.core.joints import JointLayout
from mobnet.evaluation.measure.calibration import VALIDATION, grid_of, held_out, in_tests, limb_columns
from mobnet.learning.calibration import calibrate

SHARES = [0.5, 0.68]
Make = Callable[..., dict[str, Any]]


def test_the_right_factor_gives_nominal_coverage(config: dict[str, Any], told: Make) -> None:
    run = told(seed=1, scale=2.0)
    (grid,) = in_tests(config, [run], SHARES)
    assert (grid.test, grid.method, grid.limb, grid.unit) == ("walk_test", "MOB-Net", "LL", "N m")
    assert grid.values.shape == (1, 1, 2, 4)
    np.testing.assert_allclose(grid.values[0, 0, 1, :2], SHARES, atol=0.03)
    assert (grid.values[0, 0, 0, :2] < np.array(SHARES) - 0.1).all()
    assert (grid.values[0, 0, 0, 2:] > grid.values[0, 0, 1, 2:]).all()


def test_an_estimate_without_factors_is_the_same_before_and_after(config: dict[str, Any], told: Make) -> None:
    (grid,) = in_tests(config, [told(seed=1, scale=None)], SHARES)
    np.testing.assert_array_equal(grid.values[0, 0, 0], grid.values[0, 0, 1])


def test_only_samples_around_pushes_count(config: dict[str, Any], told: Make) -> None:
    """Errors there are ten times larger than sigma says."""
    (all_samples,), (pushed,) = (in_tests(config, [told(seed=1, pushed=name)], SHARES) for name in (None, "LL3"))
    assert pushed.pushed == "LL3"
    assert pushed.values[0, 0, 1, 1] < 0.15
    assert all_samples.values[0, 0, 1, 1] > 0.5


def test_a_test_without_pushes_is_left_out(config: dict[str, Any], told: Make) -> None:
    config["evaluation"]["coverage"]["push_nm"] = 1e6
    assert in_tests(config, [told(seed=1, pushed="LL3")], SHARES) == []


def test_limbs_that_are_not_asked_for_are_left_out(config: dict[str, Any], told: Make) -> None:
    assert in_tests(config, [{**told(seed=1), "limbs": ["RL"]}], SHARES) == []


def test_the_virtual_joints_are_two_groups_by_unit(layout: JointLayout) -> None:
    columns = limb_columns(layout, ["LL2", *layout.limb("V"), "LL1"])
    assert columns == {("V", "N"): [1, 2, 3], ("V", "N m"): [4, 5, 6], ("LL", "N m"): [7, 0]}


def write_note(folder: Path, seed: int, diverged: bool = False) -> str:
    """Write a training's note: sigma twice too small on two joints of the left leg; return its folder."""
    folder.mkdir(parents=True)
    std = np.full((4000, 2), 0.5)
    told = calibrate(2.0 * std * np.random.default_rng(seed).normal(size=std.shape), std, 0.68, SHARES)
    note = {"method": "GRU", "limb": "LL", "seed": seed, "diverged": diverged}
    (folder / "run.json").write_text(json.dumps(note | {"calibration": told.note(["LL1", "LL2"], SHARES)}))
    return str(folder)


def test_held_out_rows_come_from_the_notes_of_sound_trainings(tmp_path: Path, layout: JointLayout) -> None:
    folders = [write_note(tmp_path / f"s{seed}", seed, diverged=seed == 2) for seed in range(3)]
    (grid,) = held_out(layout, folders, SHARES)
    assert (grid.test, grid.method, grid.limb) == (VALIDATION, "GRU", "LL")
    assert grid.values.shape == (2, 1, 2, 4)
    np.testing.assert_allclose(grid.values[:, 0, 1, :2], [SHARES, SHARES], atol=0.03)
    assert (grid.values[:, 0, 0, 1] < 0.45).all()


def test_notes_of_other_shares_are_refused(tmp_path: Path, layout: JointLayout) -> None:
    with pytest.raises(DataError, match=r"shares \[0.5, 0.68\], but \[0.9\]"):
        held_out(layout, [write_note(tmp_path / "s0", 0)], [0.9])


def test_a_network_that_misses_a_test_is_refused() -> None:
    cell = np.zeros((2, 3))
    assert grid_of({(0, 1): cell, (0, 2): cell}).shape == (1, 2, 2, 3)
    with pytest.raises(DataError, match="networks"):
        grid_of({(0, 1): cell, (0, 2): cell, (1, 1): cell})
