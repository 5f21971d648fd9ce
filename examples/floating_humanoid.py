"""A humanoid that floats: what pushes its base stands in the first six numbers of the residual, in the base's axes."""

import numpy as np
import pinocchio as pin
from simulated import RATE_HZ, draw, moved

import mobnet

model = pin.buildSampleModelHumanoid()
model.gravity = pin.Motion.Zero()  # nothing carries it
push = np.zeros(model.nv)
push[:6] = [8.0, 0.0, 0.0, 0.0, 1.0, 0.0]  # [N], [N m]
push[9] = 2.0  # a joint [N m]
q, v, tau = moved(model, push)

observer = mobnet.MomentumObserver(model, RATE_HZ, torque="sample")
residual = observer.run(q, v, tau)

print(observer)
print(f"force on the base {residual[1400, :3].round(2)} N, moment {residual[1400, 3:6].round(2)} N m")
draw("floating_humanoid", residual, {"force x": 0, "moment y": 4, "joint": 9}, push)
