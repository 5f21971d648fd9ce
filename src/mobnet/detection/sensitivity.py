"""The smallest force that a collision must have to be found, at each point of a leg, before anything has hit it.

Section 5.4 takes thresholds for an indirect estimate of what a detector can feel. This is that estimate: the torques of
a push of 1 N follow from the pose, and what the filters leave of a short one from the filters (note 0036).
"""

import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.detection.detector import GateSignal, run_over
from mobnet.detection.leg import unit_torques
from mobnet.detection.watch import LegSetup, LimbSetup


def found_forces(setup: LegSetup, poses: Array, thresholds: Array) -> dict[str, float]:
    """Return point of the leg -> the force [N] that a short collision must have there, in most poses of a swing.

    Poses (T, nq) [m, -, rad] are those in which the leg is watched, thresholds (T, 6) [N m] those of its joints there.
    """
    numbers = setup.detection.sensitivity
    robot = setup.robot
    points = [row.name for row in robot.points if row.name.startswith(f"{setup.side}_") and row.name.count("_") == 2]
    picked = some_rows(len(poses), numbers.poses)
    left = attenuation(setup)
    units = [unit_torques(robot, setup.gate.leg, q, points, setup.inward) for q in poses[picked]]
    forces = [smallest_forces(*pair, left) for pair in zip(units, thresholds[picked], strict=True)]
    return dict(zip(points, np.quantile(forces, numbers.share, axis=0).tolist(), strict=True))


def some_rows(count: int, most: int) -> NDArray[np.intp]:
    """Return rows of poses (k,), evenly apart: neighbours differ little, and a few hundred have the same quantile."""
    return np.linspace(0, count - 1, min(most, count)).astype(np.intp)


def smallest_forces(units: Array, thresholds: Array, attenuation: float) -> Array:
    """Return the least force of each of k pushes that brings a joint over its threshold (k,) [N], (D12).

    Units (k, 6) are as in `name_push`, thresholds (6,) those of the joints [N m]; of a push that lasts as long as a
    collision, filters leave the share `attenuation`.
    """
    # The joint that crosses first counts. The floor is for joints that the push does not load.
    return (thresholds / (attenuation * np.maximum(np.abs(units), 1e-9))).min(axis=1)


def attenuation(setup: LimbSetup) -> float:
    """Return what the filters leave of the peak of a half-sine of a collision's length [-]."""
    count = round(setup.detection.sensitivity.contact_s * setup.rate_hz)
    # (D11): the low-pass is highest only after the peak of the force, so that the run goes on beyond its end.
    hit = np.sin(np.pi * np.arange(2 * count) / count)[:, None] * (np.arange(2 * count) < count)[:, None]
    always = GateSignal(np.ones(len(hit), dtype=bool), np.zeros(len(hit)))
    return float(run_over(setup.chain(np.ones((1, 1))), np.ascontiguousarray(hit), always).ratio.max())
