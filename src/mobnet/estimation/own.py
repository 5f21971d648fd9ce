"""A log of one's own as `./reproduce observe` wrote it, a network that `./reproduce learn` made, and estimates."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from mobnet.core.columns import EXTERNAL, named
from mobnet.core.errors import ConfigError, DataError, not_accepted, refuse
from mobnet.core.estimator import Estimate
from mobnet.core.files import RUN
from mobnet.core.joints import JointLayout
from mobnet.core.notes import Note, Positive, Text, note_differences, read_array_note, read_note
from mobnet.core.recording import SensedRecording, read_sensed
from mobnet.core.store import NOTE, file_of, read_array
from mobnet.estimation.estimate import Observed, only, run_segments
from mobnet.estimation.kinds.residual import ResidualEstimator
from mobnet.estimation.observer import MomentumObserver
from mobnet.learning.deployed.limbs import LimbNetworks, load_limb_networks
from mobnet.robot.description import RobotDescription
from mobnet.robot.nominal import NominalModel
from mobnet.settings.base import TorqueKind
from mobnet.settings.methods import Target
from mobnet.settings.settings import Settings

RECORDING, ESTIMATE = "recording", "estimate"  # arrays in the folder of a log
DRIVES = "drives"  # key of a note: digest of the friction that the observer knew
OBSERVER, LEARNED = "MOB", "MOB-Net"  # methods: the observer alone, and with a network
UNCERTAINTY: Target = "uncertainty"  # what such a network learns


class LearnedNote(Note):
    """What `run.json` of a network says of what it learned, at which rate; one of the workflow leaves numbers out."""

    limb: Text
    target: Target
    fingerprint: Text
    rate_hz: Positive | None = None
    gain_hz: Positive | None = None
    torque: TorqueKind | None = None
    drives: Text | None = None
    folders: list[Text] | None = None


@dataclass(frozen=True)
class Sampling:
    """Samples per second [Hz], gain K_0 of the observer [1/s], and what a log holds of torques between two ticks.

    `drives` is the digest of the friction that the observer knew; None where the table had none.
    """

    rate_hz: float
    gain_hz: float
    torque: TorqueKind
    drives: str | None = None

    def note(self) -> dict[str, float | str]:
        """Return what a note says of it."""
        return {key: value for key, value in vars(self).items() if value is not None}


@dataclass(frozen=True)
class OwnLog:
    """A log: what the robot sensed, and the residual r of (9), (T, nv) [N] and [N m]."""

    folder: Path
    recording: SensedRecording
    residual: NDArray[np.float32]
    sampling: Sampling


@dataclass(frozen=True)
class OwnNetwork:
    """A network of a limb, the hash of all that its weights depend on, its sampling, and the logs it learned from."""

    folder: Path
    limb: str
    fingerprint: str
    networks: LimbNetworks
    sampling: Sampling
    logs: tuple[Path, ...] = ()


def read_log_folder(folder: Path, layout: JointLayout) -> OwnLog:
    """Read a log that `./reproduce observe` wrote.

    Raises:
        DataError: the folder is another one, a file is damaged, or its two arrays do not belong together.
    """
    stems = [folder / name for name in (RECORDING, ESTIMATE)]
    if missing := [stem.name for stem in stems if not file_of(stem, NOTE).exists()]:
        accepted = "a folder that `./reproduce observe` wrote"
        raise DataError(f"{folder}: {missing[0]}{NOTE} is missing; accepted: {accepted}")
    note, other = (read_array_note(file_of(stem, NOTE)) for stem in reversed(stems))
    refuse(f"{stems[1]}{NOTE}", note_differences(note, other, f"{stems[0]}{NOTE}"))
    if note.get("method") != OBSERVER or not {"gain_hz", "torque"} <= note.keys():
        raise DataError(not_accepted(f"{stems[1]}{NOTE}: method", note.get("method"), [f"{OBSERVER}, by observe"]))
    held = [column["name"].removeprefix(f"{EXTERNAL}.") for column in note["columns"]]
    if others := [name for name in held if name not in layout.names]:
        raise DataError(f"{not_accepted(f'{folder}: joint', others[0], layout.names)}, those of --robot")
    recording = read_sensed(stems[0], layout)
    residual = read_array(stems[1], named(EXTERNAL, layout.names))[0]
    sampling = Sampling(recording.rate_hz, float(note["gain_hz"]), note["torque"], note.get(DRIVES))
    return OwnLog(folder, recording, residual, sampling)


def read_network_folder(folder: Path, layout: JointLayout, settings: Settings) -> OwnNetwork:
    """Read a trained network; one of the workflow has the sampling of the configuration.

    Raises:
        DataError: a file is missing or damaged, the network is another robot's, or it learned something else than
            what is taken off the residual.
    """
    if not (folder / RUN).exists():
        raise DataError(f"{folder}: {RUN} is missing; accepted: a folder that `./reproduce learn` wrote")
    note, observer = read_note(folder / RUN, LearnedNote), settings.observer
    if note.target != UNCERTAINTY:
        raise DataError(not_accepted(f"{folder / RUN}: target", note.target, [UNCERTAINTY]))
    rate_hz, gain_hz = note.rate_hz or settings.rates.data_hz, note.gain_hz or observer.gain_hz
    networks = load_limb_networks({note.limb: folder}, layout)
    sampling = Sampling(rate_hz, gain_hz, note.torque or observer.torque, note.drives)
    return OwnNetwork(folder, note.limb, note.fingerprint, networks, sampling, tuple(map(Path, note.folders or ())))


def limb_of(layout: JointLayout, given: str | None, network: OwnNetwork | None = None) -> str:
    """Return the limb that a command means: the one that is given, that of a network, or the robot's only one.

    Raises:
        ConfigError: there is none, or the network is that of another limb.
    """
    own = [name for name, joints in layout.groups.items() if not set(joints) & set(layout.virtual)]
    limb = given or (network.limb if network else own[0] if len(own) == 1 else None)
    if limb is None or limb not in layout.groups:
        raise ConfigError(not_accepted("--limb", limb or "nothing", layout.groups))
    if network and not set(layout.limb(limb)) <= set(network.networks.joints):
        raise ConfigError(not_accepted("--limb", limb, [f"{network.limb}, that of {network.folder}"]))
    return limb


def check_sampling(path: Path, sampling: Sampling, wanted: Sampling, of: Path) -> None:
    """Raise a DataError where a log was sampled or observed otherwise than what a file was made with."""
    faults = [
        not_accepted(key, value, [f"{expected}, as {of} has it"])
        for key, value in vars(sampling).items()
        if value != (expected := getattr(wanted, key))
    ]
    refuse(path, faults)


def check_drives(path: Path, drives: str | None, robot: RobotDescription) -> None:
    """Raise a DataError where a file was made with other friction or rotors than those of a robot's table."""
    if drives != robot.drives:
        accepted = [f"{robot.drives or 'none'}, those of --robot; make it anew with that table"]
        raise DataError(f"{path}: {not_accepted('drives (friction and armature)', drives or 'none', accepted)}")


def estimator_of(
    robot: RobotDescription, gravity_m_s2: float, sampling: Sampling, network: OwnNetwork | None
) -> ResidualEstimator:
    """Return the estimator of a log, as a closed loop has it: the observer, or less what a network predicts."""
    nominal = NominalModel(robot, gravity_m_s2=gravity_m_s2)
    observer = MomentumObserver(nominal, sampling.gain_hz, sampling.rate_hz, sampling.torque)
    return ResidualEstimator(observer, robot.layout, network.networks if network else None)


def estimates_of(logs: Sequence[OwnLog], estimator: ResidualEstimator, joints: Sequence[str]) -> list[Estimate]:
    """Return the estimate of some joints (T, n) [N, N m] in each log, segments from a fresh state."""
    found = run_segments(estimator, [Observed(log.recording, log.residual) for log in logs])
    return [only(result, estimator.joints, joints) for result in found]
