"""Identification: wrenches from torques by the contact Jacobian, and what no expected contact explains."""

import mujoco
import numpy as np
import pytest

from mobnet.core.joints import N_VIRTUAL
from mobnet.formats.plain import as_plain
from mobnet.reaction.contacts import (
    end_effectors,
    identify,
    make_ends,
    tell_feet,
    unexpected_force,
    unexpected_wrench,
)
from mobnet.reaction.numbers import WrenchDamping
from mobnet.robot.plant import robot_spec


@pytest.fixture(scope="module")
def ends(settings, robot):
    return make_ends(robot, end_effectors(robot), as_plain(settings.reaction.identification, WrenchDamping))


@pytest.fixture(scope="module")
def model(robot):
    return robot_spec(robot).compile()


def bent(robot, rng):
    """Return a generalized position with bent joints, so that each limb's Jacobian has full rank (nq,)."""
    q = np.zeros(robot.layout.nq)
    q[:3], q[3:7] = rng.normal(size=3), rng.normal(size=4)
    q[3:7] /= np.linalg.norm(q[3:7])
    q[7:] = [rng.uniform(max(joint.range[0], -0.6), min(joint.range[1], 0.6)) for joint in robot.joints]
    for name in ("LL4", "RL4"):
        q[7 + robot.layout.actuated.index(name)] = 0.8
    return q


def pulled(model, q, body, wrench):
    """Return what a wrench at the origin of a body does to all joints by MuJoCo (nv,)."""
    data, tau = mujoco.MjData(model), np.zeros(model.nv)
    data.qpos[:] = q
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    mujoco.mj_applyFT(model, data, wrench[:3], wrench[3:], data.body(body).xpos, model.body(body).id, tau)
    return tau, data


def test_feet_come_first_and_hands_end_the_arms(robot):
    assert list(end_effectors(robot)) == ["LL", "RL", "LA", "RA"]
    assert end_effectors(robot)["LL"] == robot.feet["left"].body


@pytest.mark.parametrize("number", range(4))
def test_the_wrench_behind_torques_is_found(ends, model, robot, number):
    rng = np.random.default_rng(number)
    q, body = bent(robot, rng), list(end_effectors(robot).values())[number]
    wrench = np.concatenate([rng.normal(size=3) * 100.0, rng.normal(size=3) * 10.0])
    tau, _ = pulled(model, q, body, wrench)
    identify(ends, q, tau)
    assert ends.wrench[number] == pytest.approx(wrench, rel=0.01, abs=0.5)  # the damping takes some of it
    others = [k for k in range(4) if k != number]
    assert np.abs(ends.wrench[others]).max() == 0.0


def test_the_damped_wrench_is_the_smallest_sum_of_squares(ends, robot, settings):
    """(C2), with the Jacobian of the joints as the identification itself has it."""
    rng = np.random.default_rng(7)
    q, tau = bent(robot, rng), rng.normal(size=robot.layout.nv)
    identify(ends, q, tau)
    jacobian = np.zeros((6, 6))
    place, pose = ends.pose.position[ends.body[0]], ends.pose
    for j in range(6):
        body = ends.tree.body_of_joint[j]
        jacobian[:3, j], jacobian[3:, j] = np.cross(pose.axis[j], place - pose.position[body]), pose.axis[j]
    numbers = settings.reaction.identification
    scale = np.repeat([numbers.force_n, numbers.moment_nm], 3)
    stacked = np.vstack([jacobian.T / numbers.torque_error_nm, np.diag(1.0 / scale)])
    wanted = np.concatenate([tau[N_VIRTUAL : N_VIRTUAL + 6] / numbers.torque_error_nm, np.zeros(6)])
    assert ends.wrench[0] == pytest.approx(np.linalg.lstsq(stacked, wanted)[0], rel=1e-6, abs=1e-6)


