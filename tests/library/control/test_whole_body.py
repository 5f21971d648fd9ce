"""Joint torques and references of the legs."""

import mujoco
import numpy as np
import pytest

from mobnet.control.geometry import yaw_roll_pitch_matrix
from mobnet.control.kinematics import update
from mobnet.control.whole_body import (
    LEG_JOINTS,
    leg_jacobian,
    leg_reference,
    posture_torque,
    stance_torque,
    swing_torque,
)
from mobnet.robot.plant import robot_spec

SOLE = np.array([0.03, 0.01, -0.158])  # point below the ankle [m]
BENT = np.array([0.1, 0.05, -0.5, 0.9, -0.4, -0.05])  # a leg [rad]
STEP, TICK_S = 1e-6, 0.0005
LEGS = [0, 1]


@pytest.fixture
def crouched(walker, robot):
    """Position (nq,) and velocity (nv,), both legs bent, the base tilted a little and moving."""
    q, v = np.zeros(robot.layout.nq), np.zeros(robot.layout.nv)
    q[:7] = [0.3, -0.2, 0.9, *(np.array([1.0, 0.05, -0.04, 0.3]) / np.linalg.norm([1.0, 0.05, -0.04, 0.3]))]
    v[:3] = [0.1, -0.2, 0.05]
    for first in walker.first:
        q[7 + first : 13 + first] = BENT
    update(walker.tree, q, v, walker.gravity, walker.pose)
    return q, v


@pytest.mark.parametrize("k", LEGS)
def test_jacobian_equals_differences_of_the_kinematics(walker, crouched, k):
    q, v = crouched
    first, foot, pose = walker.first[k], walker.feet[k], walker.pose
    jacobian, column = np.zeros((6, 6)), np.zeros(6)
    leg_jacobian(walker, k, jacobian)
    for j in range(LEG_JOINTS):
        places = []
        for step in (-STEP, STEP):
            moved = q.copy()
            moved[7 + first + j] += step
            update(walker.tree, moved, v, walker.gravity, pose)
            places.append((pose.position[foot].copy(), pose.rotation[foot].copy()))
        spin = (places[1][1] - places[0][1]) @ places[0][1].T / (2 * STEP)
        column[:3] = (places[1][0] - places[0][0]) / (2 * STEP)
        column[3:] = spin[2, 1], spin[0, 2], spin[1, 0]
        np.testing.assert_allclose(jacobian[:, j], column, atol=2e-6)


@pytest.mark.parametrize("k", LEGS)
def test_swing_reference_moves_the_foot_as_asked(walker, crouched, stepping, k):
    q, v = crouched
    pose, first, foot = walker.pose, walker.first[k], walker.feet[k]
    v[3:6] = [0.05, -0.03, 0.1]
    update(walker.tree, q, v, walker.gravity, pose)
    stepping.foot, stepping.foot_rotation = pose.position[foot], pose.rotation[foot]
    stepping.foot_velocity, stepping.foot_yaw_rate = [0.3, 0.1, -0.2], 0.4
    leg_reference(walker, stepping, k, True)
    np.testing.assert_allclose(stepping.q_reference[k], BENT, atol=1e-12)
    v[6 + first : 12 + first] = stepping.v_reference[k]
    update(walker.tree, q, v, walker.gravity, pose)
    np.testing.assert_allclose(pose.velocity[foot], stepping.foot_velocity, atol=1e-10)
    np.testing.assert_allclose(pose.omega[foot], [0, 0, stepping.foot_yaw_rate], atol=1e-10)


@pytest.mark.parametrize("k", LEGS)
def test_stance_reference_levels_a_pelvis_on_one_foot(walker, crouched, stepping, k):
    q, v = crouched
    pose, first, foot = walker.pose, walker.first[k], walker.feet[k]
    stepping.height, stepping.yaw, stepping.height_rate = 0.93, 0.5, v[2]
    leg_reference(walker, stepping, k, False)
    v[6 + first : 12 + first] = stepping.v_reference[k]
    still = pose.position[foot].copy()
    update(walker.tree, q, v, walker.gravity, pose)
    np.testing.assert_allclose(pose.velocity[foot], 0, atol=1e-10)
    q[2], q[3:7] = 0.93, [np.cos(0.25), 0, 0, np.sin(0.25)]
    q[7 + first : 13 + first] = stepping.q_reference[k]
    update(walker.tree, q, v, walker.gravity, pose)
    np.testing.assert_allclose(pose.position[foot], still, atol=1e-12)


