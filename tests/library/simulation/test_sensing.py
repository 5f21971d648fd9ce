"""Sensors: the noise of Table 3 as measured, and a base state that stays near the truth."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from mobnet.control.kinematics import update
from mobnet.control.walker import move_wrenches
from mobnet.settings.plant import OwnNoise
from mobnet.simulation.sensing import read_sensors, reset_sensors

READINGS, TICK_S = 3000, 0.0005


def readings(simulator):
    """Return readings (n, C) of one state: orientation, joints, omega, rates, acceleration, wrenches."""
    plant, sensors, rng = simulator.plant, simulator.sensors, np.random.default_rng(0)
    rows = []
    for _ in range(READINGS):
        read_sensors(sensors, simulator.walker, plant.qpos, plant.qvel, plant.sensordata, rng, TICK_S)
        state = sensors.q[3:], sensors.v[3:], sensors.acc_base_in_base, sensors.wrenches.ravel()
        rows.append(np.concatenate(state))
    return np.array(rows)


EXACT = dict.fromkeys(OwnNoise.model_fields, 0.0)


@pytest.mark.parametrize(("level", "order", "power"), [
    ("sensor_noise", [0, 1, 2, 3], 1.0), ("swapped_noise", [0, 1, 3, 2], 1.0), ("printed_noise", [0, 1, 2, 3], 0.5),
])  # fmt: skip
def test_measured_noise_is_that_of_table_3(simulate, level, order, power):
    """Its numbers are standard deviations, so with two exchanged, or, to the letter, variances."""
    simulator = simulate("flat_place", level, standing=True, plant={"own_noise": EXACT})
    _, joints, omega, rates, acc, _ = np.split(readings(simulator), np.cumsum([4, 33, 3, 33, 3]), axis=1)
    printed = np.array([number for _, number in simulator.settings.plant.noise])[order] ** power
    for found, expected in zip((joints, rates, acc, omega), printed, strict=True):
        assert found.std(axis=0).mean() == pytest.approx(expected, rel=0.02)
    correlation = np.corrcoef(rates.T) - np.eye(33)
    assert np.abs(correlation).max() < 0.1


def test_the_inertial_sensor_of_a_robot_has_the_noise_of_its_unit(simulate):
    simulator = simulate("flat_place", "robot_1", standing=True)
    _, _, omega, rates, acc, _ = np.split(readings(simulator), np.cumsum([4, 33, 3, 33, 3]), axis=1)
    errors = simulator.settings.surrogate.sensors
    assert omega.std(axis=0).mean() == pytest.approx(errors.angular_velocity_noise_rad_s, rel=0.05)
    assert acc.std(axis=0).mean() == pytest.approx(errors.acceleration_noise_m_s2, rel=0.05)
    assert rates.std(axis=0).mean() == pytest.approx(simulator.settings.plant.noise.joint_velocity_rad_s, rel=0.02)


def test_encoders_orientation_and_feet_have_noise_of_our_own(simulate):
    """The orientation's error has a constant part, drawn for each episode, and a white one."""
    simulator = simulate("flat_place", "sensor_noise", standing=True)
    own, sensors, rng = simulator.settings.plant.own_noise, simulator.sensors, np.random.default_rng(0)
    quaternion, joints, _, wrench = np.split(readings(simulator), [4, 37, len(sensors.v) + 37], axis=1)
    np.testing.assert_allclose(np.linalg.norm(quaternion, axis=1), 1.0, atol=1e-12)
    steps = joints / own.encoder_step_rad
    np.testing.assert_allclose(steps, steps.round(), atol=1e-6)
    assert np.abs(joints - simulator.plant.qpos[7:]).max() < 0.6 * own.encoder_step_rad
    turned = error_of(quaternion, simulator.plant.qpos[3:7])
    np.testing.assert_allclose(turned.std(axis=0), own.orientation_rad, rtol=0.05)
    np.testing.assert_allclose(turned.mean(axis=0), sensors.offset, atol=1e-5)
    force, moment = wrench.reshape(-1, 2, 2, 3).transpose(2, 0, 1, 3)
    np.testing.assert_allclose(force.std(axis=0), own.foot_force_n, rtol=0.05)
    np.testing.assert_allclose(moment.std(axis=0), own.foot_moment_nm, rtol=0.05)
    offsets = []
    for _ in range(500):
        reset_sensors(sensors, simulator.plant.qpos, simulator.plant.qvel, rng)
        offsets.append(sensors.offset.copy())
    np.testing.assert_allclose(np.std(offsets, axis=0), own.orientation_offset_rad, rtol=0.1)


