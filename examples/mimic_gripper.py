"""A gripper whose second finger follows the first: a force on it counts at the joint that moves both."""

import numpy as np
import pinocchio as pin
from simulated import RATE_HZ, draw

import mobnet

model = pin.Model()
model.name = "wrist with gripper"
wrist = model.addJoint(0, pin.JointModelRX(), pin.SE3.Identity(), "wrist")
model.appendBodyToJoint(wrist, pin.Inertia(1.0, np.array([0.0, 0.0, 0.05]), 0.01 * np.eye(3)), pin.SE3.Identity())
for name, joint, side in (("left", pin.JointModelPY(), 1.0), ("right", pin.JointModelPY(), -1.0)):
    finger = model.addJoint(wrist, joint, pin.SE3(np.eye(3), np.array([0.0, 0.02 * side, 0.1])), name)
    model.appendBodyToJoint(finger, pin.Inertia(0.1, np.zeros(3), 1e-4 * np.eye(3)), pin.SE3.Identity())
model = pin.transformJointIntoMimic(model, 2, 3, -1.0, 0.0)  # right = -left

push = np.array([0.0, 5.0])  # [N m] at the wrist, [N] at the fingers
observer = mobnet.MomentumObserver(model, RATE_HZ)
q = np.zeros((1000, model.nq))
v = np.zeros((1000, model.nv))
weight = pin.computeGeneralizedGravity(model, model.createData(), q[0])
held = np.tile(weight, (1000, 1))
held[500:] -= push  # the motors hold the weight, and what pushes
residual = observer.run(q, v, held)

print(observer)
print(f"after half a second: {residual[-1].round(2)} of {observer.joints}, true {push}")
draw("mimic_gripper", residual, {"wrist": 0, "fingers": 1}, push)
