"""Table of the kinds of networks (section 6.1): losses, errors and sizes, beside the paper's order.

The time that a training takes is in the page of runs: tables come out the same each time.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from experiments.evaluation.measure.learning.trainings import (
    MEASURES,
    TrainedNetwork,
    kind_of_each,
    read_trainings,
    sound,
)
from experiments.evaluation.number.intervals import RunGrid, summarise
from experiments.evaluation.number.number import Number, number_text
from experiments.evaluation.number.rows import Field
from experiments.evaluation.tables.layout import GAP, RULE, Line, Table, with_intervals, write_table
from experiments.settings.figures import Figure17
from experiments.settings.published import PublishedKinds
from experiments.settings.runs import Statistics
from experiments.settings.table_columns import KINDS
from experiments.settings.tables import Kinds

ORDERED_BY = "validation loss"
HEADER = [
    "Order",
    "Paper",
    "Network",
    "Parameters",
    "Paper",
    "Runs",
    "Val. loss",
    "RMSE [N m]",
    "On windows",
    "Train. loss, end",
    "Val. loss, end",
]
LEFT = 3  # columns of text

Traits = Mapping[str, Number]  # `order`, `parameters`, `runs`, `diverged` or a name of `MEASURES` -> of a kind


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
    found = read_trainings(folders)
    variants = settings.variants
    kinds = kind_of_each(figure_17)
    measured = {method: measures_of(found[method], statistics) for method in (*kinds, *variants)}
    parts = [by_loss(methods, measured) for methods in (figure_17.methods, figure_17.best)]
    ranks: dict[str, int] = {}
    for part in parts:
        ordered = [method for method in part if kinds[method] in published.order]
        ranks |= {method: k for k, method in enumerate(ordered, start=1)}
    traits = {
        method: {**counts(found[method], ranks.get(method), kinds.get(method, method), published), **measured[method]}
        for method in (*parts[0], *parts[1], *variants)
    }
    records: list[tuple[Field, ...]] = []
    for method, own in traits.items():
        for quantity, number in own.items():
            records.append((method, quantity, *number.with_ends, *number.spread, number.unit, number.published))
    firsts = [methods[0] for methods in (parts[1], variants) if methods]
    lines = kind_lines(traits, firsts, statistics.confidence)
    align = "rrl" + "r" * (len(HEADER) - LEFT)
    write_table(table_dir / "kinds", Table(KINDS, records, HEADER, lines, LEFT, align))


def by_loss(methods: Sequence[str], measured: Mapping[str, Traits]) -> list[str]:
    """Return methods in the order of their losses, lowest first; those that always diverged come last."""
    losses = {method: measured[method][ORDERED_BY].value for method in methods}
    return sorted(methods, key=lambda method: (losses[method] is None, losses[method] or 0.0))


def measures_of(trainings: Sequence[TrainedNetwork], statistics: Statistics) -> Traits:
    """Return the measures of the trainings that did not diverge [-, N m], without a number if all did."""
    good = sound(trainings)
    if not good:
        return {name: Number(None, unit=unit) for name, (_, unit) in MEASURES.items()}
    found = {}
    for name, (measure, unit) in MEASURES.items():
        values = np.array([[measure(run)] for run in good])
        found[name] = summarise([RunGrid(values)], statistics, unit=unit)
    return found


def counts(trainings: Sequence[TrainedNetwork], rank: int | None, kind: str, published: PublishedKinds) -> Traits:
    """Return what is counted of a kind; `rank` is its place among the kinds that the paper orders, None for others."""
    return {
        "order": Number(rank, published=published.order.get(kind)),
        "parameters": Number(trainings[0].parameters, published=published.parameters.get(kind)),
        "runs": Number(len(trainings)),
        "diverged": Number(len(trainings) - len(sound(trainings))),
    }


def kind_lines(traits: Mapping[str, Traits], firsts: Sequence[str], confidence: float) -> list[Line]:
    """Return the rows of text, two a kind where there are intervals, a rule above `firsts`, where a part begins."""
    lines: list[Line] = []
    for method, own in traits.items():
        if lines:
            lines.append(RULE if method in firsts else GAP)
        order, size, runs, diverged = (own[name] for name in ("order", "parameters", "runs", "diverged"))
        ranks = [order.text(0), number_text(order.published, 0)]
        sizes = [size.text(0), number_text(size.published, 0)]
        count = runs.text(0) + (f", {diverged.text(0)} diverged" if diverged.value else "")
        lines += with_intervals([*ranks, method, *sizes, count], [own[name] for name in MEASURES], confidence)
    return lines
