"""Files of rows that jobs hand on: errors of runs, epochs of trainings, and what detectors find."""

from collections.abc import Iterator, Sequence
from dataclasses import fields
from operator import attrgetter
from pathlib import Path
from typing import Any, cast

from mobnet.core.columns import Epoch, Score
from mobnet.core.detections import FILES, PARTS, UNNAMED
from mobnet.core.errors import ConfigError
from mobnet.core.metrics import JOINT_UNITS, kind_of_metric
from mobnet.evaluation.number.files import read_rows, refuse_rows

SIGNED = ("-", "ms", "deg")  # units of numbers that may be below zero
KEY = attrgetter(*(field.name for field in fields(Score) if field.name != "value"))  # what names a score, unit last
ENDS = (("start_s", "end_s"), ("low", "high"), ("found", "collisions"))  # of rows of detectors, smaller one first
Fault = tuple[int, str, object, str]  # number of a row, column, value, accepted


def read_scores(*paths: Path) -> list[Score]:
    """Read errors of runs from files, one for each test and level, one file after another.

    Raises:
        DataError: a file is missing or damaged, or a row is not accepted; one line for each fault.
    """
    found: list[Score] = []
    for path in paths:
        rows = read_rows(path, Score)
        refuse_rows(path, _score_faults(rows))
        found += rows
    return found


def read_epochs(path: Path) -> tuple[Epoch, ...]:
    """Read the epochs of a training.

    Raises:
        DataError: the file is missing or damaged, or a row is not accepted; one line for each fault.
    """
    rows = read_rows(path, Epoch)
    refuse_rows(path, _epoch_faults(rows))
    return tuple(rows)


def read_detections(path: Path, name: str) -> list[Any]:
    """Read the rows of a file of a robot's detectors, one of `core.detections.FILES` by its name.

    Raises:
        DataError: the file is missing or damaged, or a row is not accepted; one line for each fault.
    """
    rows = read_rows(path, FILES[name])
    refuse_rows(path, _detection_faults(rows))
    return rows


def _detection_faults(rows: Sequence[Any]) -> Iterator[Fault]:
    """Yield numbers below zero, empty names, unknown parts, and ends of times or intervals that come before starts."""
    for k, row in enumerate(rows):
        values = cast("dict[str, Any]", vars(row))
        for name, value in values.items():
            if value == "" and name not in UNNAMED:
                yield k, name, value, "a name"
            if isinstance(value, int | float) and value < 0:
                yield k, name, value, "0 or more"
        if values.get("part", PARTS[0]) not in PARTS:
            yield k, "part", row.part, ", ".join(PARTS)
        for low, high in ENDS:
            if low in values and values[low] > values[high]:
                yield k, low, values[low], f"at most {high}, {values[high]}"


def _score_faults(rows: Sequence[Score]) -> Iterator[Fault]:
    """Yield numbers below zero, empty names, unknown metrics and rows that occur twice."""
    seen: dict[tuple[object, ...], int] = {}
    for k, row in enumerate(rows):
        for name, low in (("network_seed", 0), ("test_seed", 0), ("value", 0.0)):
            if getattr(row, name) < low and not (name == "value" and row.unit in SIGNED):
                yield k, name, getattr(row, name), "0 or more"
        for name in ("scenario", "level", "method", "limb", "joint", "metric"):
            if not getattr(row, name):
                yield k, name, "", "a name"
        yield from ((k, *fault) for fault in _metric_faults(row.metric, row.unit, row.value))
        key = KEY(row)
        first = seen.setdefault(key, k)
        # a limb with forces and torques has two means of what has no unit of a joint, such as %
        if first != k and not (row.joint == "avg" and row.unit in ("%", *SIGNED)):
            yield k, "row", ", ".join(map(str, key[:-1])), f"once; it stands in line {first + 2} already"


def _metric_faults(name: str, unit: str, value: float) -> Iterator[tuple[str, object, str]]:
    """Yield a metric that is unknown, a unit that is not its own, and a value outside of its range."""
    try:
        kind = kind_of_metric(name)
    except ConfigError:
        yield "metric", name, "a name of mobnet.core.metrics"
        return
    units = dict.fromkeys(kind.unit.format(of) for of in JOINT_UNITS)
    if unit not in units:
        yield "unit", unit, ", ".join(units)
    low, high = kind.ends or (value, value)
    if not low <= value <= high:
        yield f"value of {name}", value, f"{low:g} to {high:g}"


def _epoch_faults(rows: Sequence[Epoch]) -> Iterator[Fault]:
    """Yield epochs that are not counted from 1, and numbers below zero."""
    for k, row in enumerate(rows):
        if row.epoch != k + 1:
            yield k, "epoch", row.epoch, str(k + 1)
        for name in ("validation_rmse", "rate", "gradient_norm"):
            if getattr(row, name) < 0.0:
                yield k, name, getattr(row, name), "0 or more"
