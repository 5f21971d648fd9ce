"""Table of how well the feet followed the walking commands."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import astuple, dataclass
from pathlib import Path

import numpy as np

from experiments.evaluation.measure.data.steps import UNITS, Array, WalkedSteps, bin_edges, bin_of, read_steps
from experiments.evaluation.number.number import number_text
from experiments.evaluation.number.rows import Field
from experiments.evaluation.tables.layout import Table, in_blocks, write_table
from experiments.settings.table_columns import STEPS
from experiments.settings.tables import Steps as StepsTable
from mobnet.core.columns import COMMAND
from mobnet.robot.description import describe
from mobnet.robot.nominal import NominalModel
from mobnet.settings.data import Commands
from mobnet.settings.robot import RobotTable
from mobnet.settings.walking import Walking

HEADER = ["Set", "Command", "from", "to", "Steps", "Commanded", "Measured", "Ratio", "Within"]


@dataclass(frozen=True)
class Followed:
    """What came of a command, in a bin of it; numbers are in the command's unit [m], [deg] or [s].

    Attributes:
        count: steps of the foot that leads.
        commanded: mean.
        measured: mean.
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


def steps(
    settings: StepsTable,
    robot: RobotTable,
    walking: Walking,
    commands: Commands,
    sets: Mapping[str, Sequence[Path]],
    table_dir: Path,
) -> None:
    """Write the table of measured against commanded steps, by bins of the command, as CSV, TeX and Markdown."""
    nominal = NominalModel(describe(robot))
    rows: dict[tuple[str, int], list[Followed]] = {}
    for name, stems in sets.items():
        found = read_steps(stems, nominal.robot.layout)
        measured = found.measured(nominal, walking.foot_spacing_m)
        for column in range(measured.shape[1]):
            edges = bin_edges(commands, column, settings.bins)
            rows[name, column] = list(followed(found, measured, column, edges, settings.tolerance))
    records: list[tuple[Field, ...]] = []
    blocks: list[tuple[list[str], list[list[str]]]] = []
    for (name, column), own in rows.items():
        command = COMMAND[column][0]
        unit = UNITS[column]
        records += [(name, command, *astuple(row), unit) for row in own]
        digits = 1 if unit == "deg" else 3
        label = f"{command.replace('_', ' ')} [{unit}]"
        blocks.append(([name, label], [row.texts(digits) for row in own]))
    write_table(table_dir / "steps", Table(STEPS, records, HEADER, in_blocks(blocks), left=2))


def followed(found: WalkedSteps, measured: Array, column: int, edges: Array, tolerance: float) -> Iterator[Followed]:
    """Yield the rows of one command in one set, empty bins left out.

    Args:
        found: the steps (N,).
        measured: what the feet did, (N, 4) [m], [deg], [s].
        column: of the command.
        edges: of its bins [unit of the command].
        tolerance: share of its command within which a step follows it.
    """
    follows = found.follows(column)
    wanted = found.commanded[follows, column]
    got = measured[follows, column]
    where = bin_of(wanted, edges)
    near = np.abs(got - wanted) <= tolerance * np.abs(wanted)
    for k in np.unique(where):
        own = where == k
        low = float(edges[k])
        high = float(edges[k + 1])
        means = float(wanted[own].mean()), float(got[own].mean())
        clear = low * high >= 0.0  # a bin around zero has no meaningful ratio
        ratios = (means[1] / means[0], float(near[own].mean())) if clear else (None, None)
        yield Followed(low, high, int(own.sum()), *means, *ratios)
