"""The steps of a recorded walk: commanded (Table 2) and measured, and bins of the commands."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from experiments.evaluation.compare.rmse import Spans
from experiments.evaluation.compare.windows import FLAG
from mobnet.control.steps import DURATION, STEP_Y, TURN
from mobnet.core.arrays import Array
from mobnet.core.columns import FEET, recording_columns
from mobnet.core.errors import DataError
from mobnet.core.joints import JointLayout
from mobnet.core.store import read_array
from mobnet.robot.description import SIDES
from mobnet.robot.frames import to_pinocchio
from mobnet.robot.nominal import NominalModel
from mobnet.settings.data import Commands

SIGN = np.array([1.0, -1.0])  # outwards in y, left and right foot
KEYS = ("step_x_m", "step_y_m", "turn_deg", "duration_s", "foot_height_m")  # of the configuration's commands
UNITS = ("m", "m", "deg", "s", "m")  # of a command here; recordings have turns in rad
CHOICES = 3  # the first three are ranges, the others a few values to choose from


def ankle_places(nominal: NominalModel, q: NDArray[Any]) -> tuple[Array, Array]:
    """Return the ankles' positions (T, 2, 3) [m] in world and the feet's yaw (T, 2) [rad], left and then right.

    The generalized positions are (T, nq) [m], [-], [rad]; the model's masses do not matter here.
    """
    robot = nominal.robot
    model = nominal.model
    data = nominal.data
    joints = [model.getJointId(robot.layout.limb(robot.feet[side].limb)[-1]) for side in SIDES]
    position = np.zeros((len(q), len(SIDES), 3))
    yaw = np.zeros((len(q), len(SIDES)))
    for row, posture in enumerate(to_pinocchio(q)):
        pin.forwardKinematics(model, data, posture)
        for side, joint in enumerate(joints):
            place = data.oMi[joint]
            position[row, side] = place.translation
            yaw[row, side] = np.arctan2(place.rotation[1, 0], place.rotation[0, 0])
    return position, yaw


@dataclass(frozen=True)
class WalkedSteps:
    """Steps, each from one touch-down to the next, of the other foot: 0 where the left one moved, 1 the right one (N,).

    Commanded are step x, step y [m], turn [deg], duration [s] and foot height [m] (N, 5), Table 2. The time they took
    is (N,) [s], and the generalized positions at the touch-downs that end them (N, nq).
    """

    foot: NDArray[np.intp]
    commanded: Array
    duration_s: Array
    landed: NDArray[Any]

    def __len__(self) -> int:
        """Return the number of steps."""
        return len(self.foot)

    def follows(self, column: int) -> NDArray[np.bool_]:
        """Return whether each step (N,) makes its foot move by a column of the command.

        Sideways and turning steps are led by the foot on that side; the other one only closes up.
        """
        if column in (STEP_Y, TURN):
            return self.commanded[:, column] * SIGN[self.foot] > 0.0
        return self.commanded[:, column] != 0.0

    def measured(self, nominal: NominalModel, spacing_m: float) -> Array:
        """Return step x, step y [m], turn [deg] and duration [s] (N, 4) in the stance foot's yaw frame.

        Step y is the distance between the ankles less the controller's spacing [m].
        """
        moved = measure(nominal, self.landed, self.foot, spacing_m)
        return in_degrees(np.concatenate([moved, self.duration_s[:, None]], axis=1))


def read_steps(stems: Sequence[Path], layout: JointLayout) -> WalkedSteps:
    """Return the steps of recordings, one after another; only the columns needed are read.

    Raises:
        DataError: a file or a column is missing, or no step is made.
    """
    parts = [_steps_of(stem, layout) for stem in stems]
    steps = WalkedSteps(
        foot=np.concatenate([part.foot for part in parts]),
        commanded=np.concatenate([part.commanded for part in parts]),
        duration_s=np.concatenate([part.duration_s for part in parts]),
        landed=np.concatenate([part.landed for part in parts]),
    )
    if not len(steps):
        raise DataError(f"{', '.join(map(str, stems))}: no step is made in these recordings")
    return steps


def _steps_of(stem: Path, layout: JointLayout) -> WalkedSteps:
    """Return the steps of one recording."""
    columns = recording_columns(layout)
    names: list[str] = []
    for field in ("q", "swing", "command"):
        names += [name for name, _, _ in columns[field]]
    array, meta = read_array(stem, names)
    q, swing, command = np.split(array, [layout.nq, layout.nq + len(FEET)], axis=1)
    bounds = np.array(list(step_bounds(swing > FLAG, command, meta["segments"])), dtype=np.intp).reshape(-1, 3)
    first, last, foot = bounds.T
    return WalkedSteps(foot, in_degrees(command[last - 1].astype(float)), (last - first) / meta["rate_hz"], q[last])


def step_bounds(swing: NDArray[np.bool_], command: NDArray[Any], segments: Spans) -> Iterator[tuple[int, int, int]]:
    """Yield (row of the touch-down before, row of its own touch-down, foot) of every step.

    A step ends where the plan ends a swing, flagged for left and right foot (T, 2). One is left out where the robot
    stands for a part of it, which zero commands (T, 5) say, where its foot moved twice in a row, or where it starts
    before its segment (start, end) does.
    """
    for start, end in segments:
        downs = np.argwhere(swing[start : end - 1] & ~swing[start + 1 : end])
        for (before, other), (row, foot) in pairwise(downs):
            first = int(start + before + 1)
            last = int(start + row + 1)
            if other != foot and np.all(command[first:last, DURATION] > 0.0):
                yield first, last, int(foot)


def measure(nominal: NominalModel, q: NDArray[Any], foot: NDArray[np.intp], spacing_m: float) -> NDArray[np.float64]:
    """Return step x, step y [m] and turn [rad] (N, 3) of feet that have just touched down, 0 left, 1 right (N,).

    The generalized positions at the touch-downs are (N, nq); the ankles' distance at a step y of zero is the spacing
    [m].
    """
    position, yaw = ankle_places(nominal, q)
    rows = np.arange(len(foot))
    stance = 1 - foot
    apart = position[rows, foot] - position[rows, stance]
    facing = yaw[rows, stance]
    forward = np.cos(facing) * apart[:, 0] + np.sin(facing) * apart[:, 1]
    left = np.cos(facing) * apart[:, 1] - np.sin(facing) * apart[:, 0]
    # The shorter way round: yaw angles jump by a whole turn.
    turn = np.remainder(yaw[rows, foot] - facing + np.pi, 2 * np.pi) - np.pi
    return np.stack([forward, left - SIGN[foot] * spacing_m, turn], axis=1)


def in_degrees(numbers: Array) -> Array:
    """Return numbers of steps (N, n) with the turns in [deg] instead of [rad]."""
    turned = numbers.copy()
    turned[:, TURN] = np.rad2deg(turned[:, TURN])
    return turned


def bin_edges(commands: Commands, column: int, bins: int) -> Array:
    """Return the bins' edges (n + 1,) [m], [deg], [s] of a command: a range cut evenly, or around every choice."""
    values = np.asarray(getattr(commands, KEYS[column]), dtype=float)
    if column < CHOICES:
        return np.linspace(values[0], values[1], bins + 1)
    middle = (values[1:] + values[:-1]) / 2
    return np.concatenate([[2 * values[0] - middle[0]], middle, [2 * values[-1] - middle[-1]]])


def bin_of(values: NDArray[Any], edges: NDArray[np.float64]) -> NDArray[np.intp]:
    """Return the bin (N,) of every value [unit of the edges]; a value on an outer edge, up to rounding, lies inside."""
    return np.clip(np.searchsorted(edges, values, side="right") - 1, 0, len(edges) - 2)
