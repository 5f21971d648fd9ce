"""False alarms of detectors: what was promised, and what was measured in walks that calibrated nothing."""

from pathlib import Path

import pandas as pd

from experiments.evaluation.measure.detection.results import ALL, hours_per_swing, read_of_leg
from experiments.evaluation.number.frames import rows_of
from experiments.evaluation.number.laws import fields_of
from experiments.evaluation.number.number import Number
from experiments.evaluation.tables.look import Row, ShownColumn, TableLook, write_look
from experiments.intervals.single import rate_of
from experiments.plan.detection import Detections
from experiments.records.collisions import UNPUSHED
from experiments.settings.detection_tables import AlarmTable
from experiments.settings.runs import Statistics
from experiments.settings.table_columns import DETECTION
from mobnet.core.detections import CALIBRATION, COLLISION, HELD_OUT, LARGEST, WALKING
from mobnet.detection.thresholds import Calibrated, expected_counts
from mobnet.settings.detection import Detection

PROMISED = "promised"
MEASURED = "measured"
WITHIN = "within"
KEPT = "kept"
RANDOM, BETWEEN, COUNTED = "random", "between pushes", "held out"  # cells; the last one is the first two together
PLACE = "in place"
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
    every_promise = read_of_leg(settings, detections, "promises")
    every_swing = read_of_leg(settings, detections, "swings")
    parts: list[pd.DataFrame] = []
    for (level, name), promises in every_promise.groupby(["level", "detector"], observed=True):
        swings = rows_of(every_swing, level=level, detector=name)
        swings = swings[swings["robot"].isin(promises["robot"])]
        rates = rates_of(promises, in_cells(swings, detection), statistics)
        title = str(level).replace("_", " ")
        parts.append(rates.assign(level=str(level), title=title, detector=str(name), leg=settings.leg))
    share = f"{statistics.confidence:.0%}"
    shown = [
        ShownColumn("promised", _of(COLLISION, ALL, PROMISED), 1, ends=share),
        ShownColumn("counted", _of(COLLISION, COUNTED), 1, ends=share),
        ShownColumn("kept", _of(COLLISION, COUNTED, KEPT), text=_yes_or_no, none="no"),
        ShownColumn("pushes", _of(COLLISION, BETWEEN), 1),
        ShownColumn("random: there", _of(WALKING, RANDOM), 0),
        ShownColumn("pushes", _of(WALKING, BETWEEN), 0),
        ShownColumn("in place: there", _of(LARGEST, PLACE), 0),
        ShownColumn("random", _of(LARGEST, RANDOM), 0),
        ShownColumn("pushes", _of(LARGEST, BETWEEN), 0),
    ]
    # the level stands in every line, and a rule between levels
    look = TableLook({"title": "Level", "detector": "Detector"}, shown, blocks=("level",))
    write_look(table_dir / "false_alarms", pd.concat(parts, ignore_index=True), DETECTION, look)


def _of(kind: object, cell: object, quantity: str = MEASURED) -> dict[str, object]:
    """Return the columns of a number of a detector."""
    return {"kind": kind, "cell": cell, "quantity": quantity}


def _yes_or_no(row: Row) -> str:
    """Return whether the promise is kept."""
    return "yes" if row["value"] else "no"


def in_cells(swings: pd.DataFrame, detection: Detection) -> pd.DataFrame:
    """Return each swing once for each `cell` that it is part of: random walking, a ground, in place, between pushes.

    What is held out is random walking and the swings between pushes together: a leg that was hit goes on walking.
    """
    unpushed = rows_of(swings, part=HELD_OUT)
    random = rows_of(unpushed, scenario=detection.random)
    between = rows_of(swings, part=UNPUSHED)
    grounds = {f"random on {terrain}": on_ground for terrain, on_ground in random.groupby("terrain", sort=False)}
    cells = {
        COUNTED: pd.concat([random, between]),
        RANDOM: random,
        **grounds,
        PLACE: rows_of(unpushed, scenario=detection.place),
        BETWEEN: between,
        CALIBRATION: rows_of(swings, part=CALIBRATION, scenario=detection.random),
    }
    placed = pd.concat([of_cell.assign(cell=cell) for cell, of_cell in cells.items()], ignore_index=True)
    return placed.assign(cell=pd.Categorical(placed["cell"], list(cells)))


def rates_of(promises: pd.DataFrame, swings: pd.DataFrame, statistics: Statistics) -> pd.DataFrame:
    """Return the rates of a detector [1/h], by rule of thresholds and where they were counted, with their intervals.

    Promises are those of each robot; swings stand in their cells.
    """
    rows: list[dict[str, object]] = []

    def add(number: Number, kind: object, cell: object, quantity: str, count: int) -> None:
        rows.append({**_of(kind, cell, quantity), **fields_of(number), "count": count})

    swing_h = hours_per_swing(promises)
    factors = promises.pivot(index="robot", columns="kind", values="factor")
    for kind, of_kind in promises.groupby("kind", sort=False):
        rate, low, high = of_kind[["rate_per_h", "low", "high"]].mean()
        promised = Number(rate, low, high, unit="1/h")
        add(promised, kind, ALL, PROMISED, int(of_kind["swings"].sum()))
        # Ratios are over the threshold for one false alarm an hour, of which that of another kind is a multiple,
        # another one on each robot.
        over = swings["robot"].map(factors[kind] / factors[COLLISION])
        alarms = swings.assign(alarm=swings["ratio"] > over)
        for cell, walked in alarms.groupby("cell", observed=False):
            count = int(walked["alarm"].sum())
            hours = len(walked) * swing_h
            measured = rate_of(count, hours, statistics)
            add(measured, kind, cell, MEASURED, count)
            if cell in (COUNTED, RANDOM, BETWEEN):
                within = _is_within(promised, hours, count, statistics)
                add(Number(within), kind, cell, WITHIN, len(walked))
                add(Number(_is_kept(promised, measured)), kind, cell, KEPT, len(walked))
    for kind, column in OVER.items():
        for cell, walked in swings.groupby("cell", observed=False):
            count = int((walked[column] > 1.0).sum())
            add(rate_of(count, len(walked) * swing_h, statistics), kind, cell, MEASURED, count)
    return pd.DataFrame(rows)


def _is_within(promised: Number, hours: float, alarms: int, statistics: Statistics) -> float:
    """Return 1 where a number of false alarms is one that the promised interval allows, else 0."""
    rate = Calibrated(0.0, promised.value or 0.0, promised.low or 0.0, promised.high or 0.0)
    low, high = expected_counts(rate, hours, statistics.confidence)
    return float(low <= alarms <= high)


def _is_kept(promised: Number, measured: Number) -> float:
    """Return 1 where the interval of a measured rate holds the promised one, else 0."""
    low, value, high = measured.low or 0.0, promised.value or 0.0, measured.high or 0.0
    return float(low <= value <= high)
