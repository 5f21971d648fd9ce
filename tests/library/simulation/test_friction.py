"""Joint friction obeys (23)."""

import numpy as np
import pytest

from mobnet.simulation.friction import friction_torque, make_friction

LEG, ARM = 0, 1


@pytest.fixture
def friction(settings):
    return make_friction(settings.plant, np.array([True, False]), ["stribeck", "load"])


@pytest.mark.parametrize("rate", [-3.0, -0.2, 0.2, 1.51, 6.0, 100.0])
@pytest.mark.parametrize("torque", [-100.0, 0.0, 30.0])
def test_leg_friction_is_table_4_in_equation_23(friction, rate, torque):
    dry = 5.0 + (2.0 - 5.0) * np.exp(-abs(rate / 1.51)) + 0.002 * torque**2
    assert friction_torque(friction, LEG, rate, torque) == pytest.approx(-np.sign(rate) * dry - 4.0 * rate, rel=1e-6)


def test_arm_friction_has_less_damping_and_no_load_term(friction):
    dry = 5.0 - 3.0 * np.exp(-1.0 / 1.51)
    assert friction_torque(friction, ARM, 1.0, 50.0) == pytest.approx(-dry - 3.0, rel=1e-9)


@pytest.mark.parametrize("rate", [1e-3, 0.02, 0.5, 5.0])
def test_friction_is_odd_in_the_rate_and_takes_energy(friction, rate):
    for torque in (-80.0, 20.0):
        forward, back = (friction_torque(friction, LEG, sign * rate, torque) for sign in (1, -1))
        assert forward == -back
        assert forward * rate < 0


def test_friction_is_zero_at_rest_and_rises_smoothly(friction):
    assert friction_torque(friction, LEG, 0.0, 100.0) == 0.0
    half = friction_torque(friction, LEG, 0.0, 0.0), friction_torque(friction, LEG, 1e-6, 0.0)
    slope = (half[1] - half[0]) / 1e-6
    assert slope == pytest.approx(-2.0 / friction.smoothing - 4.0, rel=1e-4)


def test_absent_friction_is_zero(settings):
    absent = make_friction(settings.plant, np.array([True, False]), [])
    assert [friction_torque(absent, joint, 2.0, 100.0) for joint in (LEG, ARM)] == [0.0, 0.0]
