"""A robot that walks with an estimator of its external torque in the loop, and reacts to what it feels."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from mobnet.control.parameters import State
from mobnet.core.arrays import Array
from mobnet.core.columns import recording_columns
from mobnet.core.estimator import Estimate, TorqueEstimator
from mobnet.core.joints import N_VIRTUAL, JointLayout
from mobnet.core.recording import Sensed
from mobnet.reaction.contacts import tell_feet
from mobnet.reaction.feed_forward import FeedForward, swing_error
from mobnet.reaction.handler import Handler, Reacted
from mobnet.robot.description import LEG_JOINTS
from mobnet.simulation.obstacles import obstacle_force, place_of, points_on
from mobnet.simulation.simulator import Simulator


@dataclass
class Course:
    """What happened in a walk, sample by sample; joints that are not estimated have zeros.

    Attributes:
        rows: the recording (T, C), columns of `recording_columns`.
        tau: estimated external torque (T, nv) [N, N m].
        std: its standard deviation (T, nv) [N, N m], zero where there is none.
        force: of obstacles and pushes on the robot (T, 3) [N], world axes.
        point: where obstacles act, the mean of the points of contact (T, 3) [m], zero where nothing touches.
        base: place of the base (T, 3) [m], world axes, as it was.
        error: of the base's sensed velocity (T, 3) [m/s], world axes.
        tracking: error of the joints of the leg that swings from their references (T, 6) [rad]; NaN while none does.
        power: sum of `|motor torque x joint velocity|` (T, 1) [W].
        obstacles: places of the obstacles by name (3,) [m].
        reacted: the reaction and its sample, if there was one.
        fallen: whether the robot fell at the end.
    """

    rows: NDArray[np.float32]
    tau: NDArray[np.float32]
    std: NDArray[np.float32]
    force: NDArray[np.float32]
    point: NDArray[np.float32]
    base: NDArray[np.float32]
    error: NDArray[np.float32]
    tracking: NDArray[np.float32]
    power: NDArray[np.float32]
    obstacles: Mapping[str, Array]
    reacted: tuple[int, Reacted] | None = None
    fallen: bool = False

    @classmethod
    def of(cls, samples: int, simulator: Simulator) -> "Course":
        """Return room for so many samples."""
        width = simulator.width
        nv = simulator.robot.layout.nv
        rows, tau, std = (np.zeros((samples, n), np.float32) for n in (width, nv, nv))
        places = {name: place_of(simulator.world.model, name) for name in simulator.settings.obstacles}
        force, point, base, error = (np.zeros((samples, 3), np.float32) for _ in range(4))
        tracking = np.full((samples, LEG_JOINTS), np.nan, np.float32)
        power = np.zeros((samples, 1), np.float32)
        return cls(rows, tau, std, force, point, base, error, tracking, power, places)

    def cut(self, samples: int) -> "Course":
        """Return the first samples."""
        arrays = ("rows", "tau", "std", "force", "point", "base", "error", "tracking", "power")
        return replace(self, **{name: getattr(self, name)[:samples] for name in arrays})


def walk_with(
    simulator: Simulator,
    estimator: TorqueEstimator,
    handler: Handler,
    longest: int,
    after: int,
    touch_n: float,
    height_m: float,
    feed_forward: float = 0.0,
) -> Course:
    """Walk a started episode until so many samples `after` the robot reacts, or is pushed with touch_n [N].

    It ends before that where the robot falls, and after `longest` samples at the latest. A foot that swings higher than
    height_m [m] above the other one touches no ground. Motors of the leg that swings make up for the share
    `feed_forward` of the uncertainty torque that the estimate knows.
    """
    layout = simulator.robot.layout
    sensors = simulator.sensors
    places = columns_of(layout)
    columns = layout.columns(estimator.joints)
    pushed = slice(places["push"].stop - 3, places["push"].stop)  # the force follows the push's row
    course = Course.of(longest, simulator)
    row = np.zeros((1, simulator.width), np.float32)
    state = handler.init()
    estimating = estimator.init()
    left = longest
    fed = FeedForward.of(simulator, estimator.joints, feed_forward) if feed_forward else None
    for k in range(longest):
        if left == 0:
            return course.cut(k)
        if simulator.run(row) == 0:
            course.fallen = True
            return course.cut(k)
        sample = Sensed(*(row[0, places[name]] for name in Sensed.__dataclass_fields__))
        estimating, estimate = estimator.step(estimating, sample)
        course.rows[k] = row[0]
        course.tau[k, columns] = estimate.tau_ext
        course.force[k] = force_on(simulator) + row[0, pushed]
        course.base[k] = simulator.plant.qpos[:3]
        is_pushed = course.force[k].any()
        if is_pushed and len(points := points_on(simulator.world.model, simulator.world.data)):
            course.point[k] = points.mean(axis=0)
        course.error[k] = sample.v[:3] - simulator.plant.qvel[:3]
        swing_error(simulator.state, simulator.walker.first, simulator.plant.qpos, course.tracking[k])
        course.power[k] = np.abs(sample.tau_motor * simulator.plant.qvel[N_VIRTUAL:]).sum()
        if fed is not None and estimate.uncertainty is not None:
            fed.feed(estimate.uncertainty)
        if estimate.std is not None:
            course.std[k, columns] = estimate.std
        reacted = handler.step(state, sample, Estimate(course.tau[k], course.std[k]))
        tell_feet(handler.identified, simulator.walker.sensor, sample.swing, height_m, sensors.told)
        if reacted is not None:
            course.reacted = k, reacted
            simulator.commands = plan_steps(simulator.state, reacted.steps)
            give_way(simulator.state, reacted.direction)
        if course.reacted is not None:
            stop(simulator.state, len(simulator.commands))
        is_touched = is_pushed and np.linalg.norm(course.force[k]) > touch_n
        ending = left < longest or course.reacted is not None or is_touched
        left = min(left, after) - 1 if ending else left
    return course


def force_on(simulator: Simulator) -> Array:
    """Return the force of all obstacles on the robot in the last step (3,) [N], world axes."""
    model = simulator.world.model
    data = simulator.world.data
    return sum((obstacle_force(model, data, name) for name in simulator.settings.obstacles), np.zeros(3))


def columns_of(layout: JointLayout) -> Mapping[str, slice]:
    """Return field -> its columns in a row of a recording."""
    slices = dict[str, slice]()
    at = 0
    for name, columns in recording_columns(layout).items():
        slices[name] = slice(at, at + len(columns))
        at += len(columns)
    return slices


def plan_steps(s: State, steps: Array) -> Array:
    """Give the controller reacting steps (n, 5), the first for the present step; return its commands (m, 5)."""
    s.command[:] = steps[0]
    # The controller looks up the command of a step by its number; those of steps that are past are not read again.
    return np.vstack([np.zeros((int(s.steps), steps.shape[1])), steps])


def give_way(s: State, direction: Array) -> None:
    """Tell the controller the direction (2,) of a force: the swing foot turns back, footholds do not move against it.

    A force without a direction, zeros, keeps no foothold from moving.
    """
    s.reacting = 1
    s.away[:] = direction
    s.turns_back = 1


def stop(s: State, steps: int) -> None:
    """Let a robot that has made all its steps stand, once the last foot has landed."""
    if s.steps >= steps and s.swinging == 0 and s.t >= 0.0:
        s.standing = 1
