"""Table of what the walks of a training set teach: errors in walking and under hits of the knee, and what changes them.

Networks that differ in the walks that they learn from alone are judged on the same walks of each robot. An effect is
the ratio of the errors on two levels of a factor, means over a robot's walks. It is a geometric mean over robots, and
over the other factors where it stands for all of their levels; its interval is that of its logarithm over robots.
"""

# pandas has no complete types, which the strict rules of this folder ask for.
# pyright: standard

import logging
from collections.abc import Mapping, Sequence
from itertools import product
from pathlib import Path

import numpy as np
import pandas as pd

from experiments.evaluation.measure.learning.taught import HITS, SHARE_OF_HIT, WALKING, judged
from experiments.evaluation.measure.learning.trials import read_walks
from experiments.evaluation.number.frames import ordered, records_of, rows_of
from experiments.evaluation.number.laws import ENDS, fields_of
from experiments.evaluation.number.number import is_missing
from experiments.evaluation.tables.layout import Table, write_table
from experiments.evaluation.tables.look import ShownColumn, TableLook, lines_of
from experiments.intervals.crossed import Formula, RunGrid, summarise
from experiments.plan.runs import TaughtRobot, Tried
from experiments.settings.measures import Peaks
from experiments.settings.runs import Statistics
from experiments.settings.table_columns import FACTORIAL
from experiments.settings.trials import DATA, Factorial, Factors
from mobnet.core.arrays import Array
from mobnet.formats.robot import RobotTable
from mobnet.settings.methods import ObserverSettings

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
OF = {"random_torque": "random_torque_nm", "pushes": "pushes", "commands": "commands"}  # factor -> column of its level
LOGS = Formula(lambda means: means.mean(axis=0, keepdims=True))  # a mean of numbers of either sign
log = logging.getLogger(__name__)
ByRobot = Mapping[str, Mapping[str, Array]]  # variant -> measure -> numbers of walks (robots, walks)


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
    numbers_of_sets: dict[str, dict[str, list[Array]]] = {}
    for name, taught in robots.items():
        walk = read_walks(robot, gravity_m_s2, observer, taught.walk, rate_hz)
        hits = read_walks(robot, gravity_m_s2, observer, taught.hits, rate_hz)
        for tried in taught.walk.tried:
            every = judged(settings.hits, settings.joint, taught, tried, (walk, hits), peaks)
            numbers = {key: every[key] for key in UNITS}
            log.info("%s, %s: %s", name, tried.name, {key: round(float(row.mean()), 3) for key, row in numbers.items()})
            for key, row in numbers.items():
                numbers_of_sets.setdefault(_label(tried), {}).setdefault(key, []).append(row)
    by_robot = {name: {key: np.array(rows) for key, rows in of_set.items()} for name, of_set in numbers_of_sets.items()}
    effects = effects_of(by_robot, cells, torque_nm, statistics)
    another = ratios(by_robot, [(settings.another_day, settings.same_day)], statistics)
    effects = pd.concat([effects, another.assign(name=ANOTHER_DAY)])
    write_table(out, table_of(settings, list(robots), by_robot, cells, torque_nm, effects, statistics))


def effects_of(errors: ByRobot, cells: Mapping[str, Factors], torque_nm: float, statistics: Statistics) -> pd.DataFrame:
    """Return the effect of each factor at each pair of levels of the other two, then over all of them.

    A row has the name of an effect, `measure` and the ratio of errors on two levels of a factor [-]. Levels of the
    others are `random_torque_nm`, `pushes` and `commands`; they are missing where it is over all of them.
    """
    names: dict[Factors, str] = {}
    for name, factors in cells.items():
        names.setdefault(factors, name)  # the set of another day comes last, and has a cell's factors
    rows: list[pd.DataFrame] = []
    for factor, (above, below, title) in EFFECTS.items():
        others = [other for other in EFFECTS if other != factor]
        pairs: list[tuple[str, str]] = []
        for levels in product(*(EFFECTS[other][:2] for other in others)):
            at_levels = dict(zip(others, levels, strict=True))
            pair = names[Factors(**at_levels, **{factor: above})], names[Factors(**at_levels, **{factor: below})]
            pairs.append(pair)
            shown = {name: text for name, text in levels_of(cells[pair[0]], torque_nm).items() if name != OF[factor]}
            rows.append(ratios(errors, [pair], statistics).assign(name=title, **shown))
        rows.append(ratios(errors, pairs, statistics).assign(name=title))
    return pd.concat(rows, ignore_index=True)