def test_reference_speed_is_limited_also_near_a_straight_leg(walker, crouched, stepping):
    q, v = crouched
    q[10] = 1e-3
    update(walker.tree, q, v, walker.gravity, walker.pose)
    stepping.foot, stepping.foot_rotation = walker.pose.position[walker.feet[0]], np.eye(3)
    stepping.foot_velocity = [0.0, 0.0, -5.0]
    leg_reference(walker, stepping, 0, True)
    assert np.abs(stepping.v_reference[0]).max() <= walker.par.joint_speed_max_rad_s


def stand(walker, crouched, s, k, dt=0.0):
    """Return the torques (nu,) of a stance leg that follows its reference, pushing below the ankle."""
    q, v = crouched
    first, tau = walker.first[k], np.zeros(len(q) - 7)
    s.q_reference[k], s.v_reference[k] = q[7 + first : 13 + first], v[6 + first : 12 + first]
    stance_torque(walker, s, k, q, v, walker.pose.position[walker.feet[k]] + SOLE, dt, tau)
    return tau


@pytest.mark.parametrize("k", LEGS)
def test_stance_torque_is_the_force_through_mujoco_s_jacobian(walker, robot, crouched, stepping, k):
    q, _ = crouched
    stepping.force, stepping.load = [40.0, -25.0, 900.0], [0.6, 0.4]
    foot = walker.feet[k]
    walker.pose.rotation[foot] = np.eye(3)  # a level, still foot: no guard against tipping
    walker.pose.omega[foot] = 0
    tau = stand(walker, crouched, stepping, k)
    model = robot_spec(robot).compile()
    data, jacobian = mujoco.MjData(model), np.zeros((3, model.nv))
    data.qpos[:] = q
    mujoco.mj_forward(model, data)
    body = model.body(robot.bodies[foot].name).id
    mujoco.mj_jac(model, data, jacobian, None, walker.pose.position[foot] + SOLE, body)
    np.testing.assert_allclose(tau, -stepping.load[k] * jacobian[:, 6:].T @ stepping.force, atol=1e-9)


@pytest.mark.parametrize("k", LEGS)
def test_leg_that_lacks_load_pushes_by_a_share_more(walker, crouched, stepping, k):
    """More torque is that of more vertical force: the same as of a wanted force greater by that much."""
    lacks = 80.0
    stepping.force, stepping.load = [40.0, -25.0, 900.0], [0.6, 0.4]
    before = stand(walker, crouched, stepping, k)
    stepping.load_error[k] = lacks
    felt = stand(walker, crouched, stepping, k)
    stepping.load_error[k] = 0.0
    stepping.force[2] += walker.par.load_gain * lacks / stepping.load[k]
    np.testing.assert_allclose(felt, stand(walker, crouched, stepping, k), atol=1e-9)
    knee = walker.first[k] + 3
    assert (felt - before)[knee] < -1.0  # a positive angle bends the knee: this stretches the leg


@pytest.mark.parametrize("force", [4000.0, -4000.0])
def test_a_stance_knee_asks_for_no_more_than_its_bound(walker, crouched, stepping, force):
    """(W50): beyond the maximum of its friction law a knee that drives would get less of a greater torque."""
    stepping.force, stepping.load = [0.0, 0.0, force], [1.0, 0.0]
    tau = stand(walker, crouched, stepping, 0)
    assert abs(tau[walker.first[0] + 3]) == walker.par.knee_torque_max_nm
    assert np.abs(tau[:3]).max() > walker.par.knee_torque_max_nm  # no other joint is bounded


