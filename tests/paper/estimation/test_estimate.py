"""The rule `estimate`: columns, segments, and what a file says of itself."""

import json
from dataclasses import replace

import numpy as np
import pytest
from made_notes import network_note
from safetensors.numpy import save_file

from experiments.jobs import estimates as estimates_module
from experiments.jobs.estimates import estimate
from experiments.jobs.observing import observe
from experiments.plan.parts import MethodRun
from mobnet.core.errors import ConfigError, DataError
from mobnet.core.estimator import Estimate
from mobnet.core.files import WEIGHTS
from mobnet.core.store import read_array, write_array
from mobnet.estimation.estimate import ObservedRecording, rate_of, read_observed, run_segments, table_of
from mobnet.estimation.kinds import build_estimator
from mobnet.learning.deployed.tensors import STD_SCALE, Z_SCORES
from mobnet.learning.deployed.weights import NOTE, std_scales


@pytest.fixture
def run_methods(settings, tmp_path):
    """Return a function that runs MOB on recordings and their residuals, and returns where its estimates are."""

    def run(recordings, residuals, joints=None):
        level, gravity = settings.levels["all_uncertainty"], settings.plant.gravity_m_s2
        runs, out = [MethodRun("MOB", settings.methods, {}, None, 3, joints)], tmp_path / "estimates"
        estimate(settings.robot, level, gravity, settings.observer, runs, recordings, residuals, out)
        return [out / "MOB" / "n3" / stem.name for stem in recordings]

    return run


def test_each_segment_starts_from_a_fresh_state(settings, recipe_of, tmp_path, made_up, write_pair, run_methods):
    recording = made_up(0, 0.4, segments=2)
    stem, _ = write_pair(tmp_path, recording)
    given = settings.robot, settings.levels["all_uncertainty"], settings.plant.gravity_m_s2, settings.observer
    observe(*given, stem, tmp_path / "residual")
    (out,) = run_methods([stem], [tmp_path / "residual"])
    array, meta = read_array(out)
    estimator = build_estimator(recipe_of("MOB"))
    for span in recording.spans():
        alone = estimator.estimate(recording.sensed[span]).tau_ext
        np.testing.assert_allclose(array[span], alone, atol=1e-3 * np.abs(alone).max())
        assert not array[span.start].any()
    assert meta["segments"] == [[0, 200], [200, 400]]
    assert (meta["method"], meta["scenario"], meta["level"]) == ("MOB", "made_up", "all_uncertainty")
    assert [column["name"] for column in meta["columns"]] == [f"tau_ext.{joint}" for joint in estimator.joints]


def test_an_estimate_holds_the_joints_asked_for(tmp_path, made_up, write_pair, run_methods):
    stem, residual = write_pair(tmp_path, made_up(0, 0.2))
    (out,) = run_methods([stem], [residual], joints=("LL4", "W1"))
    array, meta = read_array(out)
    assert [column["name"] for column in meta["columns"]] == ["tau_ext.LL4", "tau_ext.W1"]
    np.testing.assert_array_equal(array, read_array(residual, ["r.LL4", "r.W1"])[0])
    with pytest.raises(ConfigError, match="joint to estimate: 'LL9' is not accepted; accepted: "):
        run_methods([stem], [residual], joints=("LL9",))


def test_std_columns_follow_if_there_are_any(layout):
    tau, std = np.zeros((3, 2)), np.ones((3, 2))
    array, columns = table_of(Estimate(tau, std), ["V1", "LL2"], layout)
    assert columns[0] == ("tau_ext.V1", "N", "world")
    assert [name for name, _, _ in columns] == ["tau_ext.V1", "tau_ext.LL2", "std.V1", "std.LL2"]
    np.testing.assert_array_equal(array, np.concatenate([tau, std], axis=1))
    assert len(table_of(Estimate(tau), ["V1", "LL2"], layout)[1]) == 2


