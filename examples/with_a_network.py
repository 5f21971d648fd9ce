"""Observer and network together: the demo's humanoid walks, and something pushes its leg."""

from pathlib import Path

import numpy as np
from simulated import RATE_HZ

import mobnet

ROOT = Path(__file__).parents[1]
DEMO = ROOT / "docs" / "demo"
PUSHED = 1700  # the sample at which something pushes

robot = mobnet.Robot.read(ROOT / "configs" / "robots" / "tocabi.yaml")
recording = mobnet.read_recording(DEMO / "recording", robot)
estimator = mobnet.Estimator.from_folder(robot, DEMO / "networks" / "MOB-Net-pushed-LL")
estimate = estimator.estimate(recording.sensed)
residual = mobnet.Observer(robot, recording.rate_hz, torque="mean").residual(recording.sensed)

columns = [robot.joints.index(joint) for joint in estimator.joints]
in_air = recording.sensed.swing[:, 0] > 0.5
in_air[PUSHED:] = False  # before the push, nothing touches the leg that swings
for name, torque in (("observer alone", residual[:, columns]), ("observer and network", estimate.tau_ext)):
    print(f"{name}: error in the air {np.sqrt(np.mean(torque[in_air] ** 2)):.1f} N m")
joint = estimator.joints.index("LL3")

import matplotlib.pyplot as plt  # noqa: E402

time = np.arange(len(residual)) / RATE_HZ
plt.plot(time, residual[:, columns[joint]], label="observer alone")
plt.plot(time, estimate.tau_ext[:, joint], label="observer and network")
plt.xlabel("time [s]")
plt.ylabel("external torque of the hip's pitch [N m]")
plt.legend()
plt.savefig("with_a_network.png")
