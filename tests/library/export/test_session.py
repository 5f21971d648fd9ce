"""Exported networks in ONNX Runtime: on the recording of docs/demo they are the project's own, and so are the flags."""

import json

import numpy as np
import onnx
import pytest
from demo_push import NETWORK

from mobnet.core.errors import DataError
from mobnet.core.estimator import Estimate
from mobnet.detection.detector import ALARM_RATIO, LegDetector
from mobnet.detection.signals import Watched
from mobnet.estimation.residual import ResidualEstimator
from mobnet.export.session import OnnxNetwork, load_exported
from mobnet.formats.plain import as_plain
from mobnet.kernel.detecting import WatchedSignals
from mobnet.learning.deployed.loading import load_network
from mobnet.learning.features import signal_names, signals

BOUND = 1e-5  # of the target's standard deviation


@pytest.fixture(scope="module")
def own():
    return load_network(NETWORK)


@pytest.fixture(scope="module")
def lane(push, own):
    """Inputs of the network in the recording, (T, n_in)."""
    where = {name: k for k, name in enumerate(signal_names(push.robot.layout))}
    return signals(push.recording.sensed)[:, [where[name] for name in own.input_names]]


def test_the_whole_recording_gives_the_same_mean_and_deviation(demo, own, lane):
    (wanted,), (found,) = own.run_all([lane]), OnnxNetwork(demo / "LL.onnx").run_all([lane])
    unit = own._target_std
    assert (np.abs(found.mean - wanted.mean) < BOUND * unit).all()
    assert (np.abs(found.std - wanted.std) < BOUND * unit).all()
    assert wanted.mean.std(axis=0).min() > 0.1  # N m: there is something to agree on


def test_flags_come_at_the_same_samples(demo, push):
    row, setup = push.row, push.setup
    detector = LegDetector(Watched(as_plain(row, WatchedSignals)), push.gate, push.chain)
    sensed, wanted = push.recording.sensed, push.estimate("MOB-Net-pushed")
    found = _stepped(push, load_exported(demo, push.robot.layout))
    gate = push.gate.run(sensed, push.estimate(setup.detection.gate.method).tau_ext)
    ratios = [detector.run(gate, sensed, estimate).ratio for estimate in (wanted, found)]
    level = ratios[0].max() / 2  # the push of the demo may raise no alarm
    assert (ratios[0] > level).sum() > 10
    np.testing.assert_array_equal(ratios[0] > level, ratios[1] > level)
    np.testing.assert_array_equal(ratios[0] > ALARM_RATIO, ratios[1] > ALARM_RATIO)


def _stepped(push, networks):
    """Return MOB-Net's estimate with some networks, step by step."""
    own = push.estimator("MOB-Net-pushed")
    estimator = ResidualEstimator(own._observer, push.robot.layout, networks)
    state, steps, sensed = estimator.init(), [], push.recording.sensed
    for k in range(len(sensed)):
        state, estimate = estimator.step(state, sensed[k])
        steps.append(estimate)
    return Estimate(np.array([one.tau_ext for one in steps]), np.array([one.std for one in steps]))


def test_a_state_can_be_kept_and_taken_up_again(demo, lane):
    network = OnnxNetwork(demo / "LL.onnx")
    state, first = network.step(network.init(), lane[0])
    kept = state.copy()
    _, second = network.step(state, lane[1])
    network.step(network.init(), lane[2])
    np.testing.assert_array_equal(state, kept)
    np.testing.assert_array_equal(network.step(state, lane[1])[1].mean, second.mean)
    assert (first.mean != second.mean).all()


@pytest.mark.parametrize("content", [b"", b"no graph"])
def test_what_is_no_exported_network_is_refused_in_one_line(content, tmp_path):
    (tmp_path / "LL.onnx").write_bytes(content)
    with pytest.raises(DataError, match=r"LL.onnx: not an exported network") as refused:
        OnnxNetwork(tmp_path / "LL.onnx")
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize(("metadata", "text"), [
    ({}, "LL.onnx: format: key is missing"),
    ({"author": "A. N. Other"}, "LL.onnx: metadata: not JSON"),
])  # fmt: skip
def test_a_graph_with_other_metadata_is_refused(metadata, text, demo, tmp_path):
    model = onnx.load(demo / "LL.onnx")
    del model.metadata_props[:]
    onnx.helper.set_model_props(model, metadata)
    onnx.save(model, tmp_path / "LL.onnx")
    with pytest.raises(DataError, match=text):
        OnnxNetwork(tmp_path / "LL.onnx")


@pytest.mark.parametrize("file", ["/etc/passwd", "../LL.onnx", "a/LL.onnx", "", ".LL.onnx"])
def test_a_contract_names_no_file_elsewhere(file, demo, tmp_path, layout):
    contract = json.loads((demo / "contract.json").read_text())
    contract["networks"][0]["file"] = file
    (tmp_path / "contract.json").write_text(json.dumps(contract))
    with pytest.raises(DataError, match=rf"networks.0.file: '{file}' is not accepted; accepted: text of the form"):
        load_exported(tmp_path, layout)


def test_a_folder_without_a_contract_is_refused(tmp_path, layout):
    with pytest.raises(DataError, match=r"contract.json: file is missing"):
        load_exported(tmp_path, layout)
