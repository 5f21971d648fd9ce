"""Table of why a hit is hidden: what networks show that differ in inputs, robot or learning, and how it enters."""

# pandas has no complete types, which the strict rules of this folder ask for.
# pyright: standard

import logging
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from experiments.evaluation.measure.learning.explained import ALL, NETWORKS, PATH, over_robots
from experiments.evaluation.measure.learning.paths import GROUPS, taken_by_inputs
from experiments.evaluation.measure.learning.taught import HITS, ROUGHNESS, SHARE_OF_HIT, WALKING, judged
from experiments.evaluation.measure.learning.trials import read_walks
from experiments.evaluation.number.frames import ordered, rows_of
from experiments.evaluation.number.laws import fields_of, number_from
from experiments.evaluation.number.number import number_text
from experiments.evaluation.tables.look import ShownColumn, TableLook, column, write_look
from experiments.plan.runs import ExplainedRobot
from experiments.settings.measures import Peaks
from experiments.settings.runs import Statistics
from experiments.settings.table_columns import WHY
from experiments.settings.trials import WAY, Why
from mobnet.formats.robot import RobotTable
from mobnet.settings.methods import ObserverSettings

UNITS = {WALKING: "N m", HITS: "N m", SHARE_OF_HIT: "-", ROUGHNESS: "-"}
log = logging.getLogger(__name__)
TAKEN = ["method", "inputs", "robot", "value"]


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
    taught: list[dict[str, object]] = []
    taken: list[dict[str, object]] = []
    for each in robots:
        walk = read_walks(robot, gravity_m_s2, observer, each.taught.walk, rate_hz)
        hits = read_walks(robot, gravity_m_s2, observer, each.taught.hits, rate_hz)
        for tried in each.taught.walk.tried:
            numbers = judged(settings.hits, settings.joint, each.taught, tried, (walk, hits), peaks)
            log.info("%s, %s, %s: share %.3f", each.robot, each.data, tried.name, numbers[SHARE_OF_HIT].mean())
            place = {"data": each.data, "method": tried.base, "way": str(tried.changes.get(WAY, ""))}
            for measure in UNITS:
                value = float(np.mean(numbers[measure]))
                taught.append({**place, "measure": measure, "robot": each.robot, "value": value})
        pairs = list(zip(each.taught.hits.recordings, each.twins, strict=False))
        for tried in each.paths:
            brought = taken_by_inputs(tried, hits, pairs, peaks.after_s, settings.joint)
            for inputs, value in brought.items():
                taken.append({"method": tried.base, "inputs": inputs, "robot": each.robot, "value": value})
    write_why(out, pd.DataFrame(taught), pd.DataFrame(taken, columns=TAKEN), settings, statistics)


def write_why(
    out: Path, taught: pd.DataFrame, taken: pd.DataFrame, settings: Why, statistics: Statistics
) -> None:  # fmt: skip
    """Write the table: a line for each training set, method and way, then the inputs by which a hit enters.

    Args:
        out: path without a suffix.
        taught: a row for each network: `data`, `method`, `way`, `measure`, `robot` and `value`, a mean over walks.
        taken: columns `TAKEN`: the share of a hit that inputs bring into the prediction of a network [-].
        settings: the trial.
        statistics: of the intervals.
    """
    learned = with_robots(taught.assign(inputs=""), statistics)
    taken = taken.assign(data=settings.path_set, way="", measure=PATH)
    brought = with_robots(ordered(taken, inputs=list(GROUPS)), statistics)
    whole = rows_of(learned, robot=ALL)
    counts = rows_of(taught, measure=WALKING).groupby(NETWORKS, sort=False)["robot"].nunique().rename("robots")
    # Sets that differ in how they are learned stand in blocks of their own.
    shown = whole.merge(counts.reset_index(), on=NETWORKS)
    shown = shown.assign(block=shown["data"] + " " + shown["way"], training=shown["data"])
    rows = pd.concat([learned, brought.astype({"inputs": str})])
    write_look(out, shown, WHY, look_at(settings.joint, path_note(brought), statistics), filed=rows)


def with_robots(networks: pd.DataFrame, statistics: Statistics) -> pd.DataFrame:
    """Return rows of networks, columns `WHY`: after those of each measure one of all robots, with its interval."""
    parts: list[pd.DataFrame] = []
    place = [*NETWORKS, "measure", "inputs"]
    for keys, same in networks.groupby(place, sort=False, observed=True):
        of = dict(zip(place, keys, strict=True))
        unit = UNITS.get(str(of["measure"]), "-")
        means = {str(robot): float(values.mean()) for robot, values in same.groupby("robot", sort=False)["value"]}
        robots = list(means)
        number = over_robots([means], robots, statistics, unit)
        # Networks of a robot are counted in the order of their seeds; rows stand robot by robot.
        single = same.assign(network=same.groupby("robot").cumcount(), unit=unit)
        single = single.sort_values("robot", key=lambda names: names.map(robots.index), kind="stable")
        parts += [single, pd.DataFrame([{**of, "robot": ALL, **fields_of(number)}])]
    return pd.concat(parts, ignore_index=True)[list(WHY)] if parts else pd.DataFrame(columns=list(WHY))


def path_note(brought: pd.DataFrame) -> str:
    """Return what stands below the table: by which inputs a hit enters the prediction of each method."""
    sentences: list[str] = []
    for method, whole in rows_of(brought, robot=ALL).groupby("method", sort=False):
        parts = [f"{row['inputs']} {number_text(row['value'])}" for row in whole.to_dict("records")]
        sentences.append(f"Share of a hit that the prediction of {method} takes, by inputs: {', '.join(parts)}.")
    return " ".join(sentences)


def look_at(joint: str, note: str, statistics: Statistics) -> TableLook:
    """Return what a reader sees: numbers over all robots of networks that have set, method and way in common."""
    heads = {WALKING: "Walking [N m]", HITS: f"Hits, {joint} [N m]", SHARE_OF_HIT: "Share of a hit"}
    heads[ROUGHNESS] = "Roughness"
    shown = [ShownColumn("Robots", text=column("robots"))]
    for measure, head in heads.items():
        of = {"measure": measure}
        shown.append(ShownColumn(head, of, text=lambda row: number_from(row).texts()[0]))
        shown.append(ShownColumn(f"{statistics.confidence:.0%}", of, text=lambda row: number_from(row).texts()[1]))
    labels = {"training": "Training set", "method": "Method", "way": "Learning"}
    return TableLook(labels, shown, blocks=("block",), note=note)
