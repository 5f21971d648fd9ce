"""The observer on a log of a two-link arm on a fixed base: no base, no feet, no walking."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest

from experiments.jobs.observing import observe
from mobnet.core.columns import recording_columns
from mobnet.core.errors import ConfigError
from mobnet.core.recording import Recording, Sensed, Truth, read_recording, read_sensed, write_recording
from mobnet.core.store import read_array
from mobnet.estimation.low_pass import low_pass
from mobnet.estimation.observer import MomentumObserver
from mobnet.robot.dynamics import inverse_dynamics
from mobnet.robot.nominal import NominalModel
from mobnet.robot.plant import robot_spec

RATE_HZ, SUB_STEPS, SAMPLES = 1000.0, 2, 600
GAIN_HZ, PUSH = 100.0, np.array([0.0, 3.0])  # [N m]


@pytest.fixture(scope="module")
def log(arm):
    """The simulated arm swings under its motors, and is pushed after a tenth of a second."""
    spec = robot_spec(arm)
    spec.option.timestep = 1 / (SUB_STEPS * RATE_HZ)
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_RK4  # links turn at 10 rad/s, too fast for Euler's method
    model = spec.compile()
    data, rows = mujoco.MjData(model), []
    data.qpos[:] = 0.5, -0.8
    for sample in range(SAMPLES):
        ticks = []
        for _ in range(SUB_STEPS):
            data.ctrl[:] = 12 * np.sin(9 * data.time) - 4 * data.qpos - data.qvel
            data.qfrc_applied[:] = PUSH if sample >= RATE_HZ / 10 else 0.0
            mujoco.mj_step(model, data)
            ticks.append([data.ctrl.copy(), data.qfrc_applied.copy()])
        rows.append([data.qpos.copy(), data.qvel.copy(), *np.mean(ticks, axis=0)])
    q, v, tau, external = np.array(rows).transpose(1, 0, 2)
    none = np.zeros((SAMPLES, 0))
    truth = Truth(external, none, none, none, np.zeros((SAMPLES, 1)), np.zeros_like(tau), np.zeros_like(external), none)
    return Recording(
        Sensed(q, v, none, tau, tau, none, none, none), ((0, SAMPLES),), RATE_HZ, {"level": "ideal"}, truth
    )


def swing(arm, rate_hz):
    """Return two seconds of both joints on sines of 10 rad/s, pushed by PUSH: torques are means, or samples."""
    nominal, period = NominalModel(arm), 1 / rate_hz
    size, rate, phase = np.array([0.3, 0.2]), 10.0, np.array([0.0, 1.0])

    def needed(t):
        angle = rate * t + phase
        return inverse_dynamics(
            nominal, size * np.sin(angle), size * rate * np.cos(angle), -size * rate**2 * np.sin(angle)
        )

    times = np.arange(0, 2, period)
    angles, none = rate * times[:, None] + phase, np.zeros((len(times), 0))
    q, v = size * np.sin(angles), size * rate * np.cos(angles)
    before = period * ((np.arange(20) + 0.5) / 20 - 1)
    mean = np.array([np.mean([needed(t + dt) for dt in before], axis=0) for t in times]) - PUSH
    sample = np.array([needed(t) for t in times]) - PUSH
    return tuple(Sensed(q, v, none, tau, tau, none, none, none) for tau in (mean, sample))


def error(arm, kind, sensed, rate_hz):
    """Return the largest departure (2,) from the answer (10) to a push, a share of the motors' torque."""
    residual = MomentumObserver(NominalModel(arm), GAIN_HZ, rate_hz, kind).residual(sensed)
    answer = PUSH * (1 - np.exp(-GAIN_HZ / rate_hz * np.arange(len(residual))))[:, None]
    return np.abs(residual - answer).max(axis=0) / (np.ptp(sensed.tau_motor, axis=0) / 2)


