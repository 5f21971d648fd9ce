"""The graph of a network of any cell gives what the project's own network gives, sample by sample."""

import numpy as np
import onnx
import onnxruntime as ort
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from made_weights import weights

from mobnet.export.graph import graph_of, state_size
from mobnet.formats.network import NetworkCell
from mobnet.learning.deployed.loading import deployed

STEPS, BOUND = 120, 1e-5  # the bound is a share of the target's standard deviation
ROUNDING = 2e-7  # of a sum in float32, to which the target's mean is added
SIZES = st.integers(1, 9)
CELLS = st.one_of(
    st.builds(NetworkCell, cell=st.sampled_from(["GRU", "LSTM", "RNN"]), hidden=SIZES),
    st.builds(NetworkCell, cell=st.just("MLP"), hidden=SIZES, window_steps=SIZES),
    st.builds(
        NetworkCell, cell=st.just("TCN"), hidden=SIZES, window_steps=st.integers(6, 9), kernel_steps=st.integers(2, 3),
        dilations=st.sampled_from([(1,), (2,), (1, 2)]), dropout=st.just(0.1), head=SIZES,
    ),
    st.builds(NetworkCell, cell=st.just("constant")),
)  # fmt: skip


def stepper(model):
    """Return a function of state and inputs that runs a model once."""
    options = ort.SessionOptions()
    options.intra_op_num_threads = 1
    session = ort.InferenceSession(model.SerializeToString(), options, providers=["CPUExecutionProvider"])
    return lambda state, x: session.run(["mean", "std", "state_out"], {"x": x, "state": state})


@settings(max_examples=40, deadline=None, derandomize=True)
@given(cell=CELLS, inputs=SIZES, joints=st.integers(1, 6), seed=st.integers(0, 99))
def test_every_cell_is_the_projects_own_network(cell, inputs, joints, seed):
    tensors, note = weights(cell, inputs, joints, seed)
    own, step = deployed(tensors, note), stepper(graph_of(tensors, note))
    carried, state = own.init(), np.zeros(state_size(cell, inputs), np.float32)
    draw, unit = np.random.default_rng(seed), tensors["target.std"]
    lane = draw.normal(tensors["input.mean"], 2 * tensors["input.std"], (STEPS, inputs)).astype(np.float32)
    for x in lane:
        carried, wanted = own.step(carried, x)
        mean, std, state = step(state, x)
        assert (np.abs(mean - wanted.mean) <= BOUND * unit + ROUNDING * np.abs(wanted.mean)).all()
        assert (np.abs(std - wanted.std) <= BOUND * unit * tensors["std.scale"]).all()


def test_large_outputs_neither_overflow_nor_fall_below_the_smallest_deviation():
    cell = NetworkCell(cell="RNN", hidden=3)
    tensors, note = weights(cell, 2, 2, 0)
    tensors["head.bias"] = np.array([0, 0, 300, -300], np.float32)
    _, std, _ = stepper(graph_of(tensors, note))(np.zeros(3, np.float32), np.zeros(2, np.float32))
    unit = tensors["target.std"] * tensors["std.scale"]
    np.testing.assert_allclose(std, unit * [300, 0.01], rtol=0.02)


@pytest.mark.parametrize("kind", ["GRU", "LSTM"])
def test_equal_weights_give_equal_bytes_and_a_graph_that_onnx_accepts(kind):
    tensors, note = weights(NetworkCell(cell=kind, hidden=4), 3, 2, 0)
    first, second = (graph_of(dict(tensors), note) for _ in range(2))
    assert first.SerializeToString(deterministic=True) == second.SerializeToString(deterministic=True)
    onnx.checker.check_model(first, full_check=True)
    shapes = {one.name: [d.dim_value for d in one.type.tensor_type.shape.dim] for one in first.graph.output}
    size = state_size(note.cell, 3)
    assert shapes == {"mean": [2], "std": [2], "state_out": [size]}
    assert {one.domain for one in first.opset_import} == {""}
