"""A two-link arm on a fixed base: both models against the closed form of a planar arm."""

import mujoco
import numpy as np
import pytest

from mobnet.robot.dynamics import bias, coriolis, gravity, mass_matrix, momentum_and_beta
from mobnet.robot.nominal import NominalModel
from mobnet.robot.plant import robot_spec

GRAVITY = 9.81


def closed_form(arm, q, v):
    """Return M (2, 2) and C v + g (2,) of links along x that hinges about y turn, gravity along -z."""
    _, upper, lower = arm.bodies
    length, reach, far = lower.pos[0], upper.com[0], lower.com[0]
    inertia, other = (body.inertia[1] for body in (upper, lower))
    coupling = lower.mass * length * far
    m22 = other + lower.mass * far**2
    m12 = m22 + coupling * np.cos(q[1])
    m11 = inertia + upper.mass * reach**2 + m22 + lower.mass * length**2 + 2 * coupling * np.cos(q[1])
    g2 = -GRAVITY * lower.mass * far * np.cos(q[0] + q[1])
    g1 = g2 - GRAVITY * (upper.mass * reach + lower.mass * length) * np.cos(q[0])
    curve = coupling * np.sin(q[1]) * np.array([-v[1] * (2 * v[0] + v[1]), v[0] ** 2])
    return np.array([[m11, m12], [m12, m22]]) + np.diag(arm.armature), curve + [g1, g2]


@pytest.mark.parametrize("seed", range(3))
def test_both_models_equal_the_closed_form(arm, seed):
    """The reference is the equation of motion of a planar two-link arm; MuJoCo and Pinocchio must agree with it."""
    rng, nominal, plant = np.random.default_rng(seed), NominalModel(arm), robot_spec(arm).compile()
    q, v, data = rng.normal(size=2), rng.normal(size=2), mujoco.MjData(plant)
    expected, terms = closed_form(arm, q, v)
    data.qpos[:], data.qvel[:] = q, v
    mujoco.mj_forward(plant, data)
    inertia = np.zeros((2, 2))
    mujoco.mj_fullM(plant, data, inertia)
    for found in (mass_matrix(nominal, q), inertia):
        np.testing.assert_allclose(found, expected, atol=1e-10 * np.abs(expected).max())
    for found in (bias(nominal, q, v), data.qfrc_bias, coriolis(nominal, q, v) @ v + gravity(nominal, q)):
        np.testing.assert_allclose(found, terms, atol=1e-10 * np.abs(terms).max())
    momentum, beta = momentum_and_beta(nominal, q, v)
    np.testing.assert_allclose(momentum, expected @ v, atol=1e-10)
    np.testing.assert_allclose(beta, coriolis(nominal, q, v).T @ v - gravity(nominal, q), atol=1e-10)


def test_models_have_hinges_and_motors_alone_and_no_foot_to_load(arm):
    plant = robot_spec(arm).compile()
    assert (plant.nq, plant.nv, plant.nu, plant.nsensor, plant.nsite, plant.ngeom) == (2, 2, 2, 0, 0, 0)
    assert [plant.actuator(i).name for i in range(plant.nu)] == list(arm.layout.actuated)
    assert plant.body_mass.sum() == pytest.approx(arm.mass)
    assert NominalModel(arm).foot_frames == {}
