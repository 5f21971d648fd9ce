"""The gate of a leg as the C library takes it: the numbers of the gate, and where the soles are on the links."""

import struct
from typing import Any

import numpy as np

from mobnet.control.kinematics import empty_pose, update
from mobnet.core.joints import NQ_BASE
from mobnet.detection.detector import LegGate
from mobnet.detection.leg import Leg
from mobnet.robot.nominal import NominalModel


def leg_record(nominal: NominalModel, gate: LegGate) -> bytes:
    """Return the bytes of a leg's gate: `struct gate` and `struct leg` of internal.h."""
    numbers = gate.gate
    leg = gate.leg
    head = struct.pack("<dq5dq", *numbers) + struct.pack("<q", leg.first)
    return head + _sole(nominal, leg, leg.foot) + _sole(nominal, leg, leg.other)


def _sole(nominal: NominalModel, leg: Leg, foot: int) -> bytes:
    """Return the link that carries a foot, and in its axes the foot's origin and the corners of its sole [m]."""
    body = foot
    robot = nominal.robot
    while body > 0 and leg.tree.joint[body] < 0:  # welded to its parent
        body = int(leg.tree.parent[body])
    pose = empty_pose(leg.tree)
    q = np.zeros(robot.layout.nq)
    q[NQ_BASE - 4] = 1.0
    update(leg.tree, q, leg.still, 0.0, pose)
    corners = leg.corners @ pose.rotation[foot].T + pose.position[foot]
    points: Any = np.vstack([pose.position[foot], corners]) - pose.position[body]
    link = int(leg.tree.joint[body]) + 1  # the base stands before the links of the joints
    return struct.pack("<q", link) + (points @ pose.rotation[body]).astype("<f8").tobytes()
