"""The residual file: what it holds, how segments and levels enter, and the scheme's error on the simulated plant."""

import tracemalloc
from dataclasses import replace

import numpy as np
import pytest
from made_swings import unseen

from experiments.jobs.observing import observe
from mobnet.core.columns import residual_columns
from mobnet.core.recording import Recording
from mobnet.core.recording_file import write_recording
from mobnet.core.store import read_array
from mobnet.estimation.label import foot_label
from mobnet.estimation.observe import observer_of
from mobnet.estimation.observer import RobotObserver
from mobnet.kernel.low_pass import low_pass
from mobnet.robot.nominal import NominalModel

RATE_HZ, GAIN_HZ = 1000.0, 100.0
META = {"scenario": "random_walk", "level": "ideal", "seed": 3}


@pytest.fixture
def recording(robot, follow):
    """Two segments of a tenth of a second each."""
    sensed, tau_ext = follow(RATE_HZ, 0.199, np.zeros(robot.layout.nu))
    truth = replace(unseen(robot.layout, len(sensed)), tau_ext=tau_ext)
    return Recording(sensed, ((0, 100), (100, 200)), RATE_HZ, META, truth)


@pytest.fixture
def written(robot, tmp_path):
    def write(recording):
        write_recording(tmp_path / "s3", recording, robot.layout)
        return tmp_path / "s3"

    return write


@pytest.fixture
def run(settings):
    def observed(recording, out, level="ideal"):
        gravity = settings.plant.gravity_m_s2
        observe(settings.robot, settings.levels[level], gravity, settings.observer, recording, out)

    return observed


def test_file_has_residual_then_truth_and_says_where_from(run, recording, robot, written, tmp_path):
    run(written(recording), tmp_path / "out" / "s3")
    array, meta = read_array(tmp_path / "out" / "s3")
    names = [column["name"] for column in meta["columns"]]
    joints = robot.layout.names
    assert names == [f"r.{joint}" for joint in joints] + [f"tau_ext_lp.{joint}" for joint in joints]
    assert (array.dtype, array.shape) == (np.float32, (200, 2 * robot.layout.nv))
    assert {key: meta[key] for key in META} == META
    assert (meta["rate_hz"], meta["gain_hz"], meta["nominal_mass_ratio"]) == (RATE_HZ, GAIN_HZ, 1.0)
    assert meta["segments"] == [[0, 100], [100, 200]]


def test_the_label_of_foot_sensors_stands_beside_the_truth(run, recording, robot, written, tmp_path):
    """That of test_label.py, by the wrenches of the file; r and the truth do not depend on the forces."""
    rng = np.random.default_rng(0)
    wrenches = {side: rng.normal(0.0, 100.0, (200, 6)) for side in ("left", "right")}
    truth = replace(recording.truth, wrench_left_foot=wrenches["left"], wrench_right_foot=wrenches["right"])
    stem = written(replace(recording, truth=truth))
    for level in ("robot_1", "exact_model"):  # both observe with the same model
        run(stem, tmp_path / level, level)
    labelled, meta = read_array(tmp_path / "robot_1")
    parts = np.split(labelled, 3, axis=1)
    np.testing.assert_array_equal(np.concatenate(parts[:2], axis=1), read_array(tmp_path / "exact_model")[0])
    expected = foot_label(NominalModel(robot), recording, wrenches, GAIN_HZ)
    np.testing.assert_allclose(parts[2], expected, rtol=1e-4, atol=1e-2)
    assert [column["name"] for column in meta["columns"]][2 * robot.layout.nv] == "label_lp.V1"


def test_every_segment_starts_anew(run, recording, nominal, written, tmp_path):
    run(written(recording), tmp_path / "out")
    array, _ = read_array(tmp_path / "out")
    nv = nominal.model.nv
    np.testing.assert_array_equal(array[[0, 100]], 0)
    alone = RobotObserver(nominal, GAIN_HZ, RATE_HZ).residual(recording.sensed[100:200])
    np.testing.assert_allclose(array[100:, :nv], alone, atol=0.02)
    np.testing.assert_allclose(array[100:, nv:], low_pass(recording.truth.tau_ext[100:], GAIN_HZ, RATE_HZ), atol=0.01)


