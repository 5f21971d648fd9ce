"""`./reproduce export`: what it writes and prints, and what it refuses."""

import hashlib
import json
import re
from pathlib import Path

import pytest
from safetensors import safe_open
from safetensors.numpy import save_file

from mobnet.core.errors import DataError
from mobnet.detection.threshold_file import write_thresholds
from mobnet.export.export import agreed, export, main
from mobnet.export.trained import read_trained
from mobnet.formats.limb_thresholds import LimbThresholds
from mobnet.formats.network import NetworkCell
from mobnet.learning.deployed.weights import NOTE


@pytest.fixture
def called(caplog):
    """Return a function of words that runs the command, and returns its status and what it printed."""

    def call(*words):
        caplog.clear()
        caplog.set_level("INFO")
        status = main([*map(str, words)])
        return status, [record.message for record in caplog.records if record.name == "mobnet.export.export"]

    return call


def test_the_command_writes_a_file_for_each_limb_and_says_how_close_it_is(called, save, tmp_path, thresholds):
    folders = save(tmp_path / "a", "LL"), save(tmp_path / "b", "RA", NetworkCell(cell="LSTM", hidden=5))
    write_thresholds(tmp_path / "LL.yaml", thresholds("LL"))
    status, lines = called(*folders, "--thresholds", tmp_path / "LL.yaml", "--out", tmp_path / "out")
    assert status == 0, lines
    assert {path.name for path in (tmp_path / "out").iterdir()} >= {"LL.onnx", "RA.onnx", "contract.json"}
    assert lines[0] == "TOCABI at 1000 Hz, gain 100 1/s, torques: mean"
    assert "LL.onnx: GRU, 30 inputs, 6 joints, state 16; differs" in lines[1]
    assert "RA.onnx: LSTM" in lines[2]
    assert all(0 < float(line.split(" differs by ")[1].split()[0]) < 1e-5 for line in lines[1:3])
    assert lines[3] == "detector of LL: mean of LL1, LL2, LL3, LL4, LL5, LL6, always"


def test_equal_networks_give_equal_bytes(robot, run, gate, save, tmp_path):
    networks = [read_trained(save(tmp_path / "a"), robot.layout)]
    for out in ("one", "two"):
        export(networks, robot, run, [], gate, tmp_path / out)
    for name in ("LL.onnx", "contract.json"):
        assert (tmp_path / "one" / name).read_bytes() == (tmp_path / "two" / name).read_bytes()


def test_numbers_are_those_of_the_training_then_those_given_then_those_of_configs(called, save, tmp_path):
    folder, out = save(tmp_path / "a", rate_hz=500.0, torque="sample"), ("--out", tmp_path / "out")
    status, lines = called(folder, "--gain", 50, *out)
    assert (status, lines[0]) == (0, "TOCABI at 500 Hz, gain 50 1/s, torques: sample")
    _, lines = called(folder, "--rate", 500, *out)
    assert lines[0] == "TOCABI at 500 Hz, gain 100 1/s, torques: sample"
    refused = "--rate: 250.0 is not accepted; accepted: 500.0, that of the files"
    assert called(folder, "--rate", 250, *out) == (1, [refused])


def test_the_observer_alone_is_exported_with_its_thresholds(called, save, tmp_path, thresholds):
    found = thresholds("LL", method="MOB", network=None, rate_hz=500.0, gain_hz=50.0, torque="sample")
    write_thresholds(tmp_path / "LL.yaml", found)
    out = tmp_path / "out"
    status, lines = called("--thresholds", tmp_path / "LL.yaml", "--out", out)
    assert (status, lines[0]) == (0, "TOCABI at 500 Hz, gain 50 1/s, torques: sample")
    assert lines[1:] == [
        "detector of LL: mean of LL1, LL2, LL3, LL4, LL5, LL6, always",
        f"{out / 'contract.json'}",
        f"{out / 'model.bin'}: for the C library in src/runtime",
    ]
    refused = "--rate: 250.0 is not accepted; accepted: 500.0, that of the files"
    assert called("--thresholds", tmp_path / "LL.yaml", "--rate", 250, "--out", out) == (1, [refused])
    assert called("--rate", 250, "--out", out)[1][0] == "TOCABI at 250 Hz, gain 100 1/s, torques: mean"


def test_trainings_that_differ_are_refused():
    assert agreed("rate", None, [None, 500.0, 500.0], 1000.0) == 500.0
    with pytest.raises(DataError, match="rate of the networks"):
        agreed("rate", None, [500.0, 1000.0], 1000.0)


