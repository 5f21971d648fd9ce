"""Table of what the walks of a training set teach: errors in walking and under hits of the knee, and what changes them.

Networks that differ in the walks that they learn from alone are judged on the same walks of each robot. An effect is
the ratio of the errors on two levels of a factor, means over a robot's walks. It is a geometric mean over robots, and
over the other factors where it stands for all of their levels; its interval is that of its logarithm over robots.
"""

import logging
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product
from pathlib import Path

import numpy as np

from experiments.evaluation.measure.learning.taught import HITS, SHARE_OF_HIT, WALKING, judged
from experiments.evaluation.measure.learning.trials import Known, read_walks
from experiments.evaluation.number.intervals import Formula, RunGrid, summarise
from experiments.evaluation.number.number import Number
from experiments.evaluation.number.rows import Field
from experiments.evaluation.tables.layout import Line, Table, in_blocks, write_table
from experiments.plan.runs import TaughtRobot, Tried
from experiments.settings.measures import Peaks
from experiments.settings.runs import Statistics
from experiments.settings.table_columns import FACTORIAL
from experiments.settings.trials import DATA, Factorial, Factors
from mobnet.core.arrays import Array
from mobnet.settings.methods import ObserverSettings
from mobnet.settings.robot import RobotTable

UNITS = {WALKING: "N m", HITS: "N m", SHARE_OF_HIT: "-"}  # of the measures
ERRORS = (WALKING, HITS)  # measures of which effects are ratios
ALL = "all"  # robots
ANOTHER_DAY = "another day / same day"
DAY = "{}, another day"
EFFECTS = {  # factor -> its level above and below in an effect, and the name of the effect
    "random_torque": (False, True, "without / with random torque"),
    "pushes": (False, True, "without / with pushes"),
    "commands": ("joystick", "random", "joystick / varied commands"),
}
PUSHES = {False: "none", True: "often"}
COMMANDS = {"joystick": "joystick", "random": "varied"}
LOGS = Formula(lambda means: means.mean(axis=0, keepdims=True))  # a mean of numbers of either sign
log = logging.getLogger(__name__)
ByRobot = Mapping[str, Mapping[str, Array]]  # variant -> measure -> numbers of walks (robots, walks)


@dataclass(frozen=True)
class Effect:
    """A ratio of errors on two levels of a factor, at levels of the others or, where they are None, over all of them.

    `numbers` leads from a measure to the ratio [-].
    """

    name: str
    torque_nm: float | None
    pushes: str | None
    commands: str | None
    numbers: Mapping[str, Number]


def factorial(
    robot: RobotTable,
    gravity_m_s2: float,
    observer: ObserverSettings,
    rate_hz: float,
    settings: Factorial,
    robots: Mapping[str, TaughtRobot],
    cells: Mapping[str, Factors],
    torque_nm: float,
    peaks: Peaks,
    statistics: Statistics,
    out: Path,
) -> None:
    """Write a CSV, .tex and .md: RMSE [N m] and share of a hit [-] of each training set, and ratios [-] of factors.

    Recordings at a rate [Hz] and `out` are paths without a suffix; gravity is in [m/s^2], `torque_nm` is the largest
    random torque [N m].
    """
    known = Known(robot, gravity_m_s2, observer)
    found: dict[str, dict[str, list[Array]]] = {}
    for name, own in robots.items():
        walk, hits = (read_walks(known, task, rate_hz) for task in (own.walk, own.hits))
        for tried in own.walk.tried:
            every = judged(settings.hits, settings.joint, known, own, tried, (walk, hits), peaks)
            numbers = {key: every[key] for key in UNITS}
            log.info("%s, %s: %s", name, tried.name, {key: round(float(row.mean()), 3) for key, row in numbers.items()})
            for key, row in numbers.items():
                found.setdefault(_label(tried), {}).setdefault(key, []).append(row)
    by_robot = {name: {key: np.array(rows) for key, rows in own.items()} for name, own in found.items()}
    effects = [*effects_of(by_robot, cells, torque_nm, statistics)]
    effects.append(_ratio(ANOTHER_DAY, by_robot, [(settings.another_day, settings.same_day)], statistics))
    write_table(out, table_of(settings, list(robots), by_robot, cells, torque_nm, effects, statistics))


