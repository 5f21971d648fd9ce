"""What tables and figures show: one section for each, under its own name."""

from typing import Annotated

from pydantic import AfterValidator, Field

from mobnet.core.metrics import METRIC, SECTIONS
from mobnet.settings import base
from mobnet.settings.base import Section
from mobnet.settings.detection_tables import (
    AlarmTable,
    DetectionCurves,
    DetectorTable,
    Figure13,
    Figure14,
    Figure15,
    FoundByRate,
    Links,
    SmallestForce,
    ThresholdTable,
)

Metric = Annotated[str, Field(pattern=rf"^({METRIC})$")]
LimbsOrJoints = base.Distinct[base.LimbOrJointName]
Texts = Annotated[tuple[base.Text, ...], AfterValidator(base.distinct)]


class Statistics(Section):
    """Intervals over networks and test recordings."""

    confidence: base.Real = Field(ge=0.5, lt=1)


class PushWindow(Section):
    """Time around each push of a test that its push metrics look at."""

    before_s: base.NotNegative = Field(le=10)
    after_s: base.NotNegative = Field(le=10)


class Runs(Section):
    """Methods on one test at one level."""

    scenario: base.ScenarioName
    level: base.LevelName
    methods: base.MethodNames


class PushedRuns(Runs):
    """Methods on one test that has pushes."""

    scenario: base.PushedTestName


class Mean(Section):
    """A column that is a mean over joints, or over metrics."""

    name: base.Text
    joints: LimbsOrJoints
    metrics: Annotated[tuple[Metric, ...], AfterValidator(base.distinct)] = ()


Columns = base.Some[base.LimbOrJointName | Mean]


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


class Figure05(Section):
    """Figure 5: one joint over a gait cycle, by method, at each level; the paper's numbers are those of a table.

    The errors of some methods, `errors_of`, are drawn over time, those of others are far beyond them.
    """

    table: base.LowerName
    errors_of: base.MethodNames
    scenario: base.ScenarioName
    joint: base.LegJointName
    start_s: base.NotNegative = Field(le=3600)
    panels: Annotated[dict[base.LevelName, base.MethodNames], Field(min_length=1)]


class Figure06(PushedRuns, PushWindow):
    """Figure 6: a step of torque on a swinging hip."""

    joint: base.LegJointName


class ComparedRuns(Runs):
    """Errors of single joints in one test, beside the paper's at a place of a table.

    The errors of some methods, `errors_of`, are drawn over time, those of others are far beyond them.
    """

    metric: Metric = "rmse"
    table: base.LowerName
    place: base.Text
    errors_of: base.MethodNames


class HandFigure(ComparedRuns):
    """Figures 7 and 12: a push on a hand, and what it is called; every so many samples is drawn."""

    called: base.LowerName
    joints: base.Distinct[base.JointName]
    start_s: base.NotNegative = Field(le=3600)
    end_s: base.Positive = Field(le=3600)
    every: base.Whole = Field(ge=1, le=1000)


class GaitFigure(ComparedRuns):
    """Figures 8 and 9: a leg over a gait cycle."""

    limb: base.LegName
    start_s: base.NotNegative = Field(le=3600)


class Figure09(GaitFigure):
    """Figure 9: methods side by side; some of the joints are drawn."""

    drawn: base.Distinct[base.LegJointName]


class Figure08(GaitFigure):
    """Figure 8: what the networks of one method predict."""

    methods: tuple[base.LearnedName]


class QuietRuns(Runs):
    """Methods on one test that nothing pushes."""

    scenario: base.QuietName


class Figure10(PushWindow):
    """Figure 10: knee collisions; errors are increases over the walk that nothing pushes.

    The curves of some methods are drawn.
    """

    drawn: base.MethodNames
    joint: base.LegJointName
    tests: Annotated[dict[base.Text, PushedRuns], Field(min_length=1)]
    against: QuietRuns


class Figure17(Section):
    """Figure 17: losses by kind of network, trained at a level."""

    limb: base.NetworkName
    level: base.LevelName
    methods: base.MethodNames


class Kinds(Section):
    """The table of kinds of networks: variants below those of Figure 17, trained at a level of their own."""

    level: base.LevelName
    variants: Annotated[tuple[base.MethodName, ...], AfterValidator(base.distinct)]


