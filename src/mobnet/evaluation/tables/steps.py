"""Table of how well the feet followed the walking commands."""

from __future__ import annotations

import logging
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from mobnet.core.files import write_text
from mobnet.core.recording import COMMAND
from mobnet.evaluation.measure.steps import (
    UNITS,
    Sets,
    Steps,
    bin_edges,
    bin_of,
    read_sets,
)
from mobnet.evaluation.number.rows import write_rows
from mobnet.evaluation.tables.layout import RULE, Line, markdown_table, number, text_table

log = logging.getLogger(__name__)


@dataclass(frozen=True)
class Followed:
    """What came of a command: a row of steps.csv.

    Attributes:
        set: data set.
        command: quantity of Table 2.
        bin_from: lower end of the bin [unit].
        bin_to: upper end of the bin [unit].
        count: steps of the foot that leads.
        commanded: mean [unit].
        measured: mean [unit].
        ratio: measured over commanded [-]; None in a bin around zero.
        within: share of the steps that lie within the tolerance of their own command [-]; None in a bin around zero.
        unit: unit of the numbers.
    """

    set: str
    command: str
    bin_from: float
    bin_to: float
    count: int
    commanded: float
    measured: float
    ratio: float | None
    within: float | None
    unit: str


def steps(config: Mapping[str, Any], sets: Sets, out_dir: Path) -> None:
    """Write the table of measured against commanded steps, by bins of the command, as CSV, TeX and Markdown.

    Args:
        config: resolved configuration: `robot`, `walking`, `commands`, `evaluation.steps` (bins, tolerance [-]).
        sets: name -> stems of the recordings.
        out_dir: gets steps.csv, .tex and .md.

    Raises:
        DataError: a file is missing, or a set holds no step.
    """
    rows = []
    for name, found in read_sets(config, sets).items():
        for column in range(found.measured.shape[1]):
            rows += followed(config, name, found, column)
    header = ["Set", "Command", "from", "to", "Steps", "Commanded", "Measured", "Ratio", "Within"]
    lines = followed_lines(rows)
    write_rows(out_dir / "steps.csv", Followed, rows)
    write_text(out_dir / "steps.tex", text_table("llrrrrrrr", header, lines))
    write_text(out_dir / "steps.md", markdown_table(header, lines, left=2))
    log.info("%s: %d bins", out_dir / "steps.csv", len(rows))


def followed(config: Mapping[str, Any], name: str, found: Steps, column: int) -> list[Followed]:
    """Return the rows of one command in one set, empty bins left out."""
    settings = config["evaluation"]["steps"]
    edges = bin_edges(config, column, settings["bins"])
    follows = found.follows(column)
    wanted, got = found.commanded[follows, column], found.measured[follows, column]
    where, near = bin_of(wanted, edges), np.abs(got - wanted) <= settings["tolerance"] * np.abs(wanted)
    rows = []
    for k in np.unique(where):
        own, low, high = where == k, float(edges[k]), float(edges[k + 1])
        means = float(wanted[own].mean()), float(got[own].mean())
        clear = low * high >= 0.0  # a bin around zero has no meaningful ratio
        ratios = (means[1] / means[0], float(near[own].mean())) if clear else (None, None)
        rows.append(Followed(name, COMMAND[column][0], low, high, int(own.sum()), *means, *ratios, UNITS[column]))
    return rows


def followed_lines(rows: Sequence[Followed]) -> list[Line]:
    """Return the rows of text, a rule between commands."""
    lines: list[Line] = []
    before = None
    for row in rows:
        first = (row.set, row.command) != before
        if first and before is not None:
            lines.append(RULE)
        before = row.set, row.command
        digits = 1 if row.unit == "deg" else 3
        within = "-" if row.within is None else f"{row.within:.0%}"
        names = [row.set, f"{row.command.replace('_', ' ')} [{row.unit}]"] if first else ["", ""]
        numbers = [number(value, digits) for value in (row.bin_from, row.bin_to, row.commanded, row.measured)]
        lines.append([*names, *numbers[:2], str(row.count), *numbers[2:], number(row.ratio), within])
    return lines