def test_an_observer_that_ran_already_is_not_run_again(recipe_of, made_up):
    recording = made_up(0, 0.1)
    given = np.random.default_rng(0).normal(size=recording.sensed.v.shape).astype(np.float32)
    (result,) = run_segments(build_estimator(recipe_of("MOB")), [ObservedRecording(recording, given)])
    np.testing.assert_array_equal(result.tau_ext, given)


def test_recordings_side_by_side_and_in_batches_are_those_alone(
    settings, recipe_of, tmp_path, made_up,
    write_pair, monkeypatch, run_methods
):  # fmt: skip
    """Of different lengths, with falls, more of them than are held in memory at once."""
    recordings = [made_up(k, seconds, segments=k) for k, seconds in ((1, 0.3), (2, 0.5), (3, 0.2))]
    pairs = [write_pair(tmp_path, recording) for recording in recordings]
    monkeypatch.setattr(estimates_module, "TOGETHER_S", 0.8)
    outs = run_methods(*map(list, zip(*pairs, strict=True)))
    for recording, (_, residual), out in zip(recordings, pairs, outs, strict=True):
        array, meta = read_array(out)
        assert meta["segments"] == [list(span) for span in recording.segments]
        np.testing.assert_array_equal(array, read_array(residual)[0][:, : settings.layout.nv])


def test_of_a_residual_only_r_is_read(settings, tmp_path, made_up, write_pair):
    """The file has the true torque too, which no estimator may see."""
    pair = write_pair(tmp_path, made_up(1, 0.2))
    array, meta = read_array(pair[1])
    read = read_observed(settings.layout, *pair)
    assert read.residual is not None
    np.testing.assert_array_equal(read.residual, array[:, : settings.layout.nv])
    columns = [(c["name"], c["unit"], c["frame"]) for c in meta["columns"]]
    array[:, settings.layout.nv :] = 1e5
    write_array(pair[1], array, columns, {"rate_hz": meta["rate_hz"]})
    again = read_observed(settings.layout, *pair)
    np.testing.assert_array_equal(again.residual, read.residual)


def test_a_residual_of_another_recording_is_refused(settings, tmp_path, made_up, write_pair):
    recording, residual = (write_pair(tmp_path, made_up(k, 0.2 * k))[k - 1] for k in (1, 2))
    with pytest.raises(DataError, match="is not accepted"):
        read_observed(settings.layout, recording, residual)


def test_recordings_of_several_rates_are_not_run_together(made_up):
    read = [ObservedRecording(replace(made_up(1, 0.1), rate_hz=rate)) for rate in (500.0, 1000.0)]
    with pytest.raises(DataError, match=r"recordings at \[500.0, 1000.0\] Hz cannot be run together"):
        rate_of(read)


def test_factors_are_told_joint_by_joint_and_are_one_where_none_are_stored(tmp_path):
    tensors = {f"cell.weight_{side}_l0": np.zeros((3, 1), np.float32) for side in ("ih", "hh")}
    tensors |= {f"cell.bias_{side}_l0": np.zeros(3, np.float32) for side in ("ih", "hh")}
    tensors |= {"head.weight": np.zeros((4, 1), np.float32), "head.bias": np.zeros(4, np.float32)}
    tensors |= {name: np.ones(2 if name.startswith("target") else 1, np.float32) for name in Z_SCORES}
    for limb, more in (("LA", {}), ("RA", {STD_SCALE: np.array([0.5, 2.0], np.float32)})):
        (tmp_path / limb).mkdir()
        note = network_note(limb, [f"{limb}1", f"{limb}2"], ["q.W1"], {"cell": "GRU", "hidden": 1})
        save_file(tensors | more, tmp_path / limb / WEIGHTS, {NOTE: json.dumps(note)})
    told = std_scales(tmp_path / limb / WEIGHTS for limb in ("LA", "RA"))
    assert told == {"LA1": 1.0, "LA2": 1.0, "RA1": 0.5, "RA2": 2.0}
    assert std_scales({}) == {}
