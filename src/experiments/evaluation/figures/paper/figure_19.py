"""Figure 19: how wide random torque exploration makes the torques of training, by the phase of the gait."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from experiments.evaluation.compare.windows import pushed_of
from experiments.evaluation.figures.style import beside, entitle, save_figure
from experiments.evaluation.measure.data.conditional import HALF
from experiments.evaluation.measure.data.planes import TESTS, Plane, plane_of, read_samples
from experiments.settings.figures import Figure19
from experiments.settings.measures import Coverage
from experiments.settings.table_columns import PLANES
from mobnet.core.columns import foot_of
from mobnet.core.joints import JointLayout
from mobnet.core.style import STYLE, styled

HEIGHT_INCH = 2.2
FIRST, SECOND, TEST = "#D55E00", "#0072B2", "black"  # colours of the two training sets and of the tests
DASHES = ("-", (0, (4, 1)), (0, (1, 1)))  # of the same, in print without colour
SHADE, NOTE_POINTS = 0.25, 7.0  # opacity of a range; size of a note
NOTE_ROOM, BESIDE = 0.12, 0.03  # room of a note [of the axis]; of a name beside the middle [phase]


def figure_19(
    settings: Figure19,
    coverage: Coverage,
    layout: JointLayout,
    training: Mapping[str, Sequence[Path]],
    tests: Sequence[Sequence[Path]],
    figure_dir: Path,
) -> None:
    """Write Figure 19, ranges of the desired torque [N m] by phase, as PDF, PNG and CSV.

    The CSV file has the samples in the plane of velocity [rad/s] and torque, too.

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
    planes: list[Plane] = []
    for k, joint in enumerate(joints):
        of_joint = {name: samples[:, k] for name, samples in sets.items()}
        planes.append(plane_of(joint, of_joint, coverage))
    rows = [row for plane in planes for row in plane.rows()]
    save_figure(draw_ranges(planes), figure_dir / "figure_19", PLANES, rows)


@styled
def draw_ranges(planes: Sequence[Plane]) -> Figure:
    """Draw the torque ranges of each joint by phase, and the share of samples that two training sets have in common."""
    figure, axes = beside(len(planes), HEIGHT_INCH, sharex=True)
    for k, (plane, axis) in enumerate(zip(planes, axes, strict=True)):
        _ranges(axis, plane)
        entitle(axis, k, plane.joint)
        axis.set(xlabel="phase of the gait [-]", xlim=(0.0, 1.0))
        # Below all ranges, where the axis is made longer for it.
        low, high = axis.get_ylim()
        axis.set_ylim(low - NOTE_ROOM * (high - low), high)
        note = f"{plane.common:.0f} % of samples in common"
        axis.text(0.03, 0.03, note, transform=axis.transAxes, fontsize=NOTE_POINTS)
    axes[0].set_ylabel("desired torque [N m]")
    _key(figure, list(planes[0].ranges))
    return figure


def _ranges(axis: Axes, plane: Plane) -> None:
    """Draw the ranges of the torque [N m] over the phase of the gait [-]: one filled, the others as outlines."""
    for k, (torque_range, colour, dash) in enumerate(
        zip(plane.ranges.values(), (FIRST, SECOND, TEST), DASHES, strict=True)
    ):
        edges = torque_range.cells.edges[0]
        if k == 0:
            axis.stairs(torque_range.high, edges, baseline=torque_range.low, fill=True, color=colour, alpha=SHADE, lw=0)
        for end in (torque_range.low, torque_range.high):
            axis.stairs(end, edges, baseline=None, color=colour, linestyle=dash, linewidth=0.9)
    axis.axvline(HALF, color="0.6", linewidth=0.6, linestyle=(0, (2, 2)), zorder=0)
    above: Mapping[str, Any] = {"transform": axis.get_xaxis_transform(), "va": "bottom", "fontsize": NOTE_POINTS}
    axis.text(HALF - BESIDE, 1.0, "swing", ha="right", **above)
    axis.text(HALF + BESIDE, 1.0, "stance", ha="left", **above)


def _key(figure: Figure, sets: Sequence[str]) -> None:
    """Put the legend above all: the two training sets, and the tests."""
    handles: list[Line2D] = []
    for name, colour, dash in zip(sets, (FIRST, SECOND, TEST), DASHES, strict=True):
        label = name if name == TESTS else f"training {name}"
        handles.append(Line2D([], [], color=colour, linestyle=dash, linewidth=1.5, label=label))
    figure.legend(
        handles=handles,
        loc="outside upper center",
        ncols=len(handles),
        frameon=False,
        fontsize=STYLE["legend.fontsize"],
        borderpad=0.0,
    )
