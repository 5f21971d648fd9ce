"""What tables and figures show: one section for each, under its own name."""

from typing import Annotated

from pydantic import Field

from mobnet.settings.base import (
    Count,
    InnerShare,
    JointName,
    LevelName,
    LimbName,
    LimbOrJointName,
    MethodName,
    MethodNames,
    MotorName,
    NetworkName,
    NotNegative,
    Positive,
    PushedTestName,
    Range,
    Section,
    Share,
    ShareRange,
    SweepName,
    TestName,
    Text,
)  # fmt: skip

Metric = Annotated[str, Field(pattern=r"^(rmse|r_rmse|roughness|rmse_pushed|rmse_push_[1-9][0-9]*)$")]
LimbsOrJoints = Annotated[tuple[LimbOrJointName, ...], Field(min_length=1)]


class Statistics(Section):
    """Intervals over networks and test recordings."""

    confidence: InnerShare
    bootstrap_draws: Count


class Window(Section):
    """Time around each push of a test that its push metrics look at."""

    before_s: NotNegative
    after_s: NotNegative


class Runs(Section):
    """Methods on one test at one level."""

    scenario: TestName
    level: LevelName
    methods: MethodNames


class PushedRuns(Section):
    """Methods on one test that has pushes."""

    scenario: PushedTestName
    level: LevelName
    methods: MethodNames


class Mean(Section):
    """A column that is a mean over joints, or over metrics."""

    name: Text
    joints: LimbsOrJoints
    metrics: tuple[Metric, ...] = ()


Columns = Annotated[tuple[LimbOrJointName | Mean, ...], Field(min_length=1)]


class ErrorRow(Runs):
    """Rows of a table of errors, one for each method.

    Attributes:
        labels: texts of the leading columns.
        paper: place of the paper's numbers in its table of `configs/published.yaml`.
    """

    labels: tuple[str, ...]
    metric: Metric = "rmse"
    paper: Text | None = None


class ErrorTable(Section):
    """A table of errors by test, method and joint.

    Attributes:
        header: heads of the leading columns.
        columns: a joint, a limb for its joints one by one, or a mean.
        parts: columns at which a further part begins in TeX, because the table is too wide for a page.
        names: method -> how the table calls it, where that is not its own name.
    """

    header: tuple[str, ...]
    columns: Columns
    parts: tuple[str, ...] = ()
    names: dict[MethodName, str] = {}
    rows: Annotated[tuple[ErrorRow, ...], Field(min_length=1)]


class BudgetRow(Section):
    """The observer with some sources of error on."""

    label: Text
    scenario: TestName
    level: LevelName
    methods: Annotated[tuple[MethodName], Field()]


class ErrorBudget(Section):
    """The observer with every source of error on, then with one of them off."""

    joints: Columns
    tests: Annotated[tuple[BudgetRow, ...], Field(min_length=2)]


class Table01(Section):
    """Table 1: the method whose networks are shown."""

    method: MethodName


class Figure05(Section):
    """Figure 5: one joint over a gait cycle, a panel for each method of each level."""

    scenario: TestName
    joint: JointName
    start_s: NotNegative
    panels: dict[LevelName, MethodNames]


class Figure06(PushedRuns):
    """Figure 6: a step of torque on a swinging hip."""

    joint: MotorName
    before_s: NotNegative
    after_s: NotNegative


class Figure07(Runs):
    """Figure 7: a load on the left hand; every so many samples is drawn."""

    joints: Annotated[tuple[JointName, ...], Field(min_length=1)]
    start_s: NotNegative
    end_s: Positive
    every: Count


class GaitFigure(Runs):
    """Figures 8 and 9: a limb over a gait cycle."""

    limb: LimbName
    start_s: NotNegative


class Figure10(Section):
    """Figure 10: knee collisions; errors are increases over the walk that nothing pushes."""

    joint: MotorName
    before_s: NotNegative
    after_s: NotNegative
    tests: Annotated[dict[str, PushedRuns], Field(min_length=1)]
    against: Runs


