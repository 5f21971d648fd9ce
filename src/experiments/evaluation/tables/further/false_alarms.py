"""False alarms of detectors: what was promised, and what was measured in walks that calibrated nothing."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from experiments.evaluation.measure.detection.results import (
    ALL,
    Detections,
    alarms_in,
    hours_per_swing,
    owners,
    rows_of,
)
from experiments.evaluation.number.number import Number
from experiments.evaluation.number.rows import Field
from experiments.evaluation.number.single import rate_of
from experiments.evaluation.tables.rows import NumberRow, Rows, View, ViewColumn
from experiments.settings.detection_tables import AlarmTable
from experiments.settings.runs import Statistics
from mobnet.core.columns import DETECTION
from mobnet.core.detections import CALIBRATION, COLLISION, HELD_OUT, LARGEST, UNPUSHED, FreeSwing, Promise
from mobnet.detection.thresholds import Calibrated, expected_counts
from mobnet.settings.detection import Detection

PROMISED = "promised"
MEASURED = "measured"
WITHIN = "within"
RANDOM, BETWEEN, COUNTED = "random", "between pushes", "held out"  # cells; the last one is the first two together
PLACE = "in place"
Cells = Mapping[str, Sequence[FreeSwing]]


def false_alarms(
    settings: AlarmTable, detection: Detection, statistics: Statistics, detections: Detections, table_dir: Path
) -> None:
    """Write false_alarms.csv, .tex and .md: rates of false alarms [1/h] of walking, with intervals.

    A rate is that of one leg. What is promised follows from the swings that calibrated a detector; what is measured is
    counted on swings held out, those between the collisions of a walk included, with the interval of Poisson's law.
    `within` says whether a number of false alarms was measured that the promised interval allows.
    """
    rows = Rows(DETECTION)
    for level in settings.levels:
        names = owners(detections, level, settings.levels)
        leg = settings.leg
        swings = rows_of(detections, names, "swings", FreeSwing, leg=leg)
        promises = rows_of(detections, names, "promises", Promise, leg=leg)
        for name in settings.detectors:
            own = [row for row in promises if row.detector == name]
            if own:
                cells = cells_of([row for row in swings if row.detector == name], detection)
                place = {"level": level, "title": level.replace("_", " "), "detector": name, "leg": leg}
                _add_rates(rows, place, own, cells, statistics)
    share = f"{statistics.confidence:.0%}"
    columns = [
        ViewColumn("promised", _of(COLLISION, ALL, PROMISED), 1, ends=share),
        ViewColumn("counted", _of(COLLISION, COUNTED), 1, ends=share),
        ViewColumn("within", _of(COLLISION, COUNTED, WITHIN), text=_yes_or_no),
        ViewColumn(BETWEEN, _of(COLLISION, BETWEEN), 1),
        ViewColumn("original's rule: in place", _of(LARGEST, PLACE), 0),
        ViewColumn("random walking", _of(LARGEST, RANDOM), 0),
        ViewColumn(BETWEEN, _of(LARGEST, BETWEEN), 0),
    ]
    # the level stands in every line, and a rule between levels
    view = View({"title": "Level", "detector": "Detector"}, columns, blocks=("level",))
    rows.write(table_dir / "false_alarms", view)


def _of(kind: str, cell: str, quantity: str = MEASURED) -> dict[str, Field]:
    """Return the fields of a number of a detector."""
    return {"kind": kind, "cell": cell, "quantity": quantity}


def _yes_or_no(row: NumberRow) -> str:
    """Return whether what was measured is within what was promised."""
    return "yes" if row.number.value else "no"


def cells_of(swings: Sequence[FreeSwing], detection: Detection) -> dict[str, list[FreeSwing]]:
    """Return the swings by where they were made: in random walking, on each ground, in place, and between pushes.

    What is held out is random walking and the swings between pushes together: a leg that was hit goes on walking.
    """
    held = [row for row in swings if row.part == HELD_OUT]
    random = [row for row in held if row.scenario == detection.random]
    grounds: dict[str, list[FreeSwing]] = {}
    for row in random:
        grounds.setdefault(f"random on {row.terrain}", []).append(row)
    between = [row for row in swings if row.part == UNPUSHED]
    return {
        COUNTED: random + between,
        RANDOM: random,
        **grounds,
        PLACE: [row for row in held if row.scenario == detection.place],
        BETWEEN: between,
        CALIBRATION: [row for row in swings if row.part == CALIBRATION and row.scenario == detection.random],
    }


def _add_rates(
    rows: Rows, place: Mapping[str, Field], promises: Sequence[Promise], cells: Cells, statistics: Statistics
) -> None:
    """Add the rates of a detector [1/h], by rule of thresholds and where they were counted."""
    by_kind: dict[str, list[Promise]] = {}
    for row in promises:
        by_kind.setdefault(row.kind, []).append(row)
    of_collision = by_kind[COLLISION]
    swing_h = hours_per_swing(promises)
    for kind, own in by_kind.items():
        promised = _promised(own)
        rows.add(promised, **place, **_of(kind, ALL, PROMISED), count=sum(row.swings for row in own))
        # ratios are over the threshold for one false alarm an hour, of which that of another kind is a multiple
        over = _mean([row.factor for row in own]) / _mean([row.factor for row in of_collision])
        for cell, swings in cells.items():
            hours = len(swings) * swing_h
            alarms = alarms_in(swings, over)
            rows.add(rate_of(alarms, hours, statistics), **place, **_of(kind, cell), count=alarms)
            if cell in (COUNTED, RANDOM, BETWEEN):
                within = Number(_is_within(promised, hours, alarms, statistics))
                rows.add(within, **place, **_of(kind, cell, WITHIN), count=len(swings))
    for cell, swings in cells.items():
        alarms = sum(row.ratio_largest > 1.0 for row in swings)
        measured = rate_of(alarms, len(swings) * swing_h, statistics)
        rows.add(measured, **place, **_of(LARGEST, cell), count=alarms)


def _promised(promises: Sequence[Promise]) -> Number:
    """Return the mean of the rates that robots' detectors promise [1/h], with that of the intervals."""
    rate = _mean([row.rate_per_h for row in promises])
    low = _mean([row.low for row in promises])
    high = _mean([row.high for row in promises])
    return Number(rate, low, high, unit="1/h")


def _is_within(promised: Number, hours: float, alarms: int, statistics: Statistics) -> float:
    """Return 1 where a number of false alarms is one that the promised interval allows, else 0."""
    rate = Calibrated(0.0, promised.value or 0.0, promised.low or 0.0, promised.high or 0.0)
    low, high = expected_counts(rate, hours, statistics.confidence)
    return float(low <= alarms <= high)


def _mean(values: Sequence[float]) -> float:
    return sum(values) / len(values)
