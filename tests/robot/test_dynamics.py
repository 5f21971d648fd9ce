"""Properties of (1), (4) and (6) that hold in every state."""

from collections.abc import Callable
from typing import Literal

import numpy as np
import pinocchio as pin
import pytest

from mobnet.robot import dynamics
from mobnet.robot.description import RobotDescription
from mobnet.robot.dynamics import momentum_and_beta
from mobnet.robot.frames import from_pinocchio, rotation, to_pinocchio
from mobnet.robot.nominal import NominalModel

STEP = 1e-6  # for differences in time [s]
TOLERANCE = 1e-4  # on entries of about 100


def mass_matrix_rate(model: pin.Model, q: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Return Mdot (nv, nv) by a central difference along v."""
    data = model.createData()
    after, before = (pin.crba(model, data, pin.integrate(model, q, sign * STEP * v)).copy() for sign in (1, -1))
    upper = np.triu(after - before) / (2 * STEP)
    return upper + np.triu(upper, 1).T


def with_composite_root(model: pin.Model) -> pin.Model:
    """Return the same robot with translation and ball in one composite joint."""
    root = pin.JointModelComposite(2)
    root.addJoint(pin.JointModelTranslation())
    root.addJoint(pin.JointModelSpherical())
    composite = pin.Model()
    composite.addJoint(0, root, pin.SE3.Identity(), "base")
    composite.appendBodyToJoint(1, model.inertias[2], pin.SE3.Identity())
    for joint in range(3, model.njoints):
        parent, placement = model.parents[joint] - 1, model.jointPlacements[joint]
        composite.addJoint(parent, model.joints[joint], placement, model.names[joint])
        composite.appendBodyToJoint(joint - 1, model.inertias[joint], pin.SE3.Identity())
    composite.armature = model.armature
    return composite


@pytest.mark.parametrize("seed", range(3))
def test_coriolis_and_its_transpose_sum_to_the_rate_of_inertia(
    nominal: NominalModel, random_state: Callable, seed: int
) -> None:
    """The identity C + C^T = dM/dt; and C v with gravity is the bias."""
    q, v = random_state(seed)
    matrix = dynamics.coriolis(nominal, q, v)
    rate = mass_matrix_rate(nominal.model, to_pinocchio(q), v)
    np.testing.assert_allclose(matrix + matrix.T, rate, atol=TOLERANCE)
    parts = matrix @ v + dynamics.gravity(nominal, q)
    np.testing.assert_allclose(parts, dynamics.bias(nominal, q, v), atol=1e-9)


def test_a_composite_root_would_fail_that_property(nominal: NominalModel, random_state: Callable) -> None:
    q, v = random_state(0)
    model, position = with_composite_root(nominal.model), to_pinocchio(q)
    data = model.createData()
    matrix = pin.computeCoriolisMatrix(model, data, position, v)
    assert np.abs(pin.nonLinearEffects(model, data, position, v) - dynamics.bias(nominal, q, v)).max() < 1e-9
    assert np.abs(matrix + matrix.T - mass_matrix_rate(model, position, v)).max() > 1


def test_momentum_and_beta_are_what_their_names_say(nominal: NominalModel, random_state: Callable) -> None:
    """The momentum of the base is mass times velocity of the centre of mass."""
    q, v = random_state(3)
    momentum = dynamics.momentum(nominal, q, v)
    np.testing.assert_allclose(momentum, dynamics.mass_matrix(nominal, q) @ v, atol=1e-10)
    beta = dynamics.coriolis(nominal, q, v).T @ v - dynamics.gravity(nominal, q)
    np.testing.assert_allclose(dynamics.beta(nominal, q, v), beta, atol=1e-10)
    pin.centerOfMass(nominal.model, nominal.data, to_pinocchio(q), v)
    np.testing.assert_allclose(momentum[:3], nominal.robot.mass * nominal.data.vcom[0], atol=1e-10)


def test_rate_of_momentum_is_torque_plus_beta(nominal: NominalModel, random_state: Callable) -> None:
    (q, v), (_, a) = random_state(5), random_state(6)
    position = to_pinocchio(q)
    after, before = (
        dynamics.momentum(
            nominal, from_pinocchio(pin.integrate(nominal.model, position, sign * STEP * v)), v + sign * STEP * a
        )
        for sign in (1, -1)
    )
    torque = dynamics.inverse_dynamics(nominal, q, v, a)
    expected = torque + dynamics.beta(nominal, q, v)
    np.testing.assert_allclose((after - before) / (2 * STEP), expected, atol=TOLERANCE)


def test_batch_equals_one_by_one(nominal: NominalModel, random_state: Callable) -> None:
    """A batch and its samples one by one are equivalent."""
    states = [random_state(seed) for seed in range(4)]
    q, v = (np.stack(part) for part in zip(*states, strict=True))
    p, beta = dynamics.momentum_and_beta(nominal, q, v)
    np.testing.assert_array_equal(p, [dynamics.momentum(nominal, *state) for state in states])
    np.testing.assert_array_equal(beta, [dynamics.beta(nominal, *state) for state in states])


@pytest.mark.parametrize("order", ["C", "F"])
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("machine", ["robot", "arm"])
def test_any_memory_order_and_float_type_gives_the_same(
    request: pytest.FixtureRequest, machine: str, dtype: type, order: Literal["C", "F"]
) -> None:
    """Columns of a table, as pandas hands them out, are the reference's rows in another order."""
    nominal, rng = NominalModel(request.getfixturevalue(machine)), np.random.default_rng(8)
    layout = nominal.robot.layout
    q, v = (rng.normal(size=(5, width)).astype(dtype) for width in (layout.nq, layout.nv))
    expected = dynamics.momentum_and_beta(nominal, q.astype(np.float64), v.astype(np.float64))
    found = dynamics.momentum_and_beta(nominal, np.array(q, order=order), np.array(v, order=order))
    np.testing.assert_array_equal(found, expected)
    column = dynamics.mass_matrix(nominal, np.array(q, order=order)[2])
    np.testing.assert_array_equal(column, dynamics.mass_matrix(nominal, q[2].astype(np.float64)))


def test_yaw_of_the_world_turns_the_linear_part_only(nominal: NominalModel, random_state: Callable) -> None:
    """The joints' dynamics are invariant to the robot's heading."""
    q, v = random_state(7)
    turn = rotation(np.array([np.cos(0.35), 0, 0, np.sin(0.35)]))
    turned_q, turned_v = q.copy(), v.copy()
    turned_q[:3], turned_v[:3] = turn @ q[:3], turn @ v[:3]
    root = pin.Quaternion(turn @ rotation(q[3:7]))
    turned_q[3:7] = root.w, root.x, root.y, root.z
    for term in (dynamics.momentum, dynamics.beta):
        here, there = term(nominal, q, v), term(nominal, turned_q, turned_v)
        np.testing.assert_allclose(there[:3], turn @ here[:3], atol=1e-9)
        np.testing.assert_allclose(there[3:], here[3:], atol=1e-9)


@pytest.mark.parametrize("floats", [np.float32, np.float64])
def test_columns_of_a_log_in_any_memory_order_give_the_same(
    nominal: NominalModel, robot: RobotDescription, floats: type
) -> None:
    """Pandas gives Fortran order, which Pinocchio's bindings refuse row by row."""
    rng = np.random.default_rng(3)
    q, v = rng.normal(size=(20, robot.layout.nq)).astype(floats), rng.normal(size=(20, robot.layout.nv)).astype(floats)
    expected = momentum_and_beta(nominal, q, v)
    for given in ((np.asfortranarray(q), np.asfortranarray(v)), (np.repeat(q, 2, axis=0)[::2], v[::-1][::-1])):
        for found, value in zip(momentum_and_beta(nominal, *given), expected, strict=True):
            np.testing.assert_array_equal(found, value)
