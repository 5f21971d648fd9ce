"""False alarms of detectors: what was promised, and what was measured in walks that calibrated nothing."""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from experiments.evaluation.measure.detection.results import (
    ALL,
    Detections,
    alarms_in,
    hours_per_swing,
    owners,
    rows_of,
)
from experiments.evaluation.number.files import Field
from experiments.evaluation.number.number import Number
from experiments.evaluation.number.single import rate_of
from experiments.evaluation.tables.layout import RULE, Line, Table, write_table
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
Cells = Mapping[str, Sequence[FreeSwing]]


def false_alarms(
    settings: AlarmTable, detection: Detection, statistics: Statistics, detections: Detections, table_dir: Path
) -> None:
    """Write false_alarms.csv, .tex and .md: rates of false alarms [1/h] of walking, with intervals.

    A rate is that of one leg. What is promised follows from the swings that calibrated a detector; what is measured is
    counted on swings held out, those between the collisions of a walk included, with the interval of Poisson's law.
    `within` says whether a number of false alarms was measured that the promised interval allows.
    """
    rows: list[Sequence[Field]] = []
    lines: list[Line] = []
    for level in settings.levels:
        names = owners(detections, level, settings.levels)
        leg = settings.leg
        swings = rows_of(detections, names, "swings", FreeSwing, leg=leg)
        promises = rows_of(detections, names, "promises", Promise, leg=leg)
        lines += [RULE] if lines else []
        for name in settings.detectors:
            own = [row for row in promises if row.detector == name]
            if own:
                cells = cells_of([row for row in swings if row.detector == name], detection)
                made = list(_rows((level, name, leg), own, cells, statistics))
                rows += made
                lines.append(_line(made, level, name))
    share = f"{statistics.confidence:.0%}"
    header = [
        "Level",
        "Detector",
        "promised",
        share,
        "counted",
        share,
        "within",
        BETWEEN,
        "paper's rule: in place",
        "random walking",
        BETWEEN,
    ]
    write_table(table_dir / "false_alarms", Table(DETECTION, rows, header, lines, left=2))


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
        "in place": [row for row in held if row.scenario == detection.place],
        BETWEEN: between,
        CALIBRATION: [row for row in swings if row.part == CALIBRATION and row.scenario == detection.random],
    }


def _rows(
    place: tuple[str, str, str], promises: Sequence[Promise], cells: Cells, statistics: Statistics
) -> Iterator[Sequence[Field]]:
    """Yield the rows of CSV of a detector: rates by rule and where they were counted."""
    by_kind: dict[str, list[Promise]] = {}
    for row in promises:
        by_kind.setdefault(row.kind, []).append(row)
    of_collision = by_kind[COLLISION]
    swing_h = hours_per_swing(promises)
    for kind, own in by_kind.items():
        promised = _promised(own)
        # ratios are over the threshold for one false alarm an hour, of which that of another kind is a multiple
        over = _mean([row.factor for row in own]) / _mean([row.factor for row in of_collision])
        yield (*place, kind, ALL, PROMISED, *promised.with_ends, sum(row.swings for row in own), "1/h", None)
        for cell, swings in cells.items():
            hours = len(swings) * swing_h
            alarms = alarms_in(swings, over)
            measured = rate_of(alarms, hours, statistics)
            yield (*place, kind, cell, MEASURED, *measured.with_ends, alarms, "1/h", None)
            if cell in (COUNTED, RANDOM, BETWEEN):
                yield (
                    *place,
                    kind,
                    cell,
                    WITHIN,
                    _is_within(promised, hours, alarms, statistics),
                    None,
                    None,
                    len(swings),
                    "-",
                    None,
                )
    for cell, swings in cells.items():
        alarms = sum(row.ratio_largest > 1.0 for row in swings)
        measured = rate_of(alarms, len(swings) * swing_h, statistics)
        yield (*place, LARGEST, cell, MEASURED, *measured.with_ends, alarms, "1/h", None)


def _promised(promises: Sequence[Promise]) -> Number:
    """Return the mean of the rates that robots' detectors promise [1/h], with that of the intervals."""
    rate = _mean([row.rate_per_h for row in promises])
    low = _mean([row.low for row in promises])
    high = _mean([row.high for row in promises])
    return Number(rate, low, high)


def _is_within(promised: Number, hours: float, alarms: int, statistics: Statistics) -> float:
    """Return 1 where a number of false alarms is one that the promised interval allows, else 0."""
    rate = Calibrated(0.0, promised.value or 0.0, promised.low or 0.0, promised.high or 0.0)
    low, high = expected_counts(rate, hours, statistics.confidence)
    return float(low <= alarms <= high)


def _line(rows: Sequence[Sequence[Field]], level: str, name: str) -> list[str]:
    """Return the line of a detector in the texts."""
    found = {row[3:6]: row for row in rows}

    def number(kind: str, cell: str, quantity: str = MEASURED) -> Number:
        value, low, high = (None if isinstance(field, str) else field for field in found[kind, cell, quantity][6:9])
        return Number(value, low, high)

    promised = number(COLLISION, ALL, PROMISED)
    counted = number(COLLISION, COUNTED)
    within = "yes" if number(COLLISION, COUNTED, WITHIN).value else "no"
    paper = [number(LARGEST, cell).text(0) for cell in ("in place", RANDOM, BETWEEN)]
    between = number(COLLISION, BETWEEN).text(1)
    return [
        level.replace("_", " "),
        name,
        promised.text(1),
        promised.interval(1),
        counted.text(1),
        counted.interval(1),
        within,
        between,
        *paper,
    ]


def _mean(values: Sequence[float]) -> float:
    return sum(values) / len(values)
