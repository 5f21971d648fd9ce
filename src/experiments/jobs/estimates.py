"""The rule `estimate`: it runs methods on recordings, several side by side, and writes the external torque of each."""

import logging
from collections.abc import Iterator, Sequence
from pathlib import Path

from experiments.plan.parts import TOGETHER_S, MethodRun
from mobnet.core.files import WEIGHTS
from mobnet.core.notes import read_array_note
from mobnet.core.store import NOTE, file_of
from mobnet.estimation.estimate import ObservedRecording, only, rate_of, read_observed, run_segments, write_estimate
from mobnet.estimation.kinds import build_estimator
from mobnet.estimation.recipe import Recipe
from mobnet.formats.robot import RobotTable
from mobnet.learning.deployed.weights import std_scales
from mobnet.robot.description import describe
from mobnet.settings.methods import ObserverSettings
from mobnet.settings.surrogate import Level

log = logging.getLogger(__name__)


def estimate(
    robot: RobotTable,
    level: Level,
    gravity_m_s2: float,
    observer: ObserverSettings,
    runs: Sequence[MethodRun],
    recordings: Sequence[Path],
    residuals: Sequence[Path],
    out: Path,
    rate_hz: float | None = None,
) -> None:
    """Write the external torque of recordings made at an uncertainty level by several methods, as Table 5 scores it.

    Columns are `tau_ext.<joint>` [N, N m] and, where the method gives it, `std.<joint>`; segments are the recording's,
    and each is run from a fresh state. Recordings, read once for all methods, and their residuals are paths without a
    suffix, in the same order. Networks run at the rate [Hz] of their training alone; without it, any single one is
    accepted. In the folder `out` those of a method with the networks of seed 1 stand below `METHOD/n1`, by the names of
    the recordings.

    Raises:
        ConfigError: a method's kind is unknown, it has no such networks, or they do not estimate a joint.
        DataError: a recording, a residual, a network or the fit is damaged, or the rates differ.
    """
    layout = describe(robot).layout
    together = list(batches(recordings))
    done = 0
    for some in together:
        pairs = zip(recordings[some], residuals[some], strict=True)
        read = [read_observed(layout, recording, residual, rate_hz) for recording, residual in pairs]
        for run in runs:
            known = robot, level.nominal_mass_ratio, gravity_m_s2, observer
            recipe = Recipe(run.method, run.methods, *known, rate_of(read), run.networks, run.fitted)
            folder = out / run.method / f"n{run.network_seed}"
            done += 1
            log.info("run %d of %d, %s, networks %d", done, len(together) * len(runs), run.method, run.network_seed)
            _estimate(recipe, read, [folder / recording.name for recording in recordings[some]], run.joints)


def _estimate(
    recipe: Recipe, read: Sequence[ObservedRecording], outs: Sequence[Path], joints: Sequence[str] | None
) -> None:
    """Write what a method estimates of the joints, or of all that it estimates, in recordings."""
    estimator = build_estimator(recipe)
    shown = joints or estimator.joints
    note = {
        "method": recipe.name,
        "networks": {limb: folder.name for limb, folder in recipe.networks.items()},
        "std_scale": std_scales(folder / WEIGHTS for folder in recipe.networks.values()),
    }
    for recording, result, out in zip(read, run_segments(estimator, read), outs, strict=True):
        write_estimate(out, recording.recording, only(result, estimator.joints, shown), shown, recipe.layout, note)


def batches(recordings: Sequence[Path]) -> Iterator[slice]:
    """Yield which recordings run side by side: as many as fit into memory, or a single longer one."""
    start = 0
    held_s = 0.0
    for k, stem in enumerate(recordings):
        note = read_array_note(file_of(stem, NOTE))
        duration_s = note["rows"] / note["rate_hz"]
        if k > start and held_s + duration_s > TOGETHER_S:
            yield slice(start, k)
            start = k
            held_s = 0.0
        held_s += duration_s
    yield slice(start, len(recordings))
