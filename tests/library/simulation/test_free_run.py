"""Recordings of robots in motion without walking: an ideal plant has an ideal observer, and the truth is the truth."""

from dataclasses import replace

import numpy as np
import pytest

from mobnet.core.arrays import rotation
from mobnet.estimation.observer import RobotObserver
from mobnet.kernel.low_pass import filter_in_place
from mobnet.robot.nominal import NominalModel
from mobnet.simulation.free_plant import damping_of, held_model, hidden_links, joint_friction
from mobnet.simulation.free_run import Numbers, record_motion, slightly_turned

SECONDS = 8.0
LONG_S = 6.0  # the longest pause and the longest push end before: there is a push, whatever is drawn
IDEAL_NM = 0.02  # error of the observer that issue 41 allows on an ideal plant
BEGIN = 500  # samples after which an observer has forgotten that it began


@pytest.fixture
def numbers(settings):
    return Numbers(settings.free_motion, settings.plant, settings.rates)


@pytest.fixture
def error_of(settings):
    """A function of a robot and a recording: error of the momentum observer (T, nv) [N, N m], from BEGIN on."""

    def measure(robot, recording):
        observer = RobotObserver(NominalModel(robot), settings.observer.gain_hz, recording.rate_hz, "sample")
        truth = filter_in_place(recording.truth.tau_ext.copy(), observer.pole)
        return (observer.residual(recording.sensed) - truth)[BEGIN:]

    return measure


@pytest.mark.parametrize("pushed", [False, True], ids=["free", "pushed"])
def test_on_an_ideal_plant_the_observer_is_ideal(imported, numbers, error_of, pushed):
    recording = record_motion(imported, numbers, SECONDS, 1, ideal=True, pushed=pushed)
    error = np.sqrt(np.square(error_of(imported, recording)).mean(axis=0))
    assert error.max() < IDEAL_NM
    assert recording.truth.pushed.any() == pushed
    joints = recording.truth.tau_ext[:, -imported.layout.nu :]
    assert (np.abs(joints).max() > 0.02 * imported.torque_limits.max()) == pushed


def test_without_pushes_only_what_holds_the_base_acts(imported, numbers):
    recording = record_motion(imported, numbers, 2.0, 1, ideal=True, pushed=False)
    base, motors = np.split(recording.truth.tau_ext[1:], [len(imported.layout.virtual)], axis=1)
    np.testing.assert_allclose(motors, 0.0, atol=1e-9)
    if imported.floating:
        assert base[:, 2].mean() == pytest.approx(imported.mass * numbers.plant.gravity_m_s2, rel=0.02)
        assert np.abs(recording.sensed.q[:, :3]).max() < 0.01
        assert recording.sensed.acc_base_in_base.mean(axis=0)[2] == pytest.approx(numbers.plant.gravity_m_s2, rel=0.02)


def test_a_push_is_a_push_alone_and_changes_nothing_before_it(imported, numbers):
    free, pushed = (record_motion(imported, numbers, LONG_S, 5, ideal=True, pushed=flag) for flag in (False, True))
    first = int(pushed.truth.pushed.argmax())
    assert first > 0
    np.testing.assert_array_equal(free.sensed.q[:first], pushed.sensed.q[:first])
    np.testing.assert_allclose(pushed.truth.tau_push[pushed.truth.pushed[:, 0] == 0], 0.0, atol=1e-12)
    assert not np.array_equal(free.sensed.q[first + 100], pushed.sensed.q[first + 100])


def test_a_hidden_plant_costs_the_observer_what_friction_takes(imported, numbers, error_of):
    recording = record_motion(imported, numbers, SECONDS, 2, ideal=False, pushed=False)
    size = np.sqrt(np.square(error_of(imported, recording)).mean(axis=0))[-imported.layout.nu :]
    coulomb = numbers.motion.joints.coulomb_share * imported.torque_limits
    assert (size > 0.3 * coulomb).all()
    assert (size < 6 * coulomb).all()


def test_a_recording_depends_on_its_seed_alone(arm, numbers):
    one, same, next_one = (record_motion(arm, numbers, 1.0, seed, ideal=False, pushed=True) for seed in (1, 1, 2))
    np.testing.assert_array_equal(one.sensed.tau_motor, same.sensed.tau_motor)
    assert not np.array_equal(one.sensed.q, next_one.sensed.q)


def test_all_recordings_are_of_the_same_robot(arm, numbers):
    """At rest in the same posture, what the motors report is the same torque but for noise."""
    rest = [record_motion(arm, numbers, 0.02, seed, ideal=False, pushed=False).sensed.tau_motor[:5] for seed in (1, 2)]
    noise = numbers.motion.joints.torque_noise_share * arm.torque_limits
    assert (np.abs(np.mean(rest[0], axis=0) - np.mean(rest[1], axis=0)) < 5 * noise).all()


def test_friction_opposes_motion_and_grows_with_speed_and_torque(imported, numbers):
    friction, nu = joint_friction(imported, numbers.motion), imported.layout.nu
    slow, fast, torque = np.full(nu, 0.5), np.full(nu, 1.0), 0.5 * imported.torque_limits
    taken = [damping_of(friction, v, tau) * v for v, tau in ((slow, 0 * torque), (fast, 0 * torque), (fast, torque))]
    assert (taken[0] > 0.9 * friction.dry).all()
    assert (np.diff(taken, axis=0) > 0).all()
    np.testing.assert_allclose(damping_of(friction, -fast, torque), damping_of(friction, fast, torque))
    assert np.isfinite(damping_of(friction, 0 * slow, torque)).all()


def test_a_base_is_turned_by_the_rotation_that_is_asked_for():
    quaternion, angle = np.array([[np.cos(0.3), np.sin(0.3), 0.0, 0.0]]), np.array([[0.0, 0.0, 1e-3]])
    expected = rotation(quaternion[0]) @ [[1, -1e-3, 0], [1e-3, 1, 0], [0, 0, 1]]
    np.testing.assert_allclose(rotation(slightly_turned(quaternion, angle / 2)[0]), expected, atol=1e-6)


def test_hidden_links_are_near_those_of_the_table(imported, settings):
    section = settings.free_motion.body
    built = hidden_links(imported, section, np.random.default_rng(0))
    ratios = np.array([b.mass / a.mass for a, b in zip(imported.bodies, built.bodies, strict=True)])
    assert (np.abs(ratios - 1) <= section.mass_share).all()
    assert np.ptp(ratios) > section.mass_share / 2
    held_model(built, settings.free_motion, 1000.0, 9.81)


def test_a_robot_without_points_is_pushed_at_its_links(imported, numbers):
    bare = replace(imported, points=(), feet={}, sole=None)
    recording = record_motion(bare, numbers, LONG_S, 5, ideal=True, pushed=True)
    assert np.abs(recording.truth.tau_push).max() > 0.02 * imported.torque_limits.min()
