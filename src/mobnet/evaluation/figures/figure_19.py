"""Figure 19: velocities and torques of joints in training and in the tests."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from mobnet.core.columns import DESIRED, DOTS, VELOCITY
from mobnet.core.store import read_array
from mobnet.evaluation.figures.style import PAGE_INCH, STYLE, entitle, legend, looks, save_figure
from mobnet.evaluation.measure.windows import Pushed, evenly, pushed_of
from mobnet.evaluation.number.files import write_csv
from mobnet.settings.evaluation import Coverage, Figure19

CLOUD_INCH = 2.0  # height of a row
TEST_COLOUR = "black"
DOT, MARKER = 1.6, 4.0  # size of a dot [points^2]; how much larger it is in the legend


@dataclass(frozen=True)
class Cloud:
    """One panel of Figure 19, in the column of its joint and in the row and colour of its training set.

    Dots are joint velocity [rad/s] and desired torque [N m], of training (n, 2) and, drawn over it, of the tests (m,
    2).
    """

    joint: str
    training: str
    dots: NDArray[Any]
    test: NDArray[Any]


def draw_clouds(clouds: Sequence[Cloud], test: str) -> Figure:
    """Draw desired torque [N m] over joint velocity [rad/s], a column for each joint, a row for each training set.

    The tests' dots have the label `test`.
    """
    joints, sets = (list(dict.fromkeys(getattr(cloud, key) for cloud in clouds)) for key in ("joint", "training"))
    styles = looks(sets)
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(PAGE_INCH, CLOUD_INCH * len(sets)), layout="constrained")
        axes = figure.subplots(len(sets), len(joints), sharex="col", sharey="col", squeeze=False)
        for cloud in clouds:
            row, column = sets.index(cloud.training), joints.index(cloud.joint)
            _scatter(axes[row, column], cloud.dots, styles[cloud.training].colour, f"training {cloud.training}")
            _scatter(axes[row, column], cloud.test, TEST_COLOUR, test)
        for k, (joint, axis) in enumerate(zip(joints, axes[0], strict=True)):
            entitle(axis, k, joint)
        for axis in axes[-1]:
            axis.set_xlabel("velocity [rad/s]")
        for axis in axes[:, 0]:
            axis.set_ylabel("desired torque [N m]")
        legend(figure, axes[:, 0].tolist(), last=test, markerscale=MARKER)
    return figure


def _scatter(axis: Axes, dots: NDArray[Any], colour: str, label: str) -> None:
    """Draw dots (n, 2) as pixels: thousands of vector dots would make a slow page."""
    axis.scatter(dots[:, 0], dots[:, 1], s=DOT, c=colour, linewidths=0, label=label, rasterized=True)


def figure_19(
    settings: Figure19, coverage: Coverage, training: Mapping[str, Sequence[Path]], tests: Sequence[Sequence[Path]],
    figure_dir: Path,
) -> None:  # fmt: skip
    """Write Figure 19, desired torque [N m] over velocity [rad/s] of some joints, as PDF, PNG and CSV.

    Each training set has a row of panels; the tests are shown together, each with the same number of dots.
    """
    joints, share = settings.joints, settings.test_dots // len(tests)
    learnt = {name: read_dots(stems, joints, settings.dots) for name, stems in training.items()}
    tested = {
        test.scenario: read_dots(stems, joints, share, pushed_of(test, coverage))
        for test, stems in zip(coverage.tests, tests, strict=True)
    }
    together = np.concatenate(list(tested.values()))
    clouds = [
        Cloud(joint, name, dots[:, k], together[:, k])
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
    write_csv(figure_dir / "figure_19.csv", DOTS, rows)
    save_figure(draw_clouds(clouds, "test"), figure_dir / "figure_19")


def read_dots(
    stems: Sequence[Path], joints: Sequence[str], count: int, pushed: Pushed | None = None
) -> NDArray[np.float32]:
    """Return velocity [rad/s] and desired torque [N m] of joints at evenly spread samples (n, joints, 2).

    At most `count` of all recordings together are taken, around pushes only where those are given.
    """
    names = [f"{quantity}.{joint}" for joint in joints for quantity in (VELOCITY, DESIRED)]
    arrays = []
    for stem in stems:
        array, meta = read_array(stem, names)
        spans = pushed.spans(stem) if pushed else meta["segments"]
        arrays += [array[start:end] for start, end in spans]
    together = np.concatenate([*arrays, np.zeros((0, len(names)), dtype=np.float32)])
    return together[evenly(len(together), count)].reshape(-1, len(joints), 2)
