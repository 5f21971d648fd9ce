"""The observer of a `pin.Model`: against plain Pinocchio, that of a robot's table, and what is known."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest
from library_settings import library_settings

import mobnet
from mobnet.core.errors import ConfigError, DataError
from mobnet.estimation.observer import RobotObserver
from mobnet.kernel.drive import DriveParameters
from mobnet.kernel.mechanism import Mechanism
from mobnet.kernel.observer import GAIN_HZ, MomentumObserver
from mobnet.kernel.recursion import ObserverState, Recursion
from mobnet.robot.nominal import NominalModel

ROOT = Path(__file__).parents[3]
RATE_HZ = 1000.0


def plain(model, q, v, tau, gain_hz=GAIN_HZ):
    """Return the residual (T, nv) of the means `tau` (T, nv), by Pinocchio's own functions and (O1) to (O5)."""
    data = model.createData()
    pole = np.exp(-gain_hz / RATE_HZ)
    residuals = [np.zeros(model.nv)]
    before = None
    for position, velocity, torque in zip(q, v, tau, strict=True):
        upper = np.triu(pin.crba(model, data, position))
        momentum = (upper + np.triu(upper, 1).T) @ velocity
        coriolis = pin.computeCoriolisMatrix(model, data, position, velocity)
        beta = coriolis.T @ velocity - pin.computeGeneralizedGravity(model, data, position)
        if before is not None:
            raw = (momentum - before[0]) * RATE_HZ - torque - (beta + before[1]) / 2
            residuals.append(pole * residuals[-1] + (1 - pole) * raw)
        before = momentum, beta
    return np.array(residuals)


def moving(model, samples=200):
    """Return positions, velocities and torques of a model that moves at drawn speeds."""
    rng = np.random.default_rng(1)
    v = np.cumsum(rng.normal(size=(samples, model.nv)), axis=0) * 0.02
    q = [pin.randomConfiguration(model, -np.ones(model.nq), np.ones(model.nq))]
    for velocity in v[1:]:
        q.append(pin.integrate(model, q[-1], velocity / RATE_HZ))
    return np.array(q), v, rng.normal(size=(samples, model.nv))


def arm(*joints):
    model = pin.Model()
    for number, joint in enumerate(joints):
        model.addJoint(number, joint, pin.SE3.Random(), f"J{number + 1}")
        model.appendBodyToJoint(number + 1, pin.Inertia.Random(), pin.SE3.Identity())
    return model


@pytest.mark.parametrize(
    "build",
    [
        pin.buildSampleModelManipulator,
        lambda: arm(pin.JointModelRX(), pin.JointModelPY(), pin.JointModelRZ()),
        lambda: arm(pin.JointModelRX(), pin.JointModelSpherical(), pin.JointModelRY()),
    ],
)
def test_it_is_that_of_plain_pinocchio(build):
    pin.seed(2)
    model = build()
    q, v, tau = moving(model)
    found = MomentumObserver(model, RATE_HZ, torque="mean").run(q, v, tau)
    wanted = plain(model, q, v, tau)
    np.testing.assert_allclose(found, wanted, atol=1e-9 * np.abs(wanted).max())


def with_free_flyer(nominal):
    """Return the model of a robot's table with a free-flyer in place of translation and ball."""
    given = nominal.model
    model = pin.Model()
    model.gravity = given.gravity
    numbers = {0: 0, 2: model.addJoint(0, pin.JointModelFreeFlyer(), pin.SE3.Identity(), "root")}
    for number in range(3, given.njoints):
        parent = numbers[given.parents[number]]
        placement = given.jointPlacements[number]
        numbers[number] = model.addJoint(parent, given.joints[number], placement, given.names[number])
    for number in range(2, given.njoints):
        model.appendBodyToJoint(numbers[number], given.inertias[number], pin.SE3.Identity())
    model.armature = given.armature
    return model


