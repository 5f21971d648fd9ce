"""Table of the kinds of networks (section 6.1): losses, errors and sizes, beside the paper's order.

The time that a training takes is in the page of runs: tables come out the same each time.
"""

from collections.abc import Sequence
from pathlib import Path

import pandas as pd

from experiments.evaluation.measure.learning.trainings import MEASURES, kind_of_each, over_networks, read_trainings
from experiments.evaluation.number.frames import records_of, rows_of
from experiments.evaluation.number.laws import fields_of, measured, numbers_by
from experiments.evaluation.number.number import Number, number_text
from experiments.evaluation.tables.layout import GAP, RULE, Line, Table, with_intervals, write_table
from experiments.settings.figures import Figure17
from experiments.settings.published import PublishedKinds
from experiments.settings.runs import Statistics
from experiments.settings.table_columns import KINDS
from experiments.settings.tables import Kinds

ORDERED_BY = "validation loss"
HEADER = [
    "Order",
    "Original",
    "Network",
    "Parameters",
    "Original",
    "Runs",
    "Val. loss",
    "RMSE [N m]",
    "On windows",
    "Train. loss, end",
    "Val. loss, end",
]
LEFT = 3  # columns of text


def kinds(
    settings: Kinds,
    figure_17: Figure17,
    statistics: Statistics,
    published: PublishedKinds,
    folders: Sequence[Path],
    table_dir: Path,
) -> None:
    """Write kinds.csv, .tex and .md: mean over runs of loss (22) [-] and RMSE [N m], best kind first.

    The kinds of Figure 17, which are the paper's, stand in an order of their own by each of its recipes; below them
    stand our own variants.
    """
    networks, _ = read_trainings(folders)
    networks = networks.assign(sound=~networks["diverged"])
    kinds = kind_of_each(figure_17)
    laws = {name: over_networks(column, unit, statistics) for name, (column, unit) in MEASURES.items()}
    measures = measured(networks, ["method"], laws, of="sound")
    # A kind that always diverged has no loss and comes last.
    losses = rows_of(measures, quantity=ORDERED_BY).set_index("method")["value"].astype(float)
    parts: list[list[str]] = []
    for methods in (figure_17.methods, figure_17.best):
        parts.append(losses.loc[list(methods)].sort_values(kind="stable").index.to_list())
    ranks: dict[str, int] = {}
    for part in parts:
        ranked = [method for method in part if kinds[method] in published.order]
        ranks |= {method: k for k, method in enumerate(ranked, start=1)}
    rows: list[pd.DataFrame] = []
    for method in (*parts[0], *parts[1], *settings.variants):
        of_method = rows_of(networks, method=method)
        counts = counts_of(of_method, ranks.get(method), kinds.get(method, method), published)
        # Counts are whole numbers, and stay so beside others.
        rows += [counts.assign(method=method), rows_of(measures, method=method).astype(object)]
    shown = pd.concat(rows)
    firsts = [methods[0] for methods in (parts[1], settings.variants) if methods]
    lines = kind_lines(shown, firsts, statistics.confidence)
    align = "rrl" + "r" * (len(HEADER) - LEFT)
    write_table(table_dir / "kinds", Table(KINDS, records_of(shown, KINDS), HEADER, lines, LEFT, align))


def counts_of(networks: pd.DataFrame, rank: int | None, kind: str, published: PublishedKinds) -> pd.DataFrame:
    """Return what is counted of a kind; `rank` is its place among the kinds that the paper orders, None for others."""
    counts = {
        "order": Number(rank, published=published.order.get(kind)),
        "parameters": Number(int(networks["parameters"].iloc[0]), published=published.parameters.get(kind)),
        "runs": Number(len(networks)),
        "diverged": Number(int(networks["diverged"].sum())),
    }
    rows = [{"quantity": name, **fields_of(number)} for name, number in counts.items()]
    return pd.DataFrame(rows, dtype=object)


def kind_lines(rows: pd.DataFrame, firsts: Sequence[str], confidence: float) -> list[Line]:
    """Return the rows of text, two a kind where there are intervals, a rule above `firsts`, where a part begins."""
    lines: list[Line] = []
    for method, of in rows.groupby("method", sort=False):
        numbers = numbers_by(of, "quantity")
        if lines:
            lines.append(RULE if method in firsts else GAP)
        order, size, runs, diverged = (numbers[name] for name in ("order", "parameters", "runs", "diverged"))
        ranks = [order.text(0), number_text(order.published, 0)]
        sizes = [size.text(0), number_text(size.published, 0)]
        count = runs.text(0) + (f", {diverged.text(0)} diverged" if diverged.value else "")
        lines += with_intervals([*ranks, str(method), *sizes, count], [numbers[name] for name in MEASURES], confidence)
    return lines
