"""A panel of estimates beside the errors that they make in it."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from experiments.evaluation.compare.curves import Panel, TorqueCurve
from experiments.plan.runs import Run

ZERO = "zero"  # the method that estimates no torque at all: its error is the torque


@dataclass(frozen=True)
class Compared:
    """Truth, or target, and estimates of a joint, and their errors: estimate minus truth [N m], V1..V3 [N].

    `rmse` leads from each estimate, and from `zero`, to the root mean square of its error in the panel [same unit].
    """

    torque: Panel
    error: Panel
    rmse: Mapping[str, float]


def compared(panel: Panel, during: str = "") -> Compared:
    """Return a panel whose first curve is the truth, or the target, with the errors of all other curves.

    An error keeps the standard deviation of its estimate. Where a flag is named, its RMSE is that while the flag holds.
    """
    truth, *estimates = panel.curves
    errors = [TorqueCurve(curve.label, curve.values - truth.values, curve.std) for curve in estimates]
    # An estimate of zero has the torque as its error, up to its sign, of which the RMSE knows nothing.
    shown = {ZERO: truth.values, **{error.label: error.values for error in errors}}
    counted = panel.flags[during].astype(bool) if during else np.ones(len(panel.time), dtype=bool)
    rmse = {
        label: float(np.sqrt(np.mean(values[counted].astype(np.float64) ** 2)))
        for label, values in shown.items()
        if counted.any()
    }
    return Compared(panel, replace(panel, curves=errors), rmse)


def without_zero(runs: Iterable[Run]) -> list[Run]:
    """Return the runs whose estimates are drawn as curves."""
    return [run for run in runs if run.method != ZERO]