def test_a_free_flyer_is_the_floating_base_of_a_table():
    """The residual of the base is the same force, in the base's axes instead of the world's."""
    robot = mobnet.Robot.read(ROOT / "configs" / "robots" / "g1.yaml")
    nominal = NominalModel(robot.description)
    model = with_free_flyer(nominal)
    q, v, tau = moving(model)
    observer = MomentumObserver(model, RATE_HZ, torque="mean")
    assert observer.joints == robot.motors
    found = observer.run(q, v, tau[:, 6:])

    turned = np.array([pin.XYZQUATToSE3(row[:7]).rotation for row in q])
    v_table = v.copy()
    v_table[:, :3] = np.einsum("tij,tj->ti", turned, v[:, :3])
    q_table = q.copy()
    q_table[:, 3:7] = q[:, [6, 3, 4, 5]]
    samples = robot.sample(q_table, v_table, tau[:, 6:])
    wanted = RobotObserver(nominal, GAIN_HZ, RATE_HZ, "mean").residual(samples)
    wanted[:, :3] = np.einsum("tji,tj->ti", turned, wanted[:, :3])
    np.testing.assert_allclose(found, wanted, atol=1e-9 * np.abs(wanted).max())


@pytest.mark.parametrize("build", [pin.buildSampleModelManipulator, pin.buildSampleModelHumanoid])
@pytest.mark.parametrize("torque", ["mean", "sample"])
def test_steps_are_the_run(build, torque):
    model = build()
    q, v, tau = moving(model, 40)
    observer = MomentumObserver(model, RATE_HZ, torque=torque)
    tau = tau[:, : observer.nu]
    state = observer.init()
    steps = []
    for sample in zip(q, v, tau, strict=True):
        state, residual = observer.step(state, *sample)
        steps.append(residual)
    np.testing.assert_allclose(steps, observer.run(q, v, tau), atol=1e-9)
    np.testing.assert_array_equal(steps[0], 0.0)


@pytest.mark.parametrize("torque", ["mean", "sample"])
def test_a_compiled_step_is_that_of_the_recursion_to_the_bit(torque):
    model = pin.buildSampleModelManipulator()
    joints, motors = [model.names[3], model.names[1]], np.array([2, 0])
    observer = MomentumObserver(model, RATE_HZ, torque=torque, joints=joints)
    recursion = Recursion(Mechanism(model).terms, motors, GAIN_HZ, RATE_HZ, torque, None)
    state, plain_state = observer.init(), ObserverState()
    buffer = np.empty(2)  # into which a robot writes each of its samples
    for q, v, tau in zip(*moving(model, 40), strict=True):
        buffer[:] = tau[motors]
        state, residual = observer.step(state, q, v, buffer)
        plain_state, wanted = recursion.step(plain_state, q, v, buffer)
        np.testing.assert_array_equal(residual, wanted)
    locked = np.broadcast_to(0.5, model.nv)
    _, residual = observer.step(state, list(locked), locked, buffer[::-1])
    _, wanted = recursion.step(plain_state, locked, locked, buffer[::-1])
    np.testing.assert_array_equal(residual, wanted)


def test_a_held_push_comes_through_the_low_pass():
    """At rest an arm whose motors hold its weight and a push of 5 N m shows 5 (1 - exp(-K_0 t))."""
    model = pin.buildSampleModelManipulator()
    q = np.tile(0.3 * np.ones(model.nq), (100, 1))
    v = np.zeros((100, model.nv))
    weight = pin.computeGeneralizedGravity(model, model.createData(), q[0])
    push = np.zeros(model.nv)
    push[3] = 5.0
    found = MomentumObserver(model, RATE_HZ, gain_hz=50.0).run(q, v, np.tile(weight - push, (100, 1)))
    wanted = np.outer(1.0 - np.exp(-50.0 * np.arange(100) / RATE_HZ), push)
    np.testing.assert_allclose(found, wanted, atol=1e-9)


def test_torques_are_of_the_joints_with_a_motor_in_their_order():
    model = pin.buildSampleModelManipulator()
    q, v, tau = moving(model)
    joints = [model.names[3], model.names[1]]
    found = MomentumObserver(model, RATE_HZ, torque="mean", joints=joints).run(q, v, tau[:, [2, 0]])
    tau[:, [1, 3, 4, 5]] = 0.0
    np.testing.assert_allclose(found, MomentumObserver(model, RATE_HZ, torque="mean").run(q, v, tau), atol=1e-9)


