"""In a control loop without ROS: one `step` a tick, and the loop stops the motion when something pushes."""

import time

import numpy as np
import pinocchio as pin
from simulated import RATE_HZ, draw, moved

import mobnet

THRESHOLD_NM = 2.0

model = pin.buildSampleModelManipulator()
push = np.array([0.0, 0.0, 6.0, 0.0, 0.0, 0.0])
ticks = list(zip(*moved(model, push), strict=True))  # your robot's driver stands here

observer = mobnet.MomentumObserver(model, RATE_HZ)
state = observer.init()
state, _ = observer.step(state, *ticks[0])  # compiles
state = observer.init()
residuals = []
began = time.perf_counter()
for k, (q, v, tau) in enumerate(ticks):
    state, torque = observer.step(state, q, v, tau)
    residuals.append(torque)
    joint = int(np.argmax(np.abs(torque)))
    if abs(torque[joint]) > THRESHOLD_NM:
        print(f"stop at {k / RATE_HZ:.3f} s: {observer.joints[joint]} is pushed with {torque[joint]:.1f} N m")
        break
print(f"{1e6 * (time.perf_counter() - began) / len(residuals):.0f} us a tick")
draw("control_loop", np.array(residuals), {"shoulder 3": 2}, push)
