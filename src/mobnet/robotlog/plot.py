"""The residual of a log as a picture: one panel a joint."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.core.files import atomic_path
from mobnet.core.joints import JointLayout
from mobnet.core.recording import Recording
from mobnet.core.style import PAGE_INCH, settle, styled
from mobnet.formats.limb_thresholds import LimbThresholds
from mobnet.robotlog.flags import Flag, stretches
from mobnet.robotlog.long_arrays import give_back

MOST_POINTS = 4000  # of a line, two for each stretch: more than a page shows
PANEL_INCH, EDGE_INCH, BETWEEN = 1.1, 0.5, 0.5  # height of a panel, edge of the page, and gap as a share of a panel
FOOT = 0.06  # height of the bar of a push, share of a panel
PALE, DARK = 0.2, 0.5  # opacity of a flag in all panels, and in that of its joint
LABELS = {"mean": "torque [N m]", "std": "sigma [N m]", "ratio": "torque / sigma [-]"}


@styled
def plot_residual(
    read: Recording, residual: Array, pushed: NDArray[np.bool_] | None, layout: JointLayout, stem: Path
) -> None:
    """Write the residual (T, nv) [N] and [N m] of a log over time as `stem.png`, one panel for each joint.

    Time is counted in samples; a line is broken where a segment ends. Of a long log it goes through the lowest and the
    highest value of each stretch that is narrower than a point of the page. Where the log tells when it was pushed
    (T,), bands show it.
    """
    from matplotlib.figure import Figure

    step = max(1, 2 * len(residual) // MOST_POINTS)
    parts = [_peaks(np.arange(start, end) / read.rate_hz, residual[start:end], step) for start, end in read.segments]
    give_back()
    gap = np.full((1, layout.nv), np.nan)
    times = np.concatenate([np.append(time_s, time_s[-1]) for time_s, _ in parts])
    shown = np.concatenate([np.concatenate([values, gap]) for _, values in parts])
    pushes = [] if pushed is None else stretches(pushed, read.segments, 0)
    height = PANEL_INCH * layout.nv + 2 * EDGE_INCH
    figure = Figure(figsize=(PAGE_INCH, height))
    figure.subplots_adjust(left=0.1, right=0.98, bottom=EDGE_INCH / height, top=1 - EDGE_INCH / height, hspace=BETWEEN)
    axes = figure.subplots(layout.nv, 1, sharex=True, squeeze=False)[:, 0]
    for k, (axis, joint) in enumerate(zip(axes, layout.names, strict=True)):
        for start, end in pushes:
            axis.axvspan(start / read.rate_hz, end / read.rate_hz, color="C1", alpha=0.3, linewidth=0)
        axis.plot(times, shown[:, k], linewidth=0.7)
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


@styled
def plot_flags(
    time_s: Array,
    segments: Sequence[tuple[int, int]],
    signals: Array,
    flags: Sequence[Flag],
    thresholds: LimbThresholds,
    pushed: NDArray[np.bool_] | None,
    stem: Path,
) -> None:
    """Write what is watched of a limb behind the low-pass (T, n) over time (T,) [s] as `stem.png`, a panel a joint.

    Thresholds are dashed on both sides of zero, flags are bands, darker in the panel of the joint that lies highest
    above its threshold; a line is broken where a segment ends. Where the log tells when it was pushed (T,), bars at the
    foot of each panel show it, so that a push that was missed is seen.
    """
    from matplotlib.figure import Figure
    from matplotlib.patches import Patch

    count = len(thresholds.joints)
    figure = Figure(figsize=(PAGE_INCH, PANEL_INCH * count + 0.4), layout="constrained")
    axes = figure.subplots(count, 1, squeeze=False, sharex=True)[:, 0]
    step = max(1, len(signals) // MOST_POINTS)
    pushes = [] if pushed is None else stretches(pushed, tuple(segments), 0)
    for k, (axis, joint, threshold) in enumerate(zip(axes, thresholds.joints, thresholds.thresholds, strict=True)):
        for number, (start, end) in enumerate(segments):
            times, values = _peaks(time_s[start:end], signals[start:end, k], step)
            axis.plot(times, values, linewidth=0.7, color="C0", label=None if number else "estimate")
        for side in (1.0, -1.0) if thresholds.signal != "std" else (1.0,):
            axis.axhline(side * threshold, linewidth=0.7, linestyle="--", color="0.3", label=_once("threshold", side))
        for start, end in pushes:
            axis.axvspan(time_s[start], time_s[end - 1], ymax=FOOT, color="0.2", linewidth=1.0)
        for flag in flags:
            alpha = DARK if flag.joint == joint else PALE
            axis.axvspan(flag.start_s, flag.end_s, color="C3", alpha=alpha, linewidth=1.0)
        axis.set_title(joint, loc="left", fontsize="medium")
        axis.set_ylabel(LABELS[thresholds.signal])
        axis.set_xlim(time_s[0], time_s[-1])
    lines, _ = axes[0].get_legend_handles_labels()
    bands = [
        Patch(color="C3", alpha=alpha, label=label)
        for alpha, label in ((DARK, "flag, highest at this joint"), (PALE, "flag, highest at another joint"))
    ]
    if pushes:
        bands.append(Patch(color="0.2", label="push"))
    axes[0].legend(handles=[*lines, *bands], loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=5, frameon=False)
    axes[-1].set_xlabel("time [s]")
    settle(figure)
    with atomic_path(stem.with_suffix(".png")) as temporary:
        figure.savefig(temporary, metadata={"Software": None})


def _once(label: str, side: float) -> str | None:
    """Return the label of the first of two lines."""
    return label if side > 0.0 else None


def _peaks(time_s: Array, values: Array, step: int) -> tuple[Array, Array]:
    """Return lowest and highest value of each `step` samples (T, ...), so that no short push is lost.

    The samples of a last stretch that is shorter are left out. Where the step is 1, all are returned.
    """
    whole = len(values) // step * step
    if step == 1 or not whole:
        return time_s, values
    parts = values[:whole].reshape(-1, step, *values.shape[1:])
    both = np.stack([parts.min(axis=1), parts.max(axis=1)], axis=1)
    return np.repeat(time_s[:whole:step], 2), both.reshape(-1, *values.shape[1:])