def test_the_blocks_in_which_it_is_read_change_no_bit(run, recording, written, tmp_path, monkeypatch):
    """Observer, low-pass and label carry their states; `robot_1` has all three."""
    rng = np.random.default_rng(0)
    wrenches = {f"wrench_{side}_foot": rng.normal(0.0, 100.0, (200, 6)) for side in ("left", "right")}
    swinging = replace(recording.sensed, swing=np.tile([1.0, 0.0], (200, 1)))
    truth = replace(recording.truth, **wrenches)
    stem = written(replace(recording, sensed=swinging, truth=truth, segments=((3, 100), (100, 190))))
    run(stem, tmp_path / "whole", "robot_1")
    for module in ("experiments.jobs.observing", "mobnet.estimation.observe"):
        monkeypatch.setattr(f"{module}.BLOCK_ROWS", 7)
    run(stem, tmp_path / "blocks", "robot_1")
    np.testing.assert_array_equal(read_array(tmp_path / "blocks")[0], read_array(tmp_path / "whole")[0])


def test_memory_does_not_grow_with_the_recording(run, recording, written, tmp_path, monkeypatch):
    monkeypatch.setattr("mobnet.core.store.GROUP_ROWS", 500)
    sensed = replace(recording.sensed, acc_base_in_base=np.tile([0.0, 0.0, 9.81], (200, 1)))
    most = []
    for times in (5, 5, 50):  # the first one also compiles
        rows = np.tile(np.arange(200), times)
        segments = tuple((start, start + 100) for start in range(0, len(rows), 100))
        stem = written(replace(recording, sensed=sensed[rows], truth=recording.truth[rows], segments=segments))
        tracemalloc.start()
        run(stem, tmp_path / "out")
        most.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
    assert most[2] < 1.5 * most[1]


def test_level_picks_the_nominal_model(settings, robot):
    ratios = {name: level.nominal_mass_ratio for name, level in settings.levels.items()}
    made = {name: observer_of(robot, ratio, 9.81, GAIN_HZ, RATE_HZ) for name, ratio in ratios.items()}
    ratios = {name: observer.nominal.mass_ratio for name, observer in made.items()}
    lighter = {level for level, ratio in ratios.items() if ratio == pytest.approx(0.9)}
    assert lighter == {"all_uncertainty", "no_friction", "no_load_friction", "no_noise"}
    assert {ratios[level] for level in ratios.keys() - lighter} == {1.0}


def test_a_lighter_model_leaves_a_share_of_what_is_needed_in_the_residual(run, recording, written, tmp_path, robot):
    stem = written(replace(recording, meta={**META, "level": "all_uncertainty"}))
    run(stem, tmp_path / "out", "all_uncertainty")
    array, meta = read_array(tmp_path / "out")
    residual, truth = np.split(np.asarray(array, dtype=np.float64), 2, axis=1)
    needed = np.concatenate([recording.truth.tau_ext[:, :6], recording.sensed.tau_motor], axis=1)
    error = -0.1 * low_pass(needed[:100], GAIN_HZ, RATE_HZ)
    assert meta["nominal_mass_ratio"] == 0.9
    np.testing.assert_allclose((residual - truth)[:100], error, atol=0.02)


def test_columns_carry_unit_and_frame(robot):
    described = {name: (unit, frame) for name, unit, frame in residual_columns(robot.layout)}
    assert described["r.V1"] == ("N", "world")
    assert described["tau_ext_lp.V4"] == ("N m", "joint")
    assert described["r.LL3"] == ("N m", "joint")


def test_residual_is_the_low_passed_torque_that_pushed_it(pushed_arm, arm_table, settings, tmp_path):
    write_recording(tmp_path / "log", pushed_arm, arm_table.layout)
    level, gravity = settings.levels["ideal"], settings.plant.gravity_m_s2
    observe(arm_table, level, gravity, settings.observer, tmp_path / "log", tmp_path / "out")
    array, meta = read_array(tmp_path / "out")
    assert [column["name"] for column in meta["columns"]] == ["r.J1", "r.J2", "tau_ext_lp.J1", "tau_ext_lp.J2"]
    pushed = low_pass(pushed_arm.truth.tau_ext, settings.observer.gain_hz, RATE_HZ)
    assert pushed[-1, 1] == pytest.approx(3, abs=1e-9)
    np.testing.assert_allclose(array[:, 2:], pushed, atol=1e-6)
    np.testing.assert_allclose(array[:, :2], pushed, atol=0.004)
