"""The runs behind numbers: what a table asks for, joined with the scores, and the number that runs make."""

# pandas has no complete types, which the strict rules of this folder ask for.
# pyright: standard

from collections.abc import Iterable, Sequence

import numpy as np
import pandas as pd

from experiments.evaluation.number.laws import measured
from experiments.evaluation.number.number import Number, published_value
from experiments.intervals.crossed import MEAN, Formula, RunGrid, summarise
from experiments.settings.fleet import FIRST_SEED
from experiments.settings.published import PublishedTable
from experiments.settings.runs import LimbRuns, Mean, Runs, Statistics
from mobnet.core.errors import ConfigError, DataError
from mobnet.core.joints import JointLayout

AVERAGE = "avg"
CELL = ["scenario", "limb", "level", "method", "joint", "metric"]  # what names the runs of a number


def runs_of(scores: pd.DataFrame, asked: pd.DataFrame, *, may_lack: bool = False) -> pd.DataFrame:
    """Return the rows that are asked for, columns CELL and any others, each once for every run; `cell` numbers them.

    With `may_lack`, a row without a run stays, once and with a missing value: the runs may be there, and a number not,
    such as that of a push after the end of a short test, or of a joint that it does not turn.

    Raises:
        DataError: what is asked for has no run.
    """
    runs = asked.assign(cell=range(len(asked))).merge(scores, how="left", on=CELL)
    lost = runs[runs["value"].isna()]
    if len(lost) and not may_lack:
        raise DataError(f"scores: no row for {cell_text(lost[CELL].iloc[0])}")
    return runs


def asked_of(
    tests: Iterable[tuple[str, LimbRuns]], metrics: Sequence[str], layout: JointLayout | None = None
) -> pd.DataFrame:
    """Return what is asked for of titled tests, columns `title` and CELL: metrics, test by test and method by method.

    They are those of a limb's average and, with a layout, before it those of each of its joints.
    """
    asked: list[tuple[str, ...]] = []
    for title, test in tests:
        for method in test.methods:
            for limb in test.limbs:
                for joint in (*(layout.limb(limb) if layout else ()), AVERAGE):
                    asked += [(title, test.scenario, limb, test.level, method, joint, metric) for metric in metrics]
    return pd.DataFrame(asked, columns=["title", *CELL])


def numbers_of(
    scores: pd.DataFrame, asked: pd.DataFrame, statistics: Statistics, *, may_lack: bool = True
) -> pd.DataFrame:
    """Return the mean of the runs of each row that is asked for, in the same order; of a row without a run none.

    Raises:
        DataError: what is asked for has no run, without `may_lack`.
    """
    runs = runs_of(scores, asked, may_lack=may_lack)
    numbers = measured(runs, ["cell"], {"mean": lambda same: number_of(same, statistics)})
    return pd.concat([asked.reset_index(drop=True), numbers.drop(columns="quantity")], axis=1)


def joint_errors(
    scores: pd.DataFrame,
    layout: JointLayout,
    test: Runs,
    joints: Sequence[str],
    metric: str,
    statistics: Statistics,
    published: PublishedTable,
    place: str,
) -> pd.DataFrame:
    """Return the errors of joints in a test by method [N m], V1..V3 [N], joint by joint: CELL and the number.

    The paper's numbers are those at a place of one of its tables. An error that was not scored has no value.
    """
    asked: list[tuple[str, ...]] = []
    for joint in joints:
        limb = layout.limb_of[joint]
        asked += [(test.scenario, limb, test.level, method, joint, metric) for method in test.methods]
    errors = numbers_of(scores, pd.DataFrame(asked, columns=CELL), statistics)
    named = zip(errors["method"], errors["joint"], strict=True)
    printed = [published_value(published, place, method, joint) for method, joint in named]
    return errors.assign(unit=errors["joint"].map(layout.unit), published=pd.Series(printed, dtype=float))


