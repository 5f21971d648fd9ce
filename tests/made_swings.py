"""A robot that hangs still in the air while its plan swings the left leg, with torques as a test wants them."""

import numpy as np

from mobnet.core.columns import COMMAND, FEET
from mobnet.core.joints import JointLayout
from mobnet.core.recording import Sensed, Truth

RATE_HZ = 1000.0
AIR, GROUND = 350, 1050  # samples of a swing, and of a step in which the foot stands
BENT = (0.0, 0.0, -0.4, 0.9, -0.5, 0.0)  # of the left leg [rad]


def swinging(layout: JointLayout, swings: int) -> Sensed:
    """Return what is sensed in so many swings, first with the foot on the ground."""
    rows = swings * (AIR + GROUND) + GROUND
    phase = np.arange(rows) % (AIR + GROUND) - GROUND
    air = phase >= 0
    q = np.zeros((rows, layout.nq))
    q[:, 3], q[:, 2] = 1.0, 1.0
    for joint, angle in zip(layout.limb("LL"), BENT, strict=True):
        q[:, 7 + layout.actuated.index(joint)] = angle
    swing, landing = np.zeros((2, rows, len(FEET)))
    swing[:, 0], landing[:, 0] = air, np.where(air, (AIR - phase) / RATE_HZ, 0.0)
    none, command = np.zeros((rows, layout.nu)), np.zeros((rows, len(COMMAND)))
    acc = np.tile([0.0, 0.0, 9.81], (rows, 1))
    return Sensed(q, np.zeros((rows, layout.nv)), acc, none, none, swing, command, landing)


def unseen(layout: JointLayout, rows: int, push: np.ndarray | None = None) -> Truth:
    """Return the truth of a walk without contacts; push (T, 4) as in `Truth`."""
    wrench, flags, one = np.zeros((rows, 6)), np.zeros((rows, len(FEET))), np.zeros((rows, 1))
    none, whole = np.zeros((rows, layout.nu)), np.zeros((rows, layout.nv))
    return Truth(whole, wrench, wrench, flags, one, none, whole, np.zeros((rows, 4)) if push is None else push)
