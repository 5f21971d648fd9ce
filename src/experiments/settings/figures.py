"""What figures show, those of detection and of reactions apart: one section for each."""

import re
from collections.abc import Iterator
from typing import TYPE_CHECKING, Annotated

from pydantic import Field

from experiments.settings.products import Checked
from experiments.settings.runs import Metric, PushedRuns, PushWindow, QuietRuns, Runs
from mobnet.core.errors import misfit, not_accepted
from mobnet.settings import base
from mobnet.settings.base import Section
from mobnet.settings.reading import Place, Problem

if TYPE_CHECKING:  # which knows all sections
    from experiments.settings.checks.results import Results


class Figure05(Checked):
    """Figure 5: one joint over a gait cycle, by method, at each level; the paper's numbers are those of a table.

    The errors of some methods, `errors_of`, are drawn over time, those of others are far beyond them.
    """

    table: base.LowerName
    errors_of: base.MethodNames
    scenario: base.ScenarioName
    joint: base.LegJointName
    start_s: base.NotNegative = Field(le=3600)
    panels: Annotated[dict[base.LevelName, base.MethodNames], Field(min_length=1)]

    def problems(self, results: "Results", place: Place) -> Iterator[Problem]:
        """Yield levels of which the table prints no number."""
        for level in self.panels:
            if text := results.not_printed(self.table, level):
                yield (*place, "panels", level), text


class Figure06(Checked, PushedRuns, PushWindow):
    """Figure 6: a step of torque on a swinging hip."""

    joint: base.LegJointName

    def problems(self, results: "Results", place: Place) -> Iterator[Problem]:
        """Yield a joint that no push of the test turns."""
        if text := results.not_pushed(self.scenario, self.joint):
            yield (*place, "joint"), text


class ComparedRuns(Checked, Runs):
    """Errors of single joints in one test, beside the paper's at a place of a table.

    The errors of some methods, `errors_of`, are drawn over time, those of others are far beyond them.
    """

    metric: Metric = "rmse"
    table: base.LowerName
    place: base.Text
    errors_of: base.MethodNames

    def problems(self, results: "Results", place: Place) -> Iterator[Problem]:
        """Yield a place at which the table prints no number."""
        if text := results.not_printed(self.table, self.place):
            yield (*place, "place"), text


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


class Figure10(Checked, PushWindow):
    """Figure 10: knee collisions; errors are increases over the walk that nothing pushes.

    The first test is that of the leg in the air, the second that of the leg on the ground. The curves of some methods
    are drawn.
    """

    drawn: base.MethodNames
    joint: base.LegJointName
    tests: Annotated[dict[base.Text, PushedRuns], Field(min_length=2, max_length=2)]
    against: QuietRuns

    def problems(self, results: "Results", place: Place) -> Iterator[Problem]:
        """Yield methods without a run in the walk that nothing pushes, and tests whose pushes do not turn the joint."""
        for title, test in self.tests.items():
            for k, method in enumerate(test.methods):
                if method not in self.against.methods:
                    text = not_accepted("method", method, self.against.methods)
                    yield (*place, "tests", title, "methods", k), text
            if text := results.not_pushed(test.scenario, self.joint):
                yield (*place, "tests", title, "scenario"), text


class Figure17(Checked):
    """Figure 17: losses by kind of network, trained at a level.

    `methods` learn by one recipe, `best`, the same kinds in the same order, each by its own, at a level of theirs.
    """

    limb: base.NetworkName
    level: base.LevelName
    methods: base.MethodNames
    best_level: base.LevelName
    best: base.MethodNames

    def problems(self, results: "Results", place: Place) -> Iterator[Problem]:
        """Yield methods that are not trained, and pairs of them that are not of one kind."""
        for key, methods in (("methods", self.methods), ("best", self.best)):
            for k, method in enumerate(methods):
                if text := results.not_trained(method, self.limb):
                    yield (*place, key, k), text
        yield from self._kind_problems(results, (*place, "best"))

    def _kind_problems(self, results: "Results", place: Place) -> Iterator[Problem]:
        """Yield methods that differ from the one of their kind in more than how they learn."""
        catalogue = results.catalogue
        if len(self.best) != len(self.methods):
            yield place, misfit(f"{len(self.best)} methods", f"{len(self.methods)}, one for each of `methods`")
            return
        trained = results.trained(self.limb)
        for k, (method, best) in enumerate(zip(self.methods, self.best, strict=True)):
            if best in self.methods:
                yield (*place, k), misfit(best, "a method apart from `methods`")
                continue
            are_trained = {method, best} <= {*trained}
            if are_trained and catalogue.network(method, self.limb) != catalogue.network(best, self.limb):
                yield (*place, k), misfit(best, f"a method with the network of {method}")


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


