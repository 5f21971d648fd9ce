"""Sensors: the noise of Table 3 as measured, and a base state that stays near the truth."""

from collections.abc import Callable

import numpy as np
import pytest

from mobnet.simulation.sensing import read_sensors

READINGS, TICK_S = 3000, 0.0005


@pytest.mark.parametrize(("level", "power"), [("sensor_noise", 1.0), ("all_uncertainty", 1.0), ("printed_noise", 0.5)])
def test_measured_noise_is_that_of_table_3(simulate: Callable, level: str, power: float) -> None:
    """Its numbers are standard deviations, or, to the letter, variances."""
    simulator = simulate("flat_place", level, standing=True)
    plant, sensors, rng = simulator.plant, simulator.sensors, np.random.default_rng(0)
    readings = []
    for _ in range(READINGS):
        read_sensors(sensors, simulator.walker, plant.qpos, plant.qvel, plant.sensordata, rng, TICK_S)
        readings.append(np.concatenate([sensors.q[7:] - plant.qpos[7:], sensors.v[3:], sensors.acc_base_in_base]))
    joints, omega, rates, acc = np.split(np.array(readings), np.cumsum([33, 3, 33]), axis=1)
    noise = {name: number**power for name, number in simulator.settings.plant.noise_std}
    assert joints.std() == pytest.approx(noise["joint_position_rad"], rel=0.02)
    assert rates.std() == pytest.approx(noise["joint_velocity_rad_s"], rel=0.02)
    assert omega.std() == pytest.approx(noise["base_angular_velocity_rad_s"], rel=0.05)
    assert acc.std() == pytest.approx(noise["base_acceleration_m_s2"], rel=0.05)
    correlation = np.corrcoef(rates.T) - np.eye(33)
    assert np.abs(correlation).max() < 0.1


def test_ideal_sensors_read_the_truth(simulate: Callable, run: Callable) -> None:
    simulator = simulate("flat_walk", "ideal")
    run(simulator, 0.3)
    np.testing.assert_array_equal(simulator.sensors.q, simulator.plant.qpos)
    np.testing.assert_array_equal(simulator.sensors.v, simulator.plant.qvel)


def test_base_orientation_is_never_noisy(simulate: Callable, run: Callable) -> None:
    simulator = simulate("flat_walk", "all_uncertainty")
    run(simulator, 0.1)
    np.testing.assert_array_equal(simulator.sensors.q[3:7], simulator.plant.qpos[3:7])


@pytest.mark.sim
@pytest.mark.slow
@pytest.mark.parametrize(("scenario", "bound"), [("forward_walk", 4e-3), ("random_walk", 2e-2)])
def test_sensed_base_velocity_stays_near_truth(simulate: Callable, run: Callable, scenario: str, bound: float) -> None:
    """Root mean square of seven walks of 8 s with all uncertainty [m/s]; single ones lie between 1.5 and 5 mm/s.

    A support foot that slips in a hard turn costs most.
    """
    errors = []
    for seed in range(1, 8):
        simulator = simulate(scenario, "all_uncertainty", seed)
        assert run(simulator, 2.0).done == 2000
        for _ in range(800):
            run(simulator, 0.01)
            errors.append(simulator.sensors.v[:3] - simulator.plant.qvel[:3])
    assert np.sqrt(np.mean(np.square(errors), axis=0)).max() < bound
    assert np.median(np.abs(errors)) < 2e-3


def test_sensed_base_converges_from_a_wrong_velocity(simulate: Callable, run: Callable) -> None:
    simulator = simulate("flat_place", "sensor_noise", standing=True)
    run(simulator, 0.2)
    simulator.sensors.v[:3] += [0.05, -0.05, 0.02]
    run(simulator, 2.0)
    np.testing.assert_allclose(simulator.sensors.v[:3], simulator.plant.qvel[:3], atol=3e-3)
