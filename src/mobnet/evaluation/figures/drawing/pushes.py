"""Curves around pushes above the bars of their errors (Figures 6 and 10)."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from mobnet.core.columns import PUSH_ERRORS
from mobnet.evaluation.compare.curves import Panel
from mobnet.evaluation.figures.drawing.bars import BarPanel, draw_bar_panel
from mobnet.evaluation.figures.drawing.curves import LEGEND_INCH, draw_panel, table_of
from mobnet.evaluation.figures.style import COLUMN_INCH, PAGE_INCH, entitle, legend, save_figure, styled
from mobnet.evaluation.measure.estimates.pushes import INCREASE, PushErrors
from mobnet.evaluation.number.files import write_csv

MINUS = "\N{MINUS SIGN}"
CURVES_INCH, BARS_INCH = 1.4, 1.7  # height of a row of curves and of the bars
LEGEND_COLUMNS = 4  # entries in a row, in one column of the paper


@dataclass(frozen=True)
class PushGroup:
    """Curves of the pushes of a test, a panel each, and the errors of each method [N m] with a title of their own."""

    scenario: str
    panels: Sequence[Panel]
    errors: PushErrors
    title: str
    source: str = "paper"

    def bars(self) -> BarPanel:
        """Return the errors as bars [N m]: a group for each push and for their average, in each a bar for each method.

        Above the last bar of a method its error is written and, where it is known, the increase.
        """
        shown = {method: {k: n for k, n in own.items() if k != INCREASE} for method, own in self.errors.items()}
        notes = {}
        for method, own in self.errors.items():
            *_, last = shown[method].values()
            more = f" ({own[INCREASE].value:+.1f})" if INCREASE in own else ""
            notes[method] = [""] * (len(shown[method]) - 1) + [(last.text(1) + more).replace("-", MINUS)]
        groups = list(dict.fromkeys(push for own in shown.values() for push in own))
        return BarPanel(self.title, groups, {k: list(own.values()) for k, own in shown.items()}, self.source, notes)


def save_pushes(groups: Sequence[PushGroup], joint: str, stem: Path) -> None:
    """Write curves and errors [N m] as CSV, and the figure."""
    rows = [
        (group.scenario, method, push, *error.with_ends, *error.spread, error.published)
        for group in groups for method, own in group.errors.items() for push, error in own.items()
    ]  # fmt: skip
    across, note_deg = (1, 0) if len(groups) == 1 else (2, 90)
    write_csv(stem.with_name(f"{stem.name}_bars.csv"), PUSH_ERRORS, rows)
    panels = [panel for group in groups for panel in group.panels]
    save_figure(draw_pushes(groups, joint, across, note_deg), stem, *table_of(panels))


@styled
def draw_pushes(groups: Sequence[PushGroup], joint: str, across: int = 1, note_deg: int = 0) -> Figure:
    """Draw groups side by side, one in one column of the paper and more in two: curves, and their bars below.

    Curves [N m] are over time from the push [s], `across` of them in a row of a group; notes at bars have an angle
    [deg].
    """
    rows = max(1, *(-(-len(group.panels) // across) for group in groups))
    places: list[Any] = [
        [f"{k}.{row * across + i}" for k in range(len(groups)) for i in range(across)] for row in range(rows)
    ]
    places.append([f"{k}.bars" for k in range(len(groups)) for _ in range(across)])
    size = COLUMN_INCH if len(groups) == 1 else PAGE_INCH, CURVES_INCH * rows + BARS_INCH + LEGEND_INCH
    figure = Figure(figsize=size, layout="constrained")
    axes = figure.subplot_mosaic(places, height_ratios=[*[CURVES_INCH] * rows, BARS_INCH])
    for k, group in enumerate(groups):
        bars = axes[f"{k}.bars"]
        draw_bar_panel(bars, group.bars(), note_deg)
        entitle(bars, 2 * k + 1, group.title)
        bars.set_ylabel("RMSE [N m]")
        curves = [axes[f"{k}.{i}"] for i in range(rows * across)]
        _curves(curves, group, across, joint)
        entitle(curves[0], 2 * k, curves[0].get_title(loc="left"))
    legend(figure, list(axes.values()), LEGEND_COLUMNS * len(groups))
    return figure


def _curves(axes: Sequence[Axes], group: PushGroup, across: int, joint: str) -> None:
    """Draw a group's curves [N m] on one scale, `across` in a row; only outer panels have labels."""
    for axis in axes[len(group.panels) :]:
        axis.set_visible(False)
    used = axes[: len(group.panels)]
    for axis, panel in zip(used, group.panels, strict=True):
        draw_panel(axis, panel)
        axis.set_title(panel.title, loc="left", pad=3)
        axis.set_xlim(panel.time[0], panel.time[-1])
    ends = [end for axis in used for end in axis.get_ylim()]
    for i, axis in enumerate(used):
        axis.set_ylim(min(ends), max(ends))
        axis.tick_params(labelleft=i % across == 0)
        if i % across == 0:
            axis.set_ylabel(f"{joint} torque [N m]")
        if i + across >= len(used):
            axis.set_xlabel("time from push [s]")