def run_grid(runs: pd.DataFrame) -> RunGrid:
    """Return the runs of one cell, (networks, walks) in the unit of its metric, seeds ascending.

    Raises:
        DataError: two rows of the same run, or a network that misses a test.
    """
    # In ascending order column k of every grid is the walk of the same seed, over which numbers are paired
    # (docs/notes/measures.md); a robot has walks of its own.
    network_seeds = runs["network_seed"].to_numpy()
    test_seeds = runs["test_seed"].to_numpy()
    order = np.lexsort((test_seeds, network_seeds))
    networks, counts = np.unique(network_seeds, return_counts=True)
    tests = np.unique(test_seeds)
    robots = robots_of(networks.tolist())
    walks = counts[0] if robots else len(tests)
    seeds = np.stack([network_seeds, test_seeds])[:, order]
    is_twice = (seeds[:, 1:] == seeds[:, :-1]).all(axis=0).any()
    # Variances of rows and of columns need equally many walks of each network, and each run once.
    if is_twice or (counts != walks).any():
        of = cell_text(runs[CELL].iloc[0])
        expected = f"one for each of networks {networks.tolist()} on tests {tests.tolist()}"
        raise DataError(f"scores: {len(runs)} rows for {of}; expected {expected}")
    values = runs["value"].to_numpy()[order].reshape(len(networks), -1)
    return RunGrid(values, runs["method"].iloc[0], robots)


def robots_of(seeds: Sequence[int]) -> tuple[int, ...]:
    """Return the robots of runs with some network seeds, where these are robots; else nothing."""
    return tuple(seeds) if min(seeds) >= FIRST_SEED else ()


def number_of(runs: pd.DataFrame, statistics: Statistics, formula: Formula = MEAN) -> Number:
    """Return the number that a formula makes of the means of cells, in the unit of the first one, e.g. [N m].

    There is none where a cell has no run.
    """
    if runs["value"].isna().any():
        return Number(None)
    cells = [runs] if runs["cell"].nunique() == 1 else [same for _, same in runs.groupby("cell")]
    grids = [run_grid(same) for same in cells]
    return summarise(grids, statistics, formula, runs["unit"].iloc[0])


def cell_text(place: Iterable[str]) -> str:
    """Return what a number is of, values of CELL, as text for a message."""
    return ", ".join(f"{name} {value!r}" for name, value in zip(CELL, place, strict=True))


def columns_of(layout: JointLayout, items: Sequence[str | Mean]) -> pd.DataFrame:
    """Return the columns that a table's configuration asks for, such as those of Table 6: a row for each joint of each.

    An item is a joint, a limb for its joints one by one, or a mean over some of both and perhaps over metrics. The
    frame has `column`, the `torque_unit` of its joints, `limb`, `joint` and `metric`, which is empty where each row of
    the table names its own.

    Raises:
        ConfigError: a joint is unknown, or a mean is over several units.
    """
    rows: list[tuple[str, str, str, str, str]] = []
    for item in items:
        if isinstance(item, str):
            for joint in members(layout, item):
                rows += column_of(layout, joint, [joint], ())
        else:
            joints: list[str] = []
            for name in item.joints:
                joints += members(layout, name)
            rows += column_of(layout, item.name, joints, item.metrics)
    columns = pd.DataFrame(rows, columns=["column", "torque_unit", "limb", "joint", "metric"])
    return columns.assign(column=pd.Categorical(columns["column"], columns["column"].unique()))


def column_of(
    layout: JointLayout, name: str, joints: Sequence[str], metrics: Sequence[str]
) -> list[tuple[str, str, str, str, str]]:
    """Return the rows of a column: name, unit of its torques, limb, joint and metric."""
    rows: list[tuple[str, str, str, str, str]] = []
    for limb, joint in places_of(layout, name, joints):
        rows += [(name, layout.unit(joint), limb, joint, metric) for metric in metrics or ("",)]
    return rows


def places_of(layout: JointLayout, name: str, joints: Sequence[str]) -> list[tuple[str, str]]:
    """Return limb and name of some joints, over which a mean is taken: torques must be all in N m or all in N.

    Raises:
        ConfigError: a joint is unknown, or the units differ.
    """
    layout.columns(joints)
    units = sorted({layout.unit(joint) for joint in joints})
    if len(units) > 1:
        raise ConfigError(f"column {name!r}: a mean over {', '.join(joints)} mixes {' and '.join(units)}")
    return [(layout.limb_of[joint], joint) for joint in joints]


def members(layout: JointLayout, name: str) -> tuple[str, ...]:
    """Return the joints of a limb, or the joint itself."""
    return layout.groups.get(name, (name,))
