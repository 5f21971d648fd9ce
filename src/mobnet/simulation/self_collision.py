"""Self-collision: the smallest distance between the robot's own solids (section 4.3: it does not occur).

The solids are the robot's shapes. Pairs of bodies that cannot really meet are not checked: bodies at most `NEIGHBOURS`
joints apart, and bodies joined by a hip or a waist whose axes meet in one point. Their shapes overlap by construction,
or would touch only far outside any working range (a forearm folded flat).
"""

import itertools

import mujoco
import numpy as np
from numpy.typing import NDArray

from mobnet.core.errors import DataError
from mobnet.formats.parts import BodyRow
from mobnet.robot.description import RobotDescription
from mobnet.robot.plant import SHAPE_GROUP, robot_spec

REACH_M = 0.06  # larger distances are not measured, because they cost time
NEIGHBOURS = 2  # joints
OWN_TYPE = 1  # contype and conaffinity of the robot's own solids in the check model


class Clearance:
    """Distances between the robot's own solids, by MuJoCo's collision detection on a model of its own."""

    def __init__(self, robot: RobotDescription, reach_m: float = REACH_M) -> None:
        """Compile the check model; distances above reach_m [m] are not measured."""
        self.reach = reach_m
        self.model = check_spec(robot, reach_m).compile()
        self.data = mujoco.MjData(self.model)

    def nearest(self, q: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the smallest distance between two checked solids (T,) [m] at q (T, nq) [m, rad], negative in overlap.

        Raises:
            DataError: q has another shape.
        """
        if q.ndim != 2 or q.shape[1] != self.model.nq:
            raise DataError(f"q: shape {q.shape} is not accepted; accepted: (T, {self.model.nq})")
        return np.array([collide(self.model, self.data, row, self.reach) for row in q])

    def pair(self, q: NDArray[np.float64]) -> tuple[str, str] | None:
        """Return the names of the two solids that are nearest at q (nq,) [m, rad]; None where all are out of reach."""
        if collide(self.model, self.data, q, self.reach) >= self.reach:
            return None
        first, second = self.data.contact.geom[np.argmin(self.data.contact.dist)]
        return self.model.geom(first).name, self.model.geom(second).name


def collide(model: mujoco.MjModel, data: mujoco.MjData, q: NDArray[np.float64], reach_m: float) -> float:
    """Find the contacts at q (nq,) [m, rad]; return the smallest distance, `reach_m` where there are none [m]."""
    data.qpos[:] = q
    mujoco.mj_kinematics(model, data)
    mujoco.mj_collision(model, data)
    return min(reach_m, float(data.contact.dist.min())) if data.ncon else reach_m


def check_spec(robot: RobotDescription, reach_m: float) -> mujoco.MjSpec:
    """Return the robot whose own shapes collide, all that come nearer than `reach_m` [m], and nothing else."""
    spec = robot_spec(robot)
    for geom in spec.geoms:
        type_of_shape = OWN_TYPE if geom.group == SHAPE_GROUP else 0
        geom.contype = type_of_shape
        geom.conaffinity = type_of_shape
        geom.condim = 1
        geom.margin = reach_m / 2  # MuJoCo adds the two margins of a pair
        if type_of_shape and geom.type == mujoco.mjtGeom.mjGEOM_BOX:
            _as_hull(spec, geom)
    for i, body in enumerate(robot.bodies):
        for other in robot.bodies[:i]:
            if held_together(robot, body, other):
                spec.add_exclude(bodyname1=body.name, bodyname2=other.name)
    return spec


def _as_hull(spec: mujoco.MjSpec, box: mujoco.MjsGeom) -> None:
    """Make a box a convex mesh: MuJoCo's own test of two boxes misses some that are near without touching."""
    corners = np.array(list(itertools.product((-1.0, 1.0), repeat=3))) * box.size
    spec.add_mesh(name=box.name, uservert=corners.ravel())
    box.type = mujoco.mjtGeom.mjGEOM_MESH
    box.meshname = box.name


def held_together(robot: RobotDescription, body: BodyRow, other: BodyRow) -> bool:
    """Return whether joints hold two bodies so close that their shapes are not checked against each other."""
    path = _to_base(robot, body) ^ _to_base(robot, other)
    joints = [link for link in robot.bodies if link.name in path and robot.joint_of(link.name) is not None]
    return len(joints) <= NEIGHBOURS or sum(any(link.pos) for link in joints) <= 1


def _to_base(robot: RobotDescription, body: BodyRow) -> frozenset[str]:
    """Return the names of a body and of all bodies between it and the world."""
    parents = {link.name: link.parent for link in robot.bodies}
    names = set()
    name = body.name
    while name in parents:
        names.add(name)
        name = parents[name]
    return frozenset(names)
