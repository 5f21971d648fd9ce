"""Figure 19: what random torque exploration adds to the samples of training, and the torques by the gait's phase."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from experiments.evaluation.compare.windows import pushed_of
from experiments.evaluation.figures.style import entitle, save_figure
from experiments.evaluation.measure.data.conditional import HALF
from experiments.evaluation.measure.data.planes import TESTS, Plane, plane_of, read_samples
from experiments.settings.figures import Figure19
from experiments.settings.measures import Coverage
from mobnet.core.columns import PLANES, foot_of
from mobnet.core.joints import JointLayout
from mobnet.core.style import PAGE_INCH, STYLE, styled

ROW_INCH, LEGEND_INCH = 1.9, 0.35  # height of a row of panels and of the legend
FIRST, SECOND, TEST = "#D55E00", "#0072B2", "black"  # colours of the two training sets and of the tests
MORE = LinearSegmentedColormap.from_list("more", [SECOND, "white", FIRST])
SHOWN = 0.995  # quantile of the differences at which the colours end
SHADE, NOTE_POINTS = 0.25, 6.5  # opacity of a range; size of a note
DIFFERENCE = "with less without RTE\n[% of all samples]"
FINE = 20  # points along a cell's side for its outline


def figure_19(
    settings: Figure19,
    coverage: Coverage,
    layout: JointLayout,
    training: Mapping[str, Sequence[Path]],
    tests: Sequence[Sequence[Path]],
    figure_dir: Path,
) -> None:
    """Write Figure 19, samples in the plane of velocity [rad/s] and desired torque [N m], as PDF, PNG and CSV.

    The training sets are those with and without random torque exploration; the tests are taken together, with equally
    many samples of each.
    """
    joints = settings.joints
    share = settings.test_dots // len(tests)
    foot = foot_of(layout, layout.limb(coverage.limb)[0])
    sets = {name: read_samples(stems, joints, settings.dots, foot) for name, stems in training.items()}
    tested = [
        read_samples(stems, joints, share, foot, pushed_of(test, coverage))
        for test, stems in zip(coverage.tests, tests, strict=True)
    ]
    sets[TESTS] = np.concatenate(tested)
    planes = []
    for k, joint in enumerate(joints):
        own = {name: samples[:, k] for name, samples in sets.items()}
        planes.append(plane_of(joint, own, settings.outlined, coverage))
    rows = [row for plane in planes for row in plane.rows()]
    save_figure(draw_planes(planes, settings.outlined), figure_dir / "figure_19", PLANES, rows)


@styled
def draw_planes(planes: Sequence[Plane], outlined: float) -> Figure:
    """Draw a column for each joint: the difference of two training sets in the plane, and torque ranges by phase.

    The outline is that of the tests, of which it holds the share `outlined` [-].
    """
    figure = Figure(figsize=(PAGE_INCH, 2 * ROW_INCH + LEGEND_INCH), layout="constrained")
    axes = figure.subplots(2, len(planes), squeeze=False)
    # One scale of colours in all planes; a few extreme bins must not wash out the others.
    most = max(float(np.quantile(np.abs(plane.difference), SHOWN)) for plane in planes) or 1.0
    for k, (plane, above, below) in enumerate(zip(planes, *axes, strict=True)):
        drawn = _plane(above, plane, most)
        _ranges(below, plane)
        below.sharey(above)
        entitle(above, k, plane.joint)
        above.set_xlabel("velocity [rad/s]")
        below.set(xlabel="phase of the gait [-]", xlim=(0.0, 1.0))
        above.text(
            0.03, 0.97, f"{plane.common:.0f} % in common", transform=above.transAxes, va="top", fontsize=NOTE_POINTS
        )
        if k == len(planes) - 1:
            figure.colorbar(drawn, ax=axes[0].tolist(), label=DIFFERENCE, fraction=0.03, pad=0.01, aspect=25)
    for axis in axes[:, 0]:
        axis.set_ylabel("desired torque [N m]")
    _key(figure, list(planes[0].ranges), outlined)
    return figure


def _plane(axis: Axes, plane: Plane, most: float) -> Any:
    """Draw the difference [points] in the cells, up to `most` to each side, and the outline of the tests."""
    x, y = plane.edges
    drawn = axis.pcolormesh(x, y, plane.difference.T, cmap=MORE, vmin=-most, vmax=most, rasterized=True)
    inside = np.pad(np.kron(plane.outline.T, np.ones((FINE, FINE))), FINE)
    places = [
        np.interp(np.arange(inside.shape[1 - k]) / FINE - 1.0 + 0.5 / FINE, np.arange(len(edges)), edges)
        for k, edges in enumerate((x, y))
    ]
    if plane.outline.any():
        axis.contour(*places, inside, levels=[0.5], colors=TEST, linewidths=0.7)
    return drawn


def _ranges(axis: Axes, plane: Plane) -> None:
    """Draw the ranges of the torque [N m] over the phase of the gait [-]: one filled, the others as outlines."""
    colours = dict(zip(plane.ranges, (FIRST, SECOND, TEST), strict=True))
    for k, (name, found) in enumerate(plane.ranges.items()):
        edges = found.cells.edges[0]
        colour = colours[name]
        if k == 0:
            axis.stairs(found.high, edges, baseline=found.low, fill=True, color=colour, alpha=SHADE, lw=0)
        for end in (found.low, found.high):
            axis.stairs(end, edges, baseline=None, color=colour, linewidth=0.8)
    axis.axvline(HALF, color="0.6", linewidth=0.6, linestyle=(0, (2, 2)), zorder=0)
    for middle, name in ((HALF / 2.0, "swing"), ((1.0 + HALF) / 2.0, "stance")):
        axis.text(
            middle, 1.0, name, transform=axis.get_xaxis_transform(), ha="center", va="bottom", fontsize=NOTE_POINTS
        )


def _key(figure: Figure, sets: Sequence[str], outlined: float) -> None:
    """Put the legend above all: the two training sets, and the tests."""
    colours = dict(zip(sets, (FIRST, SECOND, TEST), strict=True))
    names = {
        name: f"training {name}" if name != TESTS else f"{TESTS}; outline: {outlined:.0%} of them" for name in sets
    }
    handles = [Line2D([], [], color=colours[name], linewidth=1.5, label=names[name]) for name in sets]
    figure.legend(
        handles=handles,
        loc="outside upper center",
        ncols=len(handles),
        frameon=False,
        fontsize=STYLE["legend.fontsize"],
        borderpad=0.0,
    )