class Figure17(Section):
    """Figure 17: losses by kind of network."""

    limb: NetworkName
    methods: MethodNames


class Kinds(Section):
    """The table of kinds of networks: variants below those of Figure 17."""

    variants: tuple[MethodName, ...]


class Figure18(Section):
    """Figure 18: one network for each limb against one for the whole body; the panel's title of each test."""

    level: LevelName
    limbs: Annotated[tuple[LimbName, ...], Field(min_length=1)]
    methods: MethodNames
    panels: Annotated[dict[TestName, str], Field(min_length=1)]


class Figure19(Section):
    """Figure 19: velocity and torque in training and tests."""

    joints: Annotated[tuple[MotorName, ...], Field(min_length=1)]
    dots: Count
    test_dots: Count


class Figure20(Section):
    """Figure 20: sweeps of the network's size and of the training data."""

    limb: NetworkName
    parameters: SweepName
    samples: SweepName


class MethodsRow(Runs):
    """Methods side by side on one test; limb -> its columns, joints or `avg`."""

    columns: Annotated[dict[LimbName, tuple[str, ...]], Field(min_length=1)]


class CoverageTest(Section):
    """A test that the training data are compared with; `pushed`: only samples around pushes that turn this joint."""

    scenario: TestName
    level: LevelName
    pushed: MotorName | None = None


class Coverage(Section):
    """What the training data hold of what the tests ask about."""

    limb: NetworkName
    samples: Count
    every: Count
    block_s: Positive
    range: ShareRange
    cells: Count
    cell_range: ShareRange
    push_nm: Positive
    push_after_s: NotNegative
    tests: Annotated[tuple[CoverageTest, ...], Field(min_length=1)]


class CalibrationTest(CoverageTest):
    """A test of the standard deviations; limbs: those whose training set is like the test."""

    methods: MethodNames
    limbs: Annotated[tuple[LimbName, ...], Field(min_length=1)]


class Calibration(Section):
    """How far the networks' standard deviations can be trusted; nominal shares are those of section `learning`.

    Attributes:
        tolerance: by how much the coverage of `learning.calibration_share` may differ from it.
        points: nominal shares of a reliability diagram.
        methods: shown in the table; the CSV has all.
    """

    tolerance: Share
    points: Count
    methods: MethodNames
    tests: Annotated[tuple[CalibrationTest, ...], Field(min_length=1)]


class DataTable(Section):
    """The table of the training sets: samples from one look at the upper body to the next."""

    every: Count


class CommandsFigure(Section):
    """Histograms of the walking commands."""

    bins: Count


class Steps(Section):
    """Measured against commanded steps: a step within the tolerance of its command follows it."""

    bins: Count
    tolerance: Share


class Uncertainty(Section):
    """Size of the uncertainty torque: limb -> accepted ratio of simulated to real size."""

    ratio: dict[NetworkName, Range]


class Compute(Section):
    """The table of compute: a longer time without any job lies between two runs."""

    pause_s: Positive


class Evaluation(Section):
    """All tables and figures."""

    statistics: Statistics
    windows: dict[TestName, Window]
    table_01: Table01
    tables: dict[Annotated[str, Field(pattern="^[a-z0-9_]+$")], ErrorTable]
    error_budget: ErrorBudget
    figure_05: Figure05
    figure_06: Figure06
    figure_07: Figure07
    figure_08: GaitFigure
    figure_09: GaitFigure
    figure_10: Figure10
    figure_17: Figure17
    kinds: Kinds
    figure_18: Figure18
    methods: Annotated[tuple[MethodsRow, ...], Field(min_length=1)]
    figure_19: Figure19
    figure_20: Figure20
    coverage: Coverage
    calibration: Calibration
    data: DataTable
    commands: CommandsFigure
    steps: Steps
    uncertainty: Uncertainty
    compute: Compute
