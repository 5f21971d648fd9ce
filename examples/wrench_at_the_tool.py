"""The force at the tool of a Panda: the residual through the transposed Jacobian."""

from pathlib import Path

import numpy as np
import pinocchio as pin
from simulated import RATE_HZ, draw, moved

import mobnet
from mobnet.robot.nominal import NominalModel

PANDA = Path(__file__).parents[1] / "configs" / "robots" / "panda.yaml"
FORCE_N = np.array([0.0, 12.0, -20.0])  # at the last link's origin, world axes

model = NominalModel(mobnet.Robot.read(PANDA).description).model
data = model.createData()
last = model.njoints - 1


def jacobian(q):
    """Return the linear part of the last link's Jacobian (3, nv), world axes."""
    pin.computeJointJacobians(model, data, q)
    return pin.getJointJacobian(model, data, last, pin.LOCAL_WORLD_ALIGNED)[:3]


push = jacobian(pin.neutral(model)).T @ FORCE_N
q, v, tau = moved(model, push)
residual = mobnet.MomentumObserver(model, RATE_HZ).run(q, v, tau)

force, *_ = np.linalg.lstsq(jacobian(pin.neutral(model)).T, residual[1400], rcond=None)
print(f"force at the tool: {force.round(2)} N, true {FORCE_N} N")
draw("wrench_at_the_tool", residual, {f"joint {k + 1}": k for k in range(model.nv)}, push)