def test_means_and_samples_of_a_torque_give_the_closed_form(arm):
    """The reference is (10): a constant push comes out of a first-order low-pass, whatever the motors do."""
    for kind, coarse, fine in zip(("mean", "sample"), swing(arm, 100.0), swing(arm, 200.0), strict=True):
        errors = error(arm, kind, coarse, 100.0), error(arm, kind, fine, 200.0)
        assert errors[0].max() < 1e-3, kind
        np.testing.assert_allclose(errors[0] / errors[1], 4, atol=0.2)  # second order in time


def test_a_sample_taken_for_a_mean_is_half_a_sample_late(arm):
    """10 ms are 0.1 rad of the sine: half of it, five per cent of the torque, comes out as a push."""
    mean, sample = swing(arm, 100.0)
    np.testing.assert_allclose(error(arm, "mean", sample, 100.0), 0.05, atol=0.002)
    np.testing.assert_allclose(error(arm, "sample", mean, 100.0), 0.05, atol=0.002)


@pytest.mark.parametrize("kind", ["mean", "sample"])
def test_stepping_through_one_buffer_equals_the_whole(arm, kind):
    """Both forms are equivalent for either kind of torque, for any memory order, and if samples share their memory."""
    sensed, observer = swing(arm, 100.0)[1], MomentumObserver(NominalModel(arm), GAIN_HZ, 100.0, kind)
    whole, state, buffer, rows = observer.residual(sensed), observer.init(), np.zeros(2), []
    for k in range(len(sensed)):
        buffer[:] = sensed.tau_motor[k]
        state, residual = observer.step(state, replace(sensed[k], tau_motor=buffer))
        rows.append(residual)
    np.testing.assert_allclose(rows, whole, atol=1e-9)
    columns = Sensed(*(np.asfortranarray(getattr(sensed, name)) for name in Sensed.__dataclass_fields__))
    np.testing.assert_array_equal(observer.residual(columns), whole)


def test_an_unknown_kind_of_torque_is_named(arm):
    with pytest.raises(ConfigError, match="torque: 'median' is not accepted; accepted: mean, sample"):
        MomentumObserver(NominalModel(arm), GAIN_HZ, RATE_HZ, "median")  # type: ignore[arg-type]


def test_a_log_holds_joints_alone_and_is_read_back(log, arm, tmp_path):
    columns = recording_columns(arm.layout)
    names = [name for group in columns.values() for name, _, _ in group]
    assert names == [
        *(f"{field}.{joint}" for field in ("q", "v", "tau_des", "tau_motor", "tau_ext") for joint in ("J1", "J2")),
        "pushed", "tau_random.J1", "tau_random.J2", "tau_push.J1", "tau_push.J2",
    ]  # fmt: skip
    assert columns["tau_ext"][0] == ("tau_ext.J1", "N m", "joint")
    write_recording(tmp_path / "log", log, arm.layout)
    read = read_recording(tmp_path / "log", arm.layout)
    for name in Sensed.__dataclass_fields__:
        np.testing.assert_allclose(getattr(read.sensed, name), getattr(log.sensed, name), rtol=1e-6)
        assert getattr(read_sensed(tmp_path / "log", arm.layout).sensed, name).dtype == np.float32
    assert (read.truth.contact.shape, read.truth.wrench_left_foot.shape) == ((SAMPLES, 0), (SAMPLES, 0))


def test_residual_is_the_low_passed_torque_that_pushed_it(log, arm_table, settings, tmp_path):
    write_recording(tmp_path / "log", log, arm_table.layout)
    level, gravity = settings.levels["ideal"], settings.plant.gravity_m_s2
    observe(arm_table, level, gravity, settings.observer, tmp_path / "log", tmp_path / "out")
    array, meta = read_array(tmp_path / "out")
    assert [column["name"] for column in meta["columns"]] == ["r.J1", "r.J2", "tau_ext_lp.J1", "tau_ext_lp.J2"]
    pushed = low_pass(log.truth.tau_ext, settings.observer.gain_hz, RATE_HZ)
    assert pushed[-1, 1] == pytest.approx(3, abs=1e-9)
    np.testing.assert_allclose(array[:, 2:], pushed, atol=1e-6)
    np.testing.assert_allclose(array[:, :2], pushed, atol=0.004)
