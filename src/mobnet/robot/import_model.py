"""A robot from a model of Pinocchio that a program holds; what the model does not say is as of a URDF.

Joints stay in the model's order. A table holds hinges on a base that is fixed or a free-flyer: a model with other
joints is refused and not changed, since its arrays would no longer fit; `pin.buildReducedModel` welds them.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pinocchio as pin

from mobnet.core.arrays import Array
from mobnet.core.errors import DataError, not_accepted
from mobnet.core.options import ARMATURE_KG_M2, SPEED_LIMIT_RAD_S, TORQUE_LIMIT_NM
from mobnet.formats.checks.robot import robot_problems
from mobnet.formats.faults import refuse_faults, validated
from mobnet.formats.reading import Place, dotted
from mobnet.formats.robot import RobotTable
from mobnet.kernel.mechanism import ENDLESS, HINGES
from mobnet.robot.description import RobotDescription, describe
from mobnet.robot.import_links import Imported, import_tree, left_out, values_of
from mobnet.robot.import_tree import FREE, HINGE, WORLD, Joint, Link, LinkTree

FREE_FLYER = "JointModelFreeFlyer"
TURNING = (*HINGES, *ENDLESS, "JointModelRevoluteUnboundedUnaligned")
REMEDY = "a hinge; pin.buildReducedModel welds a joint, and mobnet.MomentumObserver takes any"
NEAR_M_S2 = 0.05  # by which gravity may differ: on the ground of the Earth it does so by 0.03 to each side


def robot_of_model(
    model: pin.Model, gravity_m_s2: float, limbs: Mapping[str, Sequence[str]] | None = None, name: str | None = None
) -> RobotDescription:
    """Return the robot of a model.

    Args:
        model: hinges on a base that is fixed, or a free-flyer.
        gravity_m_s2: that of all robots [m/s^2], downwards, which the model has to have.
        limbs: limb -> names of its joints in the model's order; chains without a branch if None.
        name: of the robot; that of the model if None.

    Raises:
        DataError: a joint is none that a table holds, gravity or the base is another one, or a body has no mass.
        ConfigError: a name or a number is not accepted, or a joint is in no limb.
    """
    tree = tree_of(model, gravity_m_s2)
    tree.name = name or tree.name
    limits = TORQUE_LIMIT_NM, SPEED_LIMIT_RAD_S
    robot = import_tree(tree, "model", "robot", _floats(model), limits, ARMATURE_KG_M2)
    idle = [joint.name for joint in tree.joints() if joint.kind == HINGE and joint not in robot.hinges]
    if idle:
        raise DataError(not_accepted("joint that moves no mass", idle[0], ["a mass; pin.buildReducedModel welds it"]))
    if limbs is not None:
        robot.groups = _renamed(limbs, robot)
    notes = [*robot.notes, *left_out(robot.hinges, 0, has_imu=False)]
    model_notes = tuple(note.replace("in the file", "in the model") for note in notes)
    return replace(describe(_checked(values_of(robot))), notes=model_notes)


def tree_of(model: pin.Model, gravity_m_s2: float) -> LinkTree:
    """Return the links that the joints of a model move, in its order.

    Raises:
        DataError: a joint is none that a table holds, or gravity or the base is another one.
    """
    down = np.array([0.0, 0.0, -gravity_m_s2])
    if np.abs(model.gravity.linear - down).max() > NEAR_M_S2:
        remedy = f"{down.tolist()}; turn the placement of the first joint where the robot is mounted otherwise"
        raise DataError(not_accepted("gravity of the model", model.gravity.linear.tolist(), [remedy]))
    if _floats(model) and not model.jointPlacements[1].isIdentity():
        raise DataError(f"{model.names[1]}: a free-flyer away from the world's origin is not accepted; accepted: there")
    links = [_link(model, number) for number in range(1, model.njoints)]
    return LinkTree(model.name, links)


def _floats(model: pin.Model) -> bool:
    """Return whether the base floats."""
    return model.njoints > 1 and model.joints[1].shortname() == FREE_FLYER


def _link(model: pin.Model, number: int) -> Link:
    """Return the link that a joint of a model moves."""
    place = model.jointPlacements[number]
    inertia = model.inertias[number]
    return Link(
        name=_body_name(model, number),
        parent=model.parents[number] - 1 if model.parents[number] else WORLD,
        pos=place.translation,
        turn=place.rotation,
        joints=[_joint(model, number)],
        mass=float(inertia.mass),
        com=inertia.lever,
        inertia=inertia.inertia,
    )


def _body_name(model: pin.Model, number: int) -> str:
    """Return the name of the first body of a joint, or of the joint where it has none."""
    for frame in model.frames:
        if frame.type == pin.FrameType.BODY and frame.parentJoint == number:
            return frame.name
    return model.names[number]


def _joint(model: pin.Model, number: int) -> Joint:
    """Return a joint of a model with its limits.

    Raises:
        DataError: it is none that a table holds.
    """
    name = model.names[number]
    joint = model.joints[number]
    kind = joint.shortname()
    if kind == FREE_FLYER and number == 1:
        return Joint(name, FREE, np.zeros(3), number)
    if kind not in TURNING:
        raise DataError(not_accepted(f"joint {name}: kind", kind, [REMEDY]))
    q = joint.idx_q
    v = joint.idx_v
    low = float(model.lowerPositionLimit[q])
    high = float(model.upperPositionLimit[q])
    return Joint(
        name=name,
        kind=HINGE,
        axis=_axis(model, number),
        index=number,
        range=(low, high) if kind in HINGES and low < high else None,
        torque=float(model.effortLimit[v]),
        speed=float(model.velocityLimit[v]),
        armature=float(model.armature[v]),
        damping=float(model.damping[v]),
        friction=float(model.friction[v]),
    )


def _axis(model: pin.Model, number: int) -> Array:
    """Return the axis of a hinge in the link that it moves (3,)."""
    joint = model.joints[number]
    data = joint.createData()
    joint.calc(data, pin.neutral(model))
    return np.reshape(data.S, (6, -1))[3:, 0]


def _renamed(limbs: Mapping[str, Sequence[str]], robot: Imported) -> dict[str, list[str]]:
    """Return limbs with the names that a table has for the joints of the model."""
    words = {joint.name: row["id"] for joint, row in zip(robot.hinges, robot.joints, strict=True)}
    renamed = dict[str, list[str]]()
    for limb, joints in limbs.items():
        unknown = [joint for joint in joints if joint not in words]
        if unknown:
            raise DataError(not_accepted(f"joint of limb {limb}", unknown[0], words))
        renamed[limb] = [words[joint] for joint in joints]
    return renamed


def _checked(values: dict[str, Any]) -> RobotTable:
    """Return the table of these values; a ConfigError has a line for each that is not accepted."""

    def line(place: Place, text: str) -> str:
        return f"{dotted(place)}: {text}"

    table = validated(RobotTable, values, values, line)
    refuse_faults(line(place, text) for place, text in robot_problems(table))
    return table
