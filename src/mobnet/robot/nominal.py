"""The nominal model: what the observer knows of the robot (section 3.2), in Pinocchio.

The root of a floating base is two joints, a translation and then a ball. A free-flyer would express the base's linear
velocity in base axes, and Pinocchio's Coriolis matrix is wrong for one composite root
(tests/library/robot/test_dynamics.py).
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from mobnet.formats.parts import BodyRow, JointRow
from mobnet.kernel.linkage import linkage_of
from mobnet.robot.description import RobotDescription
from mobnet.robot.frames import to_pinocchio

ALIGNED = {(1.0, 0.0, 0.0): pin.JointModelRX, (0.0, 1.0, 0.0): pin.JointModelRY, (0.0, 0.0, 1.0): pin.JointModelRZ}


class NominalModel:
    """The robot as the observer knows it: every mass, inertia and rotor inertia times one ratio.

    Attributes:
        mass_ratio: nominal over true mass and inertia [-]; section 5.1 takes 0.9 under all uncertainty.
        model: Pinocchio's model; nv generalized velocities in the order of `JointLayout`.
        data: its work space; one model belongs to one thread.
        foot_frames: side -> frame of the foot's force/torque sensor.
        linkage: its constants for compiled code.
    """

    def __init__(self, robot: RobotDescription, mass_ratio: float = 1.0, gravity_m_s2: float | None = None) -> None:
        """Build the model; gravity [m/s^2] is Pinocchio's own 9.81 when not given."""
        self.robot = robot
        self.mass_ratio = mass_ratio
        self.model = pin.Model()
        self.model.name = robot.name
        if gravity_m_s2 is not None:
            self.model.gravity.linear = -gravity_m_s2 * pin.ZAxis
        placements = _add_bodies(self.model, robot, mass_ratio)
        armature = self.model.armature.copy()
        armature[len(robot.layout.virtual) :] = mass_ratio * robot.armature
        self.model.armature = armature
        self.foot_frames = {
            side: _add_sensor(self.model, robot.sole.sensor_pos, f"{side}_foot", *placements[foot.body])
            for side, foot in robot.feet.items()
            if robot.sole is not None
        }
        self.data = self.model.createData()
        self.linkage = linkage_of(self.model)

    def positions(self, q: NDArray[Any]) -> NDArray[np.float64]:
        """Return generalized positions (..., nq) [m], [-], [rad] of a recording as Pinocchio takes them, row by row."""
        return to_pinocchio(q) if self.robot.floating else np.array(q, dtype=np.float64, order="C")


def _add_bodies(model: pin.Model, robot: RobotDescription, mass_ratio: float) -> dict[str, tuple[int, pin.SE3]]:
    """Add joints and inertia; return body -> (joint that carries it, its placement in that joint's frame)."""
    placements = {robot.base: _add_root(model) if robot.floating else (0, _placement(robot.bodies[0]))}
    for body in robot.bodies:
        joint = robot.joint_of(body.name)
        if body.name != robot.base:
            parent, carrier = placements[body.parent]
            placement = carrier * _placement(body)
            if joint is None:
                placements[body.name] = (parent, placement)
            else:
                hinge = model.addJoint(parent, _hinge(joint), placement, joint.id)
                placements[body.name] = (hinge, pin.SE3.Identity())
        carrier_id, in_carrier = placements[body.name]
        model.appendBodyToJoint(carrier_id, _inertia(body, mass_ratio), in_carrier)
    return placements


def _add_root(model: pin.Model) -> tuple[int, pin.SE3]:
    """Add the joints of a floating base; return the one that carries it and its placement in that joint's frame."""
    root = model.addJoint(0, pin.JointModelTranslation(), pin.SE3.Identity(), "base_translation")
    root = model.addJoint(root, pin.JointModelSpherical(), pin.SE3.Identity(), "base_rotation")
    return root, pin.SE3.Identity()


def _placement(body: BodyRow) -> pin.SE3:
    w, x, y, z = body.quat
    return pin.SE3(pin.Quaternion(w, x, y, z).matrix(), np.array(body.pos))


def _hinge(joint: JointRow) -> pin.JointModel:
    """Return the joint model of a hinge, the fast one where the axis is a coordinate axis."""
    aligned = ALIGNED.get(joint.axis)
    return aligned() if aligned else pin.JointModelRevoluteUnaligned(np.array(joint.axis))


def _inertia(body: BodyRow, mass_ratio: float) -> pin.Inertia:
    """Return a link's inertia about its centre of mass, scaled."""
    xx, yy, zz, xy, xz, yz = mass_ratio * np.array(body.inertia)
    matrix = pin.Symmetric3(xx, xy, yy, xz, yz, zz)
    return pin.Inertia(mass_ratio * body.mass, np.array(body.com), matrix.matrix())


def _add_sensor(model: pin.Model, pos: Sequence[float], name: str, joint: int, foot: pin.SE3) -> int:
    """Add the frame of a foot's force/torque sensor at pos (3,) [m] in the foot; return its index."""
    placement = foot * pin.SE3(pin.SE3.Identity().rotation, np.array(pos))
    return model.addFrame(pin.Frame(name, joint, placement, pin.FrameType.SENSOR))
