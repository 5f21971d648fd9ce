"""Trained networks of every cell run on a robot as they were trained."""

import json

import numpy as np
import pytest
import torch
from made_notes import network_note
from safetensors.torch import save_file

from mobnet.core.files import WEIGHTS
from mobnet.formats.network import SIZES, NetworkCell
from mobnet.learning.deployed import lanes
from mobnet.learning.deployed.lanes import CHUNK
from mobnet.learning.deployed.loading import load_network
from mobnet.learning.deployed.module_network import ModuleNetwork
from mobnet.learning.deployed.networks import ConstantNetwork, GruNetwork
from mobnet.learning.deployed.tensors import STD_SCALE
from mobnet.learning.deployed.weights import NOTE
from mobnet.learning.model import build_network
from mobnet.learning.streams import split

INPUTS, JOINTS, STEPS, STD_MIN = 30, 6, 400, 1e-6
WINDOW = {"window_steps": 10, "kernel_steps": 3, "dilations": (2, 4), "dropout": 0.2, "head": 12}
CELLS = {
    kind: NetworkCell(cell=kind, **{name: ({"hidden": 150 if kind == "GRU" else 16} | WINDOW)[name] for name in names})
    for kind, names in SIZES.items()
}
KINDS = {"GRU": GruNetwork, "constant": ConstantNetwork}  # by NumPy; the others by torch
FACTORS = torch.linspace(0.5, 3.0, JOINTS)
SCALES = {
    "input.mean": torch.linspace(-1.0, 1.0, INPUTS),
    "input.std": torch.linspace(0.5, 1.5, INPUTS),
    "target.mean": torch.linspace(-3.0, 40.0, JOINTS),
    "target.std": torch.linspace(1.0, 20.0, JOINTS),
}


def model_of(cell):
    """Return a network with weights as large as trained ones."""
    model = build_network(cell, INPUTS, JOINTS, STD_MIN, seed=0)
    with torch.no_grad():
        for parameter in model.parameters():
            parameter *= 1.5
    return model


def deployed(folder, model, cell, **more):
    """Write a network with its z-scores, and read it back."""
    tensors = model.deployable() | SCALES | more
    network = {"data": "walk", **cell.model_dump(mode="json")}  # a training notes more than the cell
    note = network_note("LL", "abcdef", [f"x{i}" for i in range(INPUTS)], network, STD_MIN)
    save_file(tensors, folder / WEIGHTS, {NOTE: json.dumps(note)})
    return load_network(folder)


@pytest.fixture
def x():
    return np.random.default_rng(0).normal(size=(STEPS, INPUTS)).astype(np.float32)


@pytest.mark.parametrize("kind", CELLS)
def test_step_agrees_with_run(kind, x, tmp_path, monkeypatch):
    network = deployed(tmp_path, model_of(CELLS[kind]), CELLS[kind])
    assert isinstance(network, KINDS.get(kind, ModuleNetwork))
    whole, state = network.run_all([x])[0], network.init()
    monkeypatch.setattr(lanes, "CHUNK", 7)
    np.testing.assert_allclose(network.run_all([x])[0].mean, whole.mean, rtol=1e-5, atol=1e-5)
    for k in range(STEPS):
        state, result = network.step(state, x[k])
        np.testing.assert_allclose(result.mean, whole.mean[k], rtol=1e-5, atol=1e-5)
        np.testing.assert_allclose(result.std, whole.std[k], rtol=1e-5)


@pytest.mark.parametrize("kind", [*CELLS, "spectral"])
def test_run_agrees_with_the_module(kind, x, tmp_path):
    """The module as trained is the reference, z-scores by hand; a norm and a gain are in the deployed weights."""
    cell = NetworkCell(cell="GRU", hidden=24, spectral=True, input_gain=16.0) if kind == "spectral" else CELLS[kind]
    model = model_of(cell).eval()
    zscored = (torch.from_numpy(x) - SCALES["input.mean"]) / SCALES["input.std"]
    with torch.no_grad():
        mean, std, _ = model(zscored[:, None], model.fresh_state(1))
    result = deployed(tmp_path, model, cell).run_all([x])[0]
    expected = mean[:, 0] * SCALES["target.std"] + SCALES["target.mean"]
    np.testing.assert_allclose(result.mean, expected.numpy(), rtol=1e-5, atol=1e-5)
    np.testing.assert_allclose(result.std, (std[:, 0] * SCALES["target.std"]).numpy(), rtol=1e-5)


@pytest.mark.parametrize("kind", CELLS)
def test_factors_multiply_the_standard_deviation_alone(kind, x, tmp_path):
    model = model_of(CELLS[kind])
    plain = deployed(tmp_path, model, CELLS[kind]).run_all([x])[0]
    scaled = deployed(tmp_path, model, CELLS[kind], **{STD_SCALE: FACTORS}).run_all([x])[0]
    np.testing.assert_array_equal(scaled.mean, plain.mean)
    np.testing.assert_allclose(scaled.std, plain.std * FACTORS.numpy(), rtol=1e-6)


@pytest.mark.parametrize("kind", CELLS)
def test_a_standard_deviation_is_no_less_than_the_least_one(kind, x, tmp_path, monkeypatch):
    monkeypatch.setitem(globals(), "STD_MIN", 50.0)
    network = deployed(tmp_path, model_of(CELLS[kind]), CELLS[kind])
    least = 50.0 * SCALES["target.std"].numpy()
    _, result = network.step(network.init(), x[0])
    np.testing.assert_allclose(network.run_all([x])[0].std, np.tile(least, (STEPS, 1)), rtol=1e-6)
    np.testing.assert_allclose(result.std, least, rtol=1e-6)


def test_huge_inputs_give_finite_torques(x, tmp_path):
    result = deployed(tmp_path, model_of(CELLS["GRU"]), CELLS["GRU"]).run_all([1e6 * x])[0]
    assert np.isfinite(result.mean).all()
    assert (result.std > 0).all()


def test_a_recording_longer_than_a_chunk_has_no_seam(x, tmp_path):
    network = deployed(tmp_path, model_of(CELLS["TCN"]), CELLS["TCN"])
    long = np.tile(x, (CHUNK // STEPS + 2, 1))
    periods = network.run_all([long])[0].mean.reshape(-1, STEPS, JOINTS)
    for period in periods[2:]:
        np.testing.assert_allclose(period, periods[1], rtol=1e-5, atol=1e-5)


@pytest.mark.parametrize(("method", "limb", "kind"), [
    ("TCN", "LL", ModuleNetwork), ("GRU-spectral", "LL", GruNetwork), ("MOB-Net", "N", ConstantNetwork),
])  # fmt: skip
def test_a_trained_network_on_a_robot_errs_as_in_its_validation(method, limb, kind, small, tmp_path):
    """From recordings to a network on a robot, whose error on the recordings is that of the last validation."""
    training = small.training(method, limb, epochs=1)
    out = small.train(training, tmp_path)
    network, note, data = load_network(out), json.loads((out / "run.json").read_text()), small.data(training)
    assert type(network) is kind
    _, held_out = split(data.segments, training.learning.validation_share)
    errors = [(network.run_all([data.inputs[a:b]])[0].mean - data.targets[a:b]) for a, b in held_out]
    rmse = np.sqrt(np.square(np.concatenate(errors)).mean(axis=0)).mean()
    assert rmse == pytest.approx(note["best"]["validation_rmse"], rel=0.1)  # lanes and ends of streams differ
