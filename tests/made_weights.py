"""Random weights of a network of any cell, with z-scores, as a training writes them."""

import numpy as np

from mobnet.learning.deployed.weights import WeightsNote
from mobnet.learning.model import build_network


def weights(cell, inputs, joints, seed, size=1.5):
    """Return random weights as large as trained ones, and their note."""
    tensors = {
        name: size * tensor.numpy()
        for name, tensor in build_network(cell, inputs, joints, 0.01, 0).deployable().items()
    }
    draw = np.random.default_rng(seed)
    for kind, count in (("input", inputs), ("target", joints)):
        tensors[f"{kind}.mean"] = draw.normal(0, 3, count).astype(np.float32)
        tensors[f"{kind}.std"] = draw.uniform(0.05, 20, count).astype(np.float32)
    tensors["std.scale"] = draw.uniform(0.5, 3, joints).astype(np.float32)
    names = {"joints": [f"J{k}" for k in range(joints)], "inputs": [f"x{k}" for k in range(inputs)]}
    note = WeightsNote(name="n", limb="A", **names, std_min=0.01, network=cell.model_dump(mode="json"))
    return tensors, note
