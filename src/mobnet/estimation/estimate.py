"""The rule `estimate`: it runs methods on recordings, several side by side, and writes the external torque of each."""

import logging
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mobnet.core.columns import EXTERNAL, RESIDUAL, STD, Column, named, torque_columns
from mobnet.core.errors import ConfigError, DataError, not_accepted
from mobnet.core.estimator import Estimate, Estimator, Stretch, estimate_all
from mobnet.core.files import WEIGHTS
from mobnet.core.joints import JointLayout
from mobnet.core.notes import read_array_note
from mobnet.core.recording import SensedRecording, read_sensed
from mobnet.core.store import NOTE, check_pair, check_rate, file_of, files_of, read_array, write_array
from mobnet.estimation.methods import build_estimator
from mobnet.estimation.observe import CARRIED
from mobnet.estimation.recipe import Recipe
from mobnet.learning.deployed.weights import std_scales
from mobnet.plan.parts import MethodRun
from mobnet.plan.work import TOGETHER_S
from mobnet.robot.description import describe
from mobnet.running.stage import Stage
from mobnet.settings.methods import Observer
from mobnet.settings.robot import RobotTable
from mobnet.settings.surrogate import Level

log = logging.getLogger(__name__)


class Observed(NamedTuple):
    """The sensed part of a recording, and r of (9) where an observer has run over it, (T, nv) [N, N m]."""

    recording: SensedRecording
    residual: NDArray[np.float32] | None = None


def estimate(
    robot: RobotTable,
    level: Level,
    gravity_m_s2: float,
    observer: Observer,
    runs: Sequence[MethodRun],
    recordings: Sequence[Path],
    residuals: Sequence[Path],
    stage: Stage,
    rate_hz: float | None = None,
) -> None:
    """Write the external torque of recordings made at an uncertainty level by several methods, as Table 5 scores it.

    Columns are `tau_ext.<joint>` [N, N m] and, where the method gives it, `std.<joint>`; segments are the recording's,
    and each is run from a fresh state. Recordings, read once for all methods, and their residuals are paths without a
    suffix, in the same order. Networks run at the rate [Hz] of their training alone; without it, any single one is
    accepted. A job that was killed goes on with the method that it was at.

    Raises:
        ConfigError: a method's kind is unknown, it has no such networks, or they do not estimate a joint.
        DataError: a recording, a residual, a network or the fit is damaged, or the rates differ.
    """
    stage.begin()
    layout = describe(robot).layout
    for some in batches(recordings):
        waiting = [run for run in runs if not all(stage.has(files_of(out)) for out in run.outs[some])]
        pairs = zip(recordings[some], residuals[some], strict=True)
        read = [read_observed(layout, recording, residual, rate_hz) for recording, residual in pairs] if waiting else []
        for run in waiting:
            recipe = Recipe(
                run.method, run.methods, robot, level, gravity_m_s2, observer, rate_of(read), run.networks, run.fitted
            )
            _estimate(recipe, read, [stage.place(out) for out in run.outs[some]], run.joints)
    stage.publish(file for run in runs for out in run.outs for file in files_of(out))


def _estimate(recipe: Recipe, read: Sequence[Observed], outs: Sequence[Path], joints: Sequence[str] | None) -> None:
    """Write what a method estimates of the joints, or of all that it estimates, in recordings."""
    estimator = build_estimator(recipe)
    shown = joints or estimator.joints
    note = {
        "method": recipe.name,
        "networks": {limb: folder.name for limb, folder in recipe.networks.items()},
        "std_scale": std_scales(folder / WEIGHTS for folder in recipe.networks.values()),
    }
    for one, result, out in zip(read, run_segments(estimator, read), outs, strict=True):
        write_estimate(out, one.recording, only(result, estimator.joints, shown), shown, recipe.layout, note)


def batches(recordings: Sequence[Path]) -> Iterator[slice]:
    """Yield which recordings run side by side: as many as fit into memory, or a single longer one."""
    start, held_s = 0, 0.0
    for k, stem in enumerate(recordings):
        note = read_array_note(file_of(stem, NOTE))
        duration_s = note["rows"] / note["rate_hz"]
        if k > start and held_s + duration_s > TOGETHER_S:
            yield slice(start, k)
            start, held_s = k, 0.0
        held_s += duration_s
    yield slice(start, len(recordings))


def read_observed(layout: JointLayout, recording: Path, residual: Path, rate_hz: float | None = None) -> Observed:
    """Read what was sensed in a recording, and of its residual the columns of r alone, not those of the truth."""
    check_rate(recording, rate_hz)
    check_pair(recording, residual)
    return Observed(read_sensed(recording, layout), read_array(residual, named(RESIDUAL, layout.names))[0])


def rate_of(read: Sequence[Observed]) -> float:
    """Return the rate of recordings [Hz]; raise DataError where they have several."""
    rates = sorted({one.recording.rate_hz for one in read})
    if len(rates) != 1:
        raise DataError(f"recordings at {rates} Hz cannot be run together; accepted: one or more at a single rate")
    return rates[0]


def run_segments(estimator: Estimator, read: Sequence[Observed]) -> list[Estimate]:
    """Return the estimates (T_i, n) [N, N m] of recordings, each segment from a fresh state; zero outside of segments.

    All segments of all recordings run side by side where the estimator can do that.
    """
    spans = [(k, span) for k, one in enumerate(read) for span in one.recording.spans()]
    stretches = [
        Stretch(one.recording.sensed[span], None if one.residual is None else one.residual[span])
        for one, span in ((read[k], span) for k, span in spans)
    ]
    shapes = [(len(one.recording.sensed), len(estimator.joints)) for one in read]
    found = [(np.zeros(shape), np.zeros(shape)) for shape in shapes]
    has_std = False
    for (k, span), part in zip(spans, estimate_all(estimator, stretches), strict=True):
        found[k][0][span] = part.tau_ext
        if part.std is not None:
            found[k][1][span], has_std = part.std, True
    return [Estimate(tau, std if has_std else None) for tau, std in found]


def only(result: Estimate, held: Sequence[str], joints: Sequence[str]) -> Estimate:
    """Return some of the joints (n,) of an estimate; raise ConfigError where it does not hold one."""
    missing = [joint for joint in joints if joint not in held]
    if missing:
        raise ConfigError(not_accepted("joint to estimate", missing[0], held))
    columns = [held.index(joint) for joint in joints]
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
    log.info("%s: %d samples, %d joints", out, len(array), len(joints))


def table_of(result: Estimate, joints: Sequence[str], layout: JointLayout) -> tuple[NDArray[Any], list[Column]]:
    """Return the array (T, n) or (T, 2 n) [N, N m] and the columns that a file of estimates holds."""
    signals = {EXTERNAL: result.tau_ext} | ({} if result.std is None else {STD: result.std})
    return np.concatenate(list(signals.values()), axis=1), torque_columns(layout, signals, joints)
