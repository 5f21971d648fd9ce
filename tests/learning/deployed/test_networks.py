"""Trained networks as they run on a robot agree with torch."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
import torch
from safetensors.torch import save_file

from mobnet.core.errors import DataError
from mobnet.learning.cells import Gru
from mobnet.learning.deployed.networks import NOTE, STD_SCALE, WEIGHTS, Deployed, load_network
from mobnet.learning.model import LimbNetwork, build_network
from mobnet.settings.networks import Cell

INPUTS, HIDDEN, JOINTS, STEPS = 30, 150, 6, 400
STD_MIN = 1e-6


SCALES = {
    "input.mean": torch.linspace(-1.0, 1.0, INPUTS),
    "input.std": torch.linspace(0.5, 1.5, INPUTS),
    "target.mean": torch.linspace(-2.0, 2.0, JOINTS),
    "target.std": torch.linspace(1.0, 11.0, JOINTS),
}
NOTES = {
    "limb": "LL",
    "joints": list("abcdef"),
    "inputs": [f"x{i}" for i in range(INPUTS)],
    "std_min": STD_MIN,
    "network": {"cell": "GRU", "hidden": HIDDEN},
}
Pair = tuple[LimbNetwork, Deployed]


def save(folder: Path, model: LimbNetwork, **more: torch.Tensor) -> Deployed:
    """Write a network with its z-scores and read it back."""
    save_file(model.deployable() | SCALES | more, folder / WEIGHTS, {NOTE: json.dumps(NOTES)})
    return load_network(folder)


@pytest.fixture
def pair(tmp_path: Path) -> Pair:
    """A network in torch, and the same read back from its file, z-scores included."""
    torch.manual_seed(0)
    model = LimbNetwork(Gru(INPUTS, HIDDEN), JOINTS, STD_MIN)
    return model, save(tmp_path, model)


@pytest.fixture
def x() -> np.ndarray:
    return np.random.default_rng(0).normal(size=(STEPS, INPUTS)).astype(np.float32)


def test_run_agrees_with_torch(pair: Pair, x: np.ndarray) -> None:
    """Torch is the reference."""
    model, network = pair
    zscored = (torch.from_numpy(x) - SCALES["input.mean"]) / SCALES["input.std"]
    with torch.no_grad():
        mean, std, _ = model(zscored[:, None], model.fresh_state(1))
    result = network.run(x)
    expected = mean[:, 0] * SCALES["target.std"] + SCALES["target.mean"]
    np.testing.assert_allclose(result.mean, expected.numpy(), atol=1e-4)
    np.testing.assert_allclose(result.std, (std[:, 0] * SCALES["target.std"]).numpy(), rtol=1e-4)


def test_a_normalised_network_runs_as_a_plain_one(tmp_path: Path, x: np.ndarray) -> None:
    """Torch with norm and gain is the reference."""
    cell = Cell(cell="GRU", hidden=24, spectral=True, input_gain=16.0)
    model = build_network(cell, INPUTS, JOINTS, STD_MIN, seed=0).eval()
    zscored = (torch.from_numpy(x) - SCALES["input.mean"]) / SCALES["input.std"]
    with torch.no_grad():
        mean, _, _ = model(zscored[:, None], model.fresh_state(1))
    expected = mean[:, 0] * SCALES["target.std"] + SCALES["target.mean"]
    np.testing.assert_allclose(save(tmp_path, model).run(x).mean, expected.numpy(), atol=1e-4)


def test_std_scale_multiplies_the_standard_deviation_alone(pair: Pair, x: np.ndarray, tmp_path: Path) -> None:
    factors = torch.linspace(0.5, 3.0, JOINTS)
    plain, scaled = pair[1].run(x), save(tmp_path, pair[0], **{STD_SCALE: factors}).run(x)
    np.testing.assert_array_equal(scaled.mean, plain.mean)
    np.testing.assert_allclose(scaled.std, plain.std * factors.numpy(), rtol=1e-6)


def test_step_agrees_with_run(pair: Pair, x: np.ndarray) -> None:
    """Sample by sample and all at once are equivalent."""
    _, network = pair
    whole, state = network.run(x), network.init()
    for k in range(STEPS):
        state, result = network.step(state, x[k])
        np.testing.assert_allclose(result.mean, whole.mean[k], rtol=1e-5, atol=1e-5)
        np.testing.assert_allclose(result.std, whole.std[k], rtol=1e-5)


def test_step_leaves_the_given_state_alone(pair: Pair, x: np.ndarray) -> None:
    state = pair[1].init()
    pair[1].step(state, x[0])
    assert not state.any()


def test_huge_inputs_give_finite_torques(pair: Pair, x: np.ndarray) -> None:
    result = pair[1].run(1e6 * x)
    assert np.isfinite(result.mean).all()
    assert (result.std > 0).all()


@pytest.mark.parametrize("damage", [b"", b"no weights", None])
def test_damaged_weights_are_named(damage: bytes | None, tmp_path: Path) -> None:
    if damage is not None:
        (tmp_path / WEIGHTS).write_bytes(damage)
    with pytest.raises(DataError, match=WEIGHTS):
        load_network(tmp_path)


def test_a_tensor_that_is_missing_is_named(pair: Pair, tmp_path: Path) -> None:
    tensors = pair[0].deployable() | SCALES
    del tensors["cell.bias_hh_l0"]
    save_file(tensors, tmp_path / WEIGHTS, {NOTE: json.dumps(NOTES)})
    with pytest.raises(DataError, match=rf"{WEIGHTS}: not the weights of a limb network \('cell.bias_hh_l0'\)"):
        load_network(tmp_path)
