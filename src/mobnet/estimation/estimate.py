"""The rule `estimate`: it runs a method on a recording and writes the external torque."""

import logging
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.columns import EXTERNAL, STD, Column, torque_columns
from mobnet.core.estimator import Estimate, Estimator
from mobnet.core.joints import JointLayout
from mobnet.core.recording import SensedRecording, read_sensed
from mobnet.core.store import check_rate, write_array
from mobnet.estimation.methods import build_estimator
from mobnet.estimation.observe import CARRIED
from mobnet.estimation.recipe import Recipe
from mobnet.learning.deployed.networks import load_network
from mobnet.robot.description import describe
from mobnet.settings.methods import Method, Observer
from mobnet.settings.plant import Level
from mobnet.settings.robot import RobotTable

log = logging.getLogger(__name__)


def estimate(
    robot: RobotTable,
    level: Level,
    gravity_m_s2: float,
    observer: Observer,
    method: str,
    methods: Mapping[str, Method],
    networks: Mapping[str, Path],
    fitted: Path | None,
    recording: Path,
    out: Path,
    rate_hz: float | None = None,
) -> None:
    """Write a method's external torque for a recording made at an uncertainty level, as Table 5 scores it.

    Columns are `tau_ext.<joint>` [N, N m] of the method's joints and, where the method gives it, `std.<joint>`;
    segments are the recording's, and each is run from a fresh state. `methods` holds the method and, if it runs on
    another one, that one too; `networks` the folder of each limb's network, and `fitted` is what rule `fit` wrote. The
    recording and `out` are paths without a suffix. Networks run at the rate [Hz] of their training alone; without it,
    any is accepted.

    Raises:
        ConfigError: the method's kind is unknown, or networks do not match the method's limbs.
        DataError: the recording, a network or the fit is damaged.
    """
    layout = describe(robot).layout
    check_rate(recording, rate_hz)
    read = read_sensed(recording, layout)
    recipe = Recipe(method, methods, robot, level, gravity_m_s2, observer, read.rate_hz, networks, fitted)
    estimator = build_estimator(recipe)
    array, columns = table_of(run_segments(estimator, read), estimator.joints, layout)
    meta = {
        "rate_hz": read.rate_hz,
        **{key: read.meta[key] for key in CARRIED if key in read.meta},
        "method": method,
        "networks": {limb: folder.name for limb, folder in networks.items()},
        "std_scale": std_scales(networks),
    }
    write_array(out, array, columns, meta, read.segments)
    log.info("%s: %s of %d samples, %d joints", out, method, len(array), len(estimator.joints))


def std_scales(networks: Mapping[str, Path]) -> dict[str, float]:
    """Return joint -> factor in its network's standard deviation, learned after its training."""
    return {
        joint: factor
        for network in map(load_network, networks.values())
        for joint, factor in zip(network.joints, network.std_scale.tolist(), strict=True)
    }


def run_segments(estimator: Estimator, recording: SensedRecording) -> Estimate:
    """Return the estimate (T, n) [N, N m] of all segments, each from a fresh state; zero outside of segments."""
    shape = (len(recording.sensed), len(estimator.joints))
    tau, std, has_std = np.zeros(shape), np.zeros(shape), False
    for span in recording.spans():
        part = estimator.estimate(recording.sensed[span])
        tau[span] = part.tau_ext
        if part.std is not None:
            std[span], has_std = part.std, True
    return Estimate(tau, std if has_std else None)


def table_of(result: Estimate, joints: Sequence[str], layout: JointLayout) -> tuple[NDArray[Any], list[Column]]:
    """Return the array (T, n) or (T, 2 n) [N, N m] and the columns that a file of estimates holds."""
    signals = {EXTERNAL: result.tau_ext} | ({} if result.std is None else {STD: result.std})
    return np.concatenate(list(signals.values()), axis=1), torque_columns(layout, signals, joints)
