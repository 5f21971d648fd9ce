"""What figures show, those of detection and of reactions apart: one section for each."""

from typing import Annotated

from pydantic import Field

from experiments.settings.runs import Metric, PushedRuns, PushWindow, QuietRuns, Runs
from mobnet.formats import base
from mobnet.formats.base import Section


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


class Figure10(PushWindow):
    """Figure 10: knee collisions; errors are increases over the walk that nothing pushes.

    The first test is that of the leg in the air, the second that of the leg on the ground. The curves of some methods
    are drawn.
    """

    drawn: base.MethodNames
    joint: base.LegJointName
    tests: Annotated[dict[base.Text, PushedRuns], Field(min_length=2, max_length=2)]
    against: QuietRuns


class Figure17(Section):
    """Figure 17: losses by kind of network, trained at a level.

    `methods` learn by one recipe, `best`, the same kinds in the same order, each by its own, at a level of theirs.
    """

    limb: base.NetworkName
    level: base.LevelName
    methods: base.MethodNames
    best_level: base.LevelName
    best: base.MethodNames


class Figure18(Section):
    """Figure 18: one network for each limb against one for the whole body; the panel's title of each test."""

    level: base.LevelName
    limbs: base.Distinct[base.LimbName]
    methods: base.MethodNames
    panels: Annotated[dict[base.ScenarioName, base.Text], Field(min_length=1)]


class Figure19(Section):
    """Figure 19: velocity and torque at so many samples of training and tests."""

    joints: base.Distinct[base.MotorName]
    dots: base.Whole = Field(ge=10, le=1_000_000)
    test_dots: base.Whole = Field(ge=10, le=1_000_000)


class Figure20(Section):
    """Figure 20: sweeps of the network's size and of the training data, at a level."""

    limb: base.NetworkName
    level: base.LevelName
    parameters: base.SweepName
    samples: base.SweepName


class KeptTable(Section):
    """A figure of a table of trials that is kept: the file `data`."""

    data: base.Text


class LearningCurve(KeptTable):
    """Error over the length of the training: a table of trials that is kept, and how its names are shown.

    `titles` are those of each task's panels, `recipes` and `beside` are names in the legend and in notes: of recipes of
    learning, and of methods that do not learn.
    """

    titles: dict[base.TaskName, base.Text]
    recipes: dict[base.LowerName, base.Text]
    beside: dict[base.MethodName, base.Text]


class ExplainedNetwork(Section):
    """A network of the trial `why`: its method, and the ways of learning in which it is this one."""

    method: base.LearnedName
    ways: base.Distinct[base.LowerName]


class ExplainedSet(Section):
    """A training set of the trial `why`: that of the network `over` on the same robots, and what is said of it."""

    over: base.TrainingSetName
    says: str = ""


class ExplainedPanel(Section):
    """A panel: networks by their names in the legend, with the training sets and ways of learning that it shows."""

    networks: base.Distinct[base.Text]
    sets: base.Distinct[base.TrainingSetName]
    ways: base.Distinct[base.LowerName]


class WhyShare(KeptTable):
    """What networks show of a hit over their errors in walking, which are over those of the network `over`.

    `networks` are named as in the legend, those of a kind one after another. `ways` has what is said of a way of
    learning, nothing of one that it leaves out. A panel shows the robots that all of its rows have.
    """

    over: ExplainedNetwork
    networks: dict[base.Text, ExplainedNetwork]
    sets: dict[base.TrainingSetName, ExplainedSet]
    ways: dict[base.LowerName, base.Text]
    panels: Annotated[dict[base.Text, ExplainedPanel], Field(min_length=1)]


class HitPath(KeptTable):
    """By which inputs a hit enters the predictions of methods, by name and as the legend calls them."""

    methods: Annotated[dict[base.LearnedName, base.Text], Field(min_length=1)]


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


class CommandsFigure(Section):
    """Histograms of the walking commands in some training sets."""

    sets: base.Distinct[base.TrainingSetName]
    bins: base.Whole = Field(ge=2, le=200)
