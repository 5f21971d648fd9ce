"""Untrained networks and small fits on disk, for every row of the configuration's methods."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import torch
from safetensors.torch import save_file

from mobnet.core.estimator import Estimator
from mobnet.core.joints import JointLayout
from mobnet.core.methods import network_row, source_of
from mobnet.core.recording import Recording, Sensed
from mobnet.estimation.fitting import write_fit
from mobnet.estimation.methods import build_estimator
from mobnet.learning.features import limb_inputs
from mobnet.learning.model import build_network
from mobnet.learning.networks import NOTE, WEIGHTS

LEVEL, RATE_HZ, SECONDS, FIT_SECONDS = "all_uncertainty", 1000.0, 0.15, 0.3
INPUT_STD, TARGET_STD = 2.0, 10.0
Build = Callable[..., Estimator]


@pytest.fixture(scope="session")
def build(
    full_config: dict[str, Any],
    layout: JointLayout,
    made_up: Callable[..., Recording],
    write_pair: Callable[[Path, Recording], tuple[Path, Path]],
    tmp_path_factory: pytest.TempPathFactory,
) -> Build:
    """Return a function of (method, zero) that builds it with random or zero networks, or a fit to a few samples."""

    def made(method: str, zero: bool = False) -> Estimator:
        folder = tmp_path_factory.mktemp(method)
        source = source_of(full_config, method)
        row = full_config["methods"][source]
        networks = {limb: folder / limb for limb in row.get("limbs", [])}
        for limb, place in networks.items():
            _write_network(place, full_config, source, limb, layout, zero)
        fitted = folder / "fit.json" if "fitted" in row else None
        if fitted is not None:
            pair = write_pair(folder, made_up(1, FIT_SECONDS))
            write_fit(full_config, source, {limb: [pair] for limb in row["fitted"]}, fitted)
        return build_estimator(full_config, method, networks, LEVEL, RATE_HZ, fitted)

    return made


@pytest.fixture(scope="session")
def sensed(made_up: Callable[..., Recording]) -> Sensed:
    return made_up(5, SECONDS).sensed


def _write_network(
    folder: Path, config: dict[str, Any], method: str, limb: str, layout: JointLayout, zero: bool
) -> None:
    """Write an untrained network; a zero one predicts no uncertainty."""
    row, std_min = network_row(config, method, limb), config["learning"]["std_min"]
    joints = [joint for group in row["joints"] for joint in layout.limb(group)]
    names = limb_inputs(layout, row).names
    network = build_network(row, len(names), len(joints), std_min, seed=len(limb))
    tensors = {name: tensor * (not zero) for name, tensor in network.deployable().items()}
    for name, count, std in (("input", len(names), INPUT_STD), ("target", len(joints), TARGET_STD)):
        tensors |= {f"{name}.mean": torch.zeros(count), f"{name}.std": torch.full((count,), std)}
    note = {"limb": limb, "joints": joints, "inputs": names, "std_min": std_min, "network": row}
    folder.mkdir()
    save_file(tensors, folder / WEIGHTS, {NOTE: json.dumps(note)})
