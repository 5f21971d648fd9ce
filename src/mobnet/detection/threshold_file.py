"""The file of a limb's thresholds: written by `./reproduce calibrate`, read and checked by `detect` and `export`."""

from pathlib import Path

from mobnet.core.errors import ConfigError, DataError, not_accepted, refuse
from mobnet.core.files import write_text
from mobnet.core.place import command
from mobnet.detection.always import setup_of
from mobnet.detection.signals import Watched
from mobnet.detection.watch import LegSetup, LimbSetup
from mobnet.estimation.own import OwnNetwork
from mobnet.estimation.sampling import Sampling, check_drives
from mobnet.formats.limb_thresholds import LimbThresholds
from mobnet.formats.loading import load_section
from mobnet.kernel.detecting import WatchedSignals
from mobnet.robot.description import RobotDescription
from mobnet.robot.table_file import flow
from mobnet.settings.detection import Detection

HEADER = f"# Thresholds of a limb, by {command('calibrate')} (docs/detection.md). SI units, rates of alarms per hour."


def write_thresholds(path: Path, thresholds: LimbThresholds) -> None:
    """Write the thresholds of a limb as YAML, a line for each key."""
    rows = thresholds.model_dump(mode="json", exclude_none=True).items()
    write_text(path, "\n".join([HEADER, *(f"{key}: {flow(value)}" for key, value in rows)]) + "\n")


def read_thresholds(path: Path) -> LimbThresholds:
    """Read the thresholds of a limb.

    Raises:
        ConfigError: the file is missing, or a key or a value is not accepted.
    """
    thresholds = load_section(path, LimbThresholds)
    if len(thresholds.thresholds) != len(thresholds.joints):
        raise ConfigError(
            f"{path}: {len(thresholds.thresholds)} thresholds for {len(thresholds.joints)} joints; each joint needs one"
        )
    return thresholds


def sampling_of(thresholds: LimbThresholds) -> Sampling:
    """Return how the log was sampled and observed that thresholds were made with."""
    return Sampling(thresholds.rate_hz, thresholds.gain_hz, thresholds.torque, thresholds.drives)


def watched_of(thresholds: LimbThresholds) -> Watched:
    """Return what a detector with these thresholds watches."""
    return Watched(WatchedSignals((thresholds.signal,)))


def setup_with(thresholds: LimbThresholds, detection: Detection, robot: RobotDescription) -> LimbSetup:
    """Return the setup of a limb with the filters of its thresholds; a DataError names a limb without swings."""
    filters = {"low_pass_hz": thresholds.low_pass_hz, "hold_s": thresholds.hold_s}
    walks = thresholds.watched == "swing"
    setup = setup_of(detection.model_copy(update=filters), robot, thresholds.limb, thresholds.rate_hz, walks=walks)
    if walks and not isinstance(setup, LegSetup):
        raise DataError(not_accepted(f"thresholds of {thresholds.limb}: watched", thresholds.watched, ["always"]))
    return setup


def check_thresholds(
    path: Path, thresholds: LimbThresholds, robot: RobotDescription, network: OwnNetwork | None
) -> None:
    """Raise a DataError where thresholds are those of another robot, limb or network, or of other friction."""
    check_drives(path, thresholds.drives, robot)
    joints = robot.layout.groups.get(thresholds.limb, ())
    pairs = {
        "robot": (thresholds.robot, robot.name),
        "joints": (thresholds.joints, joints),
        "network": (thresholds.network or "none", network.fingerprint if network else "none"),
    }
    refuse(
        path,
        [
            f"made for {key} {there!r}, and {here!r} is given here"
            for key, (there, here) in pairs.items()
            if there != here
        ],
    )
