"""Weights that break the contract are refused where an estimator is built, and by a check, in the tensor's name."""

import json

import numpy as np
import pytest
import torch
from made_notes import network_note
from safetensors.numpy import load_file, save_file
from tests.paper.outside.conftest import AGAINST, refusal_of, refusals

from experiments.check import check
from mobnet.core.errors import DataError
from mobnet.core.files import WEIGHTS
from mobnet.formats.network import SIZES, NetworkCell
from mobnet.learning.cells import build_cell
from mobnet.learning.deployed.loading import load_limb_networks, load_network
from mobnet.learning.deployed.weights import NOTE, shapes
from mobnet.learning.features import limb_inputs
from mobnet.learning.model import build_network

CELLS = {
    "GRU": {"hidden": 5},
    "LSTM": {"hidden": 5},
    "RNN": {"hidden": 5},
    "MLP": {"hidden": 5, "window_steps": 3},
    "TCN": {"hidden": 5, "window_steps": 3, "kernel_steps": 2, "dilations": [1, 2], "dropout": 0.1, "head": 4},
    "constant": {},
}


def write(folder, tensors, note):
    folder.mkdir(exist_ok=True)
    save_file(tensors, folder / WEIGHTS, {NOTE: note if isinstance(note, str) else json.dumps(note)})
    return folder


@pytest.fixture
def made(settings, layout):
    """Return a function of a kind of cell that returns tensors and note of a network of the left leg."""

    def make(kind):
        cell, inputs = NetworkCell(cell=kind, **CELLS[kind]), limb_inputs(layout, settings.robot.networks["LL"]).names
        model = build_network(cell, len(inputs), 6, 1e-6, seed=0)
        tensors = {name: tensor.numpy() for name, tensor in model.deployable().items()}
        for name, width in (("input", len(inputs)), ("target", 6)):
            tensors |= {f"{name}.mean": np.zeros(width, np.float32), f"{name}.std": np.ones(width, np.float32)}
        tensors["std.scale"] = np.ones(6, np.float32)
        network = {"cell": kind, **CELLS[kind], "data": "walk", "horizon_steps": 150}
        return tensors, network_note("LL", layout.limb("LL"), inputs, network)

    return make


@pytest.mark.parametrize("kind", SIZES)
def test_shapes_are_those_of_the_module(kind):
    cell = NetworkCell(cell=kind, **CELLS[kind])
    found = {f"cell.{k}": tuple(v.shape) for k, v in torch.nn.Module.state_dict(build_cell(cell, 7)).items()}  # pyright: ignore
    assert {k: v for k, v in shapes(cell, 7, 2).items() if k.startswith("cell.")} == found


@pytest.mark.parametrize("kind", SIZES)
def test_a_sound_network_is_accepted(kind, made, layout, tmp_path):
    tensors, note = made(kind)
    write(tmp_path, tensors, note)
    assert load_limb_networks({"LL": tmp_path}, layout).joints == layout.limb("LL")
    assert check(tmp_path / WEIGHTS, AGAINST) == "network of LL, 30 inputs, 6 joints"
    write(tmp_path, {name: tensor for name, tensor in tensors.items() if name != "std.scale"}, note)
    assert load_network(tmp_path).joints == layout.limb("LL")


def tensor(name, change):
    return lambda tensors, note: tensors.update({name: np.ascontiguousarray(change(tensors[name]))})


def entry(name, value):
    """Return a change of the first number of a tensor."""

    def change(tensors, note):
        tensors[name] = tensors[name].copy()
        tensors[name].ravel()[0] = value

    return change


def noted(**values):
    return lambda tensors, note: note.update(values)


def cell(**values):
    return lambda tensors, note: note["network"].update(values)