def test_what_expected_contacts_do_not_explain_is_left(ends, model, robot):
    """(24): the foot that stands is taken off, and a force on the knee of the other leg stays, at its place."""
    rng = np.random.default_rng(3)
    q = bent(robot, rng)
    ground = np.array([20.0, -10.0, 900.0, 5.0, 12.0, 1.0])
    tau, data = pulled(model, q, robot.feet["right"].body, ground)
    knee = data.body("L_Knee_Link").xpos.copy()
    push = np.array([-150.0, 30.0, 0.0])
    mujoco.mj_applyFT(model, data, push, np.zeros(3), knee, model.body("L_Knee_Link").id, tau)
    identify(ends, q, tau)
    found = unexpected_wrench(ends, tau, [1])
    assert found[:3] == pytest.approx(push, abs=8.0)  # less than a hundredth of what the ground pushes
    assert found[3:] == pytest.approx(np.cross(knee - q[:3], push), abs=8.0)


def force_on_base(ends, q, tau, std, swing, height_m=0.03):
    force, deviation = np.zeros(3), np.zeros(3)
    unexpected_force(ends, q, tau, std, np.array(swing, float), height_m, force, deviation)
    return force, deviation


@pytest.mark.parametrize(("swing", "standing"), [((0, 0), [0, 1]), ((1, 0), [1]), ((0, 1), [0])])
def test_the_force_on_the_base_is_that_of_the_wrench_in_its_axes(ends, robot, swing, standing):
    """With 1 m below the other foot as the height, a foot that swings is always in the air."""
    rng = np.random.default_rng(7)
    q, tau = bent(robot, rng), rng.normal(size=robot.layout.nv) * 20.0
    identify(ends, q, tau)
    wrench = unexpected_wrench(ends, tau, standing)
    rotation = ends.pose.rotation[0].copy()
    force, _ = force_on_base(ends, q, tau, np.ones(len(tau)), swing, height_m=-1.0)
    assert force == pytest.approx(rotation.T @ wrench[:3])


def test_its_standard_deviation_is_that_of_a_sum_of_independent_errors(ends, robot):
    rng = np.random.default_rng(8)
    q, std = bent(robot, rng), rng.uniform(0.5, 5.0, size=robot.layout.nv)
    parts = [force_on_base(ends, q, own, std, (0, 0))[0] for own in np.diag(std)]
    _, deviation = force_on_base(ends, q, np.zeros(len(std)), std, (0, 0))
    assert deviation == pytest.approx(np.linalg.norm(parts, axis=0))


def test_a_low_foot_may_touch_the_ground_though_it_swings(ends, robot):
    rng = np.random.default_rng(9)
    q, tau = bent(robot, rng), rng.normal(size=robot.layout.nv) * 20.0
    identify(ends, q, tau)
    height = ends.pose.position[ends.body[0], 2] - ends.pose.position[ends.body[1], 2]
    std = np.ones(len(tau))
    stands = force_on_base(ends, q, tau, std, (0, 0))
    low = force_on_base(ends, q, tau, std, (1, 0), height + 0.01)
    high = force_on_base(ends, q, tau, std, (1, 0), height - 0.01)
    assert low[0].tolist() == stands[0].tolist()
    assert (high[1] < stands[1]).all()  # the errors of one leg less


def test_feet_are_told_what_their_sensors_would_read(ends, model, robot):
    rng = np.random.default_rng(5)
    q, body = bent(robot, rng), robot.feet["left"].body
    wrench = np.array([30.0, 20.0, 800.0, 10.0, -20.0, 3.0])
    tau, data = pulled(model, q, body, wrench)
    identify(ends, q, tau)
    sensor, told = np.array(robot.sole.sensor_pos), np.zeros((2, 6))
    tell_feet(ends, sensor, np.zeros(2), 0.03, told)
    axes = data.body(body).xmat.reshape(3, 3)
    force = axes.T @ ends.wrench[0, :3]
    assert told[0, :3] == pytest.approx(force)
    assert told[0, 3:] == pytest.approx(axes.T @ ends.wrench[0, 3:] - np.cross(robot.sole.sensor_pos, force))
    assert np.abs(told[1]).max() == 0.0
    height = ends.pose.position[ends.body[0], 2] - ends.pose.position[ends.body[1], 2]
    cases = ((1.0, height - 0.01, False), (1.0, height + 0.01, True), (0.0, height - 0.01, True))
    for left, height_m, is_ground in cases:
        tell_feet(ends, sensor, np.array([left, 0.0]), height_m, told)
        assert told[0].any() == is_ground
