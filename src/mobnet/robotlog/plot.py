"""The residual of a log as a picture: one panel a joint."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.core.files import atomic_path
from mobnet.core.joints import JointLayout
from mobnet.core.recording import Recording
from mobnet.core.style import PAGE_INCH, settle, styled
from mobnet.robotlog.flags import stretches

MOST_POINTS = 4000  # of a line: more than a page shows
PANEL_INCH, EDGE_INCH, BETWEEN = 1.1, 0.5, 0.5  # height of a panel, edge of the page, and gap as a share of a panel


@styled
def plot_residual(
    read: Recording, residual: Array, pushed: NDArray[np.bool_] | None, layout: JointLayout, stem: Path
) -> None:
    """Write the residual (T, nv) [N] and [N m] of a log over time as `stem.png`, one panel for each joint.

    Time is counted in samples; a line is broken where a segment ends. Where the log tells when it was pushed (T,),
    bands show it.
    """
    from matplotlib.figure import Figure

    step = max(1, len(residual) // MOST_POINTS)
    rows = np.arange(0, len(residual), step)
    ends = np.array([end for _, end in read.segments])
    breaks = np.flatnonzero(np.diff(np.searchsorted(ends, rows, side="right")) > 0) + 1
    pushes = [] if pushed is None else stretches(pushed, read.segments, 0)
    height = PANEL_INCH * layout.nv + 2 * EDGE_INCH
    figure = Figure(figsize=(PAGE_INCH, height))
    figure.subplots_adjust(left=0.1, right=0.98, bottom=EDGE_INCH / height, top=1 - EDGE_INCH / height, hspace=BETWEEN)
    axes = figure.subplots(layout.nv, 1, sharex=True, squeeze=False)[:, 0]
    for k, (axis, joint) in enumerate(zip(axes, layout.names, strict=True)):
        values = residual[rows, k].copy()
        values[breaks] = np.nan
        for start, end in pushes:
            axis.axvspan(start / read.rate_hz, end / read.rate_hz, color="C1", alpha=0.3, linewidth=0)
        axis.plot(rows / read.rate_hz, values, linewidth=0.7)
        axis.set_title(joint, loc="left", y=1.0)  # a place of its own: else the ticks of all panels are measured for it
        axis.set_ylabel(f"[{layout.unit(joint)}]")
    axes[-1].set_xlim(0, len(residual) / read.rate_hz)
    axes[-1].set_xlabel("time [s]")
    bands = "; bands: pushes" if pushes else ""
    text = f"residual of the momentum observer: external torque and error of the model{bands}"
    figure.suptitle(text, fontsize=8, y=1 - 0.2 / height)
    settle(figure)
    with atomic_path(stem.with_suffix(".png")) as temporary:
        figure.savefig(temporary, metadata={"Software": None})
