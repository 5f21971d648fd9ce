"""What of the sections of tables does not fit the rest of the configuration."""

from collections.abc import Iterator, Mapping, Sequence

from experiments.settings.checks.results import Check, Results
from experiments.settings.runs import Mean
from experiments.settings.tables import (
    ErrorBudget,
    ErrorRow,
    ErrorTable,
    Hourly,
    Kinds,
    MethodsRow,
    NoiseTable,
    Table01,
    Uncertainty,
)
from mobnet.core.errors import misfit, not_accepted
from mobnet.formats.base import Section
from mobnet.formats.reading import Place, Problem


def column_problems(results: Results, columns: Sequence[str | Mean], place: Place) -> Iterator[Problem]:
    """Yield columns with a name that another one has, and means over forces and torques together."""
    names = list[str]()
    for index, column in enumerate(columns):
        new = list(results.joints(column)) if isinstance(column, str) else [column.name]
        for name in set(new) & set(names):
            yield (*place, index), misfit(name, "columns with names of their own")
        names += new
        if isinstance(column, Mean):
            joints = results.joints_of(column)
            if len(set(joints)) < len(joints):
                yield (*place, index, "joints"), misfit(list(column.joints), "each joint once")
            units = {results.layout.unit(joint) for joint in joints}
            if len(units) > 1:
                yield (*place, index, "joints"), misfit(list(column.joints), "joints with one unit, N or N m")


def error_table_problems(section: ErrorTable, results: Results, place: Place) -> Iterator[Problem]:
    """Yield columns, names and rows that do not fit; the place ends with the name of the table."""
    yield from column_problems(results, section.columns, (*place, "columns"))
    shown = set[str]()
    for row in section.rows:
        shown |= {*row.methods, *row.further}
    for name in section.names.keys() - shown:
        yield (*place, "names", name), not_accepted("method", name, shown)
    for index, row in enumerate(section.rows):
        row_place = (*place, "rows", index)
        if text := results.not_printed(str(place[-1]), row.paper):
            yield (*row_place, "paper"), text
        yield from _row_problems(section, results, row, row_place)


def _row_problems(section: ErrorTable, results: Results, row: ErrorRow, place: Place) -> Iterator[Problem]:
    """Yield metrics of a row that are not scored, and methods that stand in it twice."""
    metrics = {row.metric}
    for column in section.columns:
        metrics.update(column.metrics if isinstance(column, Mean) else ())
    for metric in sorted(metrics):
        if text := results.not_scored(row.scenario, metric):
            yield (*place, "metric" if metric == row.metric else "scenario"), text
    for k, method in enumerate(row.further):
        if method in row.methods:
            yield (*place, "further", k), misfit(method, "methods that are not among `methods`")


def error_budget_problems(section: ErrorBudget, results: Results, place: Place) -> Iterator[Problem]:
    """Yield columns that do not fit, and rows that cannot be compared with the first one."""
    yield from column_problems(results, section.joints, (*place, "joints"))
    first = section.tests[0]
    for index, row in enumerate(section.tests):
        before = section.tests[:index]
        if any(row.level == other.level or row.label == other.label for other in before):
            yield (*place, "tests", index), misfit(row.level, "a level and a label in one row only")
        if (row.scenario, row.methods) != (first.scenario, first.methods):
            yield (*place, "tests", index, "scenario"), misfit(row.scenario, "that of the first row")


def noise_table_problems(section: NoiseTable, results: Results, place: Place) -> Iterator[Problem]:
    """Yield places of numbers of the paper that it does not print."""
    for table, printed in section.paper.items():
        if text := results.not_printed(table, printed):
            yield (*place, "paper", table), text


def table_01_problems(section: Table01, results: Results, place: Place) -> Iterator[Problem]:
    """Yield a method without a network of a row of Table 1."""
    for limb in results.settings.published.table_01.rows:
        if section.method not in results.settings.methods or limb not in results.settings.methods[section.method].limbs:
            yield (*place, "method"), misfit(section.method, f"a method that trains {limb}, a row of Table 1")
            return


def kinds_problems(section: Kinds, results: Results, place: Place) -> Iterator[Problem]:
    """Yield variants that are not trained, or that Figure 17 shows."""
    figure = results.settings.evaluation.figure_17
    for k, method in enumerate(section.variants):
        if text := results.not_trained(method, figure.limb):
            yield (*place, "variants", k), text
        if method in (*figure.methods, *figure.best):
            yield (*place, "variants", k), misfit(method, "methods that Figure 17 does not show")


def methods_row_problems(section: MethodsRow, results: Results, place: Place) -> Iterator[Problem]:
    """Yield a metric that is not scored, and columns that a limb does not have."""
    if text := results.not_scored(section.scenario, section.metric):
        yield (*place, "metric"), text
    for limb, columns in section.columns.items():
        accepted = [*results.joints(limb), "avg"]
        for k, column in enumerate(columns):
            if column not in accepted:
                yield (*place, "columns", limb, k), not_accepted(f"column of {limb}", column, accepted)


def hourly_problems(section: Hourly, results: Results, place: Place) -> Iterator[Problem]:
    """Yield tests that section `changed` does not have."""
    tests = results.settings.evaluation.changed.tests
    for index, title in enumerate(section.known):
        if title not in tests:
            yield (*place, "known", index), not_accepted("test of section changed", title, tests)


def uncertainty_problems(section: Uncertainty, results: Results, place: Place) -> Iterator[Problem]:
    """Yield bounds for limbs of which the paper prints nothing."""
    printed = results.settings.published.uncertainty.std
    for limb in section.ratio:
        if limb not in printed:
            yield (*place, "ratio", limb), not_accepted("limb", limb, printed)


CHECKS: Mapping[type[Section], Check] = {
    ErrorTable: error_table_problems,
    ErrorBudget: error_budget_problems,
    NoiseTable: noise_table_problems,
    Table01: table_01_problems,
    Kinds: kinds_problems,
    MethodsRow: methods_row_problems,
    Hourly: hourly_problems,
    Uncertainty: uncertainty_problems,
}
