"""Networks of every cell run on a robot as they were trained."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import torch
from safetensors.torch import save_file

from mobnet.core.errors import DataError
from mobnet.core.joints import JointLayout
from mobnet.learning.dataset import load_limb_data
from mobnet.learning.model import LimbNetwork, build_network
from mobnet.learning.module_network import CHUNK, ModuleNetwork
from mobnet.learning.networks import NOTE, STD_SCALE, WEIGHTS, ConstantNetwork, Deployed, Network, load_network
from mobnet.learning.streams import split
from mobnet.learning.train import train

INPUTS, JOINTS, STEPS, STD_MIN = 5, 2, 300, 1e-6
WINDOW = {"window_steps": 10, "kernel_steps": 3, "dilations": [2, 4], "dropout": 0.2, "head": 12}
ROWS: dict[str, dict[str, Any]] = {
    cell: {"cell": cell, "hidden": 16, **WINDOW} for cell in ("GRU", "LSTM", "RNN", "TCN", "MLP", "constant")
}
SCALES = {
    "input.mean": torch.linspace(-1.0, 1.0, INPUTS),
    "input.std": torch.linspace(0.5, 1.5, INPUTS),
    "target.mean": torch.tensor([-3.0, 40.0]),
    "target.std": torch.tensor([1.0, 20.0]),
    STD_SCALE: torch.tensor([0.5, 2.0]),
}


def _model(row: dict[str, Any]) -> LimbNetwork:
    """Return a network with weights as large as trained ones."""
    model = build_network(row, INPUTS, JOINTS, STD_MIN, seed=0)
    with torch.no_grad():
        for parameter in model.parameters():
            parameter *= 1.5
    return model


def _save(folder: Path, model: LimbNetwork, row: dict[str, Any]) -> Deployed:
    note = {"limb": "LL", "joints": ["a", "b"], "inputs": list("vwxyz"), "std_min": STD_MIN, "network": row}
    save_file(model.deployable() | SCALES, folder / WEIGHTS, {NOTE: json.dumps(note)})
    return load_network(folder)


@pytest.fixture
def x() -> np.ndarray:
    return np.random.default_rng(0).normal(size=(STEPS, INPUTS)).astype(np.float32)


@pytest.mark.parametrize("cell", ROWS)
def test_step_agrees_with_run(cell: str, x: np.ndarray, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Sample by sample, in chunks and all at once are equivalent."""
    network = _save(tmp_path, _model(ROWS[cell]), ROWS[cell])
    assert isinstance(network, {"GRU": Network, "constant": ConstantNetwork}.get(cell, ModuleNetwork))
    whole, state = network.run(x), network.init()
    monkeypatch.setattr("mobnet.learning.module_network.CHUNK", 7)
    in_chunks = network.run(x)
    np.testing.assert_allclose(in_chunks.mean, whole.mean, rtol=1e-5, atol=1e-5)
    for k in range(STEPS):
        state, result = network.step(state, x[k])
        np.testing.assert_allclose(result.mean, whole.mean[k], rtol=1e-5, atol=1e-5)
        np.testing.assert_allclose(result.std, whole.std[k], rtol=1e-5)


@pytest.mark.parametrize("cell", ROWS)
def test_run_agrees_with_the_module(cell: str, x: np.ndarray, tmp_path: Path) -> None:
    """The module as trained is the reference, z-scores by hand."""
    model = _model(ROWS[cell])
    zscored = (torch.from_numpy(x) - SCALES["input.mean"]) / SCALES["input.std"]
    with torch.no_grad():
        mean, std, _ = model.eval()(zscored[:, None], model.fresh_state(1))
    result = _save(tmp_path, model, ROWS[cell]).run(x)
    expected = mean[:, 0] * SCALES["target.std"] + SCALES["target.mean"]
    np.testing.assert_allclose(result.mean, expected.numpy(), rtol=1e-5, atol=1e-5)
    np.testing.assert_allclose(result.std, (std[:, 0] * SCALES["target.std"] * SCALES[STD_SCALE]).numpy(), rtol=1e-5)


@pytest.mark.parametrize("cell", ROWS)
def test_step_leaves_the_given_state_alone(cell: str, x: np.ndarray, tmp_path: Path) -> None:
    network = _save(tmp_path, _model(ROWS[cell]), ROWS[cell])
    state = network.init()
    network.step(state, x[0])
    assert state is None if cell == "constant" else not np.asarray(state).any()


def test_a_recording_longer_than_a_chunk_has_no_seam(x: np.ndarray, tmp_path: Path) -> None:
    network = _save(tmp_path, _model(ROWS["TCN"]), ROWS["TCN"])
    long = np.tile(x, (CHUNK // STEPS + 2, 1))
    periods = network.run(long).mean.reshape(-1, STEPS, JOINTS)
    for period in periods[2:]:
        np.testing.assert_allclose(period, periods[1], rtol=1e-5, atol=1e-5)


def test_weights_of_another_size_are_refused(tmp_path: Path) -> None:
    with pytest.raises(DataError, match=f"{WEIGHTS}: not the weights of a limb network .*size mismatch"):
        _save(tmp_path, _model(ROWS["LSTM"]), {**ROWS["LSTM"], "hidden": 8})


@pytest.mark.parametrize(
    ("method", "limb", "kind"),
    [("TCN", "LL", ModuleNetwork), ("GRU-spectral", "LL", Network), ("MOB-Net", "N", ConstantNetwork)],
)
def test_what_a_training_leaves_predicts_what_it_was_validated_to(
    method: str, limb: str, kind: type, small: object, layout: JointLayout, tmp_path: Path
) -> None:
    """From recordings to a network on a robot, whose error on the recordings is that of the last validation."""
    small.config["sizes"]["experiments"] = {name: {"epochs": 1, "seeds": [0]} for name in ("kinds", "neck")}
    train(small.config, method, limb, 0, small.recordings, small.residuals, tmp_path / limb, tmp_path / "state")
    network, note = load_network(tmp_path / limb), json.loads((tmp_path / limb / "run.json").read_text())
    row = note["settings"]["network"]
    assert type(network) is kind
    data = load_limb_data(layout, row, "uncertainty", small.recordings, small.residuals)
    _, held_out = split(data.segments, small.config["learning"]["validation_share"])
    errors = [(network.run(data.inputs[a:b]).mean - data.targets[a:b]) for a, b in held_out]
    rmse = np.sqrt(np.square(np.concatenate(errors)).mean(axis=0)).mean()
    assert rmse == pytest.approx(note["best"]["validation_rmse"], rel=0.1)  # lanes and ends of streams differ
