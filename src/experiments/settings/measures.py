"""What is measured on estimates besides errors, with the tables and figures that show it: one section for each."""

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Annotated

from pydantic import Field

from experiments.settings.products import Checked
from experiments.settings.runs import HeldRuns, LearnedRuns, LegRuns, LimbRuns, PushedLimbRuns, PushWindow, Runs
from mobnet.core.errors import misfit, not_accepted
from mobnet.settings import base
from mobnet.settings.base import Section
from mobnet.settings.faults import at_most
from mobnet.settings.reading import Place, Problem

if TYPE_CHECKING:  # which knows all sections
    from experiments.settings.checks.results import Results

MS = 1000.0


class CoverageTest(Checked):
    """A test that the training data are compared with; `pushed`: only samples around pushes that turn this joint."""

    scenario: base.ScenarioName
    level: base.LevelName
    pushed: base.MotorName | None = None

    def problems(self, results: "Results", place: Place) -> Iterator[Problem]:
        """Yield a level at which nothing is run, and a joint that no push of the test turns."""
        levels = results.catalogue.tests.get(self.scenario, {})
        if self.level not in levels:
            yield (*place, "level"), not_accepted(f"level of test {self.scenario}", self.level, levels)
        if self.pushed is not None and (text := results.not_pushed(self.scenario, self.pushed)):
            yield (*place, "pushed"), text


class Coverage(Checked):
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

    def problems(self, results: "Results", place: Place) -> Iterator[Problem]:
        """Yield a limb that is no leg, and blocks that are longer than a test at some scale."""
        settings = results.settings
        if self.limb not in results.legs or self.limb not in settings.robot.networks[self.limb].T:
            accepted = f"a leg whose network sees its torques, `T`: {' or '.join(results.legs)}"
            yield (*place, "limb"), misfit(self.limb, accepted)
        for name, scale in settings.scales.items():
            # Where figures start elsewhere, a scale is too short for what is looked at.
            if scale.figure_start_s is None:
                what = f"a test at scale {name}"
                yield from at_most((*place, "block_s"), self.block_s, scale.test.shard_s, what)


class CalibrationTest(CoverageTest):
    """A test of the standard deviations; limbs: those whose training set is like the test."""

    methods: base.Distinct[base.LearnedName]
    limbs: base.Distinct[base.LimbName]

    def problems(self, results: "Results", place: Place) -> Iterator[Problem]:
        """Yield what does not fit in any test, and limbs that no method predicts."""
        yield from super().problems(results, place)
        held = set[str]()
        for name in self.methods:
            held.update(results.catalogue.estimated(name, self.scenario, self.level))
        if not held.issuperset(results.layout.limbs(self.limbs)):
            text = misfit("a limb that no method predicts", "limbs of the networks of `methods`")
            yield (*place, "limbs"), text


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


class Bode(Checked, Runs):
    """Gain and phase: bands of frequency, in each of which every joint of a limb is driven at one line.

    A figure of its own has the joints `shown`, another one has all.
    """

    limb: base.LegName
    shown: base.Distinct[base.LegJointName]
    bands_hz: base.Rising[base.Positive]

    def problems(self, results: "Results", place: Place) -> Iterator[Problem]:
        """Yield pushes that are no sines, or not on the limb, shown joints without sines, and lines that do not fit."""
        settings = results.settings
        pushes = [settings.pushes[name] for name in settings.scenarios[self.scenario].pushes]
        lines = {push.joint: push.sines.frequency_hz for push in pushes if push.joint and push.sines}
        joints = results.joints(self.limb)
        driven = [name for name in joints if name in lines]
        if len(lines) < len(pushes):
            text = misfit(self.scenario, "a test whose pushes are sines, each on its own joint")
            yield (*place, "scenario"), text
        if not driven:
            yield (*place, "scenario"), misfit(self.scenario, f"a test with sines on joints of {self.limb}")
        for k, joint in enumerate(self.shown):
            if joint not in driven:
                yield (*place, "shown", k), not_accepted("joint with sines", joint, driven)
        yield from self._line_problems(results, lines, place)

    def _line_problems(
        self, results: "Results", lines: Mapping[str, Sequence[float]], place: Place
    ) -> Iterator[Problem]:
        """Yield joints with another number of lines than there are bands, with lines of others, or too high ones."""
        settings = results.settings
        for joint, frequencies in lines.items():
            others = set[float]()
            for name, other in lines.items():
                others.update(other if name != joint else ())
            if len(frequencies) != len(self.bands_hz):
                text = misfit(f"{len(self.bands_hz)} bands", f"{len(frequencies)}, one for each line on {joint}")
                yield (*place, "bands_hz"), text
            elif others.intersection(frequencies):
                name = next(name for name in settings.pushes if settings.pushes[name].joint == joint)
                text = misfit(list(frequencies), f"lines of its own for each joint of {self.scenario}")
                yield ("pushes", name, "sines", "frequency_hz"), text
            elif frequencies[-1] >= settings.rates.data_hz / 2:
                yield (*place, "scenario"), misfit(frequencies[-1], "lines below half of data_hz")


