"""What the configuration will have results of: runs, scores, estimated joints, trainings and pushes."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import chain

from experiments.settings.asked import tests_in
from experiments.settings.catalogue import Catalogue
from experiments.settings.evaluation import measured_in
from experiments.settings.metrics import metric_of
from experiments.settings.runs import Mean
from experiments.settings.settings import Settings
from mobnet.core.columns import (
    CALIBRATION,
    COVERAGE,
    DETECTION,
    ERRORS,
    HOURLY,
    KINDS,
    LATENCY,
    METHODS,
    SAFETY,
    SENSORLESS,
)
from mobnet.core.errors import not_accepted
from mobnet.core.joints import JointLayout, right_of, with_image
from mobnet.settings.checks.robot import joints_above
from mobnet.settings.methods import swept_names

TABLES = {  # that are no entry of `tables` -> their columns
    **dict.fromkeys(
        ("table_09", "table_13", "false_alarms", "found_by_rate", "smallest_force", "links", "contact_points"),
        DETECTION,
    ),
    "calibration": CALIBRATION, "coverage": COVERAGE, "error_budget": ERRORS, "hourly": HOURLY, "kinds": KINDS,
    "latency": LATENCY, "methods": METHODS, "safety": SAFETY, "sensorless": SENSORLESS,
}  # fmt: skip
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
        return {**dict.fromkeys(self.settings.evaluation.tables, ERRORS), **TABLES}

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