def ratios(errors: ByRobot, pairs: Sequence[tuple[str, str]], statistics: Statistics) -> pd.DataFrame:
    """Return the ratio of the errors of pairs of training sets by measure, of several their geometric mean."""
    rows: list[dict[str, object]] = []
    for measure in ERRORS:
        logs: list[Array] = []
        for above, below in pairs:
            logs.append(np.log(errors[above][measure].mean(axis=1) / errors[below][measure].mean(axis=1)))
        number = summarise([_grid(np.mean(logs, axis=0)[:, None])], statistics, LOGS)
        value, low, high = (None if end is None else float(np.exp(end)) for end in number.with_ends)
        rows.append({"measure": measure, "value": value, "low": low, "high": high, "unit": "-"})
    return pd.DataFrame(rows).astype(dict.fromkeys(ENDS, float))


def table_of(
    settings: Factorial,
    robots: Sequence[str],
    by_robot: ByRobot,
    cells: Mapping[str, Factors],
    torque_nm: float,
    effects: pd.DataFrame,
    statistics: Statistics,
) -> Table:
    """Return the table: a line for each training set and each method beside them, then those of the effects."""
    sets: list[dict[str, object]] = []
    for name, numbers in by_robot.items():
        part = "training sets" if name in settings.cells else "beside"
        place = {"part": part, "name": name, **(levels_of(cells[name], torque_nm) if name in cells else {})}
        for measure, unit in UNITS.items():
            for robot, value in zip(robots, numbers[measure].mean(axis=1), strict=True):
                sets.append({**place, "measure": measure, "robot": robot, "value": float(value), "unit": unit})
            number = summarise([_grid(numbers[measure])], statistics, unit=unit)
            sets.append({**place, "measure": measure, "robot": ALL, **fields_of(number)})
    both = pd.concat([pd.DataFrame(sets), effects.assign(part="effects", robot=ALL)], ignore_index=True)
    rows = both.reindex(columns=list(FACTORIAL))
    titles = {**dict.fromkeys(settings.cells, settings.method), settings.another_day: DAY.format(settings.method)}
    shown = ordered(rows_of(rows, robot=ALL), part=["training sets", "beside", "effects"])
    shown = shown.sort_values("part", kind="stable")
    levels = [torque_text(torque) for torque in shown["random_torque_nm"].tolist()]
    shown = shown.assign(title=shown["name"].replace(titles), torque=levels)
    shown = shown.fillna({"pushes": "", "commands": ""})
    look = look_of(settings, statistics)
    return Table(FACTORIAL, records_of(rows, FACTORIAL), look.header, lines_of(shown, look), left=4)


def look_of(settings: Factorial, statistics: Statistics) -> TableLook:
    """Return what a reader sees: a line for each training set, method and effect."""
    heads = {WALKING: "Walking [N m]", HITS: f"Hits, {settings.joint} [N m]", SHARE_OF_HIT: "Share of a hit"}
    ends = f"{statistics.confidence:.0%}"
    shown = [ShownColumn(head, {"measure": measure}, ends=ends, none="") for measure, head in heads.items()]
    labels = {"title": "", "torque": "Random torque [N m]", "pushes": "Pushes", "commands": "Commands"}
    return TableLook(labels, shown, blocks=["part"])


def torque_text(torque_nm: float) -> str:
    """Return the largest random torque [N m] as text; nothing where there is none, or all."""
    return "" if is_missing(torque_nm) else f"{torque_nm:g}"


def levels_of(factors: Factors, torque_nm: float) -> dict[str, float | str]:
    """Return the largest random torque [N m], pushes and commands of a training set as the table names them."""
    return {
        "random_torque_nm": torque_nm * factors.random_torque,
        "pushes": PUSHES[factors.pushes],
        "commands": COMMANDS[factors.commands],
    }


def _grid(values: Array) -> RunGrid:
    """Return numbers of robots and their own walks (robots, walks) [any unit] as runs."""
    return RunGrid(values, robots=tuple(range(len(values))))


def _label(tried: Tried) -> str:
    """Return what the table calls a variant: its training set, or the name of a method that stands beside."""
    return str(tried.changes[DATA]) if tried.networks else tried.base
