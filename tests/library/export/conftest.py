"""Trained networks with random weights, on disk as a training leaves them, and those of docs/demo, exported."""

import json

import numpy as np
import pytest
import torch
from demo_push import NETWORK, DemoPush
from made_notes import network_note, training_note
from safetensors.torch import save_file

from mobnet.export.contract import ObserverContract
from mobnet.export.export import RunTime, export
from mobnet.export.trained import read_trained
from mobnet.formats.limb_thresholds import LimbThresholds
from mobnet.formats.network import NetworkCell
from mobnet.formats.plain import as_plain
from mobnet.kernel.detecting import GateNumbers
from mobnet.learning.deployed.weights import NOTE
from mobnet.learning.features import limb_inputs
from mobnet.learning.model import build_network

STD_MIN = 1e-6


@pytest.fixture(scope="session")
def run():
    return RunTime(1000.0, ObserverContract(gain_hz=100.0, torque="mean", gravity_m_s2=9.81))


@pytest.fixture(scope="session")
def gate(settings):
    return as_plain(settings.detection.gate, GateNumbers)


@pytest.fixture(scope="session")
def save(settings):
    """Return a function that writes a network of a limb with random weights into a folder, and returns the folder."""

    def write(folder, limb="LL", cell=None, seed=0, **changes):
        cell = cell or NetworkCell(cell="GRU", hidden=16)
        row = settings.robot.networks[limb]
        names, joints = limb_inputs(settings.layout, row).names, settings.layout.limbs(row.joints)
        draw, scores = np.random.default_rng(seed), {}
        for kind, count in (("input", len(names)), ("target", len(joints))):
            scores[f"{kind}.mean"] = draw.normal(0, 2, count)
            scores[f"{kind}.std"] = draw.uniform(0.1, 5, count)
        scores["std.scale"] = draw.uniform(0.5, 2, len(joints))
        tensors = build_network(cell, len(names), len(joints), STD_MIN, seed).deployable()
        tensors |= {name: torch.tensor(values, dtype=torch.float32) for name, values in scores.items()}
        note = network_note(limb, joints, names, {"data": "walk", **cell.model_dump(mode="json")}, STD_MIN)
        folder.mkdir(parents=True)
        save_file(tensors, folder / "weights.safetensors", {NOTE: json.dumps(note)})
        told = training_note(f"MOBNet-{limb}-s{seed}", [1.0], fingerprint=f"{limb}{seed}", **changes)
        (folder / "run.json").write_text(json.dumps(told))
        return folder

    return write


@pytest.fixture(scope="session")
def push(settings, recipe_of):
    return DemoPush(settings, recipe_of)


@pytest.fixture(scope="session")
def demo(robot, run, gate, tmp_path_factory):
    """The network of docs/demo, exported: the folder."""
    out = tmp_path_factory.mktemp("demo")
    export([read_trained(NETWORK, robot.layout)], robot, run, [], gate, out)
    return out


@pytest.fixture(scope="session")
def thresholds(layout):
    """Return a function of a limb that makes thresholds of it, with changes."""

    def make(limb, **changes):
        joints = layout.limb(limb)
        row = {
            "robot": "TOCABI", "limb": limb, "joints": joints, "method": "MOB-Net", "signal": "mean",
            "thresholds": [5.0] * len(joints), "watched": "always", "low_pass_hz": 15.0, "hold_s": 0.005,
            "rate_hz": 1000.0, "gain_hz": 100.0, "torque": "mean", "rate_per_h": 1.0, "expected_per_h": 1.0,
            "low_per_h": 0.5, "high_per_h": 2.0, "confidence": 0.95,
        }  # fmt: skip
        return LimbThresholds.model_validate(row | changes)

    return make