def test_friction_that_is_known_is_no_external_torque():
    model = pin.buildSampleModelManipulator()
    q, v, tau = moving(model)
    friction = {"coulomb": 2.0, "viscous": np.arange(6.0)}
    drives = DriveParameters.of(model.nv, **friction)
    _, lost = drives.run(drives.init(), v, tau, RATE_HZ)
    mean = tau.copy()
    mean[1:] += (lost[1:] + lost[:-1]) / 2
    given = MomentumObserver(model, RATE_HZ, torque="mean", friction=friction).run(q, v, mean)
    wanted = MomentumObserver(model, RATE_HZ, torque="mean").run(q, v, tau)
    np.testing.assert_allclose(given, wanted, atol=1e-9 * np.abs(wanted).max())


def test_an_endless_hinge_takes_its_angle():
    pin.seed(7)
    model = arm(pin.JointModelRX(), pin.JointModelRUBZ(), pin.JointModelRY(), pin.JointModelRUBX())
    q, v, tau = moving(model)
    angles = np.column_stack([q[:, 0], np.arctan2(q[:, 2], q[:, 1]), q[:, 3], np.arctan2(q[:, 5], q[:, 4])])
    observer = MomentumObserver(model, RATE_HZ)
    np.testing.assert_allclose(observer.run(angles, v, tau), observer.run(q, v, tau), atol=1e-9)
    with pytest.raises(DataError, match=r"shape of q: \(5,\) is not accepted; accepted: \(6,\), \(4,\)"):
        observer.step(observer.init(), q[0, :5], v[0], tau[0])


def test_what_is_wrong_is_one_line():
    model = pin.buildSampleModelManipulator()
    observer = MomentumObserver(model, RATE_HZ)
    zero = np.zeros(6)
    with pytest.raises(DataError, match=r"shape of v: \(5,\) is not accepted; accepted: \(6,\)"):
        observer.step(observer.init(), zero, zero[1:], zero)
    with pytest.raises(DataError, match="q: inf is not accepted; accepted: finite numbers"):
        observer.step(observer.init(), zero + np.inf, zero, zero)
    with pytest.raises(DataError, match="tau: nan is not accepted; accepted: finite numbers"):
        observer.run(zero[None], zero[None], np.full((1, 6), np.nan))
    with pytest.raises(ConfigError, match="joint: 'elbow' is not accepted"):
        MomentumObserver(model, RATE_HZ, joints=["elbow"])
    with pytest.raises(ConfigError, match="accepted: numbers above 0"):
        MomentumObserver(model, 0.0)
    with pytest.raises(ConfigError, match=r"coulomb: shape: \(2,\) is not accepted; accepted: \(6,\)"):
        MomentumObserver(model, RATE_HZ, friction={"coulomb": [1.0, 2.0]})
    with pytest.raises(ConfigError, match="number of a drive: 'dry' is not accepted; accepted: breakaway, coulomb"):
        MomentumObserver(model, RATE_HZ, friction={"dry": 1.0})


def test_its_gain_is_that_of_the_configuration():
    assert library_settings().observer.gain_hz == GAIN_HZ


def test_it_tells_what_it_is():
    model = pin.buildSampleModelManipulator()
    model.name = "arm"
    shown = "MomentumObserver arm: 6 velocities, 6 motors, 1000 Hz, gain 100 1/s, compiled"
    assert repr(MomentumObserver(model, RATE_HZ)) == shown


def test_the_kernel_needs_itself_and_the_core_alone():
    """What a stranger reads who takes the observer: few modules and few lines. Lower the numbers, never raise them."""
    code = """
import sys
import mobnet.kernel.observer
import mobnet.kernel.first_order
for name, module in sys.modules.items():
    if name.startswith(("mobnet.", "pydantic", "pyarrow")):
        print(name, module.__file__)
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    files = dict(line.split() for line in done.stdout.splitlines())
    rooms = {".".join(name.split(".")[:2]) for name in files}
    assert rooms == {"mobnet.kernel", "mobnet.core"}
    # Its machine code is kept under the hash of its own folder: compiled code of no other one may be called.
    of_core = {name for name in files if name.startswith("mobnet.core.")}
    assert of_core == {f"mobnet.core.{name}" for name in ("arrays", "errors", "machine_code", "root")}
    modules = [Path(file) for file in files.values() if not file.endswith("__init__.py")]
    assert len(modules) <= 14
    assert sum(len(module.read_text().splitlines()) for module in modules) <= 1550
