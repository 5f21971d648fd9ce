"""Table of standard deviations in parts of a walk, and outside of the training data."""

from collections.abc import Mapping
from pathlib import Path

import pandas as pd

from experiments.evaluation.compare.masks import MOVING, PUSHED, STUCK
from experiments.evaluation.compare.scene import STANCE, SWINGING, TOUCH_DOWN
from experiments.evaluation.measure.estimates.sigma import COVER, EXCURSION, STD
from experiments.evaluation.number.laws import measured
from experiments.evaluation.number.scored import AVERAGE, asked_of, number_of, numbers_of, runs_of
from experiments.evaluation.tables.look import ShownColumn, average, by_limb, percent, write_look
from experiments.intervals.crossed import RATIO
from experiments.settings.measures import Sigma
from experiments.settings.runs import LimbRuns, Statistics
from experiments.settings.table_columns import METHODS
from mobnet.core.joints import JointLayout

ERROR = "rmse"
ERROR_PUSHED = "rmse_pushed"  # in the windows around pushes
RISES = ("sigma, times", "error, times")
PARTS = {
    "": "all",
    f"_{SWINGING}": "swing",
    f"_{TOUCH_DOWN}": "touch-down",
    f"_{STANCE}": "stance",
    f"_{STUCK}": "stuck",
    f"_{MOVING}": "moving",
    f"_{PUSHED}": "pushed",
}


def sigma_table(
    settings: Sigma, layout: JointLayout, scores: pd.DataFrame, statistics: Statistics, share: float, table_dir: Path
) -> None:
    """Write sigma.csv, with every joint and intervals, and sigma.tex and .md: means over the joints of a limb.

    Columns are the share [%] of errors within the interval of a nominal share [-] in parts of a walk, how long an
    excursion lasts [ms], and, for tests unlike the training data, by which factor the standard deviation and the error
    exceed those of the test that is like it.
    """
    metrics: list[str] = []
    for part in PARTS:
        metrics += [COVER + part, STD + part]
    metrics += [ERROR, EXCURSION]
    for k in range(1, settings.parts + 1):
        metrics += [f"{name}_part_{k}" for name in (STD, ERROR, COVER)]
    numbers = numbers_of(scores, asked_of(settings.tests.items(), metrics, layout), statistics)
    rows = pd.concat([numbers, rises_of(settings, numbers, scores, statistics)], ignore_index=True)
    shown: list[ShownColumn] = []
    for part, head in PARTS.items():
        shown.append(ShownColumn(head if part else f"{share:.0%} {head}", average(COVER + part), text=percent))
    shown.append(ShownColumn("excursion [ms]", average(EXCURSION), digits=0))
    # A test that is compared with no other one has no rise.
    shown += [ShownColumn(head, {"metric": head}, none="") for head in RISES]
    filed = numbers[numbers["value"].notna()]
    write_look(table_dir / "sigma", rows, METHODS, by_limb("Test", shown), filed)


def rises_of(settings: Sigma, numbers: pd.DataFrame, scores: pd.DataFrame, statistics: Statistics) -> pd.DataFrame:
    """Return by which factors sigma and error exceed those of the test that is like the training data [-].

    Where a test has pushes, sigma counts while they act and the error in the windows around them.
    """
    asked: list[dict[str, object]] = []
    averages = numbers[numbers["joint"] == AVERAGE].set_index(["title", "limb", "method", "metric"])["value"]
    for title, like in settings.against.items():
        test = settings.tests[title]
        for method in test.methods:
            for limb in test.limbs:
                pushed = pd.notna(averages[title, limb, method, f"{STD}_{PUSHED}"])
                pairs = [(f"{STD}_{PUSHED}", STD), (ERROR_PUSHED, ERROR)] if pushed else [(STD, STD), (ERROR, ERROR)]
                for rise, (metric, other) in zip(RISES, pairs, strict=True):
                    place = {"title": title, "limb": limb, "method": method, "rise": rise}
                    asked.append({**place, **cell(test, metric)})
                    asked.append({**place, **cell(settings.tests[like], other)})
    if not asked:
        return numbers.iloc[:0]
    runs = runs_of(scores, pd.DataFrame(asked), may_lack=True)
    place = ["title", "limb", "method", "rise"]
    rises = measured(runs, place, {"rise": lambda same: number_of(same, statistics, RATIO)})
    return rises.rename(columns={"rise": "metric"})


def cell(test: LimbRuns, metric: str) -> Mapping[str, str]:
    """Return what is asked for of a test: the average of a metric over the joints of a limb."""
    return {"scenario": test.scenario, "level": test.level, "joint": AVERAGE, "metric": metric}