class Figure18(Section):
    """Figure 18: one network for each limb against one for the whole body; the panel's title of each test."""

    level: base.LevelName
    limbs: base.Distinct[base.LimbName]
    methods: base.MethodNames
    panels: Annotated[dict[base.ScenarioName, base.Text], Field(min_length=1)]


class Figure19(Section):
    """Figure 19: velocity and torque at so many samples of training and tests; an outline holds a share of these."""

    joints: base.Distinct[base.MotorName]
    dots: base.Whole = Field(ge=10, le=1_000_000)
    test_dots: base.Whole = Field(ge=10, le=1_000_000)
    outlined: base.PositiveShare


class Figure20(Section):
    """Figure 20: sweeps of the network's size and of the training data, at a level."""

    limb: base.NetworkName
    level: base.LevelName
    parameters: base.SweepName
    samples: base.SweepName


class MethodsRow(Runs):
    """Methods side by side on one test; limb -> its columns, joints or `avg`."""

    metric: Metric = "rmse"
    columns: Annotated[dict[base.LimbName, base.Distinct[base.Text]], Field(min_length=1)]


class LearningCurve(Section):
    """Error over the length of the training: a table of trials that is kept, and how its names are shown.

    `titles` are those of each task's panels, `recipes` and `beside` are names in the legend and in notes: of recipes of
    learning, and of methods that do not learn.
    """

    data: base.Text
    titles: dict[base.TaskName, base.Text]
    recipes: dict[base.LowerName, base.Text]
    beside: dict[base.MethodName, base.Text]


class CoverageTest(Section):
    """A test that the training data are compared with; `pushed`: only samples around pushes that turn this joint."""

    scenario: base.ScenarioName
    level: base.LevelName
    pushed: base.MotorName | None = None


class TunedTest(Runs):
    """A changed robot: the method before it is fine-tuned, a level that it knows, and the `tuned` methods by name."""

    methods: tuple[base.MethodName]
    known: base.LevelName
    tuned: Annotated[dict[base.Text, base.MethodName], Field(min_length=1)]


class FineTuning(Section):
    """Error over the seconds of new data, the values of a sweep; `joint` may be `avg`, the limb's mean."""

    sweep: base.SweepName
    limb: base.LimbName
    joint: base.Text
    tests: Annotated[dict[base.Text, TunedTest], Field(min_length=1)]


class Safety(Section):
    """What reactions are worth; a direction is right within an angle."""

    cases: base.Distinct[base.CaseName]
    within_deg: Annotated[base.Positive, Field(le=180)]


class Figure16(Safety):
    """Force of an obstacle over time in one walk of each case, `shown_s` from its contact on, every so many samples."""

    shown_s: base.Span[base.Real]
    every: base.Count


class Figure21(Section):
    """Footsteps of the first walk of a case."""

    case: base.CaseName


class Figure22(Section):
    """Pictures of the first walk of each case: moments from the contact on, and azimuth and elevation of each view."""

    cases: base.Distinct[base.CaseName]
    moments_s: base.Some[base.Real]
    views_deg: dict[base.CaseName, tuple[base.Real, base.Real]]


class Story(Section):
    """The push that demo, film and explorer show: the first of its name in the first recording of a robot's test.

    The time that is shown begins before it and ends after its beginning. An estimator that begins there is not judged
    for the first `settle_s`.
    """

    scenario: base.PushedName
    level: base.WatchedLevelName
    push: base.PushName
    before_s: Annotated[base.Positive, Field(le=10)]
    after_s: Annotated[base.Positive, Field(le=10)]
    settle_s: Annotated[base.NotNegative, Field(le=10)]
    joint: base.LegJointName
    methods: base.MethodNames
    detector: base.DetectorName


class Films(Section):
    """Films of the first walk of each case: the joint that is shown, the view, and the time that a film has.

    A view is an azimuth and an elevation [deg].
    """

    joints: dict[base.CaseName, base.JointName]
    views_deg: dict[base.CaseName, tuple[base.Real, base.Real]]
    shown_s: base.Span[base.Real]
    history_s: Annotated[base.Real, Field(ge=0.1, le=60)]
    frames_hz: Annotated[base.Real, Field(ge=1, le=60)]
    slower: Annotated[base.Real, Field(ge=0.1, le=100)]


