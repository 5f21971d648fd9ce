"""Joints of several velocities: a shoulder that is a ball, and a screw that turns and slides."""

import numpy as np
import pinocchio as pin
from simulated import RATE_HZ, draw, moved

import mobnet

model = pin.Model()
model.name = "ball and screw"
shoulder = model.addJoint(0, pin.JointModelSpherical(), pin.SE3.Identity(), "shoulder")
model.appendBodyToJoint(shoulder, pin.Inertia(3.0, np.array([0.0, 0.0, -0.2]), 0.05 * np.eye(3)), pin.SE3.Identity())
screw = model.addJoint(shoulder, pin.JointModelHZ(0.05), pin.SE3(np.eye(3), np.array([0.0, 0.0, -0.4])), "screw")
model.appendBodyToJoint(screw, pin.Inertia(1.0, np.zeros(3), 0.01 * np.eye(3)), pin.SE3.Identity())

push = np.array([2.0, 0.0, 0.5, 0.3])
observer = mobnet.MomentumObserver(model, RATE_HZ)
residual = observer.run(*moved(model, push))

print(observer)
print(f"while it is pushed: {residual[1400].round(2)} N m, true {push} N m")
draw("ball_and_screw", residual, {"shoulder x": 0, "shoulder z": 2, "screw": 3}, push)
