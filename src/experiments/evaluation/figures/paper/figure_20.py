"""Figure 20: error by size of the network and of the training data."""

from collections.abc import Sequence
from pathlib import Path

import pandas as pd

from experiments.evaluation.figures.drawing.lines import Line, LinePanel, draw_lines
from experiments.evaluation.figures.style import save_figure
from experiments.evaluation.measure.learning.sizes import sizes_of
from experiments.evaluation.number.frames import records_of, rows_of
from experiments.evaluation.number.laws import number_from
from experiments.plan.runs import SweptSize
from experiments.settings.runs import Statistics
from experiments.settings.table_columns import SIZES

TITLES = {"parameters": "size of the network, all data", "samples": "size of the data, printed network"}
X_LABELS = {"parameters": "parameters [thousand]", "samples": "samples learned from [thousand]"}
PRINTED_NAMES = {"parameters": "network of Table 1", "samples": "all data"}  # at the grey line of each panel
Y_LABEL = "RMSE [N m]"
THOUSAND = 1e3
ERROR = {"rmse_nm": "value", "rmse_low_nm": "low", "rmse_high_nm": "high"}  # columns of the error as those of a number


def figure_20(sizes_of_networks: Sequence[SweptSize], statistics: Statistics, figure_dir: Path) -> None:
    """Write Figure 20, validation RMSE [N m] over parameters (a) and samples (b); the printed size is marked.

    The CSV file has the errors over that of the printed size too.
    """
    sizes = sizes_of(sizes_of_networks, statistics)
    save_figure(draw_lines(panels_of(sizes)), figure_dir / "figure_20", SIZES, records_of(sizes, SIZES))


def panels_of(sizes: pd.DataFrame) -> list[LinePanel]:
    """Return a panel for each of `TITLES` with a line for each estimator: error [N m] over the size that it varies."""
    panels: list[LinePanel] = []
    for panel, title in TITLES.items():
        of_panel = rows_of(sizes, panel=panel)
        lines = [growth_line(of, panel, str(base)) for base, of in of_panel.groupby("base", sort=False)]
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
    return panels


def growth_line(of_base: pd.DataFrame, panel: str, base: str) -> Line:
    """Return the errors (n,) [N m] of an estimator's variations over the size that their panel varies."""
    numbers = [number_from(row) for row in of_base.rename(columns=ERROR).to_dict("records")]
    return Line(base, (of_base[panel] / THOUSAND).tolist(), numbers)


def printed_place(sizes: pd.DataFrame, panel: str) -> float | None:
    """Return where a panel has the printed network that learned from all data [thousand]; None where it is not."""
    places = rows_of(sizes, panel=panel, ratio=1.0)[panel].tolist()
    return places[0] / THOUSAND if places else None
