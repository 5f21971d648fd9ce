"""The file of a trained network, `weights.safetensors`: its note, and which tensors of which shapes it holds."""

import json
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydantic import ConfigDict, ValidationError
from safetensors import SafetensorError, safe_open

from mobnet.core.errors import DataError, not_accepted, refuse
from mobnet.core.files import parse_json
from mobnet.core.notes import Names, Note, Positive, Text, checked, fault_of
from mobnet.formats.network import NetworkCell
from mobnet.formats.robot import GroupName
from mobnet.learning.deployed.tensors import STD_SCALE, std_scale_of

NOTE = "note"  # the only entry of the file's metadata: several would be written in an order that changes
ABOVE_ZERO = ("input.std", "target.std", STD_SCALE)
GATES = {"GRU": 3, "LSTM": 4, "RNN": 1}  # recurrent cells: rows of a weight for each hidden unit
Array = NDArray[np.float32]
Shape = tuple[int, ...]


class WeightsNote(Note):
    """What the file says: names of the training, its limb, joints (n,) and inputs (n_in,), the configuration's row."""

    model_config = ConfigDict(extra="forbid")

    name: Text
    limb: GroupName
    joints: Names
    inputs: Names
    std_min: Positive
    network: dict[str, Any]

    @property
    def cell(self) -> NetworkCell:
        """The cell and its sizes; the row also has limbs and data."""
        known = {key: value for key, value in self.network.items() if key in NetworkCell.model_fields}
        return NetworkCell.model_validate_json(json.dumps(known))


def read_weights(path: Path) -> tuple[dict[str, Array], WeightsNote]:
    """Read the tensors of a network and what the file says of them.

    Raises:
        DataError: the file is missing, damaged or not accepted, one line for each fault.
    """
    try:
        with safe_open(path, framework="numpy") as file:
            metadata = file.metadata() or {}
            tensors = {name: file.get_tensor(name) for name in file.keys()}  # noqa: SIM118, not a dict
    except FileNotFoundError:
        raise DataError(f"{path}: file is missing; accepted: a file of safetensors") from None
    except (SafetensorError, OSError, TypeError, ValueError, KeyError, AttributeError) as error:
        text = f"not the weights of a limb network ({' '.join(str(error).split())}); accepted: a file of safetensors"
        raise DataError(f"{path}: {text}") from None
    if set(metadata) != {NOTE}:
        raise DataError(
            not_accepted(f"{path}: metadata", sorted(metadata), [f"just {NOTE!r}, as a training writes it"])
        )
    note = checked(path, parse_json(metadata[NOTE], f"{path}: {NOTE}"), WeightsNote)
    refuse(path, _faults(tensors, note))
    return tensors, note


def std_scales(paths: Iterable[Path]) -> dict[str, float]:
    """Return joint -> factor in its standard deviation, of several networks."""
    scales = dict[str, float]()
    for tensors, note in map(read_weights, paths):
        scales.update(zip(note.joints, std_scale_of(tensors).tolist(), strict=True))
    return scales


def _faults(tensors: Mapping[str, Array], note: WeightsNote) -> Iterator[str]:
    """Yield what is wrong with a network's cell and tensors."""
    try:
        expected = shapes(note.cell, len(note.inputs), len(note.joints))
    except ValidationError as error:
        for details in error.errors(include_url=False):
            yield fault_of({**details, "loc": ("network", *details["loc"])}, WeightsNote)
        return
    for name in expected.keys() - tensors.keys() - {STD_SCALE}:
        yield f"tensor {name!r} is missing; accepted: shape {list(expected[name])}"
    for name, tensor in tensors.items():
        if name not in expected:
            yield not_accepted("tensor", name, expected)
        else:
            yield from _tensor_faults(name, tensor, expected[name])


def _tensor_faults(name: str, tensor: Array, shape: Shape) -> Iterator[str]:
    """Yield what is wrong with a tensor: type, shape, numbers."""
    if tensor.dtype != np.float32:
        yield not_accepted(f"tensor {name!r}: type", str(tensor.dtype), ["float32"])
    elif tensor.shape != shape:
        yield not_accepted(f"tensor {name!r}: shape", list(tensor.shape), [list(shape)])
    else:
        above = name in ABOVE_ZERO
        good = np.isfinite(tensor) & (tensor > 0.0) if above else np.isfinite(tensor)
        for place in np.argwhere(~good)[:1].tolist():
            accepted = "finite numbers above 0" if above else "finite numbers"
            yield not_accepted(f"tensor {name!r}, entry {place}", float(tensor[tuple(place)]), [accepted])


def shapes(cell: NetworkCell, inputs: int, joints: int) -> dict[str, Shape]:
    """Return name -> shape of all tensors of a network with so many inputs and joints; `std.scale` may be absent."""
    scores = {"input.mean": (inputs,), "input.std": (inputs,), "target.mean": (joints,), "target.std": (joints,)}
    width, weights = _cell_shapes(cell, inputs)
    head = {"head.weight": (2 * joints, width), "head.bias": (2 * joints,)}
    return {**{f"cell.{name}": shape for name, shape in weights.items()}, **head, **scores, STD_SCALE: (joints,)}


def _cell_shapes(cell: NetworkCell, inputs: int) -> tuple[int, dict[str, Shape]]:
    """Return the features of a cell, and name -> shape of its tensors, as torch names them."""
    hidden = cell.hidden or 0
    steps = cell.window_steps or 1
    if cell.cell in GATES:
        rows = GATES[cell.cell] * hidden
        shapes = {
            "weight_ih_l0": (rows, inputs),
            "weight_hh_l0": (rows, hidden),
            "bias_ih_l0": (rows,),
            "bias_hh_l0": (rows,),
        }
        return hidden, shapes
    if cell.cell == "constant":
        return 0, {}
    shape_of = {}
    width = inputs
    for k in range(len(cell.dilations or ()) if cell.cell == "TCN" else 0):
        convolutions = {"first": (width, cell.kernel_steps), "second": (hidden, cell.kernel_steps)}
        if width != hidden:
            convolutions["shortcut"] = (width, 1)
        for name, (channels, taps) in convolutions.items():
            shape_of |= {f"blocks.{k}.{name}.weight": (hidden, channels, taps, 1), f"blocks.{k}.{name}.bias": (hidden,)}
        width = hidden
    units = (cell.head or 0) if cell.cell == "TCN" else hidden
    return units, {**shape_of, "layer.weight": (units, width, steps, 1), "layer.bias": (units,)}
