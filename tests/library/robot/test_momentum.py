"""The compiled sweeps over the tree against Pinocchio, against the kinetic energy, and for any number of samples."""

import numpy as np
import pinocchio as pin
import pytest

from mobnet.core.errors import DataError
from mobnet.kernel.momentum import LANES
from mobnet.robot.description import describe
from mobnet.robot.dynamics import coriolis, gravity, mass_matrix, momentum_and_beta
from mobnet.robot.nominal import NominalModel
from mobnet.robot.wrench import feet_torque

STEP = 1e-5  # for differences along a joint [rad]
SKEW = ((0.6, 0.0, 0.8), (-2.0 / 3.0, 1.0 / 3.0, 2.0 / 3.0))
MACHINES = ("robot", "arm", "skew_arm", "skew_robot")


@pytest.fixture
def model_of(robot_table, arm_table):
    """A function of a machine's name and of what else a nominal model takes; axes of skew machines are not aligned."""

    def make(name, *known):
        table = arm_table if name.endswith("arm") else robot_table
        if name.startswith("skew"):
            joints = [row.model_copy(update={"axis": SKEW[i % 2]}) for i, row in enumerate(table.joints)]
            bodies = [row.model_copy(update={"quat": (0.5, -0.1, 0.7, 0.5)}) for row in table.bodies]
            table = table.model_copy(update={"joints": tuple(joints), "bodies": tuple(bodies)})
        return NominalModel(describe(table), *known)

    return make


def states(robot, count):
    """Return random positions, whose quaternions are of any length, and velocities (count, ...)."""
    rng = np.random.default_rng(count)
    return rng.normal(size=(count, robot.layout.nq)), rng.normal(size=(count, robot.layout.nv))


@pytest.mark.parametrize("known", [(), (0.9, 9.7), (0.9, 0.0)])
@pytest.mark.parametrize("machine", MACHINES)
def test_equal_to_pinocchio(model_of, machine, known):
    """Mass matrix, Coriolis matrix and gravity are the reference, rotor inertia included."""
    nominal = model_of(machine, *known)
    q, v = states(nominal.robot, LANES + 3)
    p, beta = momentum_and_beta(nominal, q, v)
    for k in range(len(q)):
        wanted = mass_matrix(nominal, q[k]) @ v[k]
        np.testing.assert_allclose(p[k], wanted, rtol=0, atol=1e-12 * np.abs(wanted).max())
        wanted = coriolis(nominal, q[k], v[k]).T @ v[k] - gravity(nominal, q[k])
        np.testing.assert_allclose(beta[k], wanted, rtol=0, atol=1e-12 * np.abs(wanted).max())


@pytest.mark.parametrize("machine", MACHINES)
def test_beta_of_a_hinge_is_the_slope_of_the_kinetic_energy(model_of, machine):
    """Lagrange: without gravity the rate of p_k is dT/dq_k, where T = v . p / 2; no other library is needed."""
    nominal = model_of(machine, 1.0, 0.0)
    (q,), (v,) = states(nominal.robot, 1)
    _, beta = momentum_and_beta(nominal, q, v)
    for k in range(1, nominal.robot.layout.nu + 1):
        energy = []
        for sign in (1, -1):
            moved = q.copy()
            moved[-k] += sign * STEP
            energy.append(v @ momentum_and_beta(nominal, moved, v)[0] / 2)
        assert (energy[0] - energy[1]) / (2 * STEP) == pytest.approx(beta[-k], rel=1e-5, abs=1e-4)


@pytest.mark.parametrize("count", [0, 1, LANES - 1, LANES, LANES + 1, 2 * LANES + 5])
@pytest.mark.parametrize("machine", ["robot", "arm"])
def test_a_sample_is_the_same_to_the_bit_whatever_stands_beside_it(model_of, machine, count):
    nominal = model_of(machine)
    q, v = states(nominal.robot, count)
    found = momentum_and_beta(nominal, q, v)
    assert [part.shape for part in found] == [v.shape, v.shape]
    for k in range(count):
        np.testing.assert_array_equal([part[k] for part in found], momentum_and_beta(nominal, q[k], v[k]))


def test_leading_axes_are_kept(nominal):
    q, v = states(nominal.robot, 6)
    flat = momentum_and_beta(nominal, q, v)
    nested = momentum_and_beta(nominal, q.reshape(2, 3, -1), v.reshape(2, 3, -1))
    for one, other in zip(flat, nested, strict=True):
        np.testing.assert_array_equal(one, other.reshape(6, -1))


@pytest.mark.parametrize(("rows", "column"), [((2, 3), 0), ((3, 3), 1)])
def test_what_does_not_fit_is_refused(nominal, rows, column):
    """Compiled code would read beyond the arrays."""
    q, v = (states(nominal.robot, count)[i] for i, count in enumerate(rows))
    with pytest.raises(DataError, match=r"shape of q: .* is not accepted; accepted: \(3, 40\)"):
        momentum_and_beta(nominal, q[:, column:], v)


@pytest.mark.parametrize("machine", ["robot", "skew_robot"])
def test_torque_of_a_wrench_is_that_of_pinocchio_s_jacobian(model_of, machine):
    nominal = model_of(machine)
    q, _ = states(nominal.robot, 5)
    wrench = np.random.default_rng(0).normal(size=(5, 6))
    for side in nominal.robot.feet:
        frame, axes = nominal.foot_frames[side], pin.ReferenceFrame.LOCAL
        given = [(nominal.model, nominal.data, one, frame, axes) for one in nominal.positions(q)]
        wanted = [w @ pin.computeFrameJacobian(*each) for each, w in zip(given, wrench, strict=True)]
        np.testing.assert_allclose(feet_torque(nominal, q, {side: wrench}), wanted, rtol=0, atol=1e-13)
    with pytest.raises(DataError, match="shape of the left wrench"):
        feet_torque(nominal, q, {"left": wrench[1:]})