class Drift(Checked):
    """How long pushes are held: a leg's estimate in so many steps, swings and stances, since a push began."""

    limb: base.LegName
    steps: base.Whole = Field(ge=1, le=50)
    calm_s: base.NotNegative = Field(le=10)
    tests: Annotated[dict[base.Text, HeldRuns], Field(min_length=1)]

    def problems(self, results: "Results", place: Place) -> Iterator[Problem]:
        """Yield more steps than begin during the pushes, where swing and stance take their shortest time."""
        settings = results.settings
        for test in self.tests.values():
            pushes = [settings.pushes[name] for name in settings.scenarios[test.scenario].pushes]
            longest = max((push.duration_s[1] for push in pushes), default=0.0)
            most = 1 + int(longest / (2.0 * settings.commands.duration_s[0]))
            what = f"the steps that begin in the longest push of {test.scenario}"
            yield from at_most((*place, "steps"), self.steps, most, what)


class Phases(Section):
    """Errors by phase of the gait, a touch-down lasting some time, and of joints that are stuck or move."""

    touch_down_s: base.Real = Field(ge=0.001, le=1)
    tests: base.Some[LimbRuns]


class Sigma(Checked):
    """Standard deviations in parts of a walk, of tests like the training data and of others.

    `parts` is the number of equally large parts by size, `lags_ms` are those of the autocorrelation, which is looked at
    up to `longest_s`. Tests go by name; every other one is compared with that which `against` names.
    """

    parts: base.Whole = Field(ge=2, le=100)
    lags_ms: base.Rising[Annotated[base.Whole, Field(ge=1, le=60_000)]]
    longest_s: base.Real = Field(ge=0.01, le=60)
    tests: Annotated[dict[base.Text, LearnedRuns], Field(min_length=1)]
    against: dict[base.Text, base.Text]

    def problems(self, results: "Results", place: Place) -> Iterator[Problem]:
        """Yield lags that are not looked at, and names of tests that there are not."""
        if self.lags_ms[-1] > self.longest_s * MS:
            text = misfit(self.lags_ms[-1], f"at most longest_s, {self.longest_s * MS:g} ms")
            yield (*place, "lags_ms"), text
        for title, other in self.against.items():
            for name in (title, other):
                if name not in self.tests:
                    yield (*place, "against", title), not_accepted("test of sigma", name, self.tests)
            if title == other:
                yield (*place, "against", title), misfit(other, "another test of sigma than itself")


class Changed(Checked):
    """Robots that networks do not know, and a check of their estimates where the plan has a leg in the air.

    A window is flagged where less than the least share lies in the central interval of section `learning`; of a swing,
    the time after the planned lift-off and before the planned landing is left out.
    """

    window_s: base.Real = Field(ge=1, le=600)
    lift_off_s: base.NotNegative = Field(le=1)
    landing_s: base.NotNegative = Field(le=1)
    least_share: base.PositiveShare
    tests: Annotated[dict[base.Text, LegRuns], Field(min_length=1)]

    def problems(self, results: "Results", place: Place) -> Iterator[Problem]:
        """Yield windows that no recording is long enough for."""
        settings = results.settings
        for test in self.tests.values():
            longest = min(settings.test_s(test.scenario), settings.recording.episode_s)
            what = f"for {test.scenario} lasts so long"
            yield from at_most((*place, "window_s"), self.window_s, longest, what)


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
