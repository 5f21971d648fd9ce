"""Whether networks know the robot that they run on: what their standard deviations cover, and what a check says."""

import numpy as np
from numpy.typing import NDArray

from experiments.evaluation.compare.pair import Measured, Measures, Pair, read_std
from experiments.evaluation.compare.rmse import parts
from experiments.evaluation.compare.scene import Scene
from experiments.settings.measures import Changed
from mobnet.learning.calibration import half_width, shares_inside
from mobnet.learning.swings import hanging

KNOWN = "known_share"
FREE = "free_share"
FLAGGED = "flagged_share"
FLAGS = "flags"
WATCHED = "watched"
HOUR_S = 3600.0


def measure(pair: Pair, scene: Scene, settings: Changed) -> Measures:
    """Yield what the standard deviations of a run say of the robot, `knowledge`; nothing where it has none."""
    return knowledge(pair, read_std(pair.run, pair.joints), scene, scene.asked.cover_share, settings)


def knowledge(pair: Pair, std: NDArray[np.float32] | None, scene: Scene, share: float, settings: Changed) -> Measures:
    """Yield what the standard deviations (T, n) [N m] of a leg's joints say of a robot: shares [-], and counts.

    `known_share`: errors within the central interval of a nominal share, which only the truth tells. `free_share`:
    estimates within it where the plan has the leg in the air, which a robot can see. `flagged_share`: windows of which
    the check says that these networks do not know this robot; `flags` is their number, `watched` the time of all
    windows [h]. Of an estimate without standard deviations there is nothing to tell.
    """
    if std is None:
        return
    error = pair.estimate.astype(np.float64) - pair.truth
    count = len(pair.joints)
    covered = np.abs(error) <= half_width(share) * std
    yield Measured(KNOWN, np.concatenate(parts(covered, pair.spans)).mean(axis=0))
    # Nothing touches a leg in the middle of its swing: there the estimate is the error, and a robot can see it.
    swing = scene.planned(pair.joints[0])
    free = hanging(swing, pair.spans, pair.rate_hz, (settings.lift_off_s, settings.landing_s))
    rows = round(settings.window_s * pair.rate_hz)
    shares = shares_inside(pair.estimate, std, free, pair.spans, rows, share)
    shares = shares[~np.isnan(shares)]
    if len(shares):
        flagged = shares < settings.least_share
        numbers = {FREE: shares.mean(), FLAGGED: flagged.mean(), FLAGS: flagged.sum()}
        for metric, value in (numbers | {WATCHED: len(shares) * settings.window_s / HOUR_S}).items():
            yield Measured(metric, np.full(count, value), average_only=True)
