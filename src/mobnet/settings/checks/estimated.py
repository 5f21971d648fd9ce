"""What must hold for estimates: a test's methods estimate the joints that products show of it."""

from collections.abc import Collection, Iterable, Iterator
from typing import NamedTuple

from mobnet.core.errors import misfit
from mobnet.settings.checks.results import Results
from mobnet.settings.reading import Place

Problem = tuple[Place, str]
ROOT: Place = ("evaluation",)


class ShownJoints(NamedTuple):
    """Methods of a test, listed at a place below `evaluation`, and joints that a product shows of each of them."""

    place: Place
    scenario: str
    level: str
    methods: Iterable[str]
    joints: Collection[str]


def estimate_problems(results: Results) -> Iterator[Problem]:
    """Yield methods that estimate nothing in a test, or not what is shown of them."""
    settings = results.settings
    for scenario, rows in settings.estimated_limbs.items():
        for level in rows:
            if text := results.not_run(scenario, level, ""):
                yield ("estimated_limbs", scenario, level), text
    for scenario, levels in settings.tests.items():
        for level, methods in levels.items():
            for k, method in enumerate(methods):
                if not settings.estimated(method, scenario, level):
                    accepted = f"methods that estimate a joint of {settings.estimated_limbs[scenario][level]}"
                    yield ("tests", scenario, level, k), misfit(method, accepted)
    for shown in (*_of_tables(results), *_of_figures(results), *_of_measures(results)):
        for k, method in enumerate(shown.methods):
            if text := results.not_estimated(method, shown.scenario, shown.level, shown.joints):
                yield (*ROOT, *shown.place, k), text
    yield from _calibration_problems(results)


def _of_tables(results: Results) -> Iterator[ShownJoints]:
    """Yield what tables show."""
    evaluation = results.settings.evaluation
    for name, table in evaluation.tables.items():
        joints = {joint for column in table.columns for joint in results.joints_of(column)}
        for index, row in enumerate(table.rows):
            for key in ("methods", "further"):
                yield ShownJoints(
                    ("tables", name, "rows", index, key), row.scenario, row.level, getattr(row, key), joints
                )
    for index, row in enumerate(evaluation.methods):
        for limb in row.columns:
            yield ShownJoints(("methods", index, "methods"), row.scenario, row.level, row.methods, results.joints(limb))
    budgeted = {joint for column in evaluation.error_budget.joints for joint in results.joints_of(column)}
    noisy = {joint for name in evaluation.noise.joints for joint in results.joints(name)}
    for name, tests, joints in (
        ("error_budget", evaluation.error_budget.tests, budgeted),
        ("noise", evaluation.noise.tests, noisy),
    ):
        for k, row in enumerate(tests):
            yield ShownJoints((name, "tests", k, "methods"), row.scenario, row.level, row.methods, joints)


def _of_figures(results: Results) -> Iterator[ShownJoints]:
    """Yield what figures of walks show."""
    evaluation = results.settings.evaluation
    cycle, knee, limbs = evaluation.figure_05, evaluation.figure_10, evaluation.figure_18
    for level, methods in cycle.panels.items():
        yield ShownJoints(("figure_05", "panels", level), cycle.scenario, level, methods, (cycle.joint,))
    for name, joints in (
        ("figure_06", (evaluation.figure_06.joint,)),
        ("figure_07", evaluation.figure_07.joints),
        ("figure_08", results.joints(evaluation.figure_08.limb)),
        ("figure_09", results.joints(evaluation.figure_09.limb)),
    ):
        figure = getattr(evaluation, name)
        yield ShownJoints((name, "methods"), figure.scenario, figure.level, figure.methods, joints)
    for title, test in knee.tests.items():
        yield ShownJoints(
            ("figure_10", "tests", title, "methods"), test.scenario, test.level, test.methods, (knee.joint,)
        )
    still = knee.against
    yield ShownJoints(("figure_10", "against", "methods"), still.scenario, still.level, still.methods, (knee.joint,))
    upper = results.layout.limbs(limbs.limbs)
    for scenario in limbs.panels:
        yield ShownJoints(("figure_18", "methods"), scenario, limbs.level, limbs.methods, upper)


def _of_measures(results: Results) -> Iterator[ShownJoints]:
    """Yield what is measured limb by limb: pushes, sines, phases of the gait, standard deviations."""
    evaluation = results.settings.evaluation
    bode, drift = evaluation.bode, evaluation.drift
    yield ShownJoints(("bode", "methods"), bode.scenario, bode.level, bode.methods, results.joints(bode.limb))
    for title, test in drift.tests.items():
        yield ShownJoints(
            ("drift", "tests", title, "methods"), test.scenario, test.level, test.methods, results.joints(drift.limb)
        )
    for title, test in evaluation.fine_tuning.tests.items():
        place, joints = ("fine_tuning", "tests", title, "methods"), results.joints(evaluation.fine_tuning.limb)
        yield ShownJoints(place, test.scenario, test.level, test.methods, joints)
    for title, test in evaluation.amplitude.tests.items():
        place = "amplitude", "tests", title, "methods"
        yield ShownJoints(place, test.scenario, test.level, test.methods, results.joints(test.limb))
    for name, tests in (
        ("peaks", dict(enumerate(evaluation.peaks.tests))),
        ("phases", dict(enumerate(evaluation.phases.tests))),
        ("sigma", evaluation.sigma.tests),
        ("changed", evaluation.changed.tests),
    ):
        for key, test in tests.items():
            joints = results.layout.limbs(test.limbs)
            yield ShownJoints((name, "tests", key, "methods"), test.scenario, test.level, test.methods, joints)


def _calibration_problems(results: Results) -> Iterator[Problem]:
    """Yield tests of standard deviations that nothing predicts."""
    settings, calibration = results.settings, results.settings.evaluation.calibration
    lists: list[tuple[Place, Iterable[str]]] = [((), calibration.methods)]
    lists += [(("tests", k), test.methods) for k, test in enumerate(calibration.tests)]
    for place, methods in lists:
        for k, method in enumerate(methods):
            if text := results.not_learned(method):
                yield (*ROOT, "calibration", *place, "methods", k), text
    for k, test in enumerate(calibration.tests):
        held = {joint for method in test.methods for joint in settings.estimated(method, test.scenario, test.level)}
        if not held.issuperset(results.layout.limbs(test.limbs)):
            text = misfit("a limb that no method predicts", "limbs of the networks of `methods`")
            yield (*ROOT, "calibration", "tests", k, "limbs"), text
