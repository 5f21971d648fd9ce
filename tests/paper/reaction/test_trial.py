"""What came of a walk: contacts, impulses, angles, and times that count from its beginning."""

import numpy as np
import pytest

from experiments.jobs.reaction_trial import angle_deg, contacts_of, impulse_ns, trial_of
from mobnet.reaction.handler import Reacted
from mobnet.reaction.loop import Course
from mobnet.settings.reaction import Watch

RATE_HZ = 1000.0


def forces(*spans, samples=1000, size=-100.0):
    force = np.zeros((samples, 3), np.float32)
    for start, end in spans:
        force[start:end, 0] = size
    return force


def course_of(force, reacted=None, fallen=False, error_m_s=(0.0, 0.0, 0.0)):
    """Return a course in whose second half a leg swings 3 and 4 mrad from its references, with a power of 2 W."""
    rows, torque, place = (np.zeros((len(force), n), np.float32) for n in (4, 2, 3))
    error = np.broadcast_to(np.array(error_m_s, np.float32), force.shape)
    tracking, power = np.full((len(force), 2), np.nan, np.float32), np.full((len(force), 1), 2.0, np.float32)
    tracking[len(force) // 2 :] = 0.003, 0.004
    return Course(rows, torque, torque, force, place, place, error, tracking, power, {}, reacted, fallen)


def test_contacts_are_told_apart_by_a_gap():
    assert contacts_of(forces((100, 150), (160, 200), (500, 510)), 1.0, 20) == [slice(100, 200), slice(500, 510)]
    assert contacts_of(forces(size=0.5, samples=10), 1.0, 20) == []


def test_an_impulse_is_the_length_of_a_vector_not_a_sum_of_lengths():
    force = forces((100, 200))
    assert impulse_ns(force, [slice(100, 200)], RATE_HZ) == pytest.approx(10.0)
    force[150:200] *= -1.0
    assert impulse_ns(force, [slice(100, 200)], RATE_HZ) == pytest.approx(0.0)


@pytest.mark.parametrize(("direction", "angle"), [((-1, 0), 0.0), ((0, 1), 90.0), ((1, 0), 180.0), ((-1, -1), 45.0)])
def test_angles(direction, angle):
    assert angle_deg(np.array(direction, float), np.array([-50.0, 0.0], np.float32)) == pytest.approx(angle, abs=1e-4)


def test_a_trial_has_its_times_from_the_beginning(settings):
    reacted = Reacted("LL", np.array([-1.0, 0.0]), np.array([0.0, 5.0, 0, 0, 0, 0]), np.zeros((5, 5)))
    course = course_of(forces((300, 360), (600, 610), size=-200.0), (330, reacted), fallen=True)
    watch = Watch(detector="MOB", rule="collision", wait_s=0.02)
    row = trial_of(settings.reaction, ("foot", "robot_1", 7), watch, course, 0, RATE_HZ, stopped=True)
    assert (row.case, row.level, row.seed, row.detector, row.rule) == ("foot", "robot_1", 7, "MOB", "collision")
    assert (row.contact_s, row.alarm_s, row.reacted_s, row.fell_s) == pytest.approx((0.3, 0.31, 0.33, 1.0))
    assert (row.first_peak_n, row.peak_n, row.contacts, row.stopped) == (200.0, 200.0, 2, 0)
    assert (row.first_impulse_ns, row.impulse_ns) == pytest.approx((12.0, 14.0))
    assert (row.angle_deg, row.base_angle_deg) == pytest.approx((0.0, 90.0), abs=1e-4)


def test_a_trial_without_contact_or_reaction_says_so(settings):
    row = trial_of(
        settings.reaction, ("foot", "robot_1", 7), Watch(detector="none"), course_of(forces()), 0, RATE_HZ, False
    )
    empty = row.contact_s, row.alarm_s, row.reacted_s, row.angle_deg, row.first_peak_n, row.peak_n, row.fell_s
    assert empty == (None,) * 7
    assert (row.limb, row.rule, row.contacts) == ("", "", 0)


def test_a_robot_walks_as_told_until_it_reacts_or_is_touched_and_its_velocity_is_compared_until_then(settings):
    place, watch = ("free", "robot_1", 7), Watch(detector="MOB", wrench="sensed")
    reacted = Reacted("LL", np.array([-1.0, 0.0]), np.zeros(6), np.zeros((5, 5)))
    calm = course_of(forces(), error_m_s=(0.003, 0.0, -0.004))
    row = trial_of(settings.reaction, place, watch, calm, 100, RATE_HZ, False)
    assert (row.walked_s, row.velocity_rmse_m_s, row.wrench) == (0.9, pytest.approx(0.005), "sensed")
    assert (row.tracking_rmse_rad, row.power_w) == (pytest.approx(np.sqrt(12.5e-6)), 2.0)
    for course, walked_s in (
        (course_of(forces(), (200, reacted)), 0.2),
        (course_of(forces((300, 310)), (350, reacted)), 0.3),
        (course_of(forces((300, 310))), 0.3),
    ):
        assert trial_of(settings.reaction, place, watch, course, 0, RATE_HZ, False).walked_s == walked_s


def test_a_reaction_before_the_contact_has_no_direction(settings):
    reacted = Reacted("LL", np.array([-1.0, 0.0]), np.array([0.0, 5.0, 0, 0, 0, 0]), np.zeros((5, 5)))
    course = course_of(forces((300, 360)), (200, reacted))
    assert (
        trial_of(settings.reaction, ("foot", "r", 1), Watch(detector="MOB"), course, 0, RATE_HZ, True).angle_deg is None
    )


@pytest.mark.parametrize(("begins", "said"), [(300, 1), (700, 0)])
def test_a_contact_says_whether_it_began_in_mid_swing(settings, begins, said):
    mid_swing = np.arange(1000) < 500
    course = course_of(forces((begins, begins + 10)))
    row = trial_of(settings.reaction, ("foot", "r", 1), Watch(detector="MOB"), course, 0, RATE_HZ, False, mid_swing)
    assert row.in_swing == said


def test_where_no_leg_is_in_front_of_an_obstacle_nothing_is_said_of_its_swing(settings):
    course = course_of(forces((300, 310)))
    assert trial_of(settings.reaction, ("r", "r", 1), Watch(detector="MOB"), course, 0, RATE_HZ, False).in_swing is None