def effects_of(
    found: ByRobot, cells: Mapping[str, Factors], torque_nm: float, statistics: Statistics
) -> Iterator[Effect]:
    """Yield the effect of each factor at each pair of levels of the other two, then over all of them."""
    names: dict[Factors, str] = {}
    for name, factors in cells.items():
        names.setdefault(factors, name)  # the set of another day comes last, and has a cell's factors
    for factor, (above, below, title) in EFFECTS.items():
        others = [other for other in EFFECTS if other != factor]
        pairs: list[tuple[str, str]] = []
        for levels in product(*(EFFECTS[other][:2] for other in others)):
            held = dict(zip(others, levels, strict=True))
            pair = names[Factors(**held, **{factor: above})], names[Factors(**held, **{factor: below})]
            pairs.append(pair)
            torque = None if factor == "random_torque" else torque_nm * bool(held["random_torque"])
            pushes = None if factor == "pushes" else PUSHES[bool(held["pushes"])]
            commands = None if factor == "commands" else COMMANDS[str(held["commands"])]
            effect = _ratio(title, found, [pair], statistics)
            yield replace(effect, torque_nm=torque, pushes=pushes, commands=commands)
        yield _ratio(title, found, pairs, statistics)


def _ratio(name: str, found: ByRobot, pairs: Sequence[tuple[str, str]], statistics: Statistics) -> Effect:
    """Return the ratio of the errors of pairs of training sets, their geometric mean if there are several."""
    numbers: dict[str, Number] = {}
    for measure in ERRORS:
        logs: list[Array] = []
        for above, below in pairs:
            logs.append(np.log(found[above][measure].mean(axis=1) / found[below][measure].mean(axis=1)))
        number = summarise([_grid(np.mean(logs, axis=0)[:, None])], statistics, LOGS)
        value, low, high = (None if end is None else float(np.exp(end)) for end in number.with_ends)
        numbers[measure] = Number(value, low, high)
    return Effect(name, None, None, None, numbers)


def table_of(
    settings: Factorial,
    robots: Sequence[str],
    found: ByRobot,
    cells: Mapping[str, Factors],
    torque_nm: float,
    effects: Sequence[Effect],
    statistics: Statistics,
) -> Table:
    """Return the table: a line for each training set and each method beside them, then those of the effects."""
    rows: list[Sequence[Field]] = []
    blocks: dict[str, list[list[str]]] = {"training sets": [], "beside": [], "effects": []}
    for name, numbers in found.items():
        means = {key: _mean(numbers[key], unit, statistics) for key, unit in UNITS.items()}
        part = "training sets" if name in settings.cells else "beside"
        levels = _levels(cells[name], torque_nm) if name in cells else (None, None, None)
        for key, number in means.items():
            for robot, value in zip(robots, numbers[key].mean(axis=1), strict=True):
                rows.append((part, name, *levels, key, robot, float(value), None, None, number.unit))
            rows.append((part, name, *levels, key, ALL, *number.with_ends, number.unit))
        titles = {**dict.fromkeys(settings.cells, settings.method), settings.another_day: DAY.format(settings.method)}
        blocks[part].append([titles.get(name, name), *_texts(levels), *_cells(list(means.values()))])
    for effect in effects:
        levels = effect.torque_nm, effect.pushes, effect.commands
        for key, number in effect.numbers.items():
            rows.append(("effects", effect.name, *levels, key, ALL, *number.with_ends, number.unit))
        blocks["effects"].append([effect.name, *_texts(levels), *_cells(list(effect.numbers.values())), "", ""])
    interval = f"{statistics.confidence:.0%}"
    header = ["", "Random torque [N m]", "Pushes", "Commands", "Walking [N m]", interval]
    header += [f"Hits, {settings.joint} [N m]", interval, "Share of a hit", interval]
    lines: list[Line] = in_blocks(([], own) for own in blocks.values())
    return Table(FACTORIAL, rows, header, lines, left=4)


def _mean(values: Array, unit: str, statistics: Statistics) -> Number:
    """Return the mean of the numbers of walks (robots, walks) [unit], with its interval over robots."""
    return summarise([_grid(values)], statistics, unit=unit)


def _grid(values: Array) -> RunGrid:
    """Return numbers of robots and their own walks (robots, walks) [any unit] as runs."""
    return RunGrid(values, robots=tuple(range(len(values))))


def _levels(factors: Factors, torque_nm: float) -> tuple[float | None, str | None, str | None]:
    """Return the largest random torque [N m], pushes and commands of a training set as the table names them."""
    return torque_nm * factors.random_torque, PUSHES[factors.pushes], COMMANDS[factors.commands]


def _texts(levels: tuple[float | None, str | None, str | None]) -> list[str]:
    """Return levels of the factors as text; nothing where there are none, or all."""
    torque, pushes, commands = levels
    return ["" if torque is None else f"{torque:g}", pushes or "", commands or ""]


def _cells(numbers: Sequence[Number]) -> list[str]:
    """Return the texts of numbers, each before that of its interval."""
    cells: list[str] = []
    for number in numbers:
        cells += [number.text(), number.interval()]
    return cells


def _label(tried: Tried) -> str:
    """Return what the table calls a variant: its training set, or the name of a method that stands beside."""
    return str(tried.changes[DATA]) if tried.networks else tried.base
