"""The rule `observe`: from a recording to the observer's residual and the torque it should have followed."""

from __future__ import annotations

import logging
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.errors import ConfigError, DataError, not_accepted
from mobnet.core.joints import JointLayout
from mobnet.core.recording import Column, Recording, SensedRecording, recording_columns
from mobnet.core.store import read_recording, write_array
from mobnet.estimation.observer import MomentumObserver, low_pass
from mobnet.robot.description import RobotDescription, load_robot
from mobnet.robot.nominal import NominalModel

CARRIED = ("scenario", "level", "seed")  # what a recording says of itself and its residual repeats
log = logging.getLogger(__name__)


def observe(config: Mapping[str, Any], recording_stem: Path, out_stem: Path) -> None:
    """Write r of (9) and the low-passed external torque of (15) for a recording, 2 x (T, nv) [N] and [N m].

    Columns are `r.<joint>` and then `tau_ext_lp.<joint>`; segments are the recording's, and the observer starts anew
    with each. The target of the networks (section 4.2.3) is their difference.

    Args:
        config: the resolved configuration.
        recording_stem: the recording, path without a suffix.
        out_stem: where to write, path without a suffix.

    Raises:
        DataError: the recording is damaged or does not name its level.
        ConfigError: its level is not configured.
    """
    robot = load_robot(Path(config["robot"]))
    recording = read_recording(recording_stem, robot.layout)
    observer = observer_of(config, robot, level_of(recording, recording_stem), recording.rate_hz)
    log.info("%s: %d samples in %d segments", recording_stem, len(recording.sensed), len(recording.segments))
    array = np.concatenate(residual_and_truth(observer, recording), axis=1)
    meta = {
        "rate_hz": recording.rate_hz,
        **{key: recording.meta[key] for key in CARRIED if key in recording.meta},
        "gain_hz": observer.gain_hz,
        "nominal_mass_ratio": observer.nominal.mass_ratio,
    }
    write_array(out_stem, array, residual_columns(robot.layout), meta, recording.segments)


def observer_of(config: Mapping[str, Any], robot: RobotDescription, level: str, rate_hz: float) -> MomentumObserver:
    """Return the observer that knows the robot as an uncertainty level of section 5.1 says.

    Raises:
        ConfigError: the level is not configured.
    """
    if level not in config["levels"]:
        raise ConfigError(not_accepted("level", level, config["levels"]))
    ratio = config["levels"][level]["nominal_mass_ratio"]
    nominal = NominalModel(robot, ratio, config["plant"]["gravity_m_s2"])
    return MomentumObserver(nominal, config["observer"]["gain_hz"], rate_hz)


def level_of(recording: SensedRecording, stem: Path) -> str:
    """Return the uncertainty level a recording was made at.

    Raises:
        DataError: the recording does not say.
    """
    if "level" not in recording.meta:
        raise DataError(f"{stem}.json: key 'level' is missing; it holds {', '.join(recording.meta)}")
    return recording.meta["level"]


def residual_and_truth(
    observer: MomentumObserver, recording: Recording
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return r of (9) and the low-passed external torque, (T, nv) each [N] and [N m], every segment on its own."""
    residual, truth = np.zeros(recording.sensed.v.shape), np.zeros(recording.sensed.v.shape)
    for span in recording.spans():
        residual[span] = observer.residual(recording.sensed[span])
        truth[span] = low_pass(recording.truth.tau_ext[span], observer.gain_hz, recording.rate_hz)
    return residual, truth


def residual_columns(layout: JointLayout) -> list[Column]:
    """Return name, unit and frame of the columns of a residual file, (2 nv,)."""
    torque = recording_columns(layout)["tau_ext"]
    return [
        (f"{quantity}.{joint}", unit, frame)
        for quantity in ("r", "tau_ext_lp")
        for joint, (_, unit, frame) in zip(layout.names, torque, strict=True)
    ]
