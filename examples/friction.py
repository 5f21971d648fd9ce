"""Friction that the observer knows is no external torque: both residuals of one log."""

import numpy as np
import pinocchio as pin
from simulated import RATE_HZ, draw, moved

import mobnet

COULOMB_NM = 3.0
VISCOUS_NMS = 1.5


def lost(v):
    """Return what joints lose at velocities [rad/s]: dry and viscous friction [N m]."""
    return COULOMB_NM * np.tanh(v / 0.01) + VISCOUS_NMS * v


model = pin.buildSampleModelManipulator()
push = np.array([0.0, 5.0, 0.0, 0.0, 0.0, 0.0])
log = moved(model, push, lost=lost)

blind = mobnet.MomentumObserver(model, RATE_HZ).run(*log)
known = {"coulomb": COULOMB_NM, "viscous": VISCOUS_NMS, "smoothing": 0.01}
knowing = mobnet.MomentumObserver(model, RATE_HZ, friction=known).run(*log)

for name, residual in (("friction unknown", blind), ("friction known", knowing)):
    error = np.sqrt(np.mean(residual[200:1000] ** 2))
    print(f"{name}: {error:.2f} N m before the push, root mean square of all joints")
draw("friction", knowing, {"shoulder 2": 1, "elbow": 3}, push)
