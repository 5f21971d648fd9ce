"""How a log was sampled and observed, and the estimator that a closed loop has for it."""

from dataclasses import dataclass
from pathlib import Path

from mobnet.core.errors import DataError, not_accepted, refuse
from mobnet.estimation.observer import RobotObserver
from mobnet.estimation.residual import ResidualEstimator
from mobnet.kernel.drive import TorqueKind
from mobnet.learning.deployed.limbs import LimbNetworks
from mobnet.robot.description import RobotDescription
from mobnet.robot.nominal import NominalModel

DRIVES = "drives"  # key of a note: digest of the friction that the observer knew
OBSERVER, LEARNED = "MOB", "MOB-Net"  # methods: the observer alone, and with a network
REMEDIES = {"rate_hz": "; one `rate_hz` in the maps of all logs gives them one rate"}  # of what two logs differ in


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


def check_sampling(path: Path, sampling: Sampling, wanted: Sampling, of: Path) -> None:
    """Raise a DataError where a log was sampled or observed otherwise than what a file was made with."""
    faults = [
        not_accepted(key, value, [f"{expected}, as {of} has it"]) + REMEDIES.get(key, "")
        for key, value in vars(sampling).items()
        if value != (expected := getattr(wanted, key))
    ]
    refuse(path, faults)


def check_drives(path: Path, drives: str | None, robot: RobotDescription) -> None:
    """Raise a DataError where a file was made with other friction or rotors than those of a robot's table."""
    if drives != robot.drives:
        made = f"made with friction and armature {drives or 'none'}, and the table of --robot has"
        raise DataError(f"{path}: {made} {robot.drives or 'none'}; make it anew with that table")


def estimator_of(
    robot: RobotDescription, gravity_m_s2: float, sampling: Sampling, networks: LimbNetworks | None
) -> ResidualEstimator:
    """Return the estimator of a log, as a closed loop has it: the observer, or less what networks predict."""
    nominal = NominalModel(robot, gravity_m_s2=gravity_m_s2)
    observer = RobotObserver(nominal, sampling.gain_hz, sampling.rate_hz, sampling.torque)
    return ResidualEstimator(observer, robot.layout, networks)
