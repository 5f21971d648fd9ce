"""What the configuration will have results of: runs, scores, estimated joints, trainings and pushes."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import chain
from typing import Any

from experiments.settings.asked import tests_in
from experiments.settings.catalogue import Catalogue
from experiments.settings.evaluation import CLAIMED_TABLES, measured_in
from experiments.settings.metrics import metric_of
from experiments.settings.runs import Mean
from experiments.settings.settings import Settings
from experiments.settings.table_columns import ERRORS
from mobnet.core.errors import misfit, not_accepted
from mobnet.core.joints import JointLayout, right_of, with_image
from mobnet.formats.checks.robot import joints_above
from mobnet.formats.reading import Place, Problem
from mobnet.settings.methods import swept_names

PUSHED, PUSH, RAW = "rmse_pushed", "rmse_push_", "_raw"  # metrics of windows around pushes, against the raw truth


@dataclass(frozen=True)
class Results:
    """Answers of the configuration about results; each `not_...` returns what is wrong, empty where nothing is."""

    catalogue: Catalogue

    @property
    def settings(self) -> Settings:
        """The configuration."""
        return self.catalogue.settings

    @cached_property
    def layout(self) -> JointLayout:
        """Joints and limbs of the robot."""
        return self.settings.layout

    @property
    def legs(self) -> list[str]:
        """Limbs that stand on feet."""
        return [foot.limb for foot in self.settings.robot.feet.values()]

    def joints(self, name: str) -> tuple[str, ...]:
        """Return the joints of a limb, or the joint itself."""
        return self.layout.groups.get(name, (name,))

    def joints_of(self, column: str | Mean) -> list[str]:
        """Return the joints behind a column."""
        names = (column,) if isinstance(column, str) else column.joints
        return list(chain.from_iterable(map(self.joints, names)))

    def column_names(self, columns: Sequence[str | Mean]) -> list[str]:
        """Return the names of a table's columns: a limb has one for each of its joints."""
        names = list[str]()
        for column in columns:
            names += self.joints(column) if isinstance(column, str) else (column.name,)
        return names

    def not_scored(self, scenario: str, metric: str) -> str:
        """Return what is wrong with a metric of a test: pushes need a window, and there are only so many."""
        windows = self.settings.evaluation.windows
        if metric.startswith(PUSHED[:9]) and scenario not in windows:
            return not_accepted("test with a window around pushes", scenario, windows)
        if section := metric_of(metric).section:
            measured = measured_in(self.settings.evaluation)
            tests = [test for test, _ in tests_in(self.settings, measured[section])] if section in measured else []
            if scenario not in tests:
                return not_accepted(f"test of section {section}", scenario, tests)
        timed = [self.settings.pushes[name].at_s for name in self.settings.scenarios[scenario].pushes]
        if metric.startswith(PUSH) and None not in timed:
            count = sum(len(times) for times in timed if times)
            if int(metric.removeprefix(PUSH).removesuffix(RAW)) > count:
                return not_accepted("metric", metric, [f"{PUSH}{k + 1}" for k in range(count)])
        return ""

    def not_learned(self, method: str) -> str:
        """Return what is wrong with a method where networks are shown."""
        learned = [name for name, row in self.catalogue.all_methods.items() if row.limbs]
        return "" if method in learned else not_accepted("method with networks", method, learned)

    def not_trained(self, method: str, limb: str) -> str:
        """Return what is wrong with a method where networks of a limb are shown."""
        trained = self.trained(limb)
        return "" if method in trained else not_accepted(f"method that trains {limb}", method, trained)

    def not_printed(self, table: str, printed: str | None) -> str:
        """Return what is wrong with the place of the paper's numbers in a table; None shows none of them."""
        tables = self.settings.published.tables
        accepted = tables[table].numbers if table in tables else {}
        return "" if printed is None or printed in accepted else not_accepted("place of a row", printed, accepted)

    def not_pushed(self, scenario: str, joint: str) -> str:
        """Return what is wrong with a joint that the pushes of a test should turn."""
        pushed = self.pushed_joints(scenario)
        return "" if joint in pushed else not_accepted(f"joint pushed in {scenario}", joint, pushed)

    def not_cases(self, place: Place, names: Sequence[str], *, pushed: bool) -> Iterator[Problem]:
        """Yield cases of reactions in which something is pushed or stands in the way, or in which nothing does."""
        fitting: list[str] = []
        for name, case in self.settings.reaction.cases.items():
            row = self.settings.scenarios[case.scenario]
            if bool(row.obstacles or row.pushes) == pushed:
                fitting.append(name)
        for name in names:
            if name not in fitting:
                yield place, not_accepted("case of reactions", name, fitting)

    def not_gated(self, place: Place, methods: Sequence[str], gate: str | None = None) -> Iterator[Problem]:
        """Yield methods without that of the gate, which is that of detectors where no other one is named."""
        gate = gate or self.settings.detection.gate.method
        if gate not in methods:
            yield place, misfit(", ".join(methods), f"methods with {gate}, that of the gate")

    def trained(self, limb: str) -> list[str]:
        """Return the methods that train a network of a limb."""
        return [name for name, method in self.catalogue.all_methods.items() if limb in method.limbs]

    def claimed_trainings(self) -> list[str]:
        """Return the methods whose trainings claims may ask about: those of Figures 17 and 20, and their variants."""
        evaluation = self.settings.evaluation
        sweeps = self.settings.sweeps
        keys = (evaluation.figure_20.parameters, evaluation.figure_20.samples)
        swept = list[str]()
        for key in keys:
            swept += swept_names(key, sweeps[key])
        figure = evaluation.figure_17
        return [*figure.methods, *figure.best, *evaluation.kinds.variants, *swept]

    def claimed_tables(self) -> dict[str, tuple[str, ...]]:
        """Return the tables whose fields claims may name -> their columns."""
        of_products = {name: table.columns for name, table in CLAIMED_TABLES.items()}
        return {**dict.fromkeys(self.settings.evaluation.tables, ERRORS), **of_products}

    def pushed_joints(self, scenario: str) -> list[str]:
        """Return the joints that the pushes of a scenario turn."""
        names = self.settings.scenarios[scenario].pushes
        turned = chain.from_iterable(map(self.turned_joints, names))
        return list(dict.fromkeys(turned))

    def turned_joints(self, name: str) -> list[str]:
        """Return the joints that a push turns: the one that is driven, or all above a point."""
        robot = self.settings.robot
        push = self.settings.pushes[name]
        bodies = {f"{side}_sole": foot.body for side, foot in robot.feet.items()}
        for point in robot.points:
            bodies |= dict(zip(with_image(point.name), (point.body, right_of(point.body)), strict=False))
        return [push.joint] if push.joint else joints_above(robot, bodies.get(push.point or "", ""))


Check = Callable[[Any, Results, Place], Iterator[Problem]]  # of a section that stands at a place
