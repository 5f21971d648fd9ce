"""What tables show, those of detection and of reactions apart: one section for each."""

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Annotated

from pydantic import AfterValidator, Field

from experiments.settings.detection_tables import AlarmTable
from experiments.settings.products import Checked
from experiments.settings.runs import Columns, LimbsOrJoints, Mean, Metric, Runs, Texts
from mobnet.core.errors import misfit, not_accepted
from mobnet.settings import base
from mobnet.settings.base import Section
from mobnet.settings.reading import Place, Problem

if TYPE_CHECKING:  # which knows all sections
    from experiments.settings.checks.results import Results


def column_problems(results: "Results", columns: Sequence[str | Mean], place: Place) -> Iterator[Problem]:
    """Yield columns with a name that another one has, and means over forces and torques together."""
    names = list[str]()
    for index, column in enumerate(columns):
        new = list(results.joints(column)) if isinstance(column, str) else [column.name]
        for name in set(new) & set(names):
            yield (*place, index), misfit(name, "columns with names of their own")
        names += new
        if isinstance(column, Mean):
            held = results.joints_of(column)
            if len(set(held)) < len(held):
                yield (*place, index, "joints"), misfit(list(column.joints), "each joint once")
            units = {results.layout.unit(joint) for joint in held}
            if len(units) > 1:
                yield (*place, index, "joints"), misfit(list(column.joints), "joints with one unit, N or N m")


class ErrorRow(Runs):
    """Rows of a table of errors, one for each method; `labels` are the texts of the leading columns.

    Methods that the paper does not have follow as `further`, in shorter rows.
    """

    labels: tuple[base.Text, ...]
    further: Annotated[tuple[base.MethodName, ...], AfterValidator(base.distinct)] = ()
    metric: Metric = "rmse"
    paper: base.Text | None = None


class ErrorTable(Checked):
    """A table of errors by test, method and joint.

    `header` has the heads of the leading columns; `names` says how the table calls a method, where not by its own name.
    """

    header: Texts
    columns: Columns
    parts: Texts = ()
    names: dict[base.MethodName, base.Text] = {}
    rows: base.Some[ErrorRow]

    def problems(self, results: "Results", place: Place) -> Iterator[Problem]:
        """Yield columns, names and rows that do not fit; the place ends with the name of the table."""
        yield from column_problems(results, self.columns, (*place, "columns"))
        shown = set[str]()
        for row in self.rows:
            shown |= {*row.methods, *row.further}
        for name in self.names.keys() - shown:
            yield (*place, "names", name), not_accepted("method", name, shown)
        for index, row in enumerate(self.rows):
            own = (*place, "rows", index)
            if text := results.not_printed(str(place[-1]), row.paper):
                yield (*own, "paper"), text
            yield from self._row_problems(results, row, own)

    def _row_problems(self, results: "Results", row: ErrorRow, place: Place) -> Iterator[Problem]:
        """Yield metrics of a row that are not scored, and methods that stand in it twice."""
        metrics = {row.metric}
        for column in self.columns:
            metrics.update(column.metrics if isinstance(column, Mean) else ())
        for metric in sorted(metrics):
            if text := results.not_scored(row.scenario, metric):
                yield (*place, "metric" if metric == row.metric else "scenario"), text
        for k, method in enumerate(row.further):
            if method in row.methods:
                yield (*place, "further", k), misfit(method, "methods that are not among `methods`")


class BudgetRow(Runs):
    """One method, the observer, at one level; `label` is what a table calls it."""

    label: base.Text
    methods: tuple[base.MethodName]


class ErrorBudget(Checked):
    """The observer with every source of error on, then with one of them off."""

    joints: Columns
    tests: Annotated[tuple[BudgetRow, ...], Field(min_length=2)]

    def problems(self, results: "Results", place: Place) -> Iterator[Problem]:
        """Yield columns that do not fit, and rows that cannot be compared with the first one."""
        yield from column_problems(results, self.joints, (*place, "joints"))
        first = self.tests[0]
        for index, row in enumerate(self.tests):
            before = self.tests[:index]
            if any(row.level == other.level or row.label == other.label for other in before):
                yield (*place, "tests", index), misfit(row.level, "a level and a label in one row only")
            if (row.scenario, row.methods) != (first.scenario, first.methods):
                yield (*place, "tests", index, "scenario"), misfit(row.scenario, "that of the first row")


class NoiseTable(Checked):
    """Readings of Table 3 side by side; the paper's numbers stand at a place in each of some tables."""

    joints: LimbsOrJoints
    paper: Annotated[dict[base.LowerName, base.Text], Field(min_length=1)]
    tests: base.Some[BudgetRow]

    def problems(self, results: "Results", place: Place) -> Iterator[Problem]:
        """Yield places of numbers of the paper that it does not print."""
        for table, printed in self.paper.items():
            if text := results.not_printed(table, printed):
                yield (*place, "paper", table), text


