"""Table of standard deviations in parts of a walk, and outside of the training data."""

from collections.abc import Sequence
from functools import partial
from pathlib import Path

from experiments.evaluation.compare.masks import MOVING, PUSHED, STUCK
from experiments.evaluation.compare.scene import STANCE, SWINGING, TOUCH_DOWN
from experiments.evaluation.measure.estimates.sigma import COVER, EXCURSION, STD
from experiments.evaluation.number.grid import Wanted
from experiments.evaluation.number.intervals import RATIO
from experiments.evaluation.number.lookup import AVERAGE, Lookup
from experiments.evaluation.tables.layout import percent, write_measured
from experiments.settings.measures import Sigma
from experiments.settings.runs import LimbRuns, Runs
from mobnet.core.joints import JointLayout

ERROR = "rmse"
PARTS = {
    "": "all", f"_{SWINGING}": "swing", f"_{TOUCH_DOWN}": "touch-down", f"_{STANCE}": "stance", f"_{STUCK}": "stuck",
    f"_{MOVING}": "moving", f"_{PUSHED}": "pushed",
}  # fmt: skip


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
    heads = [f"{share:.0%} {part}" if not key else part for key, part in PARTS.items()]
    header = ["Test", "Limb", "Method", *heads, "excursion [ms]", "sigma, times", "error, times"]
    tests = list(settings.tests.items())
    lines = partial(lines_of, settings, lookup)
    write_measured(table_dir / "sigma", lookup, layout, tests, metrics, header, lines)


def lines_of(settings: Sigma, lookup: Lookup, test: LimbRuns, limb: str) -> list[list[str]]:
    """Return a line of texts for each method of a test."""
    title = next(title for title, one in settings.tests.items() if one is test)
    lines = []
    for method in test.methods:
        covered = [percent(lookup.average(test, method, limb, COVER + part)) for part in PARTS]
        excursion = lookup.average(test, method, limb, EXCURSION).text(0)
        lines.append([method, *covered, excursion, *rises(settings, lookup, title, method, limb)])
    return lines


def rises(settings: Sigma, lookup: Lookup, title: str, method: str, limb: str) -> Sequence[str]:
    """Return by which factors sigma and error exceed those of the test that is like the training data, as texts.

    Where a test has pushes, sigma counts while they act and the error in the windows around them.
    """
    base = settings.against.get(title)
    if base is None:
        return "", ""
    test = settings.tests[title]
    like = settings.tests[base]
    pushed = lookup.average(test, method, limb, f"{STD}_{PUSHED}").value is not None
    pairs = [(f"{STD}_{PUSHED}", STD), ("rmse_pushed", ERROR)] if pushed else [(STD, STD), (ERROR, ERROR)]
    found = [lookup.number([cell(test, method, limb, own), cell(like, method, limb, other)], RATIO)
             for own, other in pairs]  # fmt: skip
    return [number.text() for number in found]


def cell(test: Runs, method: str, limb: str, metric: str) -> Wanted:
    """Return the average of a metric over a limb."""
    return Wanted(test.scenario, limb, test.level, method, AVERAGE, metric)
