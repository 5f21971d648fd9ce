"""False alarms of detectors: what was promised, and what was measured in walks that calibrated nothing."""

from collections import Counter
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
from mobnet.core.detections import CALIBRATION, COLLISION, HELD_OUT, LARGEST, UNPUSHED, WALKING, FreeSwing, Promise
from mobnet.detection.thresholds import Calibrated, expected_counts
from mobnet.settings.detection import Detection

PROMISED = "promised"
MEASURED = "measured"
WITHIN = "within"
KEPT = "kept"
RANDOM, BETWEEN, COUNTED = "random", "between pushes", "held out"  # cells; the last one is the first two together
PLACE = "in place"
Counted = tuple[Sequence[FreeSwing], Sequence[Promise]]  # of a robot
OVER = {LARGEST: "ratio_largest", WALKING: "ratio_walking"}  # rule without a promise -> the numbers over its thresholds


def false_alarms(
    settings: AlarmTable, detection: Detection, statistics: Statistics, detections: Detections, table_dir: Path
) -> None:
    """Write false_alarms.csv, .tex and .md: rates of false alarms [1/h] of walking, with intervals.

    A rate is that of one leg. What is promised follows from the swings that calibrated a detector; what is measured is
    counted on swings held out, those between the collisions of a walk included, with the interval of Poisson's law.
    `within` says whether a number of false alarms was measured that the promised interval allows, `kept` whether the
    interval of the measured rate holds the promised one, which is stricter.
    """
    rows = Rows(DETECTION)
    for level in settings.levels:
        leg = settings.leg
        robots = {name: _robot(detections, name, leg) for name in owners(detections, level, settings.levels)}
        for name in settings.detectors:
            own: list[Counted] = []
            for swings, promises in robots.values():
                of_detector = [row for row in promises if row.detector == name]
                if of_detector:
                    own.append(([row for row in swings if row.detector == name], of_detector))
            if own:
                place = {"level": level, "title": level.replace("_", " "), "detector": name, "leg": leg}
                _add_rates(rows, place, own, detection, statistics)
    share = f"{statistics.confidence:.0%}"
    columns = [
        ViewColumn("promised", _of(COLLISION, ALL, PROMISED), 1, ends=share),
        ViewColumn("counted", _of(COLLISION, COUNTED), 1, ends=share),
        ViewColumn("kept", _of(COLLISION, COUNTED, KEPT), text=_yes_or_no),
        ViewColumn("pushes", _of(COLLISION, BETWEEN), 1),
        ViewColumn("random: there", _of(WALKING, RANDOM), 0),
        ViewColumn("pushes", _of(WALKING, BETWEEN), 0),
        ViewColumn("in place: there", _of(LARGEST, PLACE), 0),
        ViewColumn("random", _of(LARGEST, RANDOM), 0),
        ViewColumn("pushes", _of(LARGEST, BETWEEN), 0),
    ]
    # the level stands in every line, and a rule between levels
    view = View({"title": "Level", "detector": "Detector"}, columns, blocks=("level",))
    rows.write(table_dir / "false_alarms", view)


def _of(kind: str, cell: str, quantity: str = MEASURED) -> dict[str, Field]:
    """Return the fields of a number of a detector."""
    return {"kind": kind, "cell": cell, "quantity": quantity}


def _yes_or_no(row: NumberRow) -> str:
    """Return whether the promise is kept."""
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


def _robot(detections: Detections, name: str, leg: str) -> Counted:
    """Return the swings and the promises of a robot, of all detectors of a leg."""
    swings = rows_of(detections, [name], "swings", FreeSwing, leg=leg)
    return swings, rows_of(detections, [name], "promises", Promise, leg=leg)


def _add_rates(
    rows: Rows, place: Mapping[str, Field], robots: Sequence[Counted], detection: Detection, statistics: Statistics
) -> None:
    """Add the rates of a detector [1/h], by rule of thresholds and where they were counted."""
    swing_h = hours_per_swing([row for _, promises in robots for row in promises])
    kinds = [row.kind for row in robots[0][1]]
    for kind in kinds:
        own = [row for _, promises in robots for row in promises if row.kind == kind]
        promised = _promised(own)
        rows.add(promised, **place, **_of(kind, ALL, PROMISED), count=sum(row.swings for row in own))
        counts, totals = Counter[str](), Counter[str]()
        for swings, promises in robots:
            # Ratios are over the threshold for one false alarm an hour, of which that of another kind is a multiple,
            # another one on each robot.
            factors = {row.kind: row.factor for row in promises}
            over = factors[kind] / factors[COLLISION]
            for cell, walked in cells_of(swings, detection).items():
                counts[cell] += alarms_in(walked, over)
                totals[cell] += len(walked)
        for cell, total in totals.items():
            hours = total * swing_h
            measured = rate_of(counts[cell], hours, statistics)
            rows.add(measured, **place, **_of(kind, cell), count=counts[cell])
            if cell in (COUNTED, RANDOM, BETWEEN):
                within = Number(_is_within(promised, hours, counts[cell], statistics))
                rows.add(within, **place, **_of(kind, cell, WITHIN), count=total)
                rows.add(Number(_is_kept(promised, measured)), **place, **_of(kind, cell, KEPT), count=total)
    every = cells_of([row for swings, _ in robots for row in swings], detection)
    for kind, field in OVER.items():
        for cell, walked in every.items():
            alarms = sum(getattr(row, field) > 1.0 for row in walked)
            measured = rate_of(alarms, len(walked) * swing_h, statistics)
            rows.add(measured, **place, **_of(kind, cell), count=alarms)


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


def _is_kept(promised: Number, measured: Number) -> float:
    """Return 1 where the interval of a measured rate holds the promised one, else 0."""
    low, value, high = measured.low or 0.0, promised.value or 0.0, measured.high or 0.0
    return float(low <= value <= high)


def _mean(values: Sequence[float]) -> float:
    return sum(values) / len(values)
