"""What tables show, those of detection and of reactions apart: one section for each."""

from typing import Annotated

from pydantic import AfterValidator, Field

from experiments.settings.detection_tables import AlarmTable
from experiments.settings.runs import Columns, LimbsOrJoints, Metric, Runs, Texts
from mobnet.formats import base
from mobnet.formats.base import Section


class ErrorRow(Runs):
    """Rows of a table of errors, one for each method; `labels` are the texts of the leading columns.

    Methods that the paper does not have follow as `further`, in shorter rows.
    """

    labels: tuple[base.Text, ...]
    further: Annotated[tuple[base.MethodName, ...], AfterValidator(base.distinct)] = ()
    metric: Metric = "rmse"
    paper: base.Text | None = None


class ErrorTable(Section):
    """A table of errors by test, method and joint.

    `header` has the heads of the leading columns; `names` says how the table calls a method, where not by its own name.
    """

    header: Texts
    columns: Columns
    parts: Texts = ()
    names: dict[base.MethodName, base.Text] = {}
    rows: base.Some[ErrorRow]


class BudgetRow(Runs):
    """One method, the observer, at one level; `label` is what a table calls it."""

    label: base.Text
    methods: tuple[base.MethodName]


class ErrorBudget(Section):
    """The observer with every source of error on, then with one of them off."""

    joints: Columns
    tests: Annotated[tuple[BudgetRow, ...], Field(min_length=2)]


class NoiseTable(Section):
    """Readings of Table 3 side by side; the paper's numbers stand at a place in each of some tables."""

    joints: LimbsOrJoints
    paper: Annotated[dict[base.LowerName, base.Text], Field(min_length=1)]
    tests: base.Some[BudgetRow]


class Table01(Section):
    """Table 1: the method whose networks are shown."""

    method: base.MethodName


class Kinds(Section):
    """The table of kinds of networks: variants below those of Figure 17, trained at a level of their own."""

    level: base.LevelName
    variants: Annotated[tuple[base.MethodName, ...], AfterValidator(base.distinct)]


class MethodsRow(Runs):
    """Methods side by side on one test; limb -> its columns, joints or `avg`."""

    metric: Metric = "rmse"
    columns: Annotated[dict[base.LimbName, base.Distinct[base.Text]], Field(min_length=1)]


class Hourly(Section):
    """Events in an hour: falls, and flags in the tests `known` of section `changed`, whose robots the networks know."""

    known: base.Distinct[base.Text]


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


class Uncertainty(Section):
    """Size of the uncertainty torque: limb -> accepted ratio of simulated to real size; that of each robot's joints."""

    ratio: dict[base.NetworkName, base.Span[Annotated[base.Real, Field(ge=0.01, le=100)]]]
    robot_ratio: base.Span[Annotated[base.Real, Field(ge=0.01, le=100)]]


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