class PushFilm(Section):
    """The film of the push of `story`: real time, some of it slower, and in the middle a still for `hold_s`.

    The view is an azimuth from ahead and an elevation of the eye [deg]; times count from the beginning of the push;
    the time axis shows `margin_s` more than what is slowed; `colours` is the size of the palette. `kind` is the rule of
    the thresholds of the detector. Labels of methods, of `truth` and of `swing`, the name of the joint and the lines of
    the opening are texts of the film.
    """

    view_deg: tuple[base.Degrees, base.Degrees]
    frames_hz: base.Real = Field(ge=5, le=60)
    slowed_hz: base.Real = Field(ge=5, le=60)
    slower: base.Real = Field(ge=1, le=100)
    slow_s: base.Span[base.Real]
    hold_s: base.Seconds
    margin_s: base.Pause
    colours: base.Whole = Field(ge=8, le=256)
    kind: base.ThresholdsName
    labels: dict[base.Text, base.Text]
    joint: base.Text
    opening: base.Some[base.Text]


class Note(Section):
    """A text of the drawing of the robot: a point of a body that it names, and where it begins [m]."""

    text: base.Text
    body: base.BodyName
    pos: base.Vector3
    at_m: tuple[base.Real, base.Real]


class Drawings(Section):
    """The drawings of method and robot: limbs with networks, angles of joints that are not in the posture, the view.

    The view is an azimuth and an elevation [deg]; the corner is the lower left one of the picture, from the base on the
    ground. The axes of a leg's joints are drawn, and a push of `force_n` from ahead.
    """

    limbs: base.LimbNames
    pose_rad: dict[base.JointName, base.Radians]
    view_deg: tuple[base.Degrees, base.Degrees]
    corner_m: tuple[base.Real, base.Real]
    m_per_inch: base.Real = Field(ge=0.01, le=10)
    floor_m: base.Length
    leg: base.LegName
    force_n: base.Newton
    notes: tuple[Note, ...] = ()


class Sensorless(Section):
    """Walks that nothing stands in the way of, with what is estimated in place of force sensors."""

    cases: base.Distinct[base.CaseName]


class Coverage(Section):
    """What the training data hold of what the tests ask about."""

    limb: base.NetworkName
    samples: base.Whole = Field(ge=100, le=10_000_000)
    every: base.Whole = Field(ge=1, le=1000)
    block_s: base.Real = Field(ge=0.1, le=600)
    range: base.Span[base.Share]
    cells: base.Whole = Field(ge=2, le=1000)
    cell_range: base.Span[base.Share]
    phases: base.Whole = Field(ge=2, le=1000)
    state_cells: base.Whole = Field(ge=2, le=1000)
    cell_samples: base.Whole = Field(ge=2, le=10_000)
    push_nm: base.Real = Field(ge=0.01, le=1000)
    push_after_s: base.NotNegative = Field(le=10)
    tests: base.Some[CoverageTest]


class CalibrationTest(CoverageTest):
    """A test of the standard deviations; limbs: those whose training set is like the test."""

    methods: base.Distinct[base.LearnedName]
    limbs: base.Distinct[base.LimbName]


class CalibrationTable(Section):
    """How far the networks' standard deviations can be trusted; nominal shares are those of section `learning`.

    The figure has a panel for each of the `parts` of the body, and calls tests with pushes by their `names`.
    """

    tolerance: base.Real = Field(ge=0.001, le=0.5)
    points: base.Whole = Field(ge=3, le=1000)
    methods: base.Distinct[base.LearnedName]
    parts: Annotated[dict[base.Text, base.Distinct[base.LimbName]], Field(min_length=1)]
    names: dict[base.ScenarioName, base.Text]
    tests: base.Some[CalibrationTest]


class LimbRuns(Runs):
    """Methods on one test at one level, limb by limb."""

    limbs: base.Distinct[base.LimbName]


class PushedLimbRuns(LimbRuns):
    """The same of a test that has pushes."""

    scenario: base.PushedName


class LegRuns(LimbRuns):
    """The same of legs."""

    limbs: base.Distinct[base.LegName]


class LearnedRuns(LimbRuns):
    """The same of methods that predict standard deviations."""

    methods: base.Distinct[base.LearnedName]