def test_what_does_not_fit_is_refused_in_one_line(called, save, tmp_path, thresholds):
    left, again = save(tmp_path / "a"), save(tmp_path / "b", seed=1)
    out = "--out", tmp_path / "out"
    assert called(left, again, *out) == (
        1, [f"{again}: joint 'LL1' is estimated by {left} too; accepted: one network for each joint"],
    )  # fmt: skip
    for changes, text in (
        ({"robot": "other"}, "thresholds of LL: robot: 'other' is not accepted; accepted: TOCABI"),
        ({"rate_hz": 100.0}, "thresholds of LL: rate_hz: 100.0 is not accepted; accepted: 1000.0"),
        ({"network": "RL7"}, "thresholds of LL: network: 'RL7' is not accepted; accepted: LL0"),
        ({"torque": "sample"}, "thresholds of LL: torque: 'sample' is not accepted; accepted: mean"),
    ):
        write_thresholds(tmp_path / "t.yaml", thresholds("LL", **changes))
        assert called(left, "--thresholds", tmp_path / "t.yaml", *out) == (1, [text])
    assert not (tmp_path / "out").exists()
    assert called(left, "--rate", 0, *out) == (1, ["--rate: 0.0 is not accepted; accepted: a number from 1 to 100000"])
    (left / "run.json").unlink()
    assert called(left, *out) == (1, [f"{left}: run.json is missing; accepted: a folder of a trained network"])


def test_a_network_of_another_robot_is_refused(called, save, tmp_path):
    arm = Path(__file__).parents[2] / "data" / "arm.yaml"
    status, (line,) = called(save(tmp_path / "a"), "--robot", arm, "--out", tmp_path / "out")
    assert status == 1
    assert re.search(r"a: input: 'q.LL1' is not accepted; accepted: q.J1", line)


@pytest.fixture
def renamed(save, tmp_path):
    """Return a function of limbs that writes a network whose weights, and whose note of the training, say these."""

    def write(limb, told):
        folder = save(tmp_path / "net")
        with safe_open(folder / "weights.safetensors", framework="numpy") as file:
            note = {**json.loads(file.metadata()[NOTE]), "limb": limb}
            tensors = {name: file.get_tensor(name) for name in file.keys()}  # noqa: SIM118, not a dict
        save_file(tensors, folder / "weights.safetensors", {NOTE: json.dumps(note)})
        run = json.loads((folder / "run.json").read_text())
        (folder / "run.json").write_text(json.dumps({**run, "limb": told}))
        return folder

    return write


FORM = r"is not accepted; accepted: text of the form \^\[A-Za-z\]\[A-Za-z0-9\]\*\$"


@pytest.mark.parametrize(("limb", "told", "text"), [
    ("/evil", "LL", rf"weights.safetensors: limb: '/evil' {FORM}"),
    ("../../evil", "LL", rf"weights.safetensors: limb: '../../evil' {FORM}"),
    ("{here}/precious", "LL", "weights.safetensors: limb: .*/precious. is not accepted; accepted: at most 20 char"),
    ("LL", "../LL", rf"run.json: limb: '../LL' {FORM}"),
    ("LL", "ZZ", "run.json: limb: 'ZZ' is not accepted; accepted: LL, as weights.safetensors says"),
    ("evil", "evil", "run.json: limb: 'evil' is not accepted; accepted: LL"),
    ("A" * 21, "LL", "weights.safetensors: limb: 'A+' is not accepted; accepted: at most 20 characters"),
])  # fmt: skip
def test_a_limb_of_a_stranger_s_network_writes_nothing_elsewhere(called, renamed, tmp_path, limb, told, text):
    folder, out = renamed(limb.format(here=tmp_path), told), tmp_path / "some" / "out"
    (tmp_path / "precious.onnx").write_bytes(b"precious")
    before = {path: path.stat().st_mtime_ns for path in tmp_path.rglob("*")}
    status, (line,) = called(folder, "--out", out)
    assert status == 1
    assert re.search(rf"net/{text}", line), line
    assert {path: path.stat().st_mtime_ns for path in tmp_path.rglob("*")} == before


def test_a_network_over_several_limbs_is_exported_under_its_own_name(called, save, tmp_path):
    assert called(save(tmp_path / "net", "WB"), "--out", tmp_path / "out")[0] == 0
    assert (tmp_path / "out" / "WB.onnx").exists()