ABOVE_0 = {"input.std": (0.0,), "target.std": (-1.0, np.nan), "std.scale": (0.0, np.inf)}
NOTES = refusals(
    {
        "limb": (3,),
        "joints": ([], "LL"),
        "inputs.0": (0,),
        "std_min": (0.0, np.nan, "small"),
        "network": ("GRU",),
        "network.cell": ("QRNN",),
        "network.hidden": (5.5, 0),
    },
    "limb network",
)
DAMAGES = {
    **{name: ((lambda t, n, change=change: change(n)), says) for name, (change, says) in NOTES.items()},
    **{
        f"{name} as {value}": (entry(name, value), rf"tensor '{name}', entry \[0\]: {value} is not .*numbers above 0")
        for name, values in ABOVE_0.items()
        for value in values
    },
    "a tensor is gone": (lambda t, n: t.pop("head.bias") is None, r"tensor 'head.bias' is missing; .* \[12\]"),
    "z-scores are gone": (lambda t, n: t.pop("input.mean") is None, "tensor 'input.mean' is missing"),
    "a tensor more": (lambda t, n: t.update(extra=np.zeros(3, np.float32)), "tensor: 'extra' is not .*: cell"),
    "transposed": (tensor("head.weight", np.transpose), r"tensor 'head.weight': shape: \[5, 12\] is not .*: \[12, 5\]"),
    "too short": (tensor("input.std", lambda x: x[:-1]), r"tensor 'input.std': shape: \[29\] is not .*\[30\]"),
    "a number": (tensor("target.std", lambda x: x[0]), r"tensor 'target.std': shape: \[\] is not|shape: \[1\] is not"),
    "double": (tensor("head.bias", lambda x: x.astype(np.float64)), "tensor 'head.bias': type: 'float64' is not"),
    "NaN in a weight": (entry("cell.weight_hh_l0", np.nan), r"tensor 'cell.weight_hh_l0', entry \[0, 0\]: nan is not"),
    "infinite bias": (entry("head.bias", np.inf), r"tensor 'head.bias', entry \[0\]: inf is not .*finite numbers"),
    "limb of another": (noted(limb="RL"), "'RL' with joints|network of limb 'RL' with joints LL1"),
    "joints of another": (noted(joints=[f"RL{i}" for i in range(1, 7)]), "limb 'LL' with joints RL1.*accepted: 'LL'"),
    "a joint twice": (noted(joints=["LL1"] * 6), "joints: 'LL1' occurs 6 times; accepted: once"),
    "a joint less": (noted(joints=[f"LL{i}" for i in range(1, 6)]), r"'head.weight': shape: \[12, 5\] is not .*\[10"),
    "an input less": (lambda t, n: n["inputs"].pop() and None, r"'cell.weight_ih_l0': shape: \[15, 30\] .*\[15, 29\]"),
    "an input of another robot": (lambda t, n: n["inputs"].__setitem__(0, "q.XX1"), "input: 'q.XX1' is not accepted"),
    "an input twice": (lambda t, n: n["inputs"].__setitem__(1, n["inputs"][0]), "inputs: 'q.LL1' occurs 2 times"),
    "a key more": (noted(colour="red"), "colour: 'red' is not accepted; accepted: no such key, but name, limb"),
    "hidden of another": (cell(hidden=8), r"tensor 'cell.weight_ih_l0': shape: \[15, 30\] is not .*: \[24, 30\]"),
    "hidden null": (cell(hidden=None), "network: sizes none are not accepted; accepted: hidden of a cell GRU"),
    "cell of another kind": (cell(cell="LSTM"), r"'cell.weight_ih_l0': shape: \[15, 30\] is not .*: \[20, 30\]"),
}


@pytest.mark.parametrize("name", DAMAGES)
def test_weights_that_break_the_contract_are_refused(name, made, layout, tmp_path):
    change, says = DAMAGES[name]
    tensors, note = made("GRU")
    change(tensors, note)
    write(tmp_path, tensors, note)
    with pytest.raises(DataError, match=says):
        load_limb_networks({"LL": tmp_path}, layout)
    refusal_of(tmp_path / WEIGHTS)


@pytest.mark.parametrize("text", ["", "{", "[]", "5", '{"limb": 1e999}', "[" * 100_000])
def test_a_note_that_is_none_is_refused(text, made, tmp_path):
    write(tmp_path, made("GRU")[0], text)
    with pytest.raises(DataError, match=rf"{WEIGHTS}: note|{WEIGHTS}: note: "):
        load_network(tmp_path)
    refusal_of(tmp_path / WEIGHTS)


@pytest.mark.parametrize("damage", [
    lambda d: b"", lambda d: d[:40], lambda d: d[:-1], lambda d: b"\xff" * 99, lambda d: d * 2,
])  # fmt: skip
def test_a_damaged_file_is_refused(damage, made, tmp_path):
    path = write(tmp_path, *made("GRU")) / WEIGHTS
    path.write_bytes(damage(path.read_bytes()))
    with pytest.raises(DataError, match="not the weights of a limb network"):
        load_network(tmp_path)


def test_weights_without_a_note_or_file_are_refused(made, tmp_path):
    path = write(tmp_path, *made("GRU")) / WEIGHTS
    save_file(load_file(path), path)
    with pytest.raises(DataError, match=r"metadata: \[\] is not accepted; accepted: just 'note'"):
        load_network(tmp_path)
    path.unlink()
    path.mkdir()
    with pytest.raises(DataError, match=WEIGHTS):
        load_network(tmp_path)
