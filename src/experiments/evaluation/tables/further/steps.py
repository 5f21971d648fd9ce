"""Table of how well the feet followed the walking commands."""

# pandas has no complete types, which the strict rules of this folder ask for.
# pyright: standard

from collections.abc import Hashable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from experiments.evaluation.measure.data.steps import UNITS, Array, WalkedSteps, bin_edges, bin_of, read_steps
from experiments.evaluation.number.frames import records_of
from experiments.evaluation.number.number import is_missing, number_text
from experiments.evaluation.tables.layout import Table, in_blocks, write_table
from experiments.settings.table_columns import STEPS
from experiments.settings.tables import Steps as StepsTable
from mobnet.core.columns import COMMAND
from mobnet.formats.robot import RobotTable
from mobnet.robot.description import describe
from mobnet.robot.nominal import NominalModel
from mobnet.settings.data import Commands
from mobnet.settings.walking import Walking

HEADER = ["Set", "Command", "from", "to", "Steps", "Commanded", "Measured", "Ratio", "Within"]


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
    rows: list[pd.DataFrame] = []
    blocks: list[tuple[list[str], list[list[str]]]] = []
    for name, stems in sets.items():
        walked = read_steps(stems, nominal.robot.layout)
        measured = walked.measured(nominal, walking.foot_spacing_m)
        for column in range(measured.shape[1]):
            edges = bin_edges(commands, column, settings.bins)
            command, unit = COMMAND[column][0], UNITS[column]
            bins = followed(walked, measured, column, edges, settings.tolerance)
            rows.append(bins.assign(set=name, command=command, unit=unit))
            digits = 1 if unit == "deg" else 3
            label = f"{command.replace('_', ' ')} [{unit}]"
            blocks.append(([name, label], [texts_of(row, digits) for row in bins.to_dict("records")]))
    records = records_of(pd.concat(rows), STEPS)
    write_table(table_dir / "steps", Table(STEPS, records, HEADER, in_blocks(blocks), left=2))


def texts_of(row: Mapping[Hashable, Any], digits: int) -> list[str]:
    """Return the cells of a bin."""
    numbers = [number_text(row[name], digits) for name in ("bin_from", "bin_to", "commanded", "measured")]
    within = "-" if is_missing(row["within"]) else f"{row['within']:.0%}"
    return [*numbers[:2], str(row["count"]), *numbers[2:], number_text(row["ratio"]), within]


def followed(walked: WalkedSteps, measured: Array, column: int, edges: Array, tolerance: float) -> pd.DataFrame:
    """Return what came of one command in one set, a row for each bin of it that has steps [m], [deg] or [s].

    Beside the ends of a bin it has the `count` of steps of the foot that leads, the mean that was `commanded` and the
    one that was `measured`, their `ratio`, and the share of the steps `within` the tolerance of their own command. A
    bin around zero has neither of these two.

    Args:
        walked: the steps (N,).
        measured: what the feet did, (N, 4) [m], [deg], [s].
        column: of the command.
        edges: of its bins [unit of the command].
        tolerance: share of its command within which a step follows it.
    """
    follows = walked.follows(column)
    wanted = walked.commanded[follows, column]
    got = measured[follows, column]
    near = np.abs(got - wanted) <= tolerance * np.abs(wanted)
    steps = pd.DataFrame({"bin": bin_of(wanted, edges), "commanded": wanted, "measured": got, "within": near})
    rows = steps.groupby("bin").mean()
    low, high = edges[rows.index], edges[rows.index + 1]
    rows = rows.assign(bin_from=low, bin_to=high, count=steps.groupby("bin").size())
    rows["ratio"] = rows["measured"] / rows["commanded"]
    # A bin around zero has no meaningful ratio.
    rows.loc[low * high < 0.0, ["ratio", "within"]] = np.nan
    return rows.reset_index(drop=True)
