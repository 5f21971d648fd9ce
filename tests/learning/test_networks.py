"""Trained networks as they run on a robot agree with torch."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
import torch
from safetensors.torch import save_file

from mobnet.core.errors import DataError
from mobnet.learning.model import LimbNetwork
from mobnet.learning.networks import NOTE, WEIGHTS, Network, load_network

INPUTS, HIDDEN, JOINTS, STEPS = 30, 150, 6, 400
STD_MIN = 1e-6


@pytest.fixture
def pair(tmp_path: Path) -> tuple[LimbNetwork, Network]:
    """A network in torch, and the same read back from its file, z-scores included."""
    torch.manual_seed(0)
    model = LimbNetwork(INPUTS, HIDDEN, JOINTS, STD_MIN)
    scales = {"input.mean": torch.randn(INPUTS), "input.std": torch.rand(INPUTS) + 0.5}
    scales |= {"target.mean": torch.randn(JOINTS), "target.std": 10 * torch.rand(JOINTS) + 1}
    note = {"limb": "LL", "joints": list("abcdef"), "inputs": [f"x{i}" for i in range(INPUTS)], "std_min": STD_MIN}
    save_file(model.state_dict() | scales, tmp_path / WEIGHTS, {NOTE: json.dumps(note)})
    return model, load_network(tmp_path)


@pytest.fixture
def x() -> np.ndarray:
    return np.random.default_rng(0).normal(size=(STEPS, INPUTS)).astype(np.float32)


def test_run_agrees_with_torch(pair: tuple[LimbNetwork, Network], x: np.ndarray) -> None:
    """Torch is the reference."""
    model, network = pair
    zscored = torch.from_numpy((x - network._input_mean) / network._input_std)
    with torch.no_grad():
        mean, std, _ = model(zscored[:, None], model.fresh_state(1))
    result = network.run(x)
    target_mean, target_std = network._target_mean, network._target_std
    np.testing.assert_allclose(result.mean, mean[:, 0].numpy() * target_std + target_mean, atol=1e-4)
    np.testing.assert_allclose(result.std, std[:, 0].numpy() * target_std, rtol=1e-4)


def test_step_agrees_with_run(pair: tuple[LimbNetwork, Network], x: np.ndarray) -> None:
    """Sample by sample and all at once are equivalent."""
    _, network = pair
    whole, state = network.run(x), network.init()
    for k in range(STEPS):
        state, result = network.step(state, x[k])
        np.testing.assert_allclose(result.mean, whole.mean[k], rtol=1e-5, atol=1e-5)
        np.testing.assert_allclose(result.std, whole.std[k], rtol=1e-5)


def test_step_leaves_the_given_state_alone(pair: tuple[LimbNetwork, Network], x: np.ndarray) -> None:
    state = pair[1].init()
    pair[1].step(state, x[0])
    assert not state.any()


def test_huge_inputs_give_finite_torques(pair: tuple[LimbNetwork, Network], x: np.ndarray) -> None:
    result = pair[1].run(1e6 * x)
    assert np.isfinite(result.mean).all()
    assert (result.std > 0).all()


@pytest.mark.parametrize("damage", [b"", b"no weights", None])
def test_damaged_weights_are_named(damage: bytes | None, tmp_path: Path) -> None:
    if damage is not None:
        (tmp_path / WEIGHTS).write_bytes(damage)
    with pytest.raises(DataError, match=WEIGHTS):
        load_network(tmp_path)
