"""Kinematics and centroidal quantities against MuJoCo."""

import mujoco
import numpy as np
import pytest

from mobnet.control.kinematics import tree_of, update
from mobnet.robot.plant import robot_spec

SEEDS = range(4)


@pytest.fixture(scope="module")
def model(robot):
    return robot_spec(robot).compile()


@pytest.fixture(params=SEEDS)
def data(model, random_pose, request):
    return mujoco_at(model, *random_pose(request.param))


def mujoco_at(model, q, v):
    """Return MuJoCo's data at q (nq,), v (nv,)."""
    data = mujoco.MjData(model)
    data.qpos[:], data.qvel[:] = q, v
    mujoco.mj_forward(model, data)
    mujoco.mj_subtreeVel(model, data)
    return data


def test_bodies_stand_where_mujoco_puts_them(walker, robot, data):
    pose = walker.pose
    for i, body in enumerate(robot.bodies):
        np.testing.assert_allclose(pose.position[i], data.body(body.name).xpos, atol=1e-12)
        np.testing.assert_allclose(pose.rotation[i].ravel(), data.body(body.name).xmat, atol=1e-12)
    for j, joint in enumerate(robot.joints):
        np.testing.assert_allclose(pose.axis[j], data.joint(joint.id).xaxis, atol=1e-12)


def test_bodies_move_as_mujoco_s(walker, robot, data):
    pose = walker.pose
    model, linear, angular = data.model, np.zeros((3, 39)), np.zeros((3, 39))
    for i, body in enumerate(robot.bodies):
        mujoco.mj_jacBody(model, data, linear, angular, model.body(body.name).id)
        np.testing.assert_allclose(pose.velocity[i], linear @ data.qvel, atol=1e-11)
        np.testing.assert_allclose(pose.omega[i], angular @ data.qvel, atol=1e-11)


def test_centre_of_mass_and_momentum_are_mujoco_s(walker, robot, data):
    """MuJoCo is the reference, at a random state; mean inertia costs less than a tenth of angular momentum."""
    pose, base = walker.pose, data.body(robot.base)
    assert pose.weight[0] == pytest.approx(robot.mass, rel=1e-12)
    np.testing.assert_allclose(pose.com, base.subtree_com, atol=1e-12)
    np.testing.assert_allclose(pose.com_velocity, base.subtree_linvel, atol=1e-11)
    assert np.linalg.norm(pose.spin - base.subtree_angmom) < 0.1 * np.linalg.norm(base.subtree_angmom)


@pytest.mark.parametrize("seed", SEEDS)
def test_spin_is_exact_for_round_links(walker, robot, random_pose, seed):
    """With every link's inertia replaced by its mean principal moment, which the controller assumes."""
    round_links = robot_spec(robot).compile()
    round_links.body_inertia[:] = round_links.body_inertia.mean(axis=1, keepdims=True)
    data = mujoco_at(round_links, *random_pose(seed))
    np.testing.assert_allclose(walker.pose.spin, data.body(robot.base).subtree_angmom, atol=1e-10)


def test_gravity_torque_is_mujoco_s_bias_at_rest(walker, model, data):
    data.qvel[:] = 0
    mujoco.mj_forward(model, data)
    np.testing.assert_allclose(walker.pose.gravity, data.qfrc_bias[6:], atol=1e-10)


def test_mass_ratio_scales_masses_and_inertias_only(robot):
    full, light = tree_of(robot, 1.0), tree_of(robot, 0.9)
    for name in full._fields:
        factor = 0.9 if name in ("mass", "inertia") else 1
        np.testing.assert_allclose(getattr(light, name), factor * np.asarray(getattr(full, name)), rtol=1e-15)


def test_update_forgets_the_last_pose(walker, random_pose):
    q, v = random_pose(0)
    first = [np.copy(field) for field in walker.pose]
    random_pose(1)
    update(walker.tree, q, v, walker.gravity, walker.pose)
    for before, after in zip(first, walker.pose, strict=True):
        np.testing.assert_array_equal(before, after)