@pytest.mark.parametrize("yaw", [0.0, 1.1, -2.6])
def test_only_a_foot_off_the_slope_is_guarded(walker, crouched, stepping, yaw):
    stepping.load, stepping.force, stepping.slope = [1.0, 0.0], [0.0, 0.0, 0.0], [0.03, -0.02]
    foot, c, n = walker.feet[0], np.cos(yaw), np.sin(yaw)
    walker.pose.omega[foot] = 0
    ankles = []
    for share in (0.0, 1.0):  # level, along the slope
        slope = share * stepping.slope
        roll, pitch = np.arcsin(slope @ [-n, c]), -np.arcsin(slope @ [c, n])
        yaw_roll_pitch_matrix(yaw, roll, pitch, walker.pose.rotation[foot])
        ankles.append(np.abs(stand(walker, crouched, stepping, 0)[4:6]).max())
    assert ankles[0] > 0.5 * walker.par.guard_stiffness_nm * 0.03
    assert ankles[1] < 0.01 * ankles[0]


@pytest.mark.parametrize("which", [0, 1])
def test_ankle_integral_adds_a_missing_moment(walker, crouched, stepping, which):
    stepping.force, stepping.load = [0.0, 0.0, 900.0], [1.0, 0.0]
    walker.pose.rotation[walker.feet[0]] = np.eye(3)
    before = stand(walker, crouched, stepping, 0)[4 + which]
    for _ in range(20_000):
        after = stand(walker, crouched, stepping, 0, TICK_S)[4 + which]
    push = -before
    assert push != 0
    assert np.sign(after - before) == -np.sign(push)  # pushes harder
    assert abs(stepping.integral[0, which]) <= walker.par.ankle_integral_max_nm


def test_integral_leaks_away_on_a_tilted_foot(walker, crouched, stepping):
    stepping.load, stepping.integral[0] = [1.0, 0.0], 20.0
    walker.pose.rotation[walker.feet[0]] = np.array(
        [[1, 0, 0], [0, np.cos(0.3), -np.sin(0.3)], [0, np.sin(0.3), np.cos(0.3)]]
    )
    rate = walker.par.ankle_leak_hz + walker.par.ankle_tilt_leak_hz
    walker.wrench[:] = 1e3
    stand(walker, crouched, stepping, 0, TICK_S)
    np.testing.assert_allclose(stepping.integral[0], 20 * (1 - rate * TICK_S), rtol=1e-12)


def test_swing_torque_is_zero_on_the_reference(walker, crouched, stepping):
    q, v = crouched
    tau = np.zeros(len(q) - 7)
    stepping.q_reference[0], stepping.integral[0] = BENT, 5.0
    swing_torque(walker, stepping, 0, q, v, tau)
    np.testing.assert_array_equal(tau, 0)
    np.testing.assert_array_equal(stepping.integral[0], 0)
    stepping.q_reference[0] += 0.1
    swing_torque(walker, stepping, 0, q, v, tau)
    np.testing.assert_allclose(tau[:6], 0.1 * np.array(walker.par.leg_stiffness_nm_rad), rtol=1e-12)


def test_posture_torque_is_a_spring_and_a_damper_about_a_moving_target(walker, random_pose):
    q, v = random_pose(0)
    tau, upper, (stiffness, damping) = np.zeros(len(q) - 7), walker.upper, np.random.default_rng(1).random((2, 21))
    walker = walker._replace(posture_stiffness=stiffness, posture_damping=damping)
    walker.posture_rate[:] = np.random.default_rng(2).normal(size=len(walker.posture))
    posture_torque(walker, q, v, tau)
    error, rate = walker.posture - q[7 + upper :], walker.posture_rate - v[6 + upper :]
    np.testing.assert_allclose(tau[upper:], stiffness * error + damping * rate, rtol=1e-12)
    np.testing.assert_array_equal(tau[:upper], 0)
    walker.posture[:], walker.posture_rate[:], tau[:] = q[7 + upper :], v[6 + upper :], 0
    posture_torque(walker, q, v, tau)  # on a motion that is followed
    np.testing.assert_array_equal(tau, 0)
