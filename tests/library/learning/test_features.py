"""Inputs of the limb networks, eq. (17) and Table 1."""

import numpy as np
import pytest

from mobnet.core.arrays import rotation
from mobnet.core.errors import ConfigError
from mobnet.core.joints import N_VIRTUAL, NQ_BASE
from mobnet.core.recording import Sensed
from mobnet.core.recording_file import read_sensed, write_recording
from mobnet.core.store import read_array
from mobnet.formats.network import Limb
from mobnet.learning.features import limb_inputs, signal_names, signals

WIDTHS = {"LL": 30, "RL": 30, "RA": 34, "LA": 34, "W": 50, "V": 74}  # Table 1


@pytest.mark.parametrize("limb", WIDTHS)
def test_width_is_that_of_table_1(limb, settings, layout):
    inputs = limb_inputs(layout, settings.robot.networks[limb])
    assert len(inputs.names) == len(inputs.columns) == len(set(inputs.names)) == WIDTHS[limb]


def test_leg_sees_its_own_joints_torques_and_the_pelvis(settings, layout, made_up):
    sensed = made_up().sensed
    leg = layout.columns(layout.limb("LL")) - N_VIRTUAL
    turned = rotation(sensed.q[:, 3:NQ_BASE])
    expected = np.concatenate(
        [
            sensed.q[:, NQ_BASE + leg],
            sensed.v[:, N_VIRTUAL + leg],
            sensed.tau_des[:, leg],
            turned[:, :, 0],
            turned[:, :, 1],
            sensed.v[:, 3:N_VIRTUAL],
            sensed.acc_base_in_base,
        ],
        axis=1,
    )
    np.testing.assert_array_equal(limb_inputs(layout, settings.robot.networks["LL"])(sensed), np.float32(expected))


def test_arm_sees_the_waist_and_no_torque(settings, layout):
    names = limb_inputs(layout, settings.robot.networks["LA"]).names
    assert [name for name in names if name.startswith("q.")] == [f"q.{j}" for j in layout.limb("LA") + layout.limb("W")]
    assert not any(name.startswith("tau_des") for name in names)


@pytest.mark.parametrize(("imu", "left_out"), [((), "R. v.omega acc."), (("rotation", "angular_velocity"), "acc.")])
def test_a_network_may_see_less_of_the_inertial_sensor(imu, left_out, settings, layout, made_up, tmp_path):
    limb = settings.robot.networks["LL"]
    every, inputs = limb_inputs(layout, limb), limb_inputs(layout, limb.model_copy(update={"imu": imu}))
    assert inputs.names == tuple(name for name in every.names if not name.startswith(tuple(left_out.split())))
    write_recording(tmp_path / "walk", made_up(), layout)
    few, _ = read_array(tmp_path / "walk", inputs.recorded)
    np.testing.assert_array_equal(inputs.from_recorded(few), inputs(read_sensed(tmp_path / "walk", layout).sensed))


@pytest.mark.parametrize("limb", ["LL", "V"])
def test_few_columns_give_the_inputs_of_the_whole_recording(limb, settings, layout, made_up, tmp_path):
    recording, inputs = made_up(), limb_inputs(layout, settings.robot.networks[limb])
    write_recording(tmp_path / "walk", recording, layout)
    few, _ = read_array(tmp_path / "walk", inputs.recorded)
    np.testing.assert_array_equal(inputs.from_recorded(few), inputs(read_sensed(tmp_path / "walk", layout).sensed))


def test_a_sample_gives_its_row_of_the_recording(made_up, layout):
    sensed = made_up().sensed
    whole = signals(sensed)
    assert whole.dtype == np.float32
    assert whole.shape == (len(sensed), len(signal_names(layout)))
    np.testing.assert_array_equal(signals(sensed[7]), whole[7])


def test_a_fixed_base_has_joints_alone(arm):
    rng = np.random.default_rng(0)
    q, v, tau, none = *rng.normal(size=(3, 5, 2)), np.zeros((5, 0))
    sensed = Sensed(q, v, none, tau, tau, none, none, none)
    inputs = limb_inputs(arm.layout, Limb(joints=("A",), Q=("A",), T=("A",)))
    assert inputs.names == signal_names(arm.layout) == inputs.recorded
    whole = np.float32(np.concatenate([q, v, tau], axis=1))
    np.testing.assert_array_equal(inputs(sensed), whole)
    np.testing.assert_array_equal(inputs.from_recorded(whole), whole)
    np.testing.assert_array_equal(signals(sensed[3]), whole[3])


@pytest.mark.parametrize("limb", ["V", "tail"])
def test_a_limb_without_motors_is_refused(limb, layout):
    with pytest.raises(ConfigError, match=limb):
        limb_inputs(layout, Limb(joints=("LL",), Q=(limb,), T=()))
