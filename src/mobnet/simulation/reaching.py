"""The upper body on a fixed pelvis follows hand and posture targets by differential inverse kinematics (mink).

MuJoCo's collision detection tells where the robot's own solids, and the space in which the legs walk, come near each
other; the inverse kinematics keeps them apart.
"""

from collections.abc import Sequence

import mink
import mujoco
import numpy as np

from mobnet.core.arrays import Array
from mobnet.core.errors import SimulationError
from mobnet.robot.description import SIDES, RobotDescription
from mobnet.settings.data import Motion
from mobnet.simulation.self_collision import check_spec, collide

ZONE_TYPE = 2  # contype of the legs' space: only upper bodies meet it
SOLVER = "daqp"


class ClearanceLimit(mink.Limit):
    """Solids that are near approach only as fast as their distance shrinks to the least one allowed."""

    def __init__(self, model: mujoco.MjModel, least_m: float, gain: float) -> None:
        """Set the least distance [m] and the share of what is left of it that one step may use up."""
        self.model = model
        self.least = least_m
        self.gain = gain
        self.jacobians = np.zeros((2, 3, model.nv))

    def compute_qp_inequalities(self, configuration: mink.Configuration, dt: float) -> mink.Constraint:
        """Return G dq <= h, a row per contact: -n (J_2 - J_1) dq <= gain (distance - least), dq in [rad]."""
        del dt
        data = configuration.data
        mujoco.mj_collision(self.model, data)
        if data.ncon == 0:
            return mink.Constraint()
        contact = data.contact
        bodies = self.model.geom_bodyid[contact.geom]
        rows = np.zeros((data.ncon, self.model.nv))
        for row, normal, point, pair in zip(rows, contact.frame, contact.pos, bodies, strict=True):
            for jacobian, body in zip(self.jacobians, pair, strict=True):
                mujoco.mj_jac(self.model, data, jacobian, None, point, body)
            row[:] = normal[:3] @ (self.jacobians[0] - self.jacobians[1])
        return mink.Constraint(G=rows, h=self.gain * (contact.dist - self.least))


class Reacher:
    """Follows targets knot by knot from a posture."""

    def __init__(self, robot: RobotDescription, settings: Motion, limits: Array, posture: Array) -> None:
        """Start at a posture (n,) [rad] of the joints above the legs, whose working range is limits (n, 2) [rad]."""
        model = upper_body(robot, limits, settings.guard_m, settings.leg_poses_rad)
        self.dt = 1.0 / settings.knot_hz
        self.reach = settings.guard_m
        self.lead = settings.hand_speed_max_m_s * self.dt / settings.gain
        self.configuration = mink.Configuration(model, posture)
        self.hands = [
            mink.FrameTask(f"{side}_hand", "site", settings.hand_cost, 0.0, gain=settings.gain) for side in SIDES
        ]
        cost = np.full(model.nv, settings.arm_cost)
        free = [model.joint(name).id for name in robot.layout.limbs(("W", "N"))]
        cost[free] = settings.trunk_cost
        self.posture = mink.PostureTask(model, cost, gain=settings.gain)
        self.inertia = mink.PostureTask(model, settings.inertia_cost)
        self.before = posture
        names = robot.layout.actuated[-model.nv :]
        speeds = {joint.id: settings.speed_share * joint.velocity_limit for joint in robot.joints if joint.id in names}
        self.limits = [
            mink.ConfigurationLimit(model),
            mink.VelocityLimit(model, speeds),
            ClearanceLimit(model, settings.clearance_m, settings.gain),
        ]
        self.chest = model.body(model.site("torso").bodyid[0]).id

    def step(self, hands: Array, posture: Array) -> Array:
        """Move by one knot towards hands (2, 3) [m] in the chest's frame and posture (n,) [rad]; return q (n,) [rad].

        Raises:
            SimulationError: the quadratic program has no solution.
        """
        q = self.configuration.q
        ahead = hands - self.hand_positions()
        ahead *= np.minimum(1.0, self.lead / np.maximum(np.linalg.norm(ahead, axis=1, keepdims=True), self.lead))
        data = self.configuration.data
        for task, side, away in zip(self.hands, SIDES, ahead, strict=True):
            chest = data.xmat[self.chest].reshape(3, 3)
            task.set_target(mink.SE3.from_translation(data.site(f"{side}_hand").xpos + chest @ away))
        self.posture.set_target(posture)
        self.inertia.set_target(2 * q - self.before)
        self.before = q.copy()
        try:
            tasks = [*self.hands, self.posture, self.inertia]
            v = mink.solve_ik(self.configuration, tasks, self.dt, SOLVER, limits=self.limits)
        except mink.NoSolutionFound as error:
            raise SimulationError(f"inverse kinematics: {error}") from None
        self.configuration.integrate_inplace(v, self.dt)
        return self.configuration.q.copy()

    def hand_positions(self) -> Array:
        """Return both hands (2, 3) [m] in the chest's frame."""
        data = self.configuration.data
        hands = np.stack([data.site(f"{side}_hand").xpos for side in SIDES])
        return (hands - data.xpos[self.chest]) @ data.xmat[self.chest].reshape(3, 3)

    def look(self, knots: Array) -> tuple[Array, Array]:
        """Return the least distance (T,) [m] and both hands from the pelvis (T, 2, 3) [m] along knots (T, n) [rad]."""
        model = self.configuration.model
        data = self.configuration.data
        nearest = np.zeros(len(knots))
        hands = np.zeros((len(knots), 2, 3))
        for i, q in enumerate(knots):
            nearest[i] = collide(model, data, q, self.reach)
            hands[i] = [data.site(f"{side}_hand").xpos for side in SIDES]
        return nearest, hands


