"""Table of how well the feet followed the walking commands."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import astuple, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from mobnet.core.columns import COMMAND, STEPS
from mobnet.evaluation.measure.steps import UNITS, Sets, Steps, bin_edges, bin_of, read_sets
from mobnet.evaluation.number.number import number_text
from mobnet.evaluation.tables.layout import Table, in_blocks, write_table

HEADER = ["Set", "Command", "from", "to", "Steps", "Commanded", "Measured", "Ratio", "Within"]


@dataclass(frozen=True)
class Followed:
    """What came of a command.

    Attributes:
        bin_from: lower end of the bin [unit of the command].
        bin_to: upper end of the bin [unit of the command].
        count: steps of the foot that leads.
        commanded: mean [unit of the command].
        measured: mean [unit of the command].
        ratio: measured over commanded; None in a bin around zero.
        within: share of the steps that lie within the tolerance of their own command; None in a bin around zero.
    """

    bin_from: float
    bin_to: float
    count: int
    commanded: float
    measured: float
    ratio: float | None
    within: float | None

    def texts(self, digits: int) -> list[str]:
        """Return the row of text."""
        low, high, given, made = (
            number_text(value, digits) for value in (self.bin_from, self.bin_to, self.commanded, self.measured)
        )
        within = "-" if self.within is None else f"{self.within:.0%}"
        return [low, high, str(self.count), given, made, number_text(self.ratio), within]


def steps(config: Mapping[str, Any], sets: Sets, out_dir: Path) -> None:
    """Write the table of measured against commanded steps, by bins of the command, as CSV, TeX and Markdown.

    Args:
        config: resolved configuration: `robot`, `walking`, `commands`, `evaluation.steps` (bins, tolerance [-]).
        sets: name -> stems of the recordings.
        out_dir: gets steps.csv, .tex and .md.

    Raises:
        DataError: a file is missing, or a set holds no step.
    """
    rows = {
        (name, column): list(followed(config, found, column))
        for name, found in read_sets(config, sets).items()
        for column in range(found.measured.shape[1])
    }
    records = [
        (name, COMMAND[column][0], *astuple(row), UNITS[column]) for (name, column), own in rows.items() for row in own
    ]
    lines = in_blocks(
        (
            [name, f"{COMMAND[column][0].replace('_', ' ')} [{UNITS[column]}]"],
            [row.texts(1 if UNITS[column] == "deg" else 3) for row in own],
        )
        for (name, column), own in rows.items()
    )
    write_table(out_dir / "steps", Table(STEPS, records, HEADER, lines, left=2))


def followed(config: Mapping[str, Any], found: Steps, column: int) -> Iterator[Followed]:
    """Yield the rows of one command in one set, empty bins left out."""
    settings = config["evaluation"]["steps"]
    edges = bin_edges(config, column, settings["bins"])
    follows = found.follows(column)
    wanted, got = found.commanded[follows, column], found.measured[follows, column]
    where, near = bin_of(wanted, edges), np.abs(got - wanted) <= settings["tolerance"] * np.abs(wanted)
    for k in np.unique(where):
        own, low, high = where == k, float(edges[k]), float(edges[k + 1])
        means = float(wanted[own].mean()), float(got[own].mean())
        clear = low * high >= 0.0  # a bin around zero has no meaningful ratio
        ratios = (means[1] / means[0], float(near[own].mean())) if clear else (None, None)
        yield Followed(low, high, int(own.sum()), *means, *ratios)
