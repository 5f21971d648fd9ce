"""A robot from a `pin.Model` held in memory: that of its URDF, and what it refuses."""

from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest

import mobnet
from mobnet.robot.import_table import robot_of_text, table_text
from mobnet.robot.importing import import_robot

ARM = Path("tests/data/arm.urdf")
RATE_HZ = 500.0
SAMPLES = 50


@pytest.fixture(scope="module")
def model():
    """The arm of the URDF without its gripper, which slides."""
    whole = pin.buildModelFromUrdf(str(ARM))
    return pin.buildReducedModel(whole, [whole.getJointId("grip")], pin.neutral(whole))


def turning(joints):
    """Return angles, velocities and torques of hinges that turn at drawn speeds; one of the arm is endless."""
    rng = np.random.default_rng(1)
    v = np.cumsum(rng.normal(size=(SAMPLES, joints)), axis=0) * 0.05
    return 0.3 + np.cumsum(v, axis=0) / RATE_HZ, v, rng.normal(size=(SAMPLES, joints))


def test_its_residual_is_that_of_the_robot_of_its_urdf(model):
    """Lighter by a tenth, the model has another residual: the comparison can fail."""
    read = mobnet.Robot(robot_of_text(table_text(import_robot(ARM, None, 100.0, 10.0), ARM.name), ARM))
    q, v, tau = turning(2)
    wanted = mobnet.Observer(read, RATE_HZ).residual(read.sample(q, v, tau))
    held = mobnet.Robot.from_model(model)
    assert held.joints == read.joints
    assert held.limbs == read.limbs
    np.testing.assert_allclose(held.description.torque_limits, read.description.torque_limits)
    np.testing.assert_allclose(held.description.armature, read.description.armature)
    residual = mobnet.Observer(held, RATE_HZ).residual(held.sample(q, v, tau))
    np.testing.assert_allclose(residual, wanted, atol=1e-9)
    lighter = model.copy()
    lighter.inertias[1].mass *= 0.9
    light = mobnet.Robot.from_model(lighter)
    assert np.abs(mobnet.Observer(light, RATE_HZ).residual(light.sample(q, v, tau)) - wanted).max() > 0.1


def test_a_free_flyer_is_a_floating_base_and_rotors_are_kept():
    """The force on the base is the same in the world's axes as the observer of the model has it in the base's."""
    model = pin.buildSampleModelHumanoid()
    model.armature = np.concatenate([np.zeros(6), np.linspace(0.1, 0.5, model.nv - 6)])
    robot = mobnet.Robot.from_model(model)
    assert robot.motors == tuple(model.names)[2:]
    np.testing.assert_allclose(robot.description.armature, model.armature[6:])
    _, v, tau = turning(model.nv)
    q = [pin.neutral(model)]
    for velocity in v[1:]:
        q.append(pin.integrate(model, q[-1], velocity / RATE_HZ))
    q = np.array(q)
    wanted = mobnet.MomentumObserver(model, RATE_HZ).run(q, v, tau[:, 6:])
    turned = np.array([pin.XYZQUATToSE3(row[:7]).rotation for row in q])
    v[:, :3] = np.einsum("tij,tj->ti", turned, v[:, :3])
    q[:, 3:7] = q[:, [6, 3, 4, 5]]
    residual = mobnet.Observer(robot, RATE_HZ).residual(robot.sample(q, v, tau[:, 6:]))
    residual[:, :3] = np.einsum("tji,tj->ti", turned, residual[:, :3])
    np.testing.assert_allclose(residual, wanted, atol=1e-9 * np.abs(wanted).max())


def test_what_the_model_does_not_say_is_as_of_a_urdf_and_is_told():
    model = pin.Model()
    for number, joint in enumerate([pin.JointModelRUBZ(), pin.JointModelRevoluteUnaligned(0.6, 0.0, 0.8)]):
        added = model.addJoint(number, joint, pin.SE3.Identity(), f"axis {number}")
        model.appendBodyToJoint(added, pin.Inertia(1.0, np.zeros(3), 0.01 * np.eye(3)), pin.SE3.Identity())
    robot = mobnet.Robot.from_model(model, limbs={"arm": ["axis 0", "axis 1"]}, name="mill")
    assert repr(robot) == "Robot mill: axis_0, axis_1; fixed base"
    assert robot.limbs == {"arm": ("axis_0", "axis_1")}
    np.testing.assert_allclose([joint.axis for joint in robot.description.joints], [[0, 0, 1], [0.6, 0, 0.8]])
    assert {joint.torque_limit for joint in robot.description.joints} == {100.0}
    assert {joint.range for joint in robot.description.joints} == {(-12.6, 12.6)}
    notes = "\n".join(robot.notes)
    assert "torque of axis_0, axis_1: not in the model" in notes
    assert "armature: zero for all joints" in notes


def sliding():
    model = pin.Model()
    model.addJoint(0, pin.JointModelPX(), pin.SE3.Identity(), "rail")
    return model


def hung(gravity):
    model = pin.buildSampleModelManipulator()
    model.gravity.linear = np.array(gravity)
    return model


def crossed():
    """A model whose third joint does not follow the joint that carries it."""
    model = pin.Model()
    for parent, name in ((0, "a"), (0, "b"), (1, "c")):
        added = model.addJoint(parent, pin.JointModelRX(), pin.SE3.Identity(), name)
        model.appendBodyToJoint(added, pin.Inertia(1.0, np.zeros(3), 0.01 * np.eye(3)), pin.SE3.Identity())
    return model


def weightless():
    model = pin.buildSampleModelManipulator()
    model.inertias[6] = pin.Inertia.Zero()
    return model


@pytest.mark.parametrize(
    ("build", "limbs", "says"),
    [
        (sliding, None, "joint rail: kind: 'JointModelPX' is not accepted; accepted: a hinge; pin.buildReducedModel"),
        (lambda: hung([9.81, 0.0, 0.0]), None, r"gravity of the model: \[9.81, 0.0, 0.0\] is not accepted; accepted: "),
        (crossed, None, "parent of c: 'a' is not accepted"),
        (weightless, None, "joint that moves no mass: 'wrist2_joint' is not accepted"),
        (pin.Model, None, "no hinge that moves a mass"),
        (pin.buildSampleModelManipulator, {"arm": ["elbow_joint"]}, "no limb with .* is not accepted; accepted: every"),
        (pin.buildSampleModelManipulator, {"arm": ["elbow"]}, "joint of limb arm: 'elbow' is not accepted; accepted: "),
    ],
)
def test_what_no_table_holds_is_one_line(build, limbs, says):
    with pytest.raises(mobnet.MobnetError, match=says):
        mobnet.Robot.from_model(build(), limbs=limbs)


def test_gravity_may_be_that_of_another_place_on_the_earth():
    assert mobnet.Robot.from_model(hung([0.0, 0.0, -9.80665])).motors


def test_a_motion_that_is_too_short_gives_no_detector(model):
    robot = mobnet.Robot.from_model(model)
    with pytest.raises(mobnet.MobnetError, match=r"0 s of free motion, in windows of 1 s; 200 s or more are needed"):
        mobnet.Detector.from_free_motion(robot, robot.sample(*turning(2)), RATE_HZ)