class ContactLine(Section):
    """A line of the table of contact points: torques of a method, or the true ones, and how they are taken.

    `std` are the standard deviations of torques [N m] and of the base's forces [N]; without it, they are those of the
    estimate. With `alone` there are no torques but the leg's, and `after_s` replaces that of the table.
    """

    method: base.MethodName | None = None
    std: tuple[base.NotNegative, base.NotNegative] | None = None
    alone: base.Flag = False
    after_s: base.NotNegative | None = Field(default=None, le=1)


class ContactPoints(LimbRuns):
    """Where collisions of legs meet them: those of at least `least_n`, so long after the alarm of a detector.

    `limbs` are those whose torques are taken; collisions are those of the `legs` among them.
    """

    scenario: base.PushedName
    legs: base.Distinct[base.WatchedLegName]
    detector: base.DetectorName
    kind: base.ThresholdsName
    after_s: base.NotNegative = Field(le=1)
    least_n: base.Newton
    lines: Annotated[dict[base.Text, ContactLine], Field(min_length=1)]


class Peaks(Section):
    """Share and delay of pushes in estimates, at joints that take a share of the largest torque, or more."""

    turned_share: base.PositiveShare
    before_s: base.NotNegative = Field(le=10)
    after_s: base.NotNegative = Field(le=10)
    longest_s: base.Real = Field(ge=0.01, le=10)
    tests: base.Some[PushedLimbRuns]


class Bode(Runs):
    """Gain and phase: bands of frequency, in each of which every joint of a limb is driven at one line.

    A figure of its own has the joints `shown`, another one has all.
    """

    limb: base.LegName
    shown: base.Distinct[base.LegJointName]
    bands_hz: base.Rising[base.Positive]


class HeldRuns(Runs):
    """Methods on one test with pushes that last."""

    scenario: base.PushedName


class Drift(Section):
    """How long pushes are held: a leg's estimate in so many steps, swings and stances, since a push began."""

    limb: base.LegName
    steps: base.Whole = Field(ge=1, le=50)
    calm_s: base.NotNegative = Field(le=10)
    tests: Annotated[dict[base.Text, HeldRuns], Field(min_length=1)]


class ExploreStory(Section):
    """How the page calls the push and the plant of section `story`, and methods that it shows besides."""

    push: base.Text
    plant: base.Text
    threshold_nm: base.Real = Field(ge=0.1, le=1000)
    further: base.MethodNames


class ExploreScene(LimbRuns):
    """A scene of the page: the first push of the first run that begins from a time on, and the joint shown first.

    `push` and `plant` are the texts of its buttons.
    """

    scenario: base.PushedName
    push: base.Text
    plant: base.Text
    joint: base.MotorName
    threshold_nm: base.Real = Field(ge=0.1, le=1000)
    from_s: base.NotNegative = Field(default=0.0, le=3600)


class Explore(Section):
    """The page on which a reader plays with pushes.

    Samples are stored from `lead_s` before a scene on, torques in steps of `step_nm`, poses and forces at `pose_hz`. A
    slider runs between two ends; it begins at the observer's gain, or at the `threshold_nm` of the scene.
    """

    lead_s: base.Positive = Field(le=10)
    pose_hz: base.Real = Field(ge=10, le=1000)
    step_nm: base.Real = Field(ge=0.001, le=1)
    gains_hz: base.Span[Annotated[base.Real, Field(ge=1, le=1000)]]
    thresholds_nm: base.Span[Annotated[base.Real, Field(ge=0.1, le=1000)]]
    story: ExploreStory
    scenes: Annotated[dict[base.LowerName, ExploreScene], Field(min_length=1)]


class Phases(Section):
    """Errors by phase of the gait, a touch-down lasting some time, and of joints that are stuck or move."""

    touch_down_s: base.Real = Field(ge=0.001, le=1)
    tests: base.Some[LimbRuns]


class Sigma(Section):
    """Standard deviations in parts of a walk, of tests like the training data and of others.

    `parts` is the number of equally large parts by size, `lags_ms` are those of the autocorrelation, which is looked at
    up to `longest_s`. Tests go by name; every other one is compared with that which `against` names.
    """

    parts: base.Whole = Field(ge=2, le=100)
    lags_ms: base.Rising[Annotated[base.Whole, Field(ge=1, le=60_000)]]
    longest_s: base.Real = Field(ge=0.01, le=60)
    tests: Annotated[dict[base.Text, LearnedRuns], Field(min_length=1)]
    against: dict[base.Text, base.Text]


