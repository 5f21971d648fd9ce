"""Properties of (1), (4) and (6) that hold in every state."""

import numpy as np
import pinocchio as pin
import pytest

from mobnet.core.arrays import rotation
from mobnet.robot import dynamics
from mobnet.robot.frames import to_pinocchio
from mobnet.robot.nominal import NominalModel

STEP = 1e-6  # for differences in time [s]
BACK = [0, 1, 2, 6, 3, 4, 5, *range(7, 40)]  # Pinocchio has the real part of a quaternion last
TOLERANCE = 1e-4  # on entries of about 100


def mass_matrix_rate(model, q, v):
    """Return Mdot (nv, nv) by a central difference along v."""
    data = model.createData()
    after, before = (pin.crba(model, data, pin.integrate(model, q, sign * STEP * v)).copy() for sign in (1, -1))
    upper = np.triu(after - before) / (2 * STEP)
    return upper + np.triu(upper, 1).T


def with_composite_root(model):
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
def test_coriolis_and_its_transpose_sum_to_the_rate_of_inertia(nominal, random_state, seed):
    """The identity C + C^T = dM/dt; and C v with gravity is the bias."""
    q, v = random_state(seed)
    matrix = dynamics.coriolis(nominal, q, v)
    rate = mass_matrix_rate(nominal.model, to_pinocchio(q), v)
    np.testing.assert_allclose(matrix + matrix.T, rate, atol=TOLERANCE)
    parts = matrix @ v + dynamics.gravity(nominal, q)
    np.testing.assert_allclose(parts, dynamics.bias(nominal, q, v), atol=1e-9)


def test_a_composite_root_would_fail_that_property(nominal, random_state):
    q, v = random_state(0)
    model, position = with_composite_root(nominal.model), to_pinocchio(q)
    data = model.createData()
    matrix = pin.computeCoriolisMatrix(model, data, position, v)
    assert np.abs(pin.nonLinearEffects(model, data, position, v) - dynamics.bias(nominal, q, v)).max() < 1e-9
    assert np.abs(matrix + matrix.T - mass_matrix_rate(model, position, v)).max() > 1


def test_momentum_of_the_base_is_mass_times_velocity_of_the_centre_of_mass(nominal, random_state):
    q, v = random_state(3)
    momentum, _ = dynamics.momentum_and_beta(nominal, q, v)
    pin.centerOfMass(nominal.model, nominal.data, to_pinocchio(q), v)
    np.testing.assert_allclose(momentum[:3], nominal.robot.mass * nominal.data.vcom[0], atol=1e-10)


def test_rate_of_momentum_is_torque_plus_beta(nominal, random_state):
    (q, v), (_, a) = random_state(5), random_state(6)
    position = to_pinocchio(q)
    moved = (pin.integrate(nominal.model, position, sign * STEP * v)[BACK] for sign in (1, -1))
    rates = (v + STEP * a, v - STEP * a)
    after, before = (dynamics.momentum_and_beta(nominal, *pair)[0] for pair in zip(moved, rates, strict=True))
    torque = dynamics.inverse_dynamics(nominal, q, v, a)
    expected = torque + dynamics.momentum_and_beta(nominal, q, v)[1]
    np.testing.assert_allclose((after - before) / (2 * STEP), expected, atol=TOLERANCE)


@pytest.mark.parametrize("order", ["C", "F"])
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("machine", ["robot", "arm"])
def test_any_memory_order_and_float_type_gives_the_same(request, machine, dtype, order):
    """Columns of a table, as pandas hands them out, are the reference's rows in another order."""
    nominal, rng = NominalModel(request.getfixturevalue(machine)), np.random.default_rng(8)
    layout = nominal.robot.layout
    q, v = (rng.normal(size=(5, width)).astype(dtype) for width in (layout.nq, layout.nv))
    expected = dynamics.momentum_and_beta(nominal, q.astype(np.float64), v.astype(np.float64))
    for given in ((np.array(q, order=order), np.array(v, order=order)), (np.repeat(q, 2, 0)[::2], v[::-1][::-1])):
        np.testing.assert_array_equal(dynamics.momentum_and_beta(nominal, *given), expected)
    column = dynamics.mass_matrix(nominal, np.array(q, order=order)[2])
    np.testing.assert_array_equal(column, dynamics.mass_matrix(nominal, q[2].astype(np.float64)))


def test_yaw_of_the_world_turns_the_linear_part_only(nominal, random_state):
    """The joints' dynamics are invariant to the robot's heading."""
    q, v = random_state(7)
    turn = rotation(np.array([np.cos(0.35), 0, 0, np.sin(0.35)]))
    turned_q, turned_v = q.copy(), v.copy()
    turned_q[:3], turned_v[:3] = turn @ q[:3], turn @ v[:3]
    root = pin.Quaternion(turn @ rotation(q[3:7]))
    turned_q[3:7] = root.w, root.x, root.y, root.z
    terms = (dynamics.momentum_and_beta(nominal, *state) for state in ((q, v), (turned_q, turned_v)))
    for here, there in zip(*terms, strict=True):
        np.testing.assert_allclose(there[:3], turn @ here[:3], atol=1e-9)
        np.testing.assert_allclose(there[3:], here[3:], atol=1e-9)
