"""The steps of a recorded walk: what was commanded (Table 2), in which bins, and what the feet did."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from mobnet.control.parameters import DURATION, STEP_Y, TURN
from mobnet.core.columns import FEET, recording_columns
from mobnet.core.errors import DataError
from mobnet.core.joints import NQ_BASE
from mobnet.core.store import read_array
from mobnet.evaluation.measure.metrics import Spans
from mobnet.robot.description import SIDES, load_robot
from mobnet.robot.frames import to_pinocchio
from mobnet.robot.nominal import NominalModel

Array = NDArray[np.float64]
AIR = 0.5  # a stored flag above this is 1
SIGN = np.array([1.0, -1.0])  # outwards in y, left and right foot
Sets = Mapping[str, Sequence[str]]  # name of a data set -> stems of its recordings
KEYS = ("step_x_m", "step_y_m", "turn_deg", "duration_s", "foot_height_m")  # of `commands` in the configuration
UNITS = ("m", "m", "deg", "s", "m")
CHOICES = 3  # the first three are ranges, the others a few values to choose from


def ankle_places(nominal: NominalModel, q: NDArray[Any]) -> tuple[Array, Array]:
    """Return the ankles' positions (T, 2, 3) [m] in world and the feet's yaw (T, 2) [rad], left and then right.

    Args:
        nominal: the model; its masses do not matter here.
        q: generalized positions (T, nq) [m], [-], [rad].
    """
    robot, model, data = nominal.robot, nominal.model, nominal.data
    joints = [model.getJointId(robot.layout.limb(robot.feet[side].limb)[-1]) for side in SIDES]
    position, yaw = np.zeros((len(q), len(SIDES), 3)), np.zeros((len(q), len(SIDES)))
    for row, posture in enumerate(to_pinocchio(q)):
        pin.forwardKinematics(model, data, posture)
        for side, joint in enumerate(joints):
            place = data.oMi[joint]
            position[row, side] = place.translation
            yaw[row, side] = np.arctan2(place.rotation[1, 0], place.rotation[0, 0])
    return position, yaw


@dataclass(frozen=True)
class Steps:
    """Steps, each from one touch-down to the next, of the other foot.

    Attributes:
        foot: 0 where the left foot moved, 1 where the right one did (N,).
        commanded: step x, step y [m], turn [rad], duration [s], foot height [m] (N, 5), Table 2.
        measured: step x, step y [m], turn [rad], duration [s] (N, 4), in the stance foot's yaw frame; step y is
            what the feet stand further apart than the controller's spacing.
    """

    foot: NDArray[np.intp]
    commanded: NDArray[np.float64]
    measured: NDArray[np.float64]

    def __len__(self) -> int:
        """Return the number of steps."""
        return len(self.foot)

    def follows(self, column: int) -> NDArray[np.bool_]:
        """Return the steps (N,) that ask something of their foot in a column of the command.

        Sideways and turning steps are led by the foot on that side; the other one only closes up.
        """
        if column in (STEP_Y, TURN):
            return self.commanded[:, column] * SIGN[self.foot] > 0.0
        return self.commanded[:, column] != 0.0


def read_steps(stems: Sequence[Path], nominal: NominalModel, spacing_m: float) -> Steps:
    """Return the steps of recordings, one after another; only the columns needed are read.

    Args:
        stems: recordings, paths without a suffix.
        nominal: the model whose kinematics are used.
        spacing_m: distance between the ankles at a step y of zero [m].

    Raises:
        DataError: a file or a column is missing, or nothing is walked.
    """
    found = [steps for stem in stems for steps in [_steps_of(stem, nominal, spacing_m)] if len(steps)]
    if not found:
        raise DataError(f"{', '.join(map(str, stems))}: no step is made in these recordings")
    return Steps(*(np.concatenate([vars(steps)[name] for steps in found]) for name in vars(found[0])))


def _steps_of(stem: Path, nominal: NominalModel, spacing_m: float) -> Steps:
    """Return the steps of one recording."""
    columns = recording_columns(nominal.robot.layout)
    names = [name for field in ("q", "swing", "command") for name, _, _ in columns[field]]
    array, meta = read_array(stem, names)
    nq = NQ_BASE + nominal.robot.layout.nu
    q, swing, command = array[:, :nq], array[:, nq : nq + len(FEET)] > AIR, array[:, nq + len(FEET) :]
    bounds = np.array(list(step_bounds(swing, command, meta["segments"])), dtype=np.intp).reshape(-1, 3)
    first, last, foot = bounds.T
    measured = measure(nominal, q[last], foot, spacing_m)
    duration = (last - first)[:, None] / meta["rate_hz"]
    return Steps(foot, command[last - 1].astype(float), np.concatenate([measured, duration], axis=1))


def step_bounds(swing: NDArray[np.bool_], command: NDArray[Any], segments: Spans) -> Iterator[tuple[int, int, int]]:
    """Yield (row of the touch-down before, row of its own touch-down, foot) of every step.

    A step ends where the plan ends a swing. One is left out where the robot stands for a part of it, where its foot
    moved twice in a row, or where it starts before the segment does.

    Args:
        swing: whether the left, right foot is planned to be in the air (T, 2).
        command: Table 2's five numbers (T, 5) [m, m, rad, s, m]; zero while the robot stands.
        segments: contiguous stretches (start, end) of rows.
    """
    for start, end in segments:
        downs = np.argwhere(swing[start : end - 1] & ~swing[start + 1 : end])
        for (before, other), (row, foot) in pairwise(downs):
            first, last = int(start + before + 1), int(start + row + 1)
            if other != foot and np.all(command[first:last, DURATION] > 0.0):
                yield first, last, int(foot)


def measure(nominal: NominalModel, q: NDArray[Any], foot: NDArray[np.intp], spacing_m: float) -> NDArray[np.float64]:
    """Return step x, step y [m] and turn [rad] of feet that have just touched down (N, 3).

    Args:
        nominal: the model.
        q: generalized positions at the touch-downs (N, nq).
        foot: 0 left, 1 right (N,).
        spacing_m: distance between the ankles at a step y of zero [m].
    """
    position, yaw = ankle_places(nominal, q)
    rows, stance = np.arange(len(foot)), 1 - foot
    apart = position[rows, foot] - position[rows, stance]
    facing = yaw[rows, stance]
    forward = np.cos(facing) * apart[:, 0] + np.sin(facing) * apart[:, 1]
    left = np.cos(facing) * apart[:, 1] - np.sin(facing) * apart[:, 0]
    turn = np.remainder(yaw[rows, foot] - facing + np.pi, 2 * np.pi) - np.pi
    return np.stack([forward, left - SIGN[foot] * spacing_m, turn], axis=1)


def read_sets(config: Mapping[str, Any], sets: Sets) -> dict[str, Steps]:
    """Return the steps of every data set, turns in [deg], lengths in [m].

    Raises:
        DataError: a file is missing, or a set holds no step.
    """
    nominal = NominalModel(load_robot(Path(config["robot"])))
    spacing = config["walking"]["foot_spacing_m"]
    return {name: in_degrees(read_steps(list(map(Path, stems)), nominal, spacing)) for name, stems in sets.items()}


def in_degrees(steps: Steps) -> Steps:
    """Return steps with the turns, commanded and measured (N,), in [deg] instead of [rad]."""
    commanded, measured = steps.commanded.copy(), steps.measured.copy()
    for array in (commanded, measured):
        array[:, TURN] = np.rad2deg(array[:, TURN])
    return Steps(steps.foot, commanded, measured)


def bin_edges(config: Mapping[str, Any], column: int, bins: int) -> NDArray[np.float64]:
    """Return the bins' edges (n + 1,) [m], [deg], [s] of a command: a range cut evenly, or around every choice."""
    values = np.asarray(config["commands"][KEYS[column]], dtype=float)
    if column < CHOICES:
        return np.linspace(values[0], values[1], bins + 1)
    middle = (values[1:] + values[:-1]) / 2
    return np.concatenate([[2 * values[0] - middle[0]], middle, [2 * values[-1] - middle[-1]]])


def bin_of(values: NDArray[Any], edges: NDArray[np.float64]) -> NDArray[np.intp]:
    """Return the bin (N,) of every value [unit of the edges]; a value on an outer edge, up to rounding, lies inside."""
    return np.clip(np.searchsorted(edges, values, side="right") - 1, 0, len(edges) - 2)
