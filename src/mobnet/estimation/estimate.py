"""A method on recordings, several side by side: what it reads, what it estimates and what is written."""

import logging
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mobnet.core.columns import EXTERNAL, RESIDUAL, STD, Column, named, torque_columns
from mobnet.core.errors import ConfigError, DataError, not_accepted
from mobnet.core.estimator import Estimate, Stretch, TorqueEstimator, estimate_all
from mobnet.core.joints import JointLayout
from mobnet.core.recording import SensedRecording
from mobnet.core.recording_file import read_sensed
from mobnet.core.store import check_pair, check_rate, read_array, write_array
from mobnet.estimation.observe import CARRIED

log = logging.getLogger(__name__)


class ObservedRecording(NamedTuple):
    """The sensed part of a recording, and r of (9) where an observer has run over it, (T, nv) [N, N m]."""

    recording: SensedRecording
    residual: NDArray[np.float32] | None = None


def read_observed(
    layout: JointLayout, recording: Path, residual: Path, rate_hz: float | None = None
) -> ObservedRecording:
    """Read what was sensed in a recording, and of its residual the columns of r alone, not those of the truth."""
    check_rate(recording, rate_hz)
    check_pair(recording, residual)
    return ObservedRecording(read_sensed(recording, layout), read_array(residual, named(RESIDUAL, layout.names))[0])


def rate_of(read: Sequence[ObservedRecording]) -> float:
    """Return the rate of recordings [Hz]; raise DataError where they have several."""
    rates = sorted({recording.recording.rate_hz for recording in read})
    if len(rates) != 1:
        raise DataError(f"recordings at {rates} Hz cannot be run together; accepted: one or more at a single rate")
    return rates[0]


def run_segments(estimator: TorqueEstimator, read: Sequence[ObservedRecording]) -> list[Estimate]:
    """Return the estimates (T_i, n) [N, N m] of recordings, each segment from a fresh state; zero outside of segments.

    All segments of all recordings run side by side where the estimator can do that.
    """
    spans = list[tuple[int, slice]]()
    stretches = list[Stretch]()
    for k, recording in enumerate(read):
        for span in recording.recording.spans():
            residual = None if recording.residual is None else recording.residual[span]
            spans.append((k, span))
            stretches.append(Stretch(recording.recording.sensed[span], residual))
    shapes = [(len(recording.recording.sensed), len(estimator.joints)) for recording in read]
    estimates = [(np.zeros(shape), np.zeros(shape)) for shape in shapes]
    has_std = False
    for (k, span), part in zip(spans, estimate_all(estimator, stretches), strict=True):
        estimates[k][0][span] = part.tau_ext
        if part.std is not None:
            estimates[k][1][span] = part.std
            has_std = True
    return [Estimate(tau, std if has_std else None) for tau, std in estimates]


def only(result: Estimate, estimated: Sequence[str], joints: Sequence[str]) -> Estimate:
    """Return some of the joints (n,) of an estimate; raise ConfigError where it does not hold one."""
    missing = [joint for joint in joints if joint not in estimated]
    if missing:
        raise ConfigError(not_accepted("joint to estimate", missing[0], estimated))
    columns = [estimated.index(joint) for joint in joints]
    return Estimate(result.tau_ext[:, columns], None if result.std is None else result.std[:, columns])


def write_estimate(
    out: Path,
    recording: SensedRecording,
    result: Estimate,
    joints: Sequence[str],
    layout: JointLayout,
    note: Mapping[str, object],
) -> None:
    """Write the estimate of a recording, (T, n) [N, N m], with a note of the method beside what the recording says."""
    array, columns = table_of(result, joints, layout)
    carried = {key: recording.meta[key] for key in CARRIED if key in recording.meta}
    write_array(out, array, columns, {"rate_hz": recording.rate_hz, **carried, **note}, recording.segments)
    log.info("%s: %d samples, %d joints", out.name, len(array), len(joints))


def table_of(result: Estimate, joints: Sequence[str], layout: JointLayout) -> tuple[NDArray[Any], list[Column]]:
    """Return the array (T, n) or (T, 2 n) [N, N m] and the columns that a file of estimates holds."""
    signals = {EXTERNAL: result.tau_ext} | ({} if result.std is None else {STD: result.std})
    return np.concatenate(list(signals.values()), axis=1), torque_columns(layout, signals, joints)
