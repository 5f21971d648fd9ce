"""The plant of a robot that moves without walking: what its table does not tell, what holds it, and what pushes it."""

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import mujoco
import numpy as np

from mobnet.core.arrays import Array
from mobnet.robot.description import RobotDescription
from mobnet.robot.plant import robot_spec
from mobnet.settings.free_motion import FreeMotion, HiddenBody, HiddenJoints, LinkPushes
from mobnet.simulation.free_motion import speeds_of

STILL_RAD_S = 1e-9  # below it a joint rests
HELD = (*(0.0,) * 6, 1.0, *(0.0,) * 3, 1.0)  # of a weld: anchor, place and quaternion of the world in the base, scale
NO_LOAD = 1e-9  # share of its torque that a force of 1 N takes of a joint, below which it takes none


class JointFriction(NamedTuple):
    """Friction of joints: dry and viscous (nu,) [N m], [N m s/rad], shares and speeds [rad/s] as in HiddenJoints."""

    dry: Array
    viscous: Array
    load: float
    static: float
    stribeck: float
    smoothing: float


class LinkPush(NamedTuple):
    """A force on a link: from `start` to `end` [s], on a point (3,) [m] of a body, along a direction (3,) in the world.

    `share` is the largest torque that it makes at a joint, over that joint's largest torque.
    """

    start: float
    end: float
    body: int
    place: Array
    direction: Array
    share: float


def hidden_links(robot: RobotDescription, hidden: HiddenBody, rng: np.random.Generator) -> RobotDescription:
    """Return a robot whose links have other masses, inertias and centres of mass than its table says."""
    bodies = []
    for row in robot.bodies:
        ratio = rng.uniform(1 - hidden.mass_share, 1 + hidden.mass_share)
        inertia = tuple(ratio * value for value in row.inertia)
        com = tuple(np.add(row.com, hidden.com_m * rng.uniform(-1, 1, 3)).tolist())
        bodies.append(row.model_copy(update={"mass": ratio * row.mass, "inertia": inertia, "com": com}))
    return replace(robot, bodies=tuple(bodies))


def joint_friction(robot: RobotDescription, settings: FreeMotion) -> JointFriction:
    """Return the friction of a robot's joints, in proportion to their largest torques."""
    hidden: HiddenJoints = settings.joints
    return JointFriction(
        dry=hidden.coulomb_share * robot.torque_limits,
        viscous=hidden.viscous_share * robot.torque_limits / speeds_of(robot, settings),
        load=hidden.load_share,
        static=hidden.static_share,
        stribeck=hidden.stribeck_rad_s,
        smoothing=hidden.smoothing_rad_s,
    )


def damping_of(friction: JointFriction, v: Array, torque: Array) -> Array:
    """Return friction over speed (nu,) [N m s/rad] at v (nu,) [rad/s] and the motors' torques (nu,) [N m].

    Taken as a damping, which MuJoCo holds to the end of a step, dry friction is stable for links of any inertia.
    """
    speed = np.maximum(np.abs(v), STILL_RAD_S)
    dry = friction.dry * (1 + friction.static * np.exp(-speed / friction.stribeck)) + friction.load * np.abs(torque)
    return dry * np.tanh(speed / friction.smoothing) / speed + friction.viscous


def held_model(robot: RobotDescription, settings: FreeMotion, rate_hz: float, gravity_m_s2: float) -> mujoco.MjModel:
    """Compile the plant, stepped at a rate [1/s]; a floating base is welded to the world at its place, and gives.

    Bodies do not touch each other: the motion keeps the shapes of a table apart, and nothing else stands in the world.
    """
    spec = robot_spec(robot)
    spec.option.timestep = 1.0 / rate_hz
    spec.option.gravity = [0.0, 0.0, -gravity_m_s2]
    if robot.floating:
        weld = spec.add_equality(type=mujoco.mjtEq.mjEQ_WELD, objtype=mujoco.mjtObj.mjOBJ_BODY, name1=robot.base)
        weld.solref = [settings.hold_s, 1.0]
        weld.data[: len(HELD)] = HELD
    return spec.compile()


def draw_pushes(
    model: mujoco.MjModel, settings: LinkPushes, seconds: float, rng: np.random.Generator
) -> tuple[LinkPush, ...]:
    """Draw pushes on the named points of a robot; without points, on the centres of mass of the links that move."""
    sites = [k for k in range(model.nsite) if not model.site(k).name.startswith("imu")]
    places = [(int(model.site_bodyid[k]), model.site_pos[k]) for k in sites]
    moved = sorted(
        {int(body) for k, body in enumerate(model.jnt_bodyid) if model.jnt_type[k] == mujoco.mjtJoint.mjJNT_HINGE}
    )
    places = places or [(body, model.body_ipos[body]) for body in moved]
    pushes = list[LinkPush]()
    start = rng.uniform(*settings.pause_s)
    while True:
        end = start + rng.uniform(*(settings.short_s if rng.random() < 0.5 else settings.long_s))
        if end >= seconds:
            return tuple(pushes)
        body, place = places[int(rng.integers(len(places)))]
        direction = rng.normal(size=3)
        share = rng.uniform(*settings.torque_share)
        pushes.append(LinkPush(start, end, body, place.copy(), direction / np.linalg.norm(direction), share))
        start = end + rng.uniform(*settings.pause_s)


class PushSequence:
    """Pushes one after another, each of the size that its share of the joints' torques asks for where it begins."""

    def __init__(self, pushes: Sequence[LinkPush], limits: Array, settings: LinkPushes) -> None:
        """Take pushes in the order of their times, and the largest torques of the joints (nu,) [N m]."""
        self.waiting = list(pushes)
        self.limits = limits
        self.settings = settings
        self.size = 0.0
        self.acts = False

    def torque(self, model: mujoco.MjModel, data: mujoco.MjData) -> Array:
        """Return J^T F of what pushes at the time of the plant, (nv,) [N], [N m]."""
        torque = np.zeros(model.nv)
        if self.acts and data.time >= self.waiting[0].end:
            self.waiting.pop(0)
        was = self.acts
        self.acts = bool(self.waiting) and self.waiting[0].start <= data.time < self.waiting[0].end
        if not self.acts:
            return torque
        push = self.waiting[0]
        self.size = self.size if was else self._size(push, model, data)
        ramp = min(self.settings.ramp_s, (push.end - push.start) / 2)
        share = min(1.0, (data.time - push.start) / ramp, (push.end - data.time) / ramp)
        force = self.size * share * push.direction
        mujoco.mj_applyFT(model, data, force, np.zeros(3), _point(push, data), push.body, torque)
        return torque

    def _size(self, push: LinkPush, model: mujoco.MjModel, data: mujoco.MjData) -> float:
        """Return the largest force of a push that begins where the robot is [N]."""
        jacobian = np.zeros((3, model.nv))
        mujoco.mj_jac(model, data, jacobian, None, _point(push, data), push.body)
        load = np.abs(push.direction @ jacobian[:, -len(self.limits) :]) / self.limits
        weight = model.body_subtreemass[0] * np.linalg.norm(model.opt.gravity)
        return float(min(push.share / max(load.max(), NO_LOAD), self.settings.weight_share * weight))


def _point(push: LinkPush, data: mujoco.MjData) -> Array:
    """Return the point of a push in the world (3,) [m]."""
    return data.xpos[push.body] + data.xmat[push.body].reshape(3, 3) @ push.place
