"""Figure 20: error by size of the network and of the training data, over that of the printed size."""

from collections.abc import Sequence
from pathlib import Path

from experiments.evaluation.figures.drawing.lines import Line, LinePanel, draw_lines
from experiments.evaluation.figures.style import save_figure
from experiments.evaluation.measure.learning.sizes import Size, sizes_of
from experiments.plan.runs import SweptSize
from experiments.settings.runs import Statistics
from mobnet.core.columns import SIZES

TITLES = {"parameters": "size of the network, all data", "samples": "size of the data, printed network"}
X_LABELS = {"parameters": "parameters [thousand]", "samples": "samples learned from [thousand]"}
Y_LABEL = "relative RMSE [-]"
THOUSAND = 1e3


def figure_20(sizes_of_networks: Sequence[SweptSize], statistics: Statistics, figure_dir: Path) -> None:
    """Write Figure 20, validation RMSE over that of the printed size [-], over parameters (a) and samples (b)."""
    sizes = sizes_of(sizes_of_networks, statistics)
    panels = []
    for panel, title in TITLES.items():
        bases = dict.fromkeys(swept.base for swept in sizes_of_networks if swept.panel == panel)
        lines = []
        for base in bases:
            own = [size for size in sizes if (size.panel, size.base) == (panel, base)]
            if own:
                lines.append(growth_line(own, base))
        drawn = LinePanel(
            title,
            X_LABELS[panel],
            Y_LABEL,
            lines,
            guide=1.0,
            ends=(None, None),
            scale=panel,
            note="\n".join(printed_size(sizes, base) for base in bases),
        )
        panels.append(drawn)
    save_figure(draw_lines(panels), figure_dir / "figure_20", SIZES, [size.record() for size in sizes])


def growth_line(own: Sequence[Size], base: str) -> Line:
    """Return the relative errors (n,) of an estimator's variations over the size that their panel varies."""
    shown = [size for size in own if size.ratio.value is not None]
    return Line(base, [size.place / THOUSAND for size in shown], [size.ratio for size in shown])


def printed_size(sizes: Sequence[Size], base: str) -> str:
    """Return what a relative error of 1 is of an estimator, as text."""
    errors = [size.rmse.text() for size in sizes if size.base == base and size.ratio.value == 1.0]
    return f"{base}: 1 is {errors[0]} N m" if errors else ""
