"""The ONNX file and contract.json are enough: with NumPy alone they give the project's estimate of a recording."""

import json

import numpy as np
import onnx
import onnxruntime as ort
import pyarrow.parquet as pq
import pytest
from demo_push import DATA
from made_weights import weights

from mobnet.estimation.own import LearnedNote
from mobnet.export.export import export
from mobnet.export.session import load_exported
from mobnet.export.trained import Trained, read_trained
from mobnet.formats.network import NetworkCell
from mobnet.learning.deployed.loading import load_limb_networks
from mobnet.learning.features import signal_names, signals

STEPS = 500


@pytest.fixture(scope="module")
def contract(demo):
    return json.loads((demo / "contract.json").read_text())


def test_a_file_a_contract_and_numpy_give_the_estimate(contract, demo):
    """Formulas and names are those of the contract, columns those of the recording, and the estimate is the run's."""
    (network,) = contract["networks"]
    table = pq.read_table(DATA / "recording.parquet")
    columns = {name: table[name].to_numpy().astype(float) for name in table.column_names}
    wxyz = {axis: columns[name] for axis, name in contract["quaternion"].items()}
    columns |= {one["name"]: eval(one["formula"], {}, wxyz) for one in network["inputs"] if "formula" in one}
    session, state = ort.InferenceSession(demo / network["file"]), np.zeros(network["state"], np.float32)
    residual, stored = (pq.read_table(DATA / "estimates" / f"{method}.parquet") for method in ("MOB", "MOB-Net-pushed"))
    assert network["estimates"] == "uncertainty"
    found = []
    for x in np.stack([columns[one["name"]] for one in network["inputs"]], axis=1).astype(np.float32):
        mean, std, state = session.run(None, {"x": x, "state": state})
        found.append((mean, std))
    after, settled = np.array(found), slice(1400, None)  # by then the state forgot that it began later than the run
    for k, output in enumerate(network["outputs"]):
        mob = residual[f"tau_ext.{output['joint']}"].to_numpy()
        for values, signal in ((mob - after[:, 0, k], "tau_ext"), (after[:, 1, k], "std")):
            wanted = stored[f"{signal}.{output['joint']}"].to_numpy()
            assert np.abs(values - wanted)[settled].max() < 0.002  # N m


def test_inputs_are_those_of_the_project(contract, settings, made_up):
    sensed, layout = made_up(3, 0.2).sensed, settings.layout
    table = signals(sensed)
    columns = dict(zip(signal_names(layout), table.T, strict=True))
    wxyz = dict(zip("wxyz", sensed.q[:, 3:7].T, strict=True))
    formulas = [one for one in contract["networks"][0]["inputs"] if "formula" in one]
    assert [one["name"] for one in formulas] == ["R.11", "R.21", "R.31", "R.12", "R.22", "R.32"]
    for one in formulas:
        np.testing.assert_allclose(eval(one["formula"], {}, wxyz), columns[one["name"]], atol=1e-6)


def test_the_contract_says_all_that_a_program_needs(contract):
    assert contract["rate_hz"] == 1000.0
    assert contract["observer"] == {"gain_hz": 100.0, "torque": "mean", "gravity_m_s2": 9.81}
    assert (contract["robot"], contract["opset"], contract["format"]) == ("TOCABI", 17, 1)
    (network,) = contract["networks"]
    units = {(one["name"].split(".")[0], one["unit"], one["frame"]) for one in network["inputs"]}
    assert units == {
        ("q", "rad", "joint"), ("v", "rad/s", "joint"), ("v", "rad/s", "base"), ("tau_des", "N m", "joint"),
        ("R", "-", "world"), ("acc", "m/s^2", "base"),
    }  # fmt: skip
    assert [one["joint"] for one in network["outputs"]] == [f"LL{k}" for k in range(1, 7)]
    assert {one["unit"] for one in network["outputs"]} == {"N m"}


def test_a_fixed_base_has_no_orientation(arm, run, gate, tmp_path):
    names = ["q.J1", "q.J2", "v.J1", "v.J2"]
    tensors, note = weights(NetworkCell(cell="GRU", hidden=4), len(names), 2, 0)
    note = note.model_copy(update={"joints": ["J1", "J2"], "inputs": names})
    one = Trained(tmp_path, tensors, note, LearnedNote(limb="A", target="external", fingerprint="f"), "0")
    export([one], arm, run, [], gate, tmp_path)
    contract = json.loads((tmp_path / "contract.json").read_text())
    assert contract["quaternion"] == {}
    (network,) = contract["networks"]
    assert [(one["name"], one["unit"]) for one in network["inputs"]] == [
        ("q.J1", "rad"), ("q.J2", "rad"), ("v.J1", "rad/s"), ("v.J2", "rad/s"),
    ]  # fmt: skip
    assert network["estimates"] == "external"


def test_each_file_has_its_own_part_as_metadata(robot, run, gate, save, tmp_path, thresholds):
    folders = [save(tmp_path / limb, limb) for limb in ("LL", "RL")]
    networks = [read_trained(folder, robot.layout) for folder in folders]
    export(networks, robot, run, [thresholds("LL"), thresholds("RL")], gate, tmp_path / "out")
    whole = json.loads((tmp_path / "out" / "contract.json").read_text())
    for network in whole["networks"]:
        model = onnx.load(tmp_path / "out" / network["file"])
        told = {entry.key: json.loads(entry.value) for entry in model.metadata_props}
        own = [one for one in whole["detectors"] if one["limb"] == network["limb"]]
        assert told == {**whole, "networks": [network], "detectors": own}
        assert len(own) == 1
        stored = {one.name: onnx.numpy_helper.to_array(one) for one in model.graph.initializer}
        for key, side in (("input", "inputs"), ("target", "outputs")):
            for score in ("mean", "std"):
                numbers = np.float32([one[score] for one in network[side]])
                np.testing.assert_array_equal(numbers, stored[f"{key}_{score}"])


@pytest.mark.parametrize("limb", ["LL", "V"])
def test_networks_side_by_side_take_their_inputs_from_the_same_sample(limb, robot, run, gate, save, tmp_path, made_up):
    folder, sensed = save(tmp_path / "net", limb), made_up(1, STEPS / 1000).sensed
    export([read_trained(folder, robot.layout)], robot, run, [], gate, tmp_path / "out")
    found = load_exported(tmp_path / "out", robot.layout).run_all([sensed])[0]
    wanted = load_limb_networks({limb: folder}, robot.layout).run_all([sensed])[0]
    np.testing.assert_allclose(found.mean, wanted.mean, rtol=1e-5, atol=1e-4)
    np.testing.assert_allclose(found.std, wanted.std, rtol=1e-5)
