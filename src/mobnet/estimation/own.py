"""A log of one's own as `./reproduce observe` wrote it, a network that `./reproduce learn` made, and estimates."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from mobnet.core.columns import EXTERNAL, named
from mobnet.core.errors import ConfigError, DataError, beyond, not_accepted, refuse
from mobnet.core.estimator import Estimate
from mobnet.core.files import RUN
from mobnet.core.joints import JointLayout
from mobnet.core.notes import Note, Text, pair_differences, read_array_note, read_note
from mobnet.core.rates import GAIN_HZ, RATE_HZ
from mobnet.core.recording import SensedRecording
from mobnet.core.recording_file import read_sensed
from mobnet.core.store import ARRAY, NOTE, file_of, footer_hash, read_array
from mobnet.core.word_checks import ESTIMATE, RECORDING, check_log_folder, check_network_folder
from mobnet.estimation.estimate import ObservedRecording, only, run_segments
from mobnet.estimation.observer import RobotObserver
from mobnet.estimation.residual import ResidualEstimator
from mobnet.estimation.sampling import DRIVES, OBSERVER, Sampling
from mobnet.formats.base import GainHz, RateHz
from mobnet.formats.robot import GroupName
from mobnet.kernel.detecting import Target
from mobnet.kernel.drive import TorqueKind
from mobnet.learning.deployed.limbs import LimbNetworks
from mobnet.learning.deployed.loading import load_limb_networks
from mobnet.robot.description import RobotDescription
from mobnet.robot.nominal import NominalModel
from mobnet.robot.word_checks import limb_named
from mobnet.settings.lab import Lab

UNCERTAINTY: Target = "uncertainty"  # what such a network learns


class LearnedNote(Note):
    """What `run.json` of a network says of what it learned, at which rate; one of the workflow leaves numbers out.

    It learned from the recordings with these hashes of their footers, which stood in these folders.
    """

    limb: GroupName
    target: Target
    fingerprint: Text
    rate_hz: RateHz | None = None
    gain_hz: GainHz | None = None
    torque: TorqueKind | None = None
    drives: Text | None = None
    folders: list[Text] | None = None
    recordings: list[Text] | None = None


@dataclass(frozen=True)
class OwnLog:
    """A log: what the robot sensed, and the residual r of (9), (T, nv) [N] and [N m].

    Its recording has a hash, that of its footer, by which a copy of it in another folder is known.
    """

    folder: Path
    recording: SensedRecording
    residual: NDArray[np.float32]
    sampling: Sampling
    footer: str = ""


@dataclass(frozen=True)
class OwnNetwork:
    """A network of a limb, the hash of all that its weights depend on, its sampling, and the logs it learned from.

    The logs are folders, and hashes of their recordings' footers; an earlier version noted the folders alone.
    """

    folder: Path
    limb: str
    fingerprint: str
    networks: LimbNetworks
    sampling: Sampling
    logs: tuple[Path, ...] = ()
    recordings: tuple[str, ...] | None = None

    def has_learned_from(self, log: OwnLog) -> bool:
        """Return whether it learned from a log, wherever this stands now."""
        if self.recordings is None:
            return log.folder.resolve() in {folder.resolve() for folder in self.logs}
        return log.footer in self.recordings


def refuse_twice(logs: Sequence[OwnLog], why: str) -> None:
    """Raise a DataError with the reason where a log is given twice, be it as a copy in another folder."""
    seen = dict[str, Path]()
    for log in logs:
        if log.footer in seen:
            raise DataError(f"{log.folder} is the same log as {seen[log.footer]}; give each log once, {why}")
        seen[log.footer] = log.folder


def read_log_folder(folder: Path, layout: JointLayout) -> OwnLog:
    """Read a log that `./reproduce observe` wrote.

    Raises:
        DataError: the folder is another one, a file is damaged, or its two arrays do not belong together.
    """
    check_log_folder(folder)
    stems = [folder / name for name in (RECORDING, ESTIMATE)]
    note, other = (read_array_note(file_of(stem, NOTE)) for stem in reversed(stems))
    refuse(f"{stems[1]}{NOTE}", pair_differences(note, other, f"{stems[0]}{NOTE}"))
    if note.get("method") != OBSERVER or not {"gain_hz", "torque"} <= note.keys():
        raise DataError(not_accepted(f"{stems[1]}{NOTE}: method", note.get("method"), [f"{OBSERVER}, by observe"]))
    faults = [*beyond("rate_hz", note["rate_hz"], RATE_HZ), *beyond("gain_hz", note["gain_hz"], GAIN_HZ)]
    refuse(f"{stems[1]}{NOTE}", faults)
    joints_there = [column["name"].removeprefix(f"{EXTERNAL}.") for column in note["columns"]]
    if others := [name for name in joints_there if name not in layout.names]:
        raise DataError(f"{not_accepted(f'{folder}: joint', others[0], layout.names)}, those of --robot")
    recording = read_sensed(stems[0], layout)
    residual = read_array(stems[1], named(EXTERNAL, layout.names))[0]
    sampling = Sampling(recording.rate_hz, float(note["gain_hz"]), note["torque"], note.get(DRIVES))
    return OwnLog(folder, recording, residual, sampling, footer_hash(file_of(stems[0], ARRAY)))


def read_network_folder(folder: Path, layout: JointLayout, settings: Lab) -> OwnNetwork:
    """Read a trained network; one of the workflow has the sampling of the configuration.

    Raises:
        DataError: a file is missing or damaged, the network is another robot's, or it learned something else than
            what is taken off the residual.
    """
    check_network_folder(folder)
    note = read_note(folder / RUN, LearnedNote)
    observer = settings.observer
    if note.target != UNCERTAINTY:
        raise DataError(not_accepted(f"{folder / RUN}: target", note.target, [UNCERTAINTY]))
    rate_hz = note.rate_hz or settings.rates.data_hz
    gain_hz = note.gain_hz or observer.gain_hz
    networks = load_limb_networks({note.limb: folder}, layout)
    sampling = Sampling(rate_hz, gain_hz, note.torque or observer.torque, note.drives)
    folders = tuple(map(Path, note.folders or ()))
    recordings = note.recordings
    known = None if recordings is None else tuple(recordings)
    return OwnNetwork(folder, note.limb, note.fingerprint, networks, sampling, folders, known)


def limb_of(layout: JointLayout, given: str | None, network: OwnNetwork | None = None) -> str:
    """Return the limb that a command means: the one that is given, that of a network, or the robot's only one.

    Raises:
        ConfigError: there is none, or the network is that of another limb.
    """
    limb = limb_named(layout, given or (network and network.limb))
    if network and not set(layout.limb(limb)) <= set(network.networks.joints):
        raise ConfigError(not_accepted("--limb", limb, [f"{network.limb}, that of {network.folder}"]))
    return limb


def without_friction(logs: Sequence[OwnLog], robot: RobotDescription, gravity_m_s2: float) -> list[OwnLog]:
    """Return logs with the residual of an observer that does not know the friction of the robot's table."""
    nominal = NominalModel(replace(robot, friction={}), gravity_m_s2=gravity_m_s2)
    logs_without = list[OwnLog]()
    for log in logs:
        mob = RobotObserver(nominal, log.sampling.gain_hz, log.sampling.rate_hz, log.sampling.torque)
        residual = np.empty(log.residual.shape, dtype=np.float32)
        for span in log.recording.spans():
            residual[span] = mob.residual(log.recording.sensed[span])
        logs_without.append(replace(log, residual=residual))
    return logs_without


def estimates_of(logs: Sequence[OwnLog], estimator: ResidualEstimator, joints: Sequence[str]) -> list[Estimate]:
    """Return the estimate of some joints (T, n) [N, N m] in each log, segments from a fresh state."""
    estimates = run_segments(estimator, [ObservedRecording(log.recording, log.residual) for log in logs])
    return [only(result, estimator.joints, joints) for result in estimates]