class Table01(Checked):
    """Table 1: the method whose networks are shown."""

    method: base.MethodName

    def problems(self, results: "Results", place: Place) -> Iterator[Problem]:
        """Yield a method without a network of a row of Table 1."""
        for limb in results.settings.published.table_01.rows:
            if self.method not in results.settings.methods or limb not in results.settings.methods[self.method].limbs:
                yield (*place, "method"), misfit(self.method, f"a method that trains {limb}, a row of Table 1")
                return


class Kinds(Checked):
    """The table of kinds of networks: variants below those of Figure 17, trained at a level of their own."""

    level: base.LevelName
    variants: Annotated[tuple[base.MethodName, ...], AfterValidator(base.distinct)]

    def problems(self, results: "Results", place: Place) -> Iterator[Problem]:
        """Yield variants that are not trained, or that Figure 17 shows."""
        figure = results.settings.evaluation.figure_17
        for k, method in enumerate(self.variants):
            if text := results.not_trained(method, figure.limb):
                yield (*place, "variants", k), text
            if method in (*figure.methods, *figure.best):
                yield (*place, "variants", k), misfit(method, "methods that Figure 17 does not show")


class MethodsRow(Checked, Runs):
    """Methods side by side on one test; limb -> its columns, joints or `avg`."""

    metric: Metric = "rmse"
    columns: Annotated[dict[base.LimbName, base.Distinct[base.Text]], Field(min_length=1)]

    def problems(self, results: "Results", place: Place) -> Iterator[Problem]:
        """Yield a metric that is not scored, and columns that a limb does not have."""
        if text := results.not_scored(self.scenario, self.metric):
            yield (*place, "metric"), text
        for limb, columns in self.columns.items():
            accepted = [*results.joints(limb), "avg"]
            for k, column in enumerate(columns):
                if column not in accepted:
                    yield (*place, "columns", limb, k), not_accepted(f"column of {limb}", column, accepted)


class Hourly(Checked):
    """Events in an hour: falls, and flags in the tests `known` of section `changed`, whose robots the networks know."""

    known: base.Distinct[base.Text]

    def problems(self, results: "Results", place: Place) -> Iterator[Problem]:
        """Yield tests that section `changed` does not have."""
        tests = results.settings.evaluation.changed.tests
        for index, title in enumerate(self.known):
            if title not in tests:
                yield (*place, "known", index), not_accepted("test of section changed", title, tests)


class DataTable(Section):
    """The table of the training sets.

    `shown`: sets in the text (the CSV file has all); `every`: samples from one look at the upper body to the next;
    `limbs`: those whose random torque is looked at; `lags_s`: times after a step of it at which the desired torque is
    looked at.
    """

    shown: base.Distinct[base.TrainingSetName]
    every: base.Whole = Field(ge=1, le=1000)
    limbs: base.Distinct[base.LimbName]
    lags_s: base.Some[Annotated[base.Positive, Field(le=1)]]


class Steps(Section):
    """Measured against commanded steps: a step within the tolerance of its command follows it."""

    bins: base.Whole = Field(ge=2, le=200)
    tolerance: base.Real = Field(ge=0.001, le=0.5)


class Uncertainty(Checked):
    """Size of the uncertainty torque: limb -> accepted ratio of simulated to real size; that of each robot's joints."""

    ratio: dict[base.NetworkName, base.Span[Annotated[base.Real, Field(ge=0.01, le=100)]]]
    robot_ratio: base.Span[Annotated[base.Real, Field(ge=0.01, le=100)]]

    def problems(self, results: "Results", place: Place) -> Iterator[Problem]:
        """Yield bounds for limbs of which the paper prints nothing."""
        printed = results.settings.published.uncertainty.std
        for limb in self.ratio:
            if limb not in printed:
                yield (*place, "ratio", limb), not_accepted("limb", limb, printed)


class LabelError(Section):
    """Errors of the labels of foot sensors at the joints of a leg, in a walk of each surrogate robot."""

    leg: base.LimbName


class Latency(Section):
    """The table of latency: stretches of ticks of a method's networks."""

    method: base.LearnedName
    stretches: base.Whole = Field(ge=2, le=1000)
    ticks: base.Whole = Field(ge=10, le=100_000)


class Compute(Section):
    """The table of compute: a longer time without any job lies between two runs."""

    pause_s: base.Real = Field(ge=1, le=3600)


class PlantColumns(Section):
    """Columns of one plant: a walk and a push, each as `<scenario>@<level>`, and the table with the paper's errors."""

    title: base.Text
    walk: base.Text
    printed: base.LowerName
    push: base.Text


class LegsTable(Section):
    """Methods on the left leg, plant by plant."""

    plants: base.Some[PlantColumns]
    methods: base.MethodNames


class LimbLine(Section):
    """A limb in a test: `test` is `<table>@<scenario>@<level>`, `column` what stands behind a method there."""

    title: base.Text
    part: base.Text
    test: base.Text
    column: base.Text


class LimbsTable(Section):
    """Errors over that of estimating nothing, by limb and method."""

    lines: base.Some[LimbLine]
    methods: base.MethodNames


class MainTables(Section):
    """The tables of the paper's main text, made from other tables."""

    legs: LegsTable
    by_limb: LimbsTable
    detectors: AlarmTable
