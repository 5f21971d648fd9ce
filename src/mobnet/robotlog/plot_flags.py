"""The estimate of a limb in a log as a picture: torque, thresholds and flags, one panel a joint."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from mobnet.core.arrays import Array
from mobnet.core.files import atomic_path
from mobnet.core.style import PAGE_INCH, settle, styled
from mobnet.robotlog.flags import Flag
from mobnet.robotlog.plot import MOST_POINTS, PANEL_INCH
from mobnet.settings.limb_thresholds import LimbThresholds

PALE, DARK = 0.2, 0.5  # opacity of a flag in all panels, and in that of its joint
LABELS = {"mean": "torque [N m]", "std": "sigma [N m]", "ratio": "torque / sigma [-]"}


@styled
def plot_flags(
    time_s: Array,
    segments: Sequence[tuple[int, int]],
    signals: Array,
    flags: Sequence[Flag],
    found: LimbThresholds,
    stem: Path,
) -> None:
    """Write what is watched of a limb behind the low-pass (T, n) over time (T,) [s] as `stem.png`, a panel a joint.

    Thresholds are dashed on both sides of zero, flags are bands, darker in the panel of the joint that lies highest
    above its threshold; a line is broken where a segment ends.
    """
    from matplotlib.figure import Figure
    from matplotlib.patches import Patch

    count = len(found.joints)
    figure = Figure(figsize=(PAGE_INCH, PANEL_INCH * count + 0.4), layout="constrained")
    axes = figure.subplots(count, 1, squeeze=False, sharex=True)[:, 0]
    step = max(1, len(signals) // MOST_POINTS)
    for k, (axis, joint, threshold) in enumerate(zip(axes, found.joints, found.thresholds, strict=True)):
        for number, (start, end) in enumerate(segments):
            times, values = _peaks(time_s[start:end], signals[start:end, k], step)
            axis.plot(times, values, linewidth=0.7, color="C0", label=None if number else "estimate")
        for side in (1.0, -1.0) if found.signal != "std" else (1.0,):
            axis.axhline(side * threshold, linewidth=0.7, linestyle="--", color="0.3", label=_once("threshold", side))
        for flag in flags:
            alpha = DARK if flag.joint == joint else PALE
            axis.axvspan(flag.start_s, flag.end_s, color="C3", alpha=alpha, linewidth=1.0)
        axis.set_title(joint, loc="left", fontsize="medium")
        axis.set_ylabel(LABELS[found.signal])
        axis.set_xlim(time_s[0], time_s[-1])
    lines, _ = axes[0].get_legend_handles_labels()
    bands = [
        Patch(color="C3", alpha=alpha, label=label)
        for alpha, label in ((DARK, "flag, highest at this joint"), (PALE, "flag, highest at another joint"))
    ]
    axes[0].legend(handles=[*lines, *bands], loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=4, frameon=False)
    axes[-1].set_xlabel("time [s]")
    settle(figure)
    with atomic_path(stem.with_suffix(".png")) as temporary:
        figure.savefig(temporary, metadata={"Software": None})


def _once(label: str, side: float) -> str | None:
    """Return the label of the first of two lines."""
    return label if side > 0.0 else None


def _peaks(time_s: Array, values: Array, step: int) -> tuple[Array, Array]:
    """Return lowest and highest value of each `step` samples, so that no short push is lost; all where it is 1."""
    whole = len(values) // step * step
    if step == 1 or not whole:
        return time_s, values
    parts = values[:whole].reshape(-1, step)
    both = np.stack([parts.min(axis=1), parts.max(axis=1)], axis=1)
    return np.repeat(time_s[:whole:step], 2), both.ravel()
