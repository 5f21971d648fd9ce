"""Table of standard deviations in parts of a walk, and outside of the training data."""

from pathlib import Path

from experiments.evaluation.compare.masks import MOVING, PUSHED, STUCK
from experiments.evaluation.compare.scene import STANCE, SWINGING, TOUCH_DOWN
from experiments.evaluation.measure.estimates.sigma import COVER, EXCURSION, STD
from experiments.evaluation.number.grid import AVERAGE, Lookup, Wanted
from experiments.evaluation.number.intervals import RATIO
from experiments.evaluation.number.number import Number
from experiments.evaluation.tables.rows import NumberRow, ViewColumn, average, by_limb, measured, share_percent
from experiments.settings.measures import Sigma
from experiments.settings.runs import Runs
from mobnet.core.joints import JointLayout

ERROR = "rmse"
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


def sigma_table(settings: Sigma, layout: JointLayout, lookup: Lookup, share: float, table_dir: Path) -> None:
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
    tests = list(settings.tests.items())
    rows = measured(lookup, layout, tests, metrics)
    for title, test in tests:
        if title in settings.against:
            for method in test.methods:
                for limb in test.limbs:
                    rises = rises_of(settings, lookup, title, method, limb)
                    for metric, number in zip(RISES, rises, strict=True):
                        rows.show(number, title=title, limb=limb, method=method, metric=metric)
    columns: list[ViewColumn] = []
    for part, head in PARTS.items():
        columns.append(ViewColumn(head if part else f"{share:.0%} {head}", average(COVER + part), text=share_percent))
    columns.append(ViewColumn("excursion [ms]", average(EXCURSION), digits=0))
    columns += [ViewColumn(head, {"metric": head}, text=_rise_text) for head in RISES]
    rows.write(table_dir / "sigma", by_limb("Test", columns))


def _rise_text(row: NumberRow) -> str:
    """Return a factor as text, nothing in a test that is compared with no other."""
    return row.number.text() if row.place else ""


def rises_of(settings: Sigma, lookup: Lookup, title: str, method: str, limb: str) -> list[Number]:
    """Return by which factors sigma and error exceed those of the test that is like the training data [-].

    Where a test has pushes, sigma counts while they act and the error in the windows around them.
    """
    test = settings.tests[title]
    like = settings.tests[settings.against[title]]
    pushed = lookup.average(test, method, limb, f"{STD}_{PUSHED}").value is not None
    pairs = [(f"{STD}_{PUSHED}", STD), ("rmse_pushed", ERROR)] if pushed else [(STD, STD), (ERROR, ERROR)]
    rises: list[Number] = []
    for own, other in pairs:
        wanted = [cell(test, method, limb, own), cell(like, method, limb, other)]
        rises.append(lookup.number(wanted, RATIO))
    return rises


def cell(test: Runs, method: str, limb: str, metric: str) -> Wanted:
    """Return the average of a metric over a limb."""
    return Wanted(test.scenario, limb, test.level, method, AVERAGE, metric)
