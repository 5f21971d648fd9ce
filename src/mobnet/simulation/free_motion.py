"""A smooth random motion of all joints of any robot, within its ranges, speeds and torques and without self-collision.

Joints follow a uniform cubic B-spline: positions, velocities and accelerations are continuous, the curve stays within
the bounds of its points, and its speed within that of the steps between them. Each point is drawn near the one before
it and kept if the curve meets what is asked up to there, and also if it stopped there: so there is always a way on.
"""

from collections.abc import Sequence

import mujoco
import numpy as np
from scipy.interpolate import BSpline

from mobnet.core.arrays import Array
from mobnet.core.errors import SimulationError
from mobnet.core.joints import N_VIRTUAL
from mobnet.robot.description import RobotDescription
from mobnet.robot.plant import robot_spec
from mobnet.settings.free_motion import FreeMotion
from mobnet.simulation.self_collision import REACH_M, Clearance

DEGREE = 3
LOOKS = np.linspace(0.0, 1.0, 7)[1:]  # where a stretch is looked at
REACHES = np.linspace(1.0, 0.0, 20)  # of points that are tried one after another, shares of the largest step
UPRIGHT = (0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0)  # place and quaternion of a base


class TableModel:
    """The robot as its table has it, the base held still: torques that an acceleration of the joints needs."""

    def __init__(self, robot: RobotDescription, gravity_m_s2: float) -> None:
        """Compile MuJoCo's model of the table."""
        spec = robot_spec(robot)
        spec.option.gravity = [0.0, 0.0, -gravity_m_s2]
        spec.option.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_CONSTRAINT)
        self.model = spec.compile()
        self.data = mujoco.MjData(self.model)
        self.nu = robot.layout.nu

    def torque(self, q: Array, v: Array, acceleration: Array) -> Array:
        """Return the motors' torques (nu,) [N m] at q (nq,), v (nv,) for the joints' accelerations (nu,) [rad/s^2]."""
        data = self.data
        data.qpos[:] = q
        data.qvel[:] = v
        data.qacc[-self.nu :] = acceleration
        mujoco.mj_inverse(self.model, data)
        return data.qfrc_inverse[-self.nu :]


def plan_motion(
    robot: RobotDescription, settings: FreeMotion, seconds: float, gravity_m_s2: float, rng: np.random.Generator
) -> BSpline:
    """Return positions of the joints (nu,) [rad] as a function of time [s], which begins at rest in the posture.

    Raises:
        SimulationError: the posture needs too much torque, or the robot touches itself in it.
    """
    table = TableModel(robot, gravity_m_s2)
    clearance = Clearance(robot, REACH_M)
    low, high = bounds_of(robot, settings.span_share)
    step = settings.knot_s * speeds_of(robot, settings)
    points = [start_of(robot, low, high)] * DEGREE

    def fault(stretch: Sequence[Array]) -> str | None:
        return _fault(stretch, robot, settings, table, clearance)

    def leads_on(new: Array) -> bool:
        with_stop = [*points[-DEGREE:], new, new, new]
        return not any(fault(with_stop[k : k + DEGREE + 1]) for k in range(DEGREE))

    if (text := fault([*points, points[-1]])) is not None:
        raise SimulationError(f"motion of {robot.name}: its posture is not accepted as a start: {text}")
    for _ in range(int(np.ceil(seconds / settings.knot_s)) + 1):
        ends = (np.maximum(low, points[-1] - step), np.minimum(high, points[-1] + step))
        drawn = (points[-1] + reach * (rng.uniform(*ends) - points[-1]) for reach in REACHES)
        points.append(next(new for new in drawn if leads_on(new)))  # the last one is a stop, which is always accepted
    return curve(points, settings.knot_s)


def curve(points: Sequence[Array], knot_s: float) -> BSpline:
    """Return the curve of some points (nu,) [rad], which begins at the time zero."""
    return BSpline((np.arange(len(points) + DEGREE + 1) - DEGREE) * knot_s, np.array(points), DEGREE)


def bounds_of(robot: RobotDescription, share: float) -> tuple[Array, Array]:
    """Return the lowest and the highest positions (nu,) [rad] of a share of each joint's range."""
    low, high = np.array([joint.range for joint in robot.joints]).T
    middle = (low + high) / 2
    half = share * (high - low) / 2
    return middle - half, middle + half


def speeds_of(robot: RobotDescription, settings: FreeMotion) -> Array:
    """Return the largest speeds (nu,) [rad/s] of the motion."""
    limits = np.array([joint.velocity_limit for joint in robot.joints])
    return np.minimum(settings.speed_share * limits, settings.speed_max_rad_s)


def start_of(robot: RobotDescription, low: Array, high: Array) -> Array:
    """Return the posture of a robot (nu,) [rad] within bounds; joints that have none are at zero."""
    angles = dict(zip(robot.posture.joints, robot.posture.angle.tolist(), strict=True))
    return np.clip([angles.get(name, 0.0) for name in robot.layout.actuated], low, high)


def whole_state(robot: RobotDescription, joints: Array) -> tuple[Array, Array]:
    """Return q (nq,) and v (nv,) of joints (nu,) [rad] at rest, a floating base upright at the origin."""
    base = UPRIGHT if robot.floating else ()
    return np.concatenate([base, joints]), np.zeros(robot.layout.nv)


def _fault(
    points: Sequence[Array], robot: RobotDescription, settings: FreeMotion, table: TableModel, clearance: Clearance
) -> str | None:
    """Return what is wrong with the stretch of a curve between four points; None where nothing is."""
    stretch = curve(points, settings.knot_s)
    most = settings.torque_share * robot.torque_limits
    times = LOOKS * settings.knot_s
    for angles, rates, accelerations in zip(*(stretch(times, order) for order in range(3)), strict=True):
        q, v = whole_state(robot, angles)
        v[N_VIRTUAL if robot.floating else 0 :] = rates
        share = np.abs(table.torque(q, v, accelerations)) / most
        if share.max() > 1.0:
            joint = robot.layout.actuated[int(share.argmax())]
            return f"{joint} takes {share.max():.2f} times the accepted share of its torque"
        if clearance.model.ngeom and (distance := clearance.nearest(q[None])[0]) < settings.clearance_m:
            return f"{distance:.3f} m between {' and '.join(clearance.pair(q) or ())}"
    return None
