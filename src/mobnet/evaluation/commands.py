"""Which walking commands the data hold (Table 2), and how well the feet followed them."""

from __future__ import annotations

import logging
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.control.parameters import TURN
from mobnet.core.files import write_text
from mobnet.core.recording import COMMAND
from mobnet.evaluation.data_figures import Bars, draw_bars
from mobnet.evaluation.figures import save_figure
from mobnet.evaluation.markup import RULE, Line, markdown_table, number, text_table
from mobnet.evaluation.rows import write_rows
from mobnet.evaluation.steps import Steps, read_steps
from mobnet.robot.description import load_robot
from mobnet.robot.nominal import NominalModel

log = logging.getLogger(__name__)

Sets = Mapping[str, Sequence[str]]  # name of a data set -> stems of its recordings
KEYS = ("step_x_m", "step_y_m", "turn_deg", "duration_s", "foot_height_m")  # of `commands` in the configuration
LABELS = ("step x [m]", "step y [m]", "turn [deg]", "duration [s]", "foot height [m]")
UNITS = ("m", "m", "deg", "s", "m")
CHOICES = 3  # the first three are ranges, the others a few values to choose from


@dataclass(frozen=True)
class Bar:
    """How often a command was given: a row of commands.csv.

    Attributes:
        set: data set.
        command: quantity of Table 2.
        bin_from: lower end of the bin [unit].
        bin_to: upper end of the bin [unit].
        count: steps.
        share: of the set's steps [-].
        unit: unit of the bin.
    """

    set: str
    command: str
    bin_from: float
    bin_to: float
    count: int
    share: float
    unit: str


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


def read_sets(config: Mapping[str, Any], sets: Sets) -> dict[str, Steps]:
    """Return the steps of every data set, turns in [deg], lengths in [m].

    Raises:
        DataError: a file is missing, or a set holds no step.
    """
    nominal = NominalModel(load_robot(Path(config["robot"])))
    spacing = config["walking"]["foot_spacing_m"]
    return {name: in_degrees(read_steps(list(map(Path, stems)), nominal, spacing)) for name, stems in sets.items()}


def in_degrees(steps: Steps) -> Steps:
    """Return steps with the turns, commanded and measured (N,), in [deg] instead of [rad]."""
    commanded, measured = steps.commanded.copy(), steps.measured.copy()
    for array in (commanded, measured):
        array[:, TURN] = np.rad2deg(array[:, TURN])
    return Steps(steps.foot, commanded, measured)


def bin_edges(config: Mapping[str, Any], column: int, bins: int) -> NDArray[np.float64]:
    """Return the bins' edges (n + 1,) [m], [deg], [s] of a command: a range cut evenly, or around every choice."""
    values = np.asarray(config["commands"][KEYS[column]], dtype=float)
    if column < CHOICES:
        return np.linspace(values[0], values[1], bins + 1)
    middle = (values[1:] + values[:-1]) / 2
    return np.concatenate([[2 * values[0] - middle[0]], middle, [2 * values[-1] - middle[-1]]])


def bin_of(values: NDArray[Any], edges: NDArray[np.float64]) -> NDArray[np.intp]:
    """Return the bin (N,) of every value [unit of the edges]; a value on an outer edge, up to rounding, lies inside."""
    return np.clip(np.searchsorted(edges, values, side="right") - 1, 0, len(edges) - 2)


def commands(config: Mapping[str, Any], sets: Sets, out_dir: Path) -> None:
    """Write the histograms of the commands given as PDF, PNG and CSV (Table 2).

    Args:
        config: resolved configuration: `robot`, `walking`, `commands`, `evaluation.commands.bins`.
        sets: name -> stems of the recordings.
        out_dir: gets commands.pdf, .png and .csv.

    Raises:
        DataError: a file is missing, or a set holds no step.
    """
    steps = read_sets(config, sets)
    rows = [bar for column in range(len(KEYS)) for name in steps for bar in bars(config, name, steps[name], column)]
    write_rows(out_dir / "commands.csv", Bar, rows)
    save_figure(draw_bars([panel(rows, column) for column in range(len(KEYS))]), out_dir / "commands")
    log.info("%s: %s steps", out_dir / "commands.pdf", {name: len(found) for name, found in steps.items()})


def bars(config: Mapping[str, Any], name: str, steps: Steps, column: int) -> list[Bar]:
    """Return the histogram of one command in one set."""
    edges = bin_edges(config, column, config["evaluation"]["commands"]["bins"])
    counts = np.bincount(bin_of(steps.commanded[:, column], edges), minlength=len(edges) - 1)
    return [
        Bar(name, COMMAND[column][0], float(low), float(high), int(count), float(count / len(steps)), UNITS[column])
        for low, high, count in zip(edges[:-1], edges[1:], counts, strict=True)
    ]


def panel(rows: Sequence[Bar], column: int) -> Bars:
    """Return what one panel of the figure shows."""
    own = [row for row in rows if row.command == COMMAND[column][0]]
    names = dict.fromkeys(row.set for row in own)
    shares = {name: np.array([row.share for row in own if row.set == name]) for name in names}
    first = [row for row in own if row.set == own[0].set]
    return Bars(LABELS[column], np.array([first[0].bin_from, *(row.bin_to for row in first)]), shares)


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
