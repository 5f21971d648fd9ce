"""The upper body's reference: through its knots, continuous in velocity, held at the ends."""

import numpy as np
import pytest

from mobnet.control.upper_body import UpperBody, follow

RATE_HZ = 50.0


@pytest.fixture
def upper():
    """A motion of three joints, 1 s long, that starts half a second into the clock."""
    time = np.arange(51) / RATE_HZ
    return UpperBody(np.column_stack([np.sin(3 * time), time, np.full(51, 0.7)]), RATE_HZ, np.array([0.5]))


def at(upper, clock):
    q, v = np.zeros(3), np.zeros(3)
    follow(upper, clock, q, v)
    return q, v


def test_reference_meets_every_knot(upper):
    for k, knot in enumerate(upper.knots):
        np.testing.assert_allclose(at(upper, k / RATE_HZ - 0.5)[0], knot, atol=1e-12)


def test_velocity_is_the_derivative_of_position_and_continuous(upper):
    clocks, small = np.linspace(-0.45, 0.45, 333), 1e-6
    for clock in clocks:
        slope = (at(upper, clock + small)[0] - at(upper, clock - small)[0]) / (2 * small)
        np.testing.assert_allclose(at(upper, clock)[1], slope, atol=1e-5)
    for k in range(1, 50):
        before, after = (at(upper, k / RATE_HZ - 0.5 + sign * 1e-9)[1] for sign in (-1, 1))
        np.testing.assert_allclose(before, after, atol=1e-5)


def test_line_is_followed_exactly_and_a_constant_stays(upper):
    """Linear motion is a cubic's closed form; a constant has zero velocity."""
    for clock in np.linspace(-0.48, 0.48, 77):
        q, v = at(upper, clock)
        np.testing.assert_allclose([q[1], v[1], q[2], v[2]], [clock + 0.5, 1.0, 0.7, 0.0], atol=1e-12)


@pytest.mark.parametrize(("clock", "row"), [(-5.0, 0), (-0.5, 0), (0.5, -1), (9.0, -1)])
def test_ends_are_held_still(upper, clock, row):
    q, v = at(upper, clock)
    np.testing.assert_array_equal(q, upper.knots[row])
    np.testing.assert_array_equal(v, 0)


@pytest.mark.parametrize(("clock", "knots"), [(-0.5 + 1e-9, slice(0, 2)), (0.5 - 1e-9, slice(-2, None))])
def test_a_motion_begins_and_ends_with_half_the_speed_of_its_outer_intervals(upper, clock, knots):
    """The joint rests on the other side of the first and the last knot."""
    _, v = at(upper, clock)
    np.testing.assert_allclose(v, np.diff(upper.knots[knots], axis=0)[0] * RATE_HZ / 2, atol=1e-5)


def test_single_knot_is_a_posture():
    still = UpperBody(np.array([[0.1, 0.2, 0.3]]), 1.0, np.zeros(1))
    for clock in (-1.0, 0.0, 0.5, 1.0, 100.0):
        q, v = at(still, clock)
        assert (q.tolist(), v.tolist()) == ([0.1, 0.2, 0.3], [0, 0, 0])
