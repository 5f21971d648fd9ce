"""The file of a limb's thresholds: written by `./reproduce calibrate`, read and checked by `detect` and `export`."""

from pathlib import Path

from mobnet.core.errors import ConfigError, DataError, not_accepted, refuse
from mobnet.core.files import write_text
from mobnet.core.place import command
from mobnet.detection.always import setup_of
from mobnet.detection.signals import Watched
from mobnet.detection.watch import LegSetup, LimbSetup
from mobnet.estimation.own import OwnNetwork, Sampling, check_drives
from mobnet.kernel.detecting import WatchedSignals
from mobnet.robot.description import RobotDescription
from mobnet.robot.table_file import flow
from mobnet.settings.detection import Detection
from mobnet.settings.lab import load_section
from mobnet.settings.limb_thresholds import LimbThresholds

HEADER = f"# Thresholds of a limb, by {command('calibrate')} (docs/detection.md). SI units, rates of alarms per hour."


def write_thresholds(path: Path, found: LimbThresholds) -> None:
    """Write the thresholds of a limb as YAML, a line for each key."""
    rows = found.model_dump(mode="json", exclude_none=True).items()
    write_text(path, "\n".join([HEADER, *(f"{key}: {flow(value)}" for key, value in rows)]) + "\n")


def read_thresholds(path: Path) -> LimbThresholds:
    """Read the thresholds of a limb.

    Raises:
        ConfigError: the file is missing, or a key or a value is not accepted.
    """
    found = load_section(path, LimbThresholds)
    if len(found.thresholds) != len(found.joints):
        raise ConfigError(
            f"{path}: {len(found.thresholds)} thresholds for {len(found.joints)} joints; each joint needs one"
        )
    return found


def sampling_of(found: LimbThresholds) -> Sampling:
    """Return how the log was sampled and observed that thresholds were made with."""
    return Sampling(found.rate_hz, found.gain_hz, found.torque, found.drives)


def watched_of(found: LimbThresholds) -> Watched:
    """Return what a detector with these thresholds watches."""
    return Watched(WatchedSignals((found.signal,)))


def setup_with(found: LimbThresholds, detection: Detection, robot: RobotDescription) -> LimbSetup:
    """Return the setup of a limb with the filters of its thresholds; a DataError names a limb without swings."""
    filters = {"low_pass_hz": found.low_pass_hz, "hold_s": found.hold_s}
    walks = found.watched == "swing"
    setup = setup_of(detection.model_copy(update=filters), robot, found.limb, found.rate_hz, walks=walks)
    if walks and not isinstance(setup, LegSetup):
        raise DataError(not_accepted(f"thresholds of {found.limb}: watched", found.watched, ["always"]))
    return setup


def check_thresholds(path: Path, found: LimbThresholds, robot: RobotDescription, network: OwnNetwork | None) -> None:
    """Raise a DataError where thresholds are those of another robot, limb or network, or of other friction."""
    check_drives(path, found.drives, robot)
    own = robot.layout.groups.get(found.limb, ())
    pairs = {
        "robot": (found.robot, robot.name),
        "joints": (found.joints, own),
        "network": (found.network or "none", network.fingerprint if network else "none"),
    }
    refuse(
        path,
        [f"made for {key} {held!r}, and {here!r} is given here" for key, (held, here) in pairs.items() if held != here],
    )
