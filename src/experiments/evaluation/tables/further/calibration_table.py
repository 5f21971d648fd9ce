"""Table of the standard deviations' calibration."""

# pandas has no complete types, which the strict rules of this folder ask for.
# pyright: standard

from pathlib import Path

import pandas as pd

from experiments.evaluation.measure.learning.calibration import CASE, COVERAGE, CRPS, NLL, STAGES, case_of
from experiments.evaluation.number.frames import rows_of
from experiments.evaluation.number.number import interval_text, is_missing, number_text
from experiments.evaluation.number.scored import run_grid
from experiments.evaluation.tables.look import Row, ShownColumn, TableLook, column, write_look
from experiments.intervals.crossed import summarise
from experiments.settings.measures import CalibrationTable
from experiments.settings.runs import Statistics
from experiments.settings.table_columns import CALIBRATION, SPREAD
from mobnet.settings.networks import Learning

ENDS = ("before", "before_low", "before_high", "after", "low", "high")
BAR = "within"  # column: whether the coverage of the bar's share is near it


def trust_table(
    settings: CalibrationTable, learning: Learning, statistics: Statistics, measures: pd.DataFrame, table_dir: Path
) -> None:
    """Write calibration.csv, .tex and .md of held-out data and tests; texts hold the methods of `settings` only.

    The measures have columns `TRUSTED`.
    """
    asked = measures[measures["share"].isna() | measures["share"].isin(learning.calibration_levels)]
    numbers = trust_of(asked, statistics)
    cases = [case_of(*place) for place in zip(numbers["test"], numbers["level"], numbers["pushed"], strict=True)]
    rows = numbers.to_dict("records")
    bars = [verdict(row, learning.calibration_share, settings.tolerance) for row in rows]
    shown = numbers.assign(case=cases, **{BAR: bars})
    shown = shown[shown["method"].isin(settings.methods)]
    look = look_at(settings, learning, statistics.confidence)
    write_look(table_dir / "calibration", shown, CALIBRATION, look, filed=numbers)


def trust_of(measures: pd.DataFrame, statistics: Statistics) -> pd.DataFrame:
    """Return the numbers of runs with their intervals before and after the scaling: columns `CALIBRATION`.

    A row is a measure of a limb in one test, of the coverage one for each nominal share.
    """
    place = [*CASE, "metric", "share"]
    rows: list[dict[str, object]] = []
    for keys, same in measures.groupby(place, sort=False, dropna=False):
        of = dict(zip(place, keys, strict=True))
        before, after = (summarise([run_grid(rows_of(same, stage=stage))], statistics) for stage in STAGES)
        ends = dict(zip(ENDS, (*before.with_ends, *after.with_ends), strict=True))
        rows.append({**of, **ends, **dict(zip(SPREAD, after.spread, strict=True))})
    numbers = pd.DataFrame(rows, columns=[*place, *ENDS, *SPREAD]).astype(dict.fromkeys(ENDS, float))
    return numbers.rename(columns={"scenario": "test", "metric": "measure"})


def look_at(settings: CalibrationTable, learning: Learning, confidence: float) -> TableLook:
    """Return what a reader sees: coverage [%], the interval of the bar's share, NLL [nats], and CRPS [its unit]."""
    bar = {"measure": COVERAGE, "share": learning.calibration_share}
    share = f"{learning.calibration_share:.0%}"
    shown = [ShownColumn(f"{share}, uncalibrated", bar, text=column("before", ".1%"))]
    for level in learning.calibration_levels:
        shown.append(ShownColumn(f"{level:.0%}", {**bar, "share": level}, text=column("after", ".1%")))
    shown += [
        ShownColumn(f"{confidence:.0%} of {share}", bar, text=_percent_interval),
        ShownColumn("NLL, uncalibrated", {"measure": NLL}, text=lambda row: number_text(row["before"])),
        ShownColumn("NLL", {"measure": NLL}, text=lambda row: number_text(row["after"])),
        ShownColumn("CRPS, uncalibrated", {"measure": CRPS}, text=lambda row: number_text(row["before"], 3)),
        ShownColumn("CRPS", {"measure": CRPS}, text=lambda row: f"{row['after']:.3f} {row['unit']}"),
        ShownColumn(f"{share} within {settings.tolerance:.0%}", bar, text=column(BAR)),
    ]
    labels = {"case": "Test", "method": "Method", "limb": "Limb"}
    align = "l" * len(labels) + "r" * (len(shown) - 1) + "l"
    return TableLook(labels, shown, blocks=("case",), apart=("level", "unit"), align=align)


def _percent_interval(row: Row) -> str:
    """Return the interval of a coverage in %, or nothing where there is none."""
    return interval_text(100.0 * row["low"], 100.0 * row["high"], digits=1)


def verdict(row: Row, share: float, tolerance: float) -> str:
    """Return whether the scaled coverage lies near its nominal share, `yes` or `no`; nothing for a collision."""
    if row["pushed"] or is_missing(row["after"]):
        return ""
    return "yes" if abs(row["after"] - share) <= tolerance else "no"
