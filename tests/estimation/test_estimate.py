"""The rule `estimate`: columns, segments, and what a file says of itself."""

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
from safetensors.numpy import save_file

from mobnet.core.estimator import Estimate
from mobnet.core.files import WEIGHTS
from mobnet.core.joints import JointLayout
from mobnet.core.recording import Recording
from mobnet.core.store import read_array
from mobnet.estimation.estimate import estimate, run_segments, std_scales, table_of
from mobnet.estimation.methods import build_estimator
from mobnet.estimation.recipe import Recipe
from mobnet.learning.deployed.weights import NOTE, STD_SCALE, Z_SCORES
from mobnet.settings.settings import Settings

Write = Callable[[Path, Recording], tuple[Path, Path]]


def test_each_segment_starts_from_a_fresh_state(
    settings: Settings,
    recipe_of: Callable[..., Recipe],
    tmp_path: Path,
    made_up: Callable[..., Recording],
    write_pair: Write,
) -> None:
    recording = made_up(0, 0.4, segments=2)
    stem, _ = write_pair(tmp_path, recording)
    given = settings.robot, settings.levels["all_uncertainty"], settings.plant.gravity_m_s2, settings.observer
    estimate(*given, "MOB", settings.methods, {}, None, stem, tmp_path / "out")
    array, meta = read_array(tmp_path / "out")
    estimator = build_estimator(recipe_of("MOB"))
    for span in recording.spans():
        alone = estimator.estimate(recording.sensed[span]).tau_ext
        np.testing.assert_allclose(array[span], alone, atol=1e-3 * np.abs(alone).max())
        assert not array[span.start].any()
    assert meta["segments"] == [[0, 200], [200, 400]]
    assert (meta["method"], meta["scenario"], meta["level"]) == ("MOB", "made_up", "all_uncertainty")
    assert [column["name"] for column in meta["columns"]] == [f"tau_ext.{joint}" for joint in estimator.joints]


def test_std_columns_follow_if_there_are_any(layout: JointLayout) -> None:
    tau, std = np.zeros((3, 2)), np.ones((3, 2))
    array, columns = table_of(Estimate(tau, std), ["V1", "LL2"], layout)
    assert columns[0] == ("tau_ext.V1", "N", "world")
    assert [name for name, _, _ in columns] == ["tau_ext.V1", "tau_ext.LL2", "std.V1", "std.LL2"]
    np.testing.assert_array_equal(array, np.concatenate([tau, std], axis=1))
    assert len(table_of(Estimate(tau), ["V1", "LL2"], layout)[1]) == 2


def test_a_method_without_a_std_gets_none(recipe_of: Callable[..., Recipe], made_up: Callable[..., Recording]) -> None:
    assert run_segments(build_estimator(recipe_of("MOB", "ideal")), made_up(0, 0.1)).std is None


def test_factors_are_told_joint_by_joint_and_are_one_where_none_are_stored(tmp_path: Path) -> None:
    tensors = {f"cell.weight_{side}_l0": np.zeros((3, 1), np.float32) for side in ("ih", "hh")}
    tensors |= {f"cell.bias_{side}_l0": np.zeros(3, np.float32) for side in ("ih", "hh")}
    tensors |= {"head.weight": np.zeros((4, 1), np.float32), "head.bias": np.zeros(4, np.float32)}
    tensors |= {name: np.ones(2 if name.startswith("target") else 1, np.float32) for name in Z_SCORES}
    for limb, more in (("LA", {}), ("RA", {STD_SCALE: np.array([0.5, 2.0], np.float32)})):
        (tmp_path / limb).mkdir()
        note = {"limb": limb, "joints": [f"{limb}1", f"{limb}2"], "inputs": ["q.W1"], "std_min": 1e-6}
        note["network"] = {"cell": "GRU", "hidden": 1}
        save_file(tensors | more, tmp_path / limb / WEIGHTS, {NOTE: json.dumps(note)})
    told = std_scales({limb: tmp_path / limb for limb in ("LA", "RA")})
    assert told == {"LA1": 1.0, "LA2": 1.0, "RA1": 0.5, "RA2": 2.0}
    assert std_scales({}) == {}
