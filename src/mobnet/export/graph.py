"""A trained limb network as an ONNX graph of one time step: physical units in and out, its state a flat vector.

Inputs are `x` (n_in,) and `state` (s,), outputs `mean` and `std` (n,) [N, N m] and `state_out` (s,). The state is zero
before the first sample. z-scores, softplus, smallest standard deviation and the calibration's factor are in the graph.
"""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import onnx
from numpy.typing import NDArray
from onnx import TensorProto, helper, numpy_helper

from mobnet.export.contract import IR_VERSION, OPSET
from mobnet.formats.network import CellKind, NetworkCell
from mobnet.learning.deployed.tensors import std_scale_of
from mobnet.learning.deployed.weights import WeightsNote

PRODUCER = "mobnet"
LAST = 2**31  # beyond the end of any axis
Array = NDArray[np.float32]
Tensors = Mapping[str, Array]


class GraphBuilder:
    """Nodes and constants of a graph, named in the order in which they are added."""

    def __init__(self) -> None:
        self.nodes: list[onnx.NodeProto] = []
        self.constants: list[onnx.TensorProto] = []

    def constant(self, name: str, values: Any) -> str:
        """Add a constant; return its name."""
        array = np.ascontiguousarray(values)
        self.constants.append(numpy_helper.from_array(array.reshape(np.shape(values)), name))
        return name

    def add(self, operator: str, *inputs: str, out: str | Sequence[str] = "", **attributes: Any) -> str:
        """Add a node; return the name of its output, the first one of several."""
        outputs = [out or f"{operator.lower()}_{len(self.nodes)}"] if isinstance(out, str) else list(out)
        self.nodes.append(helper.make_node(operator, inputs, outputs, f"{operator}_{len(self.nodes)}", **attributes))
        return next(name for name in outputs if name)


def graph_of(tensors: Tensors, note: WeightsNote) -> onnx.ModelProto:
    """Return the model of a trained network; equal weights give equal bytes."""
    build = GraphBuilder()
    joints = len(note.joints)
    centred = build.add("Sub", "x", build.constant("input_mean", tensors["input.mean"]))
    scaled = build.add("Div", centred, build.constant("input_std", tensors["input.std"]))
    features = CELLS[note.cell.cell](build, note.cell, tensors, scaled)
    product = build.add("MatMul", features, build.constant("head_weight", tensors["head.weight"].T))
    output = build.add("Add", product, build.constant("head_bias", tensors["head.bias"]))
    build.add("Split", output, out=["mean_scaled", "std_raw"], axis=0)
    # (N10) and (N11): the factor of the calibration is on sigma alone.
    unscaled = build.add("Mul", "mean_scaled", build.constant("target_std", tensors["target.std"]))
    build.add("Add", unscaled, build.constant("target_mean", tensors["target.mean"]), out="mean")
    soft = build.add("Softplus", "std_raw")
    least = build.add("Max", soft, build.constant("std_min", np.float32(note.std_min)))
    std_unit = (tensors["target.std"] * std_scale_of(tensors)).astype(np.float32)
    build.add("Mul", least, build.constant("std_unit", std_unit), out="std")
    size = state_size(note.cell, len(note.inputs))
    inputs = [_vector("x", len(note.inputs)), _vector("state", size)]
    outputs = [_vector("mean", joints), _vector("std", joints), _vector("state_out", size)]
    graph = helper.make_graph(build.nodes, note.limb, inputs, outputs, build.constants)
    opsets = [helper.make_opsetid("", OPSET)]
    model = helper.make_model(graph, opset_imports=opsets, ir_version=IR_VERSION, producer_name=PRODUCER)
    onnx.checker.check_model(model, full_check=True)
    return model


def state_size(cell: NetworkCell, inputs: int) -> int:
    """Return the size s of the state: hidden state, that and cell state of an LSTM, or the inputs of a window."""
    hidden = cell.hidden or 0
    window = cell.window_steps or 1
    kernel = cell.kernel_steps or 1
    past = window - 1 + sum(2 * (kernel - 1) * dilation for dilation in cell.dilations or ())
    return {"GRU": hidden, "RNN": hidden, "LSTM": 2 * hidden, "constant": 0}.get(cell.cell, past * inputs)


def _vector(name: str, size: int) -> onnx.ValueInfoProto:
    return helper.make_tensor_value_info(name, TensorProto.FLOAT, [size])