class Changed(Section):
    """Robots that networks do not know, and a check of their estimates where the plan has a leg in the air.

    A window is flagged where less than the least share lies in the central interval of section `learning`; of a swing,
    the time after the planned lift-off and before the planned landing is left out.
    """

    window_s: base.Real = Field(ge=1, le=600)
    lift_off_s: base.NotNegative = Field(le=1)
    landing_s: base.NotNegative = Field(le=1)
    least_share: base.PositiveShare
    tests: Annotated[dict[base.Text, LegRuns], Field(min_length=1)]


class Hourly(Section):
    """Events in an hour: falls, and flags in the tests `known` of section `changed`, whose robots the networks know."""

    known: base.Distinct[base.Text]


class Measure(Section):
    """A measure without a product of its own: the `Options` of the module of its name, and where it is taken."""

    options: base.Change = {}
    tests: base.Some[LimbRuns]


class Scoring(Section):
    """What is measured on the runs of one test besides errors: a window around pushes, and sections by name.

    `lines` are the injected frequencies [Hz] of each joint, `cover_share` the nominal share of covered errors.
    """

    window: PushWindow | None = None
    sections: dict[str, Section] = {}
    touch_down_s: float = 0.0
    stuck_rad_s: float = 0.0
    cover_share: float = 0.0
    lines: dict[str, tuple[float, ...]] = {}


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


class CommandsFigure(Section):
    """Histograms of the walking commands in some training sets."""

    sets: base.Distinct[base.TrainingSetName]
    bins: base.Whole = Field(ge=2, le=200)


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


class PaperText(Section):
    """The text of the paper: the scale for whose results its words were chosen, and the pages of its main text."""

    scale: base.LowerName
    pages: Annotated[base.Count, Field(le=100)]


class Evaluation(Section):
    """All tables and figures."""

    statistics: Statistics
    windows: dict[base.PushedName, PushWindow]
    table_01: Table01
    tables: dict[base.LowerName, ErrorTable]
    error_budget: ErrorBudget
    noise: NoiseTable
    figure_05: Figure05
    figure_06: Figure06
    figure_07: HandFigure
    figure_08: Figure08
    figure_09: Figure09
    figure_10: Figure10
    figure_12: HandFigure
    figure_17: Figure17
    kinds: Kinds
    figure_18: Figure18
    methods: base.Some[MethodsRow]
    figure_19: Figure19
    figure_20: Figure20
    learning_curve: LearningCurve
    fine_tuning: FineTuning
    coverage: Coverage
    calibration: CalibrationTable
    peaks: Peaks
    bode: Bode
    drift: Drift
    phases: Phases
    sigma: Sigma
    changed: Changed
    hourly: Hourly
    measures: dict[base.LowerName, Measure] = {}
    figures: dict[base.LowerName, LimbRuns] = {}
    table_09: DetectorTable
    table_13: ThresholdTable
    false_alarms: AlarmTable
    safety: Safety
    sensorless: Sensorless
    figure_16: Figure16
    figure_21: Figure21
    figure_22: Figure22
    story: Story
    films: Films
    push_film: PushFilm
    drawings: Drawings
    found_by_rate: FoundByRate
    smallest_force: SmallestForce
    links: Links
    contact_points: ContactPoints
    figure_13: Figure13
    figure_14: Figure14
    figure_15: Figure15
    detection_curves: DetectionCurves
    data: DataTable
    commands: CommandsFigure
    steps: Steps
    uncertainty: Uncertainty
    label_error: LabelError
    latency: Latency
    compute: Compute
    explore: Explore
    main_tables: MainTables
    paper: PaperText


def measured_in(evaluation: Evaluation) -> dict[str, Section]:
    """Return the sections that ask for metrics of their own, in order: those of products, then `measures`."""
    names = [name for name in Evaluation.model_fields if name in SECTIONS]
    return {**{name: getattr(evaluation, name) for name in names}, **evaluation.measures}
