"""A robot that no file describes: its `pin.Model` is built in code."""

import numpy as np
import pinocchio as pin
from simulated import RATE_HZ, draw, moved

import mobnet

model = pin.Model()
model.name = "crane"
tower = model.addJoint(0, pin.JointModelRZ(), pin.SE3.Identity(), "tower")
model.appendBodyToJoint(tower, pin.Inertia(20.0, np.array([0.0, 0.0, 0.5]), np.eye(3)), pin.SE3.Identity())
boom = model.addJoint(tower, pin.JointModelRY(), pin.SE3(np.eye(3), np.array([0.0, 0.0, 1.0])), "boom")
model.appendBodyToJoint(boom, pin.Inertia(5.0, np.array([0.6, 0.0, 0.0]), 0.5 * np.eye(3)), pin.SE3.Identity())
hoist = model.addJoint(boom, pin.JointModelPX(), pin.SE3(np.eye(3), np.array([1.2, 0.0, 0.0])), "hoist")
model.appendBodyToJoint(hoist, pin.Inertia(2.0, np.zeros(3), 0.01 * np.eye(3)), pin.SE3.Identity())
model.armature = np.array([0.5, 0.5, 0.0])  # inertia of the rotors

push = np.array([4.0, 0.0, 10.0])  # on the tower [N m] and along the hoist [N]
q, v, tau = moved(model, push)
observer = mobnet.MomentumObserver(model, RATE_HZ)
residual = observer.run(q, v, tau)

print(observer)
print(f"while it is pushed: {residual[1400].round(2)} of {observer.joints}, true {push}")
draw("model_in_code", residual, {"tower": 0, "boom": 1, "hoist": 2}, push)
