"""A humanoid from a table of this project, a Unitree G1: the observer of the table and that of its model agree."""

from pathlib import Path

import numpy as np
from simulated import RATE_HZ, draw

import mobnet
from mobnet.robot.nominal import NominalModel

G1 = Path(__file__).parents[1] / "configs" / "robots" / "g1.yaml"

robot = mobnet.Robot.read(G1)
model = NominalModel(robot.description).model  # translation and ball in place of a free-flyer
rng = np.random.default_rng(0)
samples = 1000
v = 0.2 * np.cumsum(rng.normal(size=(samples, model.nv)), axis=0) / np.sqrt(samples)
v[:, :6] = 0.0
q = np.zeros((samples, model.nq))
q[:, 3] = 1.0  # w of the quaternion, which Pinocchio has last
q[:, 7:] = np.cumsum(v[:, 6:], axis=0) / RATE_HZ
tau = rng.normal(size=(samples, len(robot.motors)))

of_table = mobnet.Observer(robot, RATE_HZ).residual(robot.sample(q, v, tau))
q[:, 3:7] = [0.0, 0.0, 0.0, 1.0]
observer = mobnet.MomentumObserver(model, RATE_HZ, joints=robot.motors)
of_model = observer.run(q, v, tau)

print(observer)
print(f"largest difference of the two residuals: {np.abs(of_table - of_model).max():.1e} N m")
draw("g1_table", of_model, {robot.motors[0]: 6, robot.motors[3]: 9}, np.zeros(model.nv))