def test_what_an_earlier_export_wrote_and_this_one_lacks_is_removed(called, save, tmp_path):
    left, right, out = save(tmp_path / "a"), save(tmp_path / "b", "RL"), tmp_path / "out"
    assert called(left, right, "--out", out)[0] == 0
    (out / "own.onnx").write_bytes(b"of somebody else")
    assert called(right, "--out", out)[0] == 0
    assert {path.name for path in out.iterdir()} == {"RL.onnx", "own.onnx", "contract.json", "model.bin"}
    status, lines = called(save(tmp_path / "c", "RL", NetworkCell(cell="LSTM", hidden=5)), "--out", out)
    assert (status, lines[-1]) == (
        0, f"{out}/model.bin: not written, as the C library has no other cells than GRU and constant",
    )  # fmt: skip
    assert {path.name for path in out.iterdir()} == {"RL.onnx", "own.onnx", "contract.json"}


def test_a_folder_whose_contract_cannot_be_read_is_left_as_it_is(called, save, tmp_path):
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "contract.json").write_text("{}")
    status, (line,) = called(save(tmp_path / "a"), "--out", tmp_path / "out")
    assert (status, line.partition(": ")[0]) == (1, str(tmp_path / "out" / "contract.json"))
    assert [path.name for path in (tmp_path / "out").iterdir()] == ["contract.json"]


def test_the_contract_names_the_weights(robot, run, gate, save, tmp_path):
    folder = save(tmp_path / "a")
    export([read_trained(folder, robot.layout)], robot, run, [], gate, tmp_path / "out")
    (network,) = json.loads((tmp_path / "out" / "contract.json").read_text())["networks"]
    assert network["weights_sha256"] == hashlib.sha256((folder / "weights.safetensors").read_bytes()).hexdigest()


@pytest.mark.parametrize(("changes", "text"), [
    ({"thresholds": (1e300,) * 6}, "thresholds.0: 1e+300 is not accepted; accepted: a number from 1e-09 to 1000000.0"),
    ({"thresholds": (1e-300,) * 6}, "thresholds.0: 1e-300 is not accepted"),
    ({"low_pass_hz": 1e-9}, "low_pass_hz: 1e-09 is not accepted; accepted: a number from 0.01 to 100000.0"),
    ({"low_pass_hz": 1e9}, "low_pass_hz: 1000000000.0 is not accepted"),
    ({"rate_hz": 1e308}, "rate_hz: 1e+308 is not accepted"),
    ({"gain_hz": 1e-300}, "gain_hz: 1e-300 is not accepted"),
    ({"method": "MOB", "signal": "ratio"}, "thresholds of LL: signal: 'ratio' is not accepted; accepted: mean of MOB"),
])  # fmt: skip
def test_thresholds_that_the_c_library_would_refuse_are_refused(called, save, tmp_path, thresholds, changes, text):
    sound = thresholds("LL").model_dump(exclude_none=True)
    write_thresholds(tmp_path / "t.yaml", LimbThresholds.model_construct(**sound | changes))
    status, lines = called(save(tmp_path / "a"), "--thresholds", tmp_path / "t.yaml", "--out", tmp_path / "out")
    assert status == 1
    assert text in "\n".join(lines)
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(("key", "value"), [("rate_hz", 1e308), ("gain_hz", 1e-300)])
def test_a_training_at_an_impossible_rate_is_refused(called, save, tmp_path, key, value):
    status, (line,) = called(save(tmp_path / "a", **{key: value}), "--out", tmp_path / "out")
    assert status == 1
    assert f"run.json: {key}: {value} is not accepted; accepted: " in line


def test_a_deviation_that_vanishes_in_the_c_library_is_refused_before_anything_is_written(called, save, tmp_path):
    folder = save(tmp_path / "a")
    with safe_open(folder / "weights.safetensors", framework="numpy") as file:
        note = file.metadata()
        tensors = {name: file.get_tensor(name) for name in file.keys()}  # noqa: SIM118, not a dict
    tensors["target.std"][0] = 1e-40
    save_file(tensors, folder / "weights.safetensors", note)
    status, (line, *_) = called(folder, "--out", tmp_path / "out")
    assert status == 1
    assert line.startswith("network of LL: target.std: ")
    assert not (tmp_path / "out").exists()


def test_a_folder_with_a_contract_is_of_one_export(robot, run, gate, save, tmp_path, monkeypatch):
    """An export that is stopped after any of its files leaves no older contract beside newer files."""
    networks, out = [read_trained(save(tmp_path / "a"), robot.layout)], tmp_path / "out"
    export(networks, robot, run, [], gate, out)
    assert (out / "contract.json").exists()

    def stopped(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr("mobnet.export.export.write_json", stopped)
    with pytest.raises(KeyboardInterrupt):
        export(networks, robot, run, [], gate, out)
    assert {path.name for path in out.iterdir()} == {"LL.onnx", "model.bin"}
