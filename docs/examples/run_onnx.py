"""Run exported networks step by step: python run_onnx.py EXPORT RECORDING RESIDUAL.

EXPORT is a folder of ./reproduce export, RECORDING and RESIDUAL are files of ./reproduce observe without their endings.
Prints when alarms begin and end. To copy: it needs numpy, onnxruntime, pandas and pyarrow, and nothing of this project.
"""

import json
import os
import sys
from pathlib import Path

os.environ.setdefault("ORT_DISABLE_TELEMETRY", "1")  # before the import, else ONNX Runtime reports to its maker
import numpy as np
import onnxruntime as ort
import pandas as pd


def inputs_of(network, quaternion, columns):
    """Return the inputs of a network (T, n_in), SI units, from a recording."""
    if quaternion:  # two columns of the rotation from base to world axes
        w, x, y, z = (columns[quaternion[axis]] for axis in "wxyz")
        columns["R.11"], columns["R.12"] = 1 - 2 * (y * y + z * z), 2 * (x * y - w * z)
        columns["R.21"], columns["R.22"] = 2 * (x * y + w * z), 1 - 2 * (x * x + z * z)
        columns["R.31"], columns["R.32"] = 2 * (x * z - w * y), 2 * (y * z + w * x)
    return columns[[one["name"] for one in network["inputs"]]].to_numpy(np.float32)


def estimates_of(network, session, inputs, mob):
    """Yield the external torque and its standard deviation (n,) [N m], sample by sample; the first state is zero."""
    state = np.zeros(network["state"], np.float32)
    for x, r in zip(inputs, mob[[f"tau_ext.{one['joint']}" for one in network["outputs"]]].to_numpy(), strict=True):
        mean, std, state = session.run(["mean", "std", "state_out"], {"x": x, "state": state})
        yield (r - mean if network["estimates"] == "uncertainty" else mean), std


def alarms_of(detector, rate_hz, estimates):
    """Yield the first sample of each alarm with its joint, and the first one after it with None."""
    pole, hold = np.exp(-2 * np.pi * detector["low_pass_hz"] / rate_hz), max(1, round(detector["hold_s"] * rate_hz))
    low, above, alarm, limits = 0, 0, False, np.array(detector["thresholds"])
    for k, (tau, std) in enumerate(estimates):
        low = pole * low + (1 - pole) * {"mean": tau, "std": std, "ratio": tau / std}[detector["signal"]]
        above = np.where((np.abs(low) > limits) & (k >= round(detector["settle_s"] * rate_hz)), above + 1, 0)
        if alarm != (alarm := above.max() >= hold):
            yield k, detector["joints"][above.argmax()] if alarm else None


export, stem, other = map(Path, sys.argv[1:])
contract = json.loads((export / "contract.json").read_text())
columns, mob = (pd.read_parquet(f"{one}.parquet").astype(float) for one in (stem, other))
options = ort.SessionOptions()
options.intra_op_num_threads = 1
watched = [one for one in contract["detectors"] if (one["method"], one["watched"]) == ("MOB-Net", "always")]
for detector in watched:  # others need no network, or the gate of a swinging leg, which is in the C library
    network, rate_hz = next(one for one in contract["networks"] if one["limb"] == detector["limb"]), contract["rate_hz"]
    session = ort.InferenceSession(export / Path(network["file"]).name, options, providers=["CPUExecutionProvider"])
    x = inputs_of(network, contract["quaternion"], columns)
    for start, end in json.loads(Path(f"{stem}.json").read_text())["segments"]:
        for k, joint in alarms_of(detector, rate_hz, estimates_of(network, session, x[start:end], mob[start:end])):
            print(f"{(start + k) / rate_hz:.3f} s: {detector['limb']}, {f'first {joint}' if joint else 'over'}")
