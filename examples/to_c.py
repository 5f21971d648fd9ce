"""Observer and thresholds as a program in C, without a network: it finds the push where Python does."""

import subprocess
import tempfile
from pathlib import Path

import numpy as np
import pandas as pd
import pinocchio as pin
from simulated import RATE_HZ, draw, moved, wandered

import mobnet
from mobnet.detection.threshold_file import write_thresholds

RUNTIME = Path(__file__).parents[1] / "src" / "runtime"
model = pin.buildSampleModelManipulator()
model.effortLimit = np.full(model.nv, 100.0)  # N m; the program refuses a torque that no motor can give
arm = mobnet.Robot.from_model(model)
q, v, tau = wandered(model, seconds=210.0)
detector = mobnet.Detector.from_free_motion(arm, arm.sample(q, v, 0.95 * tau), RATE_HZ)  # torque constants are wrong

push = np.array([0.0, 0.0, 0.0, 8.0, 0.0, 0.0])
q, v, tau = moved(model, push)
samples = arm.sample(q, v, 0.95 * tau)
alarms = [detector.step(samples[k]) for k in range(len(q))]

with tempfile.TemporaryDirectory() as name:
    folder = Path(name)
    write_thresholds(folder / "arm.yaml", detector.thresholds)
    mobnet.export_networks([], arm, folder / "c", [folder / "arm.yaml"])
    mobnet.write_recording(folder / "log", arm, samples, RATE_HZ)
    pd.read_parquet(folder / "log.parquet").astype(float).to_csv(folder / "log.csv")
    subprocess.run(["make", "-s", "-C", RUNTIME, f"OUT={folder}"], check=True)
    program = [folder / "example", folder / "c" / "model.bin", folder / "log.csv"]
    head, *lines = subprocess.run(program, capture_output=True, text=True, check=True).stdout.splitlines()

print(f"samples with an alarm in C: {len(lines)}, in Python: {sum(alarm.is_on for alarm in alarms)}")
draw("to_c", np.array([alarm.estimate.tau_ext for alarm in alarms]), {"elbow": 3}, push)
