"""Files of rows that jobs hand on: errors of runs, and epochs of trainings."""

from collections.abc import Iterator, Sequence
from dataclasses import fields
from operator import attrgetter
from pathlib import Path

from mobnet.core.columns import Epoch, Score
from mobnet.evaluation.number.files import read_rows, refuse_rows

UNITS = ("N", "N m", "N/s", "N m/s", "%", "-", "ms", "deg")  # of a score
SIGNED = ("-", "ms", "deg")  # units of numbers that may be below zero
KEY = attrgetter(*(field.name for field in fields(Score) if field.name != "value"))  # what names a score, unit last
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


def _score_faults(rows: Sequence[Score]) -> Iterator[Fault]:
    """Yield numbers below zero, empty names, unknown units and rows that occur twice."""
    seen: dict[tuple[object, ...], int] = {}
    for k, row in enumerate(rows):
        for name, low in (("network_seed", 0), ("test_seed", 0), ("value", 0.0)):
            if getattr(row, name) < low and not (name == "value" and row.unit in SIGNED):
                yield k, name, getattr(row, name), "0 or more"
        for name in ("scenario", "level", "method", "limb", "joint", "metric"):
            if not getattr(row, name):
                yield k, name, "", "a name"
        if row.unit not in UNITS:
            yield k, "unit", row.unit, ", ".join(UNITS)
        key = KEY(row)
        first = seen.setdefault(key, k)
        # a limb with forces and torques has two means of what has no unit of a joint, such as %
        if first != k and not (row.joint == "avg" and row.unit in ("%", *SIGNED)):
            yield k, "row", ", ".join(map(str, key[:-1])), f"once; it stands in line {first + 2} already"


def _epoch_faults(rows: Sequence[Epoch]) -> Iterator[Fault]:
    """Yield epochs that are not counted from 1, and numbers below zero."""
    for k, row in enumerate(rows):
        if row.epoch != k + 1:
            yield k, "epoch", row.epoch, str(k + 1)
        for name in ("validation_rmse", "rate", "gradient_norm"):
            if getattr(row, name) < 0.0:
                yield k, name, getattr(row, name), "0 or more"