class Figure20(Checked):
    """Figure 20: sweeps of the network's size and of the training data, at a level."""

    limb: base.NetworkName
    level: base.LevelName
    parameters: base.SweepName
    samples: base.SweepName

    def problems(self, results: "Results", place: Place) -> Iterator[Problem]:
        """Yield sweeps that the figure cannot show."""
        sweeps = results.settings.sweeps
        for key, name, section in (("parameters", self.parameters, "network"), ("samples", self.samples, "learning")):
            if sweeps[name].section != section or sweeps[name].limb != self.limb:
                yield (*place, key), misfit(name, f"a sweep of section {section} for {self.limb}")
                return
        sizes = sweeps[self.parameters]
        for k, base_method in enumerate(sweeps[self.samples].of):
            if base_method not in sizes.of:
                text = not_accepted(f"method of sweep {self.parameters}", base_method, sizes.of)
                yield ("sweeps", self.samples, "of", k), text


class KeptTable(Checked):
    """A figure of a table of trials that is kept: the file `data`."""

    data: base.Text

    def problems(self, results: "Results", place: Place) -> Iterator[Problem]:
        """Yield a table of trials that there is not."""
        if not re.fullmatch(r"docs/trials/[a-z0-9_]+\.csv", self.data):
            yield (*place, "data"), not_accepted("file", self.data, ["a .csv file of docs/trials"])


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

    def problems(self, results: "Results", place: Place) -> Iterator[Problem]:
        """Yield names that the section, or the trial, does not have."""
        yield from super().problems(results, place)
        known = results.settings.trials.why.ways
        for name in self.ways:
            if name not in known:
                yield (*place, "ways", name), not_accepted("way of learning", name, known)
        for title, panel in self.panels.items():
            for k, name in enumerate(panel.networks):
                if name not in self.networks:
                    yield (*place, "panels", title, "networks", k), not_accepted("network", name, self.networks)
            for k, name in enumerate(panel.sets):
                if name not in self.sets:
                    yield (*place, "panels", title, "sets", k), not_accepted("set", name, self.sets)


class HitPath(KeptTable):
    """By which inputs a hit enters the predictions of methods, by name and as the legend calls them."""

    methods: Annotated[dict[base.LearnedName, base.Text], Field(min_length=1)]


class TunedTest(Runs):
    """A changed robot: the method before it is fine-tuned, a level that it knows, and the `tuned` methods by name."""

    methods: tuple[base.MethodName]
    known: base.LevelName
    tuned: Annotated[dict[base.Text, base.MethodName], Field(min_length=1)]


class FineTuning(Checked):
    """Error over the seconds of new data, the values of a sweep; `joint` may be `avg`, the limb's mean."""

    sweep: base.SweepName
    limb: base.LimbName
    joint: base.Text
    tests: Annotated[dict[base.Text, TunedTest], Field(min_length=1)]

    def problems(self, results: "Results", place: Place) -> Iterator[Problem]:
        """Yield a joint that the limb does not have."""
        joints = [*results.joints(self.limb), "avg"]
        if self.joint not in joints:
            yield (*place, "joint"), not_accepted("joint", self.joint, joints)


class CommandsFigure(Section):
    """Histograms of the walking commands in some training sets."""

    sets: base.Distinct[base.TrainingSetName]
    bins: base.Whole = Field(ge=2, le=200)
