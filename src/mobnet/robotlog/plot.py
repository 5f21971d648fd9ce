"""The residual of a log as a picture: one panel a limb."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from mobnet.core.arrays import Array
from mobnet.core.joints import JointLayout
from mobnet.evaluation.figures.style import PAGE_INCH, styled

MOST_POINTS = 4000  # of a line: more than a page shows
PANEL_INCH = 1.6


@styled
def plot_residual(
    rate_hz: float, segments: Sequence[tuple[int, int]], residual: Array, layout: JointLayout, stem: Path
) -> None:
    """Write the residual (T, nv) [N] and [N m] of a log over time as `stem.png`, one panel for each limb and unit.

    Time is counted in samples at the rate [Hz]; a line is broken where a segment ends.
    """
    from matplotlib.figure import Figure

    panels = [
        (limb, unit, [joint for joint in joints if layout.unit(joint) == unit])
        for limb, joints in layout.groups.items()
        for unit in ("N", "N m")
    ]
    panels = [panel for panel in panels if panel[2]]
    figure = Figure(figsize=(PAGE_INCH, PANEL_INCH * len(panels)), layout="constrained")
    step = max(1, len(residual) // MOST_POINTS)
    rows = np.arange(0, len(residual), step)
    ends = np.array([end for _, end in segments])
    breaks = np.searchsorted(ends, rows, side="right")
    axes = figure.subplots(len(panels), 1, sharex=True, squeeze=False)[:, 0]
    for axis, (limb, unit, joints) in zip(axes, panels, strict=True):
        for joint in joints:
            values = residual[rows, layout.names.index(joint)].copy()
            values[1:][np.diff(breaks) > 0] = np.nan
            axis.plot(rows / rate_hz, values, label=joint, linewidth=0.7)
        axis.set_ylabel(f"{limb}: residual [{unit}]")
        axis.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    axes[-1].set_xlim(0, len(residual) / rate_hz)
    axes[-1].set_xlabel("time [s]")
    figure.suptitle("residual of the momentum observer: external torque and error of the model", fontsize=8)
    figure.savefig(stem.with_suffix(".png"), metadata={"Software": None})