def upper_body(
    robot: RobotDescription, limits: Array, reach_m: float, leg_poses: Sequence[Sequence[float]]
) -> mujoco.MjModel:
    """Compile what stands above the legs on a fixed pelvis, and the space of the legs as solids of the pelvis.

    The joints above the legs have a working range limits (n, 2) [rad]; solids nearer than reach_m [m] make contacts.
    Leg poses (4,) [rad] are left hip yaw, roll, pitch and knee; the right leg's are their mirror images.
    """
    solids = leg_space(robot, leg_poses)
    spec = check_spec(robot, reach_m)
    spec.compiler.degree = False
    for part in [*spec.actuators, *spec.sensors]:
        spec.delete(part)
    for joint in [joint for joint in spec.joints if joint.name not in robot.layout.above_legs]:
        spec.delete(joint)
    for joint, span in zip(spec.joints, limits, strict=True):
        joint.limited = True
        joint.range = span
    moved = set[str]()
    for joint in spec.joints:
        moved.add(joint.parent.name)
        moved.update(body.name for body in joint.parent.find_all("body"))
    for geom in spec.geoms:
        geom.conaffinity |= ZONE_TYPE * (geom.parent.name in moved and geom.contype > 0)
    base = spec.body(robot.base)
    for fromto, radius in solids:
        geom = base.add_geom(
            type=mujoco.mjtGeom.mjGEOM_CAPSULE, contype=ZONE_TYPE, conaffinity=0, margin=reach_m / 2, mass=0
        )
        geom.fromto = fromto
        geom.size[0] = radius
    return spec.compile()


def leg_space(robot: RobotDescription, poses: Sequence[Sequence[float]]) -> list[tuple[Array, float]]:
    """Return capsules (both ends (6,) [m] in the base's frame, radius [m]) of both legs' shapes at some poses."""
    model = check_spec(robot, 0.0).compile()
    data = mujoco.MjData(model)
    capsules = []
    for pose in poses:
        for foot, sign in zip(robot.feet.values(), (1.0, -1.0), strict=True):
            first = model.joint(robot.layout.limb(foot.limb)[0]).qposadr[0]
            data.qpos[:] = model.qpos0
            data.qpos[:3] = 0.0
            data.qpos[first : first + len(pose)] = np.array([sign, sign, 1.0, 1.0]) * pose
            mujoco.mj_kinematics(model, data)
            knee = model.joint(robot.layout.limb(foot.limb)[3]).bodyid[0]
            for i in np.flatnonzero(np.isin(model.geom_bodyid, [model.body_parentid[knee], knee])):
                axis = data.geom_xmat[i].reshape(3, 3)[:, 2] * model.geom_size[i, 1]
                ends = np.concatenate([data.geom_xpos[i] - axis, data.geom_xpos[i] + axis])
                capsules.append((ends, float(model.geom_size[i, 0])))
    return capsules
