"""Pinocchio's own arm of six joints: a detector from a motion that nothing pushes, then a push."""

import numpy as np
import pinocchio as pin
from simulated import RATE_HZ, draw, moved, wandered

import mobnet

model = pin.buildSampleModelManipulator()
wrong = pin.buildSampleModelManipulator()  # what we know of it: every link a twentieth too light
for inertia in wrong.inertias:
    inertia.mass *= 0.95
arm = mobnet.Robot.from_model(wrong)

free = arm.sample(*wandered(model, seconds=210.0))
detector = mobnet.Detector.from_free_motion(arm, free, RATE_HZ)  # one false alarm in an hour
push = np.array([0.0, 0.0, 0.0, 8.0, 0.0, 0.0])
q, v, tau = moved(model, push)

alarms = [detector.step(arm.sample(q[k], v[k], tau[k])) for k in range(len(q))]
first = next(k for k in range(len(q)) if alarms[k].is_on)

print(detector)
for joint, threshold in zip(detector.joints, detector.thresholds.thresholds, strict=True):
    print(f"{joint}: threshold {threshold:.2f} N m")
print(f"{alarms[first].joint}: flag at {first / RATE_HZ:.3f} s")
residual = np.array([alarm.estimate.tau_ext for alarm in alarms])
draw("six_joint_arm", residual, {"elbow": 3}, push)
