"""What is measured on estimates besides errors, with the tables and figures that show it: one section for each."""

from typing import Annotated

from pydantic import Field

from experiments.settings.runs import HeldRuns, LearnedRuns, LegRuns, LimbRuns, PushedLimbRuns, PushWindow, Runs
from mobnet.formats import base
from mobnet.formats.base import Section

MS = 1000.0


class CoverageTest(Section):
    """A test that the training data are compared with; `pushed`: only samples around pushes that turn this joint."""

    scenario: base.ScenarioName
    level: base.LevelName
    pushed: base.MotorName | None = None


class Coverage(Section):
    """What the training data hold of what the tests ask about."""

    limb: base.NetworkName
    samples: base.Whole = Field(ge=100, le=10_000_000)
    every: base.Whole = Field(ge=1, le=1000)
    block_s: base.Real = Field(ge=0.1, le=600)
    parts: base.Whole = Field(ge=2, le=100)
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

    The figure has the limbs `drawn`, and calls tests with pushes by their `names`.
    """

    tolerance: base.Real = Field(ge=0.001, le=0.5)
    points: base.Whole = Field(ge=3, le=1000)
    methods: base.Distinct[base.LearnedName]
    drawn: base.Distinct[base.LimbName]
    names: dict[base.ScenarioName, base.Text]
    tests: base.Some[CalibrationTest]


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


class Drift(Section):
    """How long pushes are held: a leg's estimate in so many steps, swings and stances, since a push began."""

    limb: base.LegName
    steps: base.Whole = Field(ge=1, le=50)
    calm_s: base.NotNegative = Field(le=10)
    tests: Annotated[dict[base.Text, HeldRuns], Field(min_length=1)]


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
