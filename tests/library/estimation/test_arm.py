"""The observer on a log of a two-link arm on a fixed base: no base, no feet, no walking."""

from dataclasses import replace

import numpy as np
import pytest
from pushed_arm import PUSH, RATE_HZ, SAMPLES

from mobnet.core.columns import recording_columns
from mobnet.core.errors import ConfigError
from mobnet.core.recording import Sensed
from mobnet.core.recording_file import read_recording, read_sensed, write_recording
from mobnet.estimation.observer import RobotObserver
from mobnet.robot.dynamics import inverse_dynamics
from mobnet.robot.nominal import NominalModel

GAIN_HZ = 100.0


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
    residual = RobotObserver(NominalModel(arm), GAIN_HZ, rate_hz, kind).residual(sensed)
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
    sensed, observer = swing(arm, 100.0)[1], RobotObserver(NominalModel(arm), GAIN_HZ, 100.0, kind)
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
        RobotObserver(NominalModel(arm), GAIN_HZ, RATE_HZ, "median")  # type: ignore[arg-type]


def test_a_log_holds_joints_alone_and_is_read_back(pushed_arm, arm, tmp_path):
    columns = recording_columns(arm.layout)
    names = [name for group in columns.values() for name, _, _ in group]
    assert names == [
        *(f"{field}.{joint}" for field in ("q", "v", "tau_des", "tau_motor", "tau_ext") for joint in ("J1", "J2")),
        "pushed", "tau_random.J1", "tau_random.J2", "tau_push.J1", "tau_push.J2",
    ]  # fmt: skip
    assert columns["tau_ext"][0] == ("tau_ext.J1", "N m", "joint")
    write_recording(tmp_path / "log", pushed_arm, arm.layout)
    read = read_recording(tmp_path / "log", arm.layout)
    for name in Sensed.__dataclass_fields__:
        np.testing.assert_allclose(getattr(read.sensed, name), getattr(pushed_arm.sensed, name), rtol=1e-6)
        assert getattr(read_sensed(tmp_path / "log", arm.layout).sensed, name).dtype == np.float32
    assert (read.truth.contact.shape, read.truth.wrench_left_foot.shape) == ((SAMPLES, 0), (SAMPLES, 0))
