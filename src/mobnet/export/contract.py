"""What a program must know to run exported networks: the contract, in `contract.json` and in each ONNX file.

All numbers are in SI units. docs/runtime.md explains every key.
"""

import json
from pathlib import Path
from typing import Any

from mobnet.core.files import read_json
from mobnet.core.notes import Count, FileName, Index, Note, Positive, Text, checked
from mobnet.formats.base import GainHz, RateHz
from mobnet.formats.limb_thresholds import LimbThresholds
from mobnet.formats.robot import GroupName
from mobnet.kernel.detecting import Target
from mobnet.kernel.drive import TorqueKind

FORMAT = 1  # of the contract; another one has other keys
OPSET, IR_VERSION = 17, 8  # of July 2022: run times of that age and newer ones read the files
CONTRACT = "contract.json"


class InputContract(Note):
    """An input: a column of a recording, or a formula of the base's quaternion w x y z; with its z-score."""

    name: Text
    unit: Text
    frame: Text
    mean: float
    std: Positive
    formula: Text | None = None


class OutputContract(Note):
    """A joint of `mean` and `std`, its z-score, and the calibration's factor in the standard deviation [-]."""

    joint: Text
    unit: Text
    frame: Text
    mean: float
    std: Positive
    std_scale: Positive


class NetworkContract(Note):
    """A network: what it estimates, the size of its state, and its smallest standard deviation, z-scored.

    It estimates the external torque, or the uncertainty torque that is subtracted from the observer's residual (15).
    """

    file: FileName
    name: Text
    limb: GroupName
    estimates: Target
    cell: Text
    state: Index
    std_min: Positive
    weights_sha256: Text
    inputs: list[InputContract]
    outputs: list[OutputContract]

    @property
    def joints(self) -> tuple[str, ...]:
        """Names of the joints, (n,)."""
        return tuple(output.joint for output in self.outputs)


class ObserverContract(Note):
    """The momentum observer: K_0 of (7) [1/s], and whether torques are means over intervals or samples at ticks."""

    gain_hz: GainHz
    torque: TorqueKind
    gravity_m_s2: Positive


class Contract(Note):
    """All of it; an ONNX file has its own network and the detectors of its limb.

    `quaternion` says which columns of a recording are w x y z of the formulas.
    """

    format: Count
    version: Text
    opset: Count
    robot: Text
    rate_hz: RateHz
    observer: ObserverContract
    quaternion: dict[str, Text]
    networks: list[NetworkContract]
    detectors: list[LimbThresholds]

    def of(self, network: NetworkContract) -> "Contract":
        """Return the part that belongs to one network."""
        of_limb = [detector for detector in self.detectors if detector.limb == network.limb]
        return self.model_copy(update={"networks": [network], "detectors": of_limb})

    def as_json(self) -> dict[str, Any]:
        """Return it as JSON; what an entry does not have is left out."""
        return self.model_dump(mode="json", exclude_none=True)

    def metadata(self) -> dict[str, str]:
        """Return it as the metadata of an ONNX file: each key with its value as JSON."""
        return {key: json.dumps(value) for key, value in self.as_json().items()}


def read_contract(folder: Path) -> Contract:
    """Read the contract of a folder that `./reproduce export` wrote.

    Raises:
        DataError: it is missing or damaged, or a key or a value is not accepted.
    """
    return checked(folder / CONTRACT, read_json(folder / CONTRACT), Contract)
