"""Table of why a hit is hidden: what networks show that differ in inputs, robot or learning, and how it enters."""

import logging
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from experiments.evaluation.measure.learning.explained import ALL, PATH
from experiments.evaluation.measure.learning.paths import GROUPS, taken_by_inputs
from experiments.evaluation.measure.learning.taught import HITS, ROUGHNESS, SHARE_OF_HIT, WALKING, judged
from experiments.evaluation.measure.learning.trials import Known, read_walks
from experiments.evaluation.number.number import Number
from experiments.evaluation.number.rows import Field
from experiments.evaluation.tables.layout import Line, Table, in_blocks, write_table
from experiments.intervals.crossed import RunGrid, summarise
from experiments.plan.runs import ExplainedRobot
from experiments.settings.measures import Peaks
from experiments.settings.runs import Statistics
from experiments.settings.table_columns import WHY
from experiments.settings.trials import WAY, Why
from mobnet.core.arrays import Array
from mobnet.settings.methods import ObserverSettings
from mobnet.settings.robot import RobotTable

UNITS = {WALKING: "N m", HITS: "N m", SHARE_OF_HIT: "-", ROUGHNESS: "-"}
log = logging.getLogger(__name__)
Cell = tuple[str, str, str]  # training set, method and way
Found = dict[Cell, dict[str, dict[str, list[Array]]]]  # -> measure -> robot -> numbers of the walks of each network


def why(
    robot: RobotTable,
    gravity_m_s2: float,
    observer: ObserverSettings,
    rate_hz: float,
    settings: Why,
    robots: Sequence[ExplainedRobot],
    peaks: Peaks,
    statistics: Statistics,
    out: Path,
) -> None:
    """Write a CSV, .tex and .md: errors [N m], share of a hit and roughness [-], and what inputs bring in of a hit [-].

    Recordings at a rate [Hz] and `out` are paths without a suffix; gravity is in [m/s^2]. Intervals are over robots.
    """
    known = Known(robot, gravity_m_s2, observer)
    found: Found = {}
    paths: dict[str, dict[str, dict[str, list[float]]]] = {}
    for own in robots:
        walk, hits = (read_walks(known, task, rate_hz) for task in (own.taught.walk, own.taught.hits))
        for tried in own.taught.walk.tried:
            numbers = judged(settings.hits, settings.joint, known, own.taught, tried, (walk, hits), peaks)
            log.info("%s, %s, %s: share %.3f", own.robot, own.data, tried.name, numbers[SHARE_OF_HIT].mean())
            cell = found.setdefault((own.data, tried.base, str(tried.changes.get(WAY, ""))), {})
            for measure, values in numbers.items():
                cell.setdefault(measure, {}).setdefault(own.robot, []).append(values)
        pairs = list(zip(own.taught.hits.recordings, own.twins, strict=False))
        for tried in own.paths:
            brought = taken_by_inputs(tried, known, hits, pairs, peaks.after_s, settings.joint)
            for name, value in brought.items():
                paths.setdefault(tried.base, {}).setdefault(name, {}).setdefault(own.robot, []).append(value)
    write_table(out, table_of(settings, found, paths, statistics))


def table_of(
    settings: Why,
    found: Mapping[Cell, Mapping[str, Mapping[str, Sequence[Array]]]],
    paths: Mapping[str, Mapping[str, Mapping[str, Sequence[float]]]],
    statistics: Statistics,
) -> Table:
    """Return the table: a line for each training set, method and way, then the inputs by which a hit enters."""
    rows: list[Sequence[Field]] = []
    blocks: dict[str, list[list[str]]] = {}
    for cell, measures in found.items():
        data, _, way = cell
        texts: list[str] = []
        for measure, unit in UNITS.items():
            number = _number({name: float(np.mean(own)) for name, own in measures[measure].items()}, statistics, unit)
            for name, own in measures[measure].items():
                for network, walks in enumerate(own):
                    rows.append((*cell, measure, "", name, network, float(np.mean(walks)), None, None, unit))
            rows.append((*cell, measure, "", ALL, None, *number.with_ends, unit))
            texts += [number.text(), number.interval()]
        count = len(measures[WALKING])
        blocks.setdefault(f"{data} {way}", []).append([*cell, str(count), *texts])
    lines: list[Line] = in_blocks(([], own) for own in blocks.values())
    note: list[str] = []
    for method, groups in paths.items():
        parts: list[str] = []
        for group in GROUPS:
            number = _number({name: float(np.mean(own)) for name, own in groups[group].items()}, statistics, "-")
            for name, own in groups[group].items():
                for network, value in enumerate(own):
                    rows.append((settings.path_set, method, "", PATH, group, name, network, value, None, None, "-"))
            rows.append((settings.path_set, method, "", PATH, group, ALL, None, *number.with_ends, "-"))
            parts.append(f"{group} {number.text()}")
        note.append(f"Share of a hit that the prediction of {method} takes, by inputs: {', '.join(parts)}.")
    interval = f"{statistics.confidence:.0%}"
    header = ["Training set", "Method", "Learning", "Robots", "Walking [N m]", interval]
    header += [f"Hits, {settings.joint} [N m]", interval, "Share of a hit", interval, "Roughness", interval]
    return Table(WHY, rows, header, lines, left=3, note=" ".join(note))


def _number(by_robot: Mapping[str, float], statistics: Statistics, unit: str) -> Number:
    """Return the mean over robots [unit], with its interval over them."""
    values = np.array(list(by_robot.values()))[:, None]
    return summarise([RunGrid(values, robots=tuple(range(len(values))))], statistics, unit=unit)
