"""Figure 20: error by size of the network and of the training data."""

from collections.abc import Sequence
from pathlib import Path

from experiments.evaluation.figures.drawing.lines import Line, LinePanel, draw_lines
from experiments.evaluation.figures.style import save_figure
from experiments.evaluation.measure.learning.sizes import Size, sizes_of
from experiments.plan.runs import SweptSize
from experiments.settings.runs import Statistics
from experiments.settings.table_columns import SIZES

TITLES = {"parameters": "size of the network, all data", "samples": "size of the data, printed network"}
X_LABELS = {"parameters": "parameters [thousand]", "samples": "samples learned from [thousand]"}
PRINTED_NAMES = {"parameters": "network of Table 1", "samples": "all data"}  # at the grey line of each panel
Y_LABEL = "RMSE [N m]"
THOUSAND = 1e3


def figure_20(sizes_of_networks: Sequence[SweptSize], statistics: Statistics, figure_dir: Path) -> None:
    """Write Figure 20, validation RMSE [N m] over parameters (a) and samples (b); the printed size is marked.

    The CSV file has the errors over that of the printed size too.
    """
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
            upright=printed_place(sizes, panel),
            upright_name=PRINTED_NAMES[panel],
            scale=panel,
        )
        panels.append(drawn)
    save_figure(draw_lines(panels), figure_dir / "figure_20", SIZES, [size.record() for size in sizes])


def growth_line(own: Sequence[Size], base: str) -> Line:
    """Return the errors (n,) [N m] of an estimator's variations over the size that their panel varies."""
    return Line(base, [size.place / THOUSAND for size in own], [size.rmse for size in own])


def printed_place(sizes: Sequence[Size], panel: str) -> float | None:
    """Return where a panel has the printed network that learned from all data [thousand]; None where it is not."""
    places = [size.place / THOUSAND for size in sizes if size.panel == panel and size.ratio.value == 1.0]
    return places[0] if places else None
