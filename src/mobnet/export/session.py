"""Exported networks in ONNX Runtime: the same `init` and `step` as the project's own networks have (docs/runtime.md).

A step copies its inputs into buffers that are bound once, so that ONNX Runtime allocates nothing for them.
"""

import json
import os
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

os.environ.setdefault("ORT_DISABLE_TELEMETRY", "1")  # it writes to the home and reports unless this is there before it
import onnxruntime as ort

from mobnet.core.errors import DataError
from mobnet.core.files import parse_json
from mobnet.core.joints import JointLayout
from mobnet.core.notes import checked
from mobnet.core.place import command
from mobnet.export.contract import Contract, read_contract
from mobnet.learning.deployed.limbs import LimbNetworks
from mobnet.learning.deployed.networks import Prediction

Array = NDArray[np.float32]


class OnnxNetwork:
    """An exported limb network in one thread; its state (s,) is carried by the caller.

    Buffers belong to the network, so that steps of one network must not run at the same time.
    """

    def __init__(self, path: Path) -> None:
        """Read the file and its contract.

        Raises:
            DataError: the file is missing, is no ONNX file, or its metadata are not those of an export.
        """
        options = ort.SessionOptions()
        options.intra_op_num_threads = options.inter_op_num_threads = 1
        try:
            self._session = ort.InferenceSession(path, options, providers=["CPUExecutionProvider"])
        except Exception as error:  # noqa: BLE001, onnxruntime has a class for each kind of fault
            text = f"not an exported network ({' '.join(str(error).split())}); accepted: a file of {command('export')}"
            raise DataError(f"{path}: {text}") from None
        self.contract = _contract(path, self._session.get_modelmeta().custom_metadata_map)
        (network,) = self.contract.networks
        self.limb = network.limb
        self.joints = network.joints
        self.input_names = tuple(port.name for port in network.inputs)
        self._binding = self._session.io_binding()
        self._x, self._state = (self._bound(self._binding.bind_input, port) for port in self._session.get_inputs())
        self._mean, self._std, self._after = (
            self._bound(self._binding.bind_output, port) for port in self._session.get_outputs()
        )

    @staticmethod
    def _bound(bind: Callable[..., None], tensor: Any) -> Array:
        """Return a buffer that is bound to an input or an output."""
        buffer = np.zeros(tensor.shape, dtype=np.float32)
        bind(tensor.name, "cpu", 0, np.float32, buffer.shape, buffer.ctypes.data)
        return buffer

    def init(self) -> Array:
        """Return the zero state (s,)."""
        return np.zeros_like(self._state)

    def step(self, state: Array, x: Array) -> tuple[Array, Prediction]:
        """Advance by one sample of inputs (n_in,); return the new state (s,) and the prediction (n,) [N, N m]."""
        self._x[:] = x
        self._state[:] = state
        self._session.run_with_iobinding(self._binding)
        return self._after.copy(), Prediction(self._mean.copy(), self._std.copy())

    def run_all(self, lanes: Sequence[Array]) -> list[Prediction]:
        """Run over contiguous recordings of inputs (T_i, n_in), each from a fresh state; return (T_i, n) [N, N m]."""
        return [self._run(lane) for lane in lanes]

    def _run(self, lane: Array) -> Prediction:
        """Return the predictions (T, n) [N, N m] of a recording of inputs (T, n_in), step by step."""
        mean, std = np.empty((2, len(lane), len(self.joints)), dtype=np.float32)
        state = self.init()
        for k, x in enumerate(lane):
            state, prediction = self.step(state, x)
            mean[k] = prediction.mean
            std[k] = prediction.std
        return Prediction(mean, std)


def _contract(path: Path, metadata: Mapping[str, str]) -> Contract:
    """Return the contract that the metadata of a file are."""
    entries = ", ".join(f"{json.dumps(key)}: {value}" for key, value in metadata.items())
    return checked(path, parse_json(f"{{{entries}}}", f"{path}: metadata"), Contract)


def load_exported(folder: Path, layout: JointLayout) -> LimbNetworks:
    """Return the networks of a folder that `./reproduce export` wrote, side by side.

    Raises:
        DataError: a file is missing or damaged.
    """
    contract = read_contract(folder)
    return LimbNetworks([OnnxNetwork(folder / network.file) for network in contract.networks], layout)
