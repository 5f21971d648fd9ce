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
from mobnet.learning.deployed.module_network import CHUNK, ModuleNetwork
from mobnet.learning.deployed.networks import (
    NOTE,
    STD_SCALE,
    WEIGHTS,
    ConstantNetwork,
    Deployed,
    Network,
    load_network,
)
from mobnet.learning.model import LimbNetwork, build_network
from mobnet.learning.streams import split
from mobnet.settings.networks import SIZES, Cell, CellKind

INPUTS, JOINTS, STEPS, STD_MIN = 5, 2, 300, 1e-6
WINDOW: dict[str, Any] = {"window_steps": 10, "kernel_steps": 3, "dilations": (2, 4), "dropout": 0.2, "head": 12}
CELLS = {kind: Cell(cell=kind, hidden=16, **WINDOW) for kind in SIZES}
KINDS: dict[CellKind, type[Deployed]] = {"GRU": Network, "constant": ConstantNetwork}  # by NumPy; the others by torch
SCALES = {
    "input.mean": torch.linspace(-1.0, 1.0, INPUTS),
    "input.std": torch.linspace(0.5, 1.5, INPUTS),
    "target.mean": torch.tensor([-3.0, 40.0]),
    "target.std": torch.tensor([1.0, 20.0]),
    STD_SCALE: torch.tensor([0.5, 2.0]),
}


def _model(kind: CellKind) -> LimbNetwork:
    """Return a network with weights as large as trained ones."""
    model = build_network(CELLS[kind], INPUTS, JOINTS, STD_MIN, seed=0)
    with torch.no_grad():
        for parameter in model.parameters():
            parameter *= 1.5
    return model


def _save(folder: Path, model: LimbNetwork, cell: Cell) -> Deployed:
    network = {"data": "walk", **cell.model_dump(mode="json")}  # a training notes more than the cell
    note = {"limb": "LL", "joints": ["a", "b"], "inputs": list("vwxyz"), "std_min": STD_MIN, "network": network}
    save_file(model.deployable() | SCALES, folder / WEIGHTS, {NOTE: json.dumps(note)})
    return load_network(folder)


@pytest.fixture
def x() -> np.ndarray:
    return np.random.default_rng(0).normal(size=(STEPS, INPUTS)).astype(np.float32)


@pytest.mark.parametrize("kind", CELLS)
def test_step_agrees_with_run(kind: CellKind, x: np.ndarray, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Sample by sample, in chunks and all at once are equivalent."""
    network = _save(tmp_path, _model(kind), CELLS[kind])
    assert isinstance(network, KINDS.get(kind, ModuleNetwork))
    whole, state = network.run(x), network.init()
    monkeypatch.setattr("mobnet.learning.deployed.module_network.CHUNK", 7)
    in_chunks = network.run(x)
    np.testing.assert_allclose(in_chunks.mean, whole.mean, rtol=1e-5, atol=1e-5)
    for k in range(STEPS):
        state, result = network.step(state, x[k])
        np.testing.assert_allclose(result.mean, whole.mean[k], rtol=1e-5, atol=1e-5)
        np.testing.assert_allclose(result.std, whole.std[k], rtol=1e-5)


@pytest.mark.parametrize("kind", CELLS)
def test_run_agrees_with_the_module(kind: CellKind, x: np.ndarray, tmp_path: Path) -> None:
    """The module as trained is the reference, z-scores by hand."""
    model = _model(kind)
    zscored = (torch.from_numpy(x) - SCALES["input.mean"]) / SCALES["input.std"]
    with torch.no_grad():
        mean, std, _ = model.eval()(zscored[:, None], model.fresh_state(1))
    result = _save(tmp_path, model, CELLS[kind]).run(x)
    expected = mean[:, 0] * SCALES["target.std"] + SCALES["target.mean"]
    np.testing.assert_allclose(result.mean, expected.numpy(), rtol=1e-5, atol=1e-5)
    np.testing.assert_allclose(result.std, (std[:, 0] * SCALES["target.std"] * SCALES[STD_SCALE]).numpy(), rtol=1e-5)


@pytest.mark.parametrize("kind", CELLS)
def test_step_leaves_the_given_state_alone(kind: CellKind, x: np.ndarray, tmp_path: Path) -> None:
    network = _save(tmp_path, _model(kind), CELLS[kind])
    state = network.init()
    network.step(state, x[0])
    assert state is None if kind == "constant" else not np.asarray(state).any()


def test_a_recording_longer_than_a_chunk_has_no_seam(x: np.ndarray, tmp_path: Path) -> None:
    network = _save(tmp_path, _model("TCN"), CELLS["TCN"])
    long = np.tile(x, (CHUNK // STEPS + 2, 1))
    periods = network.run(long).mean.reshape(-1, STEPS, JOINTS)
    for period in periods[2:]:
        np.testing.assert_allclose(period, periods[1], rtol=1e-5, atol=1e-5)


def test_weights_of_another_size_are_refused(tmp_path: Path) -> None:
    with pytest.raises(DataError, match=f"{WEIGHTS}: not the weights of a limb network .*size mismatch"):
        _save(tmp_path, _model("LSTM"), CELLS["LSTM"].model_copy(update={"hidden": 8}))


def test_a_cell_without_its_sizes_is_refused(tmp_path: Path) -> None:
    with pytest.raises(DataError, match=f"{WEIGHTS}: not the weights of a limb network .*hidden is missing"):
        _save(tmp_path, _model("LSTM"), CELLS["LSTM"].model_copy(update={"hidden": None}))


@pytest.mark.parametrize(
    ("method", "limb", "kind"),
    [("TCN", "LL", ModuleNetwork), ("GRU-spectral", "LL", Network), ("MOB-Net", "N", ConstantNetwork)],
)
def test_a_trained_network_on_a_robot_errs_as_in_its_validation(
    method: str, limb: str, kind: type, small: Any, tmp_path: Path
) -> None:
    """From recordings to a network on a robot, whose error on the recordings is that of the last validation."""
    training = small.training(method, limb, epochs=1)
    out = small.train(training, tmp_path)
    network, note, data = load_network(out), json.loads((out / "run.json").read_text()), small.data(training)
    assert type(network) is kind
    _, held_out = split(data.segments, training.learning.validation_share)
    errors = [(network.run(data.inputs[a:b]).mean - data.targets[a:b]) for a, b in held_out]
    rmse = np.sqrt(np.square(np.concatenate(errors)).mean(axis=0)).mean()
    assert rmse == pytest.approx(note["best"]["validation_rmse"], rel=0.1)  # lanes and ends of streams differ
