"""A robot that hangs still in the air while its plan swings the left leg, with torques as a test wants them."""

from dataclasses import replace

import numpy as np

from mobnet.core.columns import COMMAND, FEET
from mobnet.core.joints import JointLayout
from mobnet.core.recording import Sensed, Truth

RATE_HZ = 1000.0
AIR, GROUND = 350, 1050  # samples of a swing, and of a step in which the foot stands
BENT = (0.0, 0.0, -0.4, 0.9, -0.5, 0.0)  # of both legs [rad]: their soles are at one height


def swinging(layout: JointLayout, swings: int) -> Sensed:
    """Return what is sensed in so many swings, first with the foot on the ground."""
    rows = swings * (AIR + GROUND) + GROUND
    phase = np.arange(rows) % (AIR + GROUND) - GROUND
    air = phase >= 0
    q = np.zeros((rows, layout.nq))
    q[:, 3], q[:, 2] = 1.0, 1.0
    for limb in ("LL", "RL"):
        q[:, [7 + layout.actuated.index(joint) for joint in layout.limb(limb)]] = BENT
    swing, landing = np.zeros((2, rows, len(FEET)))
    swing[:, 0], landing[:, 0] = air, np.where(air, (AIR - phase) / RATE_HZ, 0.0)
    none, command = np.zeros((rows, layout.nu)), np.zeros((rows, len(COMMAND)))
    acc = np.tile([0.0, 0.0, 9.81], (rows, 1))
    return Sensed(q, np.zeros((rows, layout.nv)), acc, none, none, swing, command, landing)


def bent_to(sensed: Sensed, layout: JointLayout, further_rad: float) -> Sensed:
    """Return the same with the left knee bent further, the foot still level."""
    q = sensed.q.copy()
    hip, knee, ankle = (7 + layout.actuated.index(name) for name in ("LL3", "LL4", "LL5"))
    q[:, knee] += further_rad
    q[:, [hip, ankle]] -= further_rad / 2.0
    return replace(sensed, q=q)


def unseen(layout: JointLayout, rows: int, push: np.ndarray | None = None) -> Truth:
    """Return the truth of a walk without contacts; push (T, 4) as in `Truth`."""
    wrench, flags, one = np.zeros((rows, 6)), np.zeros((rows, len(FEET))), np.zeros((rows, 1))
    none, whole = np.zeros((rows, layout.nu)), np.zeros((rows, layout.nv))
    return Truth(whole, wrench, wrench, flags, one, none, whole, np.zeros((rows, 4)) if push is None else push)
