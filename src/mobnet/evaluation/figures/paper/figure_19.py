"""Figure 19: velocities and torques of joints in training and in the tests, and their torques by the gait's phase."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from mobnet.core.columns import DESIRED, DOTS, SWING, VELOCITY, foot_of
from mobnet.core.joints import JointLayout
from mobnet.core.store import read_array
from mobnet.evaluation.compare.windows import FLAG, Pushed, evenly, pushed_of
from mobnet.evaluation.figures.style import PAGE_INCH, entitle, legend, looks, save_figure, styled
from mobnet.evaluation.measure.data.conditional import HALF, TorqueRange, even_cells, gait_phase, torque_range
from mobnet.settings.evaluation import Coverage, Figure19

CLOUD_INCH = 2.0  # height of a row
TEST_COLOUR = "black"
DOT, MARKER = 1.6, 4.0  # size of a dot [points^2]; how much larger it is in the legend
SHADE = 0.35  # opacity of a range by phase


@dataclass(frozen=True)
class Cloud:
    """One panel of Figure 19, in the column of its joint and in the row and colour of its training set.

    Dots are joint velocity [rad/s], desired torque [N m] and phase of the gait [-], of training (n, 3) and, drawn over
    it, of the tests (m, 3). The range is that of the training's torque by phase.
    """

    joint: str
    training: str
    dots: NDArray[Any]
    test: NDArray[Any]
    range: TorqueRange


@styled
def draw_clouds(clouds: Sequence[Cloud], test: str) -> Figure:
    """Draw desired torque [N m] over joint velocity [rad/s], a column for each joint, a row for each training set.

    Below, the central range of the torque [N m] over the phase of the gait [-], all training sets in one panel. The
    tests' dots have the label `test`.
    """
    joints, sets = (list(dict.fromkeys(getattr(cloud, key) for cloud in clouds)) for key in ("joint", "training"))
    styles = looks(sets)
    figure = Figure(figsize=(PAGE_INCH, CLOUD_INCH * (len(sets) + 1)), layout="constrained")
    axes = figure.subplots(len(sets) + 1, len(joints), sharey="col", squeeze=False)
    for cloud in clouds:
        row, column = sets.index(cloud.training), joints.index(cloud.joint)
        colour = styles[cloud.training].colour
        axes[row, column].sharex(axes[0, column])
        _scatter(axes[row, column], cloud.dots[:, :2], colour, f"training {cloud.training}")
        _scatter(axes[row, column], cloud.test[:, :2], TEST_COLOUR, test)
        _shade(axes[-1, column], cloud.range, colour)
        if row == len(sets) - 1:
            _scatter(axes[-1, column], cloud.test[:, [2, 1]], TEST_COLOUR, test)
            axes[row, column].set_xlabel("velocity [rad/s]")
            axes[-1, column].set_xlabel(f"phase: swing to {HALF:g}, then stance")
    for k, (joint, axis) in enumerate(zip(joints, axes[0], strict=True)):
        entitle(axis, k, joint)
    for axis in axes[:, 0]:
        axis.set_ylabel("desired torque [N m]")
    legend(figure, axes[:, 0].tolist(), last=test, markerscale=MARKER)
    return figure


def _scatter(axis: Axes, dots: NDArray[Any], colour: str, label: str) -> None:
    """Draw dots (n, 2) as pixels: thousands of vector dots would make a slow page."""
    axis.scatter(dots[:, 0], dots[:, 1], s=DOT, c=colour, linewidths=0, label=label, rasterized=True)


def _shade(axis: Axes, torque: TorqueRange, colour: str) -> None:
    """Shade a range of the torque [N m] over the phase of the gait [-]."""
    axis.stairs(torque.high, torque.cells.edges[0], baseline=torque.low, fill=True, color=colour, alpha=SHADE, lw=0)


def figure_19(
    settings: Figure19, coverage: Coverage, layout: JointLayout, training: Mapping[str, Sequence[Path]],
    tests: Sequence[Sequence[Path]], figure_dir: Path,
) -> None:  # fmt: skip
    """Write Figure 19, desired torque [N m] over velocity [rad/s] of some joints, and by phase, as PDF, PNG and CSV.

    Each training set has a row of panels; the tests are shown together, each with the same number of dots. The range by
    phase is that of the dots shown.
    """
    joints, share = settings.joints, settings.test_dots // len(tests)
    foot = foot_of(layout, layout.limb(coverage.limb)[0])
    learnt = {name: read_dots(stems, joints, settings.dots, foot) for name, stems in training.items()}
    tested = {
        test.scenario: read_dots(stems, joints, share, foot, pushed_of(test, coverage))
        for test, stems in zip(coverage.tests, tests, strict=True)
    }
    together = np.concatenate(list(tested.values()))
    clouds = [
        Cloud(joint, name, dots[:, k], together[:, k], range_of(dots[:, k], coverage))
        for name, dots in learnt.items()
        for k, joint in enumerate(joints)
    ]
    rows = [
        (kind, name, joint, *dot)
        for kind, sets in (("training", learnt), ("test", tested))
        for name, dots in sets.items()
        for k, joint in enumerate(joints)
        for dot in dots[:, k].tolist()
    ]
    save_figure(draw_clouds(clouds, "test"), figure_dir / "figure_19", DOTS, rows)


def range_of(dots: NDArray[Any], coverage: Coverage) -> TorqueRange:
    """Return the central range by phase of the torque of dots (n, 3): velocity, torque [N m], phase [-]."""
    cells = even_cells([(0.0, 1.0)], [coverage.phases])
    return torque_range(cells, dots[:, 2:], dots[:, 1], coverage.range, coverage.cell_samples)


def read_dots(
    stems: Sequence[Path], joints: Sequence[str], count: int, foot: str, pushed: Pushed | None = None
) -> NDArray[np.float32]:
    """Return velocity [rad/s], desired torque [N m] and phase [-] at evenly spread samples (n, joints, 3).

    The phase is that of a foot's gait. At most `count` samples of all recordings together are taken, where the phase is
    known, and around pushes only where those are given.
    """
    names = [f"{SWING}.{foot}", *(f"{quantity}.{joint}" for joint in joints for quantity in (VELOCITY, DESIRED))]
    arrays = [np.zeros((0, len(joints), 3), dtype=np.float32)]
    for stem in stems:
        array, meta = read_array(stem, names)
        phase = gait_phase(array[:, 0] > FLAG, meta["segments"]).astype(np.float32)
        both = array[:, 1:].reshape(len(array), len(joints), 2)
        dots = np.concatenate([both, np.broadcast_to(phase[:, None, None], (*both.shape[:2], 1))], axis=2)
        spans = pushed.spans(stem) if pushed else meta["segments"]
        arrays += [dots[start:end][np.isfinite(phase[start:end])] for start, end in spans]
    together = np.concatenate(arrays)
    return together[evenly(len(together), count)]
