"""Momentum and beta of every kind of joint that Pinocchio has are what the equation of motion says."""

import numpy as np
import pinocchio as pin
import pytest

from mobnet.core.errors import ConfigError
from mobnet.kernel.mechanism import Mechanism

ALONG = np.array([0.6, 0.8, 0.0])
STEP_S = 1e-5


def endless():
    joint = pin.JointModelRevoluteUnboundedUnaligned()
    joint.axis = ALONG
    return joint


def composite():
    joint = pin.JointModelComposite()
    joint.addJoint(pin.JointModelRX())
    joint.addJoint(pin.JointModelPY(), pin.SE3.Random())
    joint.addJoint(pin.JointModelRUBZ(), pin.SE3.Random())
    joint.addJoint(pin.JointModelSphericalZYX(), pin.SE3.Random())
    return joint


CHAINS = {
    "hinges": (pin.JointModelRX(), pin.JointModelRY(), pin.JointModelRevoluteUnaligned(ALONG)),
    "endless": (pin.JointModelRX(), pin.JointModelRUBX(), pin.JointModelRUBY(), pin.JointModelRUBZ(), endless()),
    "sliders": (pin.JointModelPX(), pin.JointModelPZ(), pin.JointModelPrismaticUnaligned(ALONG), pin.JointModelRX()),
    "ball": (pin.JointModelRX(), pin.JointModelSpherical(), pin.JointModelPY()),
    "angles": (pin.JointModelRX(), pin.JointModelSphericalZYX(), pin.JointModelRX()),
    "planar": (pin.JointModelPlanar(), pin.JointModelRX()),
    "translation": (pin.JointModelRX(), pin.JointModelTranslation(), pin.JointModelRY()),
    "screws": (pin.JointModelHX(0.3), pin.JointModelHelicalUnaligned(ALONG, 0.2)),
    "universal": (pin.JointModelRX(), pin.JointModelUniversal(pin.XAxis, pin.YAxis), pin.JointModelRX()),
    "composite": (pin.JointModelRX(), composite(), pin.JointModelRX()),
    "flyer": (pin.JointModelFreeFlyer(), pin.JointModelRX(), pin.JointModelRY()),
    "flyer on a hinge": (pin.JointModelRX(), pin.JointModelFreeFlyer(), pin.JointModelRX()),
}
COMPILED = {"hinges", "endless", "angles", "universal", "flyer"}


def chain(joints):
    """Return a chain of bodies with rotors; a free-flyer has none, and stands at the root as parsers place it."""
    model = pin.Model()
    carrier = 0
    rotors = []
    for number, joint in enumerate(joints):
        flies = joint.shortname() == "JointModelFreeFlyer"
        placement = pin.SE3.Identity() if flies and not number else pin.SE3.Random()
        carrier = model.addJoint(carrier, joint, placement, f"J{number}")
        model.appendBodyToJoint(carrier, pin.Inertia.Random(), pin.SE3.Random())
        rotors += joint.nv * [0.0 if flies else 0.1 + 0.05 * number]
    model.armature = np.array(rotors)
    return model


def momentum(model, q, v):
    upper = np.triu(pin.crba(model, model.createData(), q))
    return (upper + np.triu(upper, 1).T) @ v


def beta_by_difference(model, q, v):
    """Return Mdot v - C v - g: by M vdot + C v + g = tau it is the rate of M v less tau."""
    ahead, behind = (momentum(model, pin.integrate(model, q, v * t), v) for t in (STEP_S, -STEP_S))
    return (ahead - behind) / (2 * STEP_S) - pin.nonLinearEffects(model, model.createData(), q, v)


def compare(model):
    """Compare p and beta at a drawn state with Pinocchio's mass matrix and forces of inertia."""
    rng = np.random.default_rng(5)
    q = pin.randomConfiguration(model, -np.ones(model.nq), np.ones(model.nq))
    v = rng.normal(size=model.nv)
    mechanism = Mechanism(model)
    p, beta = mechanism.terms(*mechanism.to_simple(q[None], v[None]))
    p = mechanism.from_simple(q[None], p)[0]
    beta = mechanism.from_simple(q[None], beta)[0]
    for number in range(1, model.njoints):
        if model.joints[number].shortname() == "JointModelFreeFlyer":  # its momentum is in axes that turn
            first = model.idx_vs[number]
            beta[first : first + 3] -= np.cross(v[first + 3 : first + 6], p[first : first + 3])
    np.testing.assert_allclose(p, momentum(model, q, v), atol=1e-12 * np.abs(p).max())
    np.testing.assert_allclose(beta, beta_by_difference(model, q, v), atol=1e-7 * np.abs(beta).max())
    return mechanism


@pytest.mark.parametrize("name", CHAINS)
def test_every_joint_has_its_momentum_and_beta(name):
    pin.seed(3)
    mechanism = compare(chain(CHAINS[name]))
    assert mechanism.is_compiled == (name in COMPILED)


@pytest.mark.parametrize("follower", [pin.JointModelRY(), pin.JointModelPZ()])
def test_a_joint_that_follows_another_one_counts_there(follower):
    pin.seed(4)
    model = chain((pin.JointModelRX(), pin.JointModelRY(), follower, pin.JointModelRX()))
    model.armature = np.zeros(4)
    compare(pin.transformJointIntoMimic(model, 1, 3, 1.5, 0.2))


@pytest.mark.parametrize(
    "build", [pin.buildSampleModelManipulator, pin.buildSampleModelHumanoid, pin.buildSampleModelHumanoidRandom]
)
def test_models_of_pinocchio_are_compiled(build):
    pin.seed(6)
    assert compare(build()).is_compiled


def test_a_model_that_does_not_move_is_refused():
    with pytest.raises(ConfigError, match="velocities: 0 is not accepted; accepted: at least 1"):
        Mechanism(pin.Model())
