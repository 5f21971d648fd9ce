"""The rule `estimate`: from a recording and trained networks to a method's external torque."""

from __future__ import annotations

import logging
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.config import load_layout
from mobnet.core.estimator import Estimate, Estimator
from mobnet.core.joints import JointLayout
from mobnet.core.recording import Column, SensedRecording, recording_columns
from mobnet.core.store import read_sensed, write_array
from mobnet.estimation.methods import build_estimator
from mobnet.estimation.observe import CARRIED, level_of
from mobnet.learning.networks import load_network

log = logging.getLogger(__name__)


def estimate(
    config: Mapping[str, Any],
    method: str,
    recording_stem: Path,
    network_dirs: Mapping[str, Path],
    out_stem: Path,
    fitted: Path | None = None,
) -> None:
    """Write a method's external torque for a recording, as Table 5 scores it.

    Columns are `tau_ext.<joint>` [N, N m] of the method's joints and, from a method that has them, `std.<joint>`;
    segments are the recording's, and each is run from a fresh state.

    Args:
        config: resolved configuration.
        method: row of its methods.
        recording_stem: the recording, path without a suffix.
        network_dirs: limb -> folder of its trained network; empty for MOB.
        out_stem: where to write, path without a suffix.
        fitted: what rule `fit` wrote, for a method that is fitted without networks.

    Raises:
        ConfigError: method or level is unknown, or networks do not match the method's limbs.
        DataError: the recording, a network or the fit is damaged.
    """
    layout = load_layout(Path(config["robot"]))
    recording = read_sensed(recording_stem, layout)
    level = level_of(recording, recording_stem)
    estimator = build_estimator(config, method, network_dirs, level, recording.rate_hz, fitted)
    array, columns = table_of(run_segments(estimator, recording), estimator.joints, layout)
    meta = {
        "rate_hz": recording.rate_hz,
        **{key: recording.meta[key] for key in CARRIED if key in recording.meta},
        "method": method,
        "networks": {limb: folder.name for limb, folder in network_dirs.items()},
        "std_scale": std_scales(network_dirs),
    }
    write_array(out_stem, array, columns, meta, recording.segments)
    log.info("%s: %s of %d samples, %d joints", out_stem, method, len(array), len(estimator.joints))


def std_scales(network_dirs: Mapping[str, Path]) -> dict[str, float]:
    """Return joint -> factor [-] that is in its networks' standard deviation, learned after their training."""
    networks = [load_network(folder) for folder in network_dirs.values()]
    return {
        joint: factor
        for network in networks
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
    described = dict(zip(layout.names, recording_columns(layout)["tau_ext"], strict=True))
    quantities = {"tau_ext": result.tau_ext} | ({} if result.std is None else {"std": result.std})
    columns = [(f"{name}.{joint}", *described[joint][1:]) for name in quantities for joint in joints]
    return np.concatenate(list(quantities.values()), axis=1), columns