def error_of(sensed, true):
    """Return the rotation vectors (n, 3) [rad] in base axes from a true quaternion w x y z to sensed ones (n, 4)."""
    turn = Rotation.from_quat(true, scalar_first=True).inv() * Rotation.from_quat(sensed, scalar_first=True)
    return turn.as_rotvec()


def test_ideal_sensors_read_the_truth(simulate, run):
    simulator = simulate("flat_walk", "ideal")
    run(simulator, 0.3)
    np.testing.assert_array_equal(simulator.sensors.q, simulator.plant.qpos)
    np.testing.assert_array_equal(simulator.sensors.v, simulator.plant.qvel)


@pytest.mark.parametrize("level", ["sensor_noise", "all_uncertainty"])
def test_no_foot_sensor_is_behind_position_velocity_and_acceleration(simulate, level):
    """Wrenches may read anything, or nothing at all: what the observer and the networks get stays the same."""
    found = []
    for reading in (0.0, 1e3, np.nan):
        simulator = simulate("flat_walk", level)
        plant, sensors, rng = simulator.plant, simulator.sensors, np.random.default_rng(0)
        data = plant.sensordata.copy()
        for first in (*sensors.force, *sensors.torque):
            data[first : first + 3] = reading
        for _ in range(20):
            read_sensors(sensors, simulator.walker, plant.qpos, plant.qvel, data, rng, TICK_S)
            update(simulator.walker.tree, sensors.q, sensors.v, simulator.walker.gravity, simulator.walker.pose)
            move_wrenches(simulator.walker, sensors.wrenches)
        found.append(np.concatenate([sensors.q, sensors.v, sensors.acc_base_in_base]))
    np.testing.assert_array_equal(found[0], found[1])
    np.testing.assert_array_equal(found[0], found[2])


@pytest.mark.sim
@pytest.mark.slow
@pytest.mark.parametrize(("scenario", "bound"), [("forward_walk", 4e-3), ("random_walk", 2e-2)])
def test_sensed_base_velocity_stays_near_truth(simulate, run, scenario, bound):
    """Root mean square of seven walks of 8 s with all uncertainty [m/s]; single ones lie between 1.5 and 5 mm/s.

    A support foot that slips in a hard turn costs most. The error of a tilted base is the next test's.
    """
    errors = []
    for seed in range(1, 8):
        simulator = simulate(scenario, "all_uncertainty", seed, plant={"own_noise": EXACT})
        assert run(simulator, 2.0).done == 2000
        for _ in range(800):
            run(simulator, 0.01)
            errors.append(simulator.sensors.v[:3] - simulator.plant.qvel[:3])
    assert np.sqrt(np.mean(np.square(errors), axis=0)).max() < bound
    assert np.median(np.abs(errors)) < 2e-3


def test_sensed_base_converges_to_the_error_of_its_tilt(simulate, run):
    """A tilt turns gravity into a horizontal acceleration, g sin(tilt); the soles hold it to tau times that."""
    simulator = simulate("flat_place", "sensor_noise", standing=True)
    walker, sensors, tilt = simulator.walker, simulator.sensors, np.array([1e-3, -2e-3, 0.0])
    sensors.offset[:] = tilt
    run(simulator, 0.2)
    sensors.v[:3] += [0.05, -0.05, 0.02]
    run(simulator, 2.5)
    c, n = np.cos(simulator.state.yaw), np.sin(simulator.state.yaw)
    along = walker.par.base_time_constant_s * walker.gravity * np.array([tilt[1], -tilt[0]])
    expected = [c * along[0] - n * along[1], n * along[0] + c * along[1], 0.0]
    np.testing.assert_allclose(sensors.v[:3] - simulator.plant.qvel[:3], expected, atol=1e-3)
