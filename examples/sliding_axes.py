"""A gantry of three sliders: its observer tells forces."""

import numpy as np
import pinocchio as pin
from simulated import RATE_HZ, draw, moved

import mobnet

model = pin.Model()
model.name = "gantry"
carrier = 0
for name, joint, mass in (
    ("x", pin.JointModelPX(), 30.0),
    ("y", pin.JointModelPY(), 12.0),
    ("z", pin.JointModelPZ(), 4.0),
):
    carrier = model.addJoint(carrier, joint, pin.SE3.Identity(), name)
    model.appendBodyToJoint(carrier, pin.Inertia(mass, np.zeros(3), np.eye(3)), pin.SE3.Identity())

force = np.array([15.0, 0.0, -8.0])  # [N]
q, v, tau = moved(model, force)
observer = mobnet.MomentumObserver(model, RATE_HZ, gain_hz=50.0)
residual = observer.run(q, v, tau)

print(observer)
print(f"force at the tool: {residual[1450].round(2)} N, true {force} N")
draw("sliding_axes", residual, {"x": 0, "y": 1, "z": 2}, force)
