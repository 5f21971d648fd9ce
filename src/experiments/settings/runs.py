"""Methods on one test at one level, which tables and figures ask for, and what they have in common."""

from typing import Annotated

from pydantic import AfterValidator, Field

from experiments.settings.metrics import METRIC
from mobnet.formats import base
from mobnet.formats.base import Section

Metric = Annotated[str, Field(pattern=rf"^({METRIC})$")]
LimbsOrJoints = base.Distinct[base.LimbOrJointName]
Texts = Annotated[tuple[base.Text, ...], AfterValidator(base.distinct)]


class Statistics(Section):
    """Intervals over networks and test recordings.

    Attributes:
        confidence: of every interval [-].
        most_correlation: of whether something happens in two walks of a robot, or in two trials of a walk [-].
        most_variation: standard deviation of a rate over robots, or walks, as a part of the rate [-].
    """

    confidence: base.Real = Field(ge=0.5, lt=1)
    most_correlation: base.Real = Field(gt=0, lt=1)
    most_variation: base.Real = Field(gt=0, le=10)


class PushWindow(Section):
    """Time around each push of a test that its push metrics look at."""

    before_s: base.NotNegative = Field(le=10)
    after_s: base.NotNegative = Field(le=10)


class Mean(Section):
    """A column that is a mean over joints, or over metrics."""

    name: base.Text
    joints: LimbsOrJoints
    metrics: Annotated[tuple[Metric, ...], AfterValidator(base.distinct)] = ()


Columns = base.Some[base.LimbOrJointName | Mean]


class Runs(Section):
    """Methods on one test at one level."""

    scenario: base.ScenarioName
    level: base.LevelName
    methods: base.MethodNames


class PushedRuns(Runs):
    """Methods on one test that has pushes."""

    scenario: base.PushedTestName


class QuietRuns(Runs):
    """Methods on one test that nothing pushes."""

    scenario: base.QuietName


class HeldRuns(Runs):
    """Methods on one test with pushes that last."""

    scenario: base.PushedName


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