def _recurrent(operator: str, gates: str, order: str) -> Callable[[GraphBuilder, NetworkCell, Tensors, str], str]:
    """Return the maker of a recurrent cell whose gates torch has in the order `gates`, and ONNX in `order`."""
    # One operator with a sequence of one step: a tick of six GRUs takes a tenth less time in ONNX Runtime than with
    # products, sums and gates as nodes of their own.
    places = [gates.index(gate) for gate in order]

    def sorted_gates(rows: Array) -> Array:
        parts = np.split(rows, len(gates))
        return np.concatenate([parts[place] for place in places])

    def cell(build: GraphBuilder, sizes: NetworkCell, tensors: Tensors, scaled: str) -> str:
        for name, key in (("cell_input", "weight_ih"), ("cell_state", "weight_hh")):
            build.constant(name, sorted_gates(tensors[f"cell.{key}_l0"])[None])
        biases = [sorted_gates(tensors[f"cell.{key}_l0"]) for key in ("bias_ih", "bias_hh")]
        build.constant("cell_bias", np.concatenate(biases)[None])
        row = build.constant("row", np.array([1, 1, -1], dtype=np.int64))  # of one direction or step, one lane
        (flat,) = _indices(build, flat=-1)
        inputs = [build.add("Reshape", scaled, row), "cell_input", "cell_state", "cell_bias", ""]
        attributes = {"hidden_size": sizes.hidden, **({"linear_before_reset": 1} if operator == "GRU" else {})}
        if operator == "LSTM":
            build.add("Split", "state", out=["hidden", "memory"], axis=0)
            inputs += [build.add("Reshape", part, row) for part in ("hidden", "memory")]
            build.add(operator, *inputs, out=["", "hidden_after", "memory_after"], **attributes)
            features, memory = (build.add("Reshape", name, flat) for name in ("hidden_after", "memory_after"))
            build.add("Concat", features, memory, out="state_out", axis=0)
            return features
        inputs.append(build.add("Reshape", "state", row))
        build.add(operator, *inputs, out=["", "after"], **attributes)
        return build.add("Reshape", "after", flat, out="state_out")

    return cell


def _window(build: GraphBuilder, cell: NetworkCell, tensors: Tensors, scaled: str) -> str:
    """Add a cell that sees a window: blocks of a TCN, if any, and a hidden layer with tanh."""
    weight = tensors["cell.layer.weight"]
    inputs = len(tensors["input.mean"])
    samples = build.add("Concat", "state", scaled, out="samples", axis=0)
    build.add("Slice", samples, *_indices(build, begin=inputs, end=LAST), out="state_out")
    if cell.cell == "TCN":
        table = build.constant("table", np.array([1, -1, inputs], dtype=np.int64))
        channels = build.add("Transpose", build.add("Reshape", samples, table), perm=[0, 2, 1])
        for k, dilation in enumerate(cell.dilations or ()):
            channels = _block(build, k, dilation, tensors, channels)
        # The blocks leave one window, whose channels come first, as in the weight.
        samples = build.add("Reshape", channels, *_indices(build, flat=-1))
        matrix = weight.reshape(len(weight), -1)
    else:
        matrix = weight[..., 0].swapaxes(1, 2).reshape(len(weight), -1)  # samples lie one after the other
    product = build.add("MatMul", samples, build.constant("layer_weight", matrix.T))
    total = build.add("Add", product, build.constant("layer_bias", tensors["cell.layer.bias"]))
    return build.add("Tanh", total)


def _indices(build: GraphBuilder, **values: int) -> list[str]:
    """Add constants of one whole number each; return their names."""
    return [build.constant(name, np.array([value], dtype=np.int64)) for name, value in values.items()]


def _block(build: GraphBuilder, k: int, dilation: int, tensors: Tensors, x: str) -> str:
    """Add a residual block of a TCN: two dilated convolutions without padding, and a shortcut as short as they are."""

    def convolution(name: str, inputs: str, step: int) -> str:
        key = f"cell.blocks.{k}.{name}"
        weight = build.constant(f"{name}_{k}_weight", tensors[f"{key}.weight"][..., 0])
        bias = build.constant(f"{name}_{k}_bias", tensors[f"{key}.bias"])
        return build.add("Conv", inputs, weight, bias, dilations=[step])

    first = build.add("Relu", convolution("first", x, dilation))
    second = build.add("Relu", convolution("second", first, dilation))
    taps = tensors[f"cell.blocks.{k}.first.weight"].shape[2]
    places = {f"begin_{k}": 2 * (taps - 1) * dilation, f"end_{k}": LAST, f"axis_{k}": 2}
    shortcut = build.add("Slice", x, *_indices(build, **places))
    if f"cell.blocks.{k}.shortcut.weight" in tensors:
        shortcut = convolution("shortcut", shortcut, 1)
    return build.add("Relu", build.add("Add", second, shortcut))


def _constant(build: GraphBuilder, cell: NetworkCell, tensors: Tensors, scaled: str) -> str:
    """Add no features: the linear layer is its bias."""
    build.add("Identity", "state", out="state_out")
    return "state"


CELLS: Mapping[CellKind, Callable[[GraphBuilder, NetworkCell, Tensors, str], str]] = {
    "GRU": _recurrent("GRU", "rzn", "zrn"),
    "LSTM": _recurrent("LSTM", "ifgo", "iofg"),
    "RNN": _recurrent("RNN", "h", "h"),
    "MLP": _window,
    "TCN": _window,
    "constant": _constant,
}
