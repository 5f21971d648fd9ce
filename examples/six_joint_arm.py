"""Pinocchio's own arm of six joints: thresholds from a motion without pushes, then a push."""

import numpy as np
import pinocchio as pin
from simulated import RATE_HZ, draw, moved

import mobnet

MARGIN = 1.5

model = pin.buildSampleModelManipulator()
wrong = pin.buildSampleModelManipulator()  # what we know of it: every link a twentieth too light
for inertia in wrong.inertias:
    inertia.mass *= 0.95
observer = mobnet.MomentumObserver(wrong, RATE_HZ)

free = observer.run(*moved(model, np.zeros(6)))
thresholds = MARGIN * np.abs(free).max(axis=0)
push = np.array([0.0, 0.0, 0.0, 8.0, 0.0, 0.0])
residual = observer.run(*moved(model, push))

print(observer)
for joint, threshold, own in zip(observer.joints, thresholds, residual.T, strict=True):
    flags = np.flatnonzero(np.abs(own) > threshold)
    when = f"flag at {flags[0] / RATE_HZ:.3f} s" if len(flags) else "no flag"
    print(f"{joint}: threshold {threshold:.2f} N m, {when}")
draw("six_joint_arm", residual, {"elbow": 3}, push)
