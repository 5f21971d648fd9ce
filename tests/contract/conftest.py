"""Untrained networks on disk, for every row of the configuration's methods."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import pytest
import torch
from safetensors.torch import save_file

from mobnet.core.joints import JointLayout
from mobnet.learning.features import limb_inputs
from mobnet.learning.model import build_network
from mobnet.learning.networks import NOTE, WEIGHTS

INPUT_STD, TARGET_STD = 2.0, 10.0


@pytest.fixture(scope="session")
def network_dirs(
    full_config: dict[str, Any], layout: JointLayout, tmp_path_factory: pytest.TempPathFactory
) -> Callable[..., Mapping[str, Path]]:
    """Return a function of (method, zero) that writes random or zero networks of its limbs."""

    def write(method: str, zero: bool = False) -> Mapping[str, Path]:
        limbs = full_config["methods"][method].get("limbs", [])
        folders = {limb: tmp_path_factory.mktemp(f"{method}-{limb}") for limb in limbs}
        for limb, folder in folders.items():
            _write_network(folder, limb, full_config, layout, zero)
        return folders

    return write


def _write_network(folder: Path, limb: str, config: dict[str, Any], layout: JointLayout, zero: bool) -> None:
    """Write an untrained network; a zero one predicts no uncertainty."""
    row, joints, std_min = config["networks"][limb], layout.limb(limb), config["learning"]["std_min"]
    names = limb_inputs(layout, row).names
    network = build_network(row, len(names), len(joints), std_min, seed=len(limb))
    tensors = {name: tensor * (not zero) for name, tensor in network.state_dict().items()}
    for name, count, std in (("input", len(names), INPUT_STD), ("target", len(joints), TARGET_STD)):
        tensors |= {f"{name}.mean": torch.zeros(count), f"{name}.std": torch.full((count,), std)}
    note = {"limb": limb, "joints": joints, "inputs": names, "std_min": std_min}
    save_file(tensors, folder / WEIGHTS, {NOTE: json.dumps(note)})
