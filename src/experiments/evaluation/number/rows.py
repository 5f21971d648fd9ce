"""Files of rows that jobs hand on: errors of runs, epochs of trainings, and what detectors find."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import fields
from operator import attrgetter
from pathlib import Path
from typing import Any, cast

from experiments.evaluation.number.number import Number
from experiments.records.collisions import FILES, PARTS, UNNAMED
from experiments.records.reactions import Trial
from experiments.records.scores import Score
from experiments.settings.metrics import metric_of
from mobnet.core.errors import ConfigError, refuse_lines
from mobnet.core.files import write_text
from mobnet.core.rows import csv_text, parse_field, read_rows, read_texts, refuse_rows

KEY = attrgetter(*(field.name for field in fields(Score) if field.name != "value"))  # what names a score, unit last
ENDS = (("start_s", "end_s"), ("low", "high"), ("found", "collisions"))  # of rows of detectors, smaller one first
Fault = tuple[int, str, object, str]  # number of a row, column, value, accepted
Field = str | int | float | None


def read_scores(*paths: Path) -> list[Score]:
    """Read errors of runs from files, one for each test and level, one file after another.

    Raises:
        DataError: a file is missing or damaged, or a row is not accepted; one line for each fault.
    """
    scores: list[Score] = []
    for path in paths:
        rows = read_rows(path, Score)
        refuse_rows(path, _score_faults(rows))
        scores += rows
    return scores


def read_detections(path: Path, name: str) -> list[Any]:
    """Read the rows of a file of a robot's detectors, one of `records.collisions.FILES` by its name.

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
    """Yield seeds below zero, empty names, what its metric does not allow of a row, and rows that occur twice."""
    seen: dict[tuple[object, ...], int] = {}
    for k, row in enumerate(rows):
        for name in ("network_seed", "test_seed"):
            if getattr(row, name) < 0:
                yield k, name, getattr(row, name), "0 or more"
        for name in ("scenario", "level", "method", "limb", "joint"):
            if not getattr(row, name):
                yield k, name, "", "a name"
        try:
            metric = metric_of(row.metric)
        except ConfigError:
            yield k, "metric", row.metric, "a name that a module of measures declares, such as rmse"
            # Unit and range of a metric that nobody declares are not known.
            continue
        if row.unit not in metric.units:
            yield k, "unit", row.unit, ", ".join(metric.units)
        if metric.low is not None and row.value < metric.low:
            yield k, "value", row.value, f"{metric.low:g} or more"
        if metric.high is not None and row.value > metric.high:
            yield k, "value", row.value, f"{metric.high:g} or less"
        key = KEY(row)
        first = seen.setdefault(key, k)
        # a limb with forces and torques has two means of what has no unit of a joint, such as %
        if first != k and not (row.joint == "avg" and len(metric.units) == 1):
            yield k, "row", ", ".join(map(str, key[:-1])), f"once; it stands in line {first + 2} already"


def read_trials(path: Path) -> list[Trial]:
    """Read walks into obstacles, or without one, from a file.

    Raises:
        DataError: the file is missing or damaged, or a row is not accepted; one line for each fault.
    """
    rows = read_rows(path, Trial)
    refuse_rows(path, _trial_faults(rows))
    return rows


def _trial_faults(rows: Sequence[Trial]) -> Iterator[Fault]:
    """Yield numbers below zero, and reactions that come before their alarm."""
    for k, row in enumerate(rows):
        for name, value in vars(row).items():
            if isinstance(value, int | float) and value < 0:
                yield k, name, value, "0 or more"
        if row.reacted_s is not None and (row.alarm_s is None or row.alarm_s > row.reacted_s):
            yield k, "alarm_s", row.alarm_s, f"at most reacted_s, {row.reacted_s}"


def write_csv(path: Path, columns: Sequence[str], rows: Iterable[Sequence[Field]]) -> None:
    """Write CSV atomically: numbers with six digits, None as an empty field, lines ending in a newline."""
    write_text(path, csv_text(columns, rows))


def read_numbers(path: Path) -> list[tuple[dict[str, str], Number]]:
    """Read the rows of a table: the texts of all columns, and the number, with what the paper prints.

    Raises:
        DataError: the file is missing, a column is missing or a field is not a number where one is due.
    """
    names = ("value", "low", "high", "published")
    faults = list[str]()
    numbers_of_rows: list[tuple[dict[str, str], Number]] = []
    # The names of the columns are line 1 of the file.
    for line, row in enumerate(read_texts(path, [*names, "unit"]), start=2):
        numbers = {name: parse_field(row[name], float | None, f"{path}:{line}: {name}", faults) for name in names}
        numbers_of_rows.append((row, Number(**numbers, unit=row["unit"])))
    refuse_lines(faults)
    return numbers_of_rows
