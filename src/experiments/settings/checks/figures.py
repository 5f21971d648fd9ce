"""What of the sections of figures does not fit the rest of the configuration."""

import re
from collections.abc import Iterator, Mapping

from experiments.settings.checks.results import Check, Results
from experiments.settings.figures import (
    ComparedRuns,
    Figure05,
    Figure06,
    Figure10,
    Figure17,
    Figure20,
    FineTuning,
    KeptTable,
    WhyShare,
)
from mobnet.core.errors import misfit, not_accepted
from mobnet.formats.base import Section
from mobnet.formats.reading import Place, Problem


def figure_05_problems(section: Figure05, results: Results, place: Place) -> Iterator[Problem]:
    """Yield levels of which the table prints no number."""
    for level in section.panels:
        if text := results.not_printed(section.table, level):
            yield (*place, "panels", level), text


def figure_06_problems(section: Figure06, results: Results, place: Place) -> Iterator[Problem]:
    """Yield a joint that no push of the test turns."""
    if text := results.not_pushed(section.scenario, section.joint):
        yield (*place, "joint"), text


def compared_runs_problems(section: ComparedRuns, results: Results, place: Place) -> Iterator[Problem]:
    """Yield a place at which the table prints no number."""
    if text := results.not_printed(section.table, section.place):
        yield (*place, "place"), text


def figure_10_problems(section: Figure10, results: Results, place: Place) -> Iterator[Problem]:
    """Yield methods without a run in the walk that nothing pushes, and tests whose pushes do not turn the joint."""
    for title, test in section.tests.items():
        for k, method in enumerate(test.methods):
            if method not in section.against.methods:
                text = not_accepted("method", method, section.against.methods)
                yield (*place, "tests", title, "methods", k), text
        if text := results.not_pushed(test.scenario, section.joint):
            yield (*place, "tests", title, "scenario"), text


def figure_17_problems(section: Figure17, results: Results, place: Place) -> Iterator[Problem]:
    """Yield methods that are not trained, and pairs of them that are not of one kind."""
    for key, methods in (("methods", section.methods), ("best", section.best)):
        for k, method in enumerate(methods):
            if text := results.not_trained(method, section.limb):
                yield (*place, key, k), text
    yield from _kind_problems(section, results, (*place, "best"))


def _kind_problems(section: Figure17, results: Results, place: Place) -> Iterator[Problem]:
    """Yield methods that differ from the one of their kind in more than how they learn."""
    catalogue = results.catalogue
    if len(section.best) != len(section.methods):
        yield place, misfit(f"{len(section.best)} methods", f"{len(section.methods)}, one for each of `methods`")
        return
    trained = results.trained(section.limb)
    for k, (method, best) in enumerate(zip(section.methods, section.best, strict=True)):
        if best in section.methods:
            yield (*place, k), misfit(best, "a method apart from `methods`")
            continue
        are_trained = {method, best} <= {*trained}
        if are_trained and catalogue.network(method, section.limb) != catalogue.network(best, section.limb):
            yield (*place, k), misfit(best, f"a method with the network of {method}")


def figure_20_problems(section: Figure20, results: Results, place: Place) -> Iterator[Problem]:
    """Yield sweeps that the figure cannot show."""
    sweeps = results.settings.sweeps
    for key, name, varied in (("parameters", section.parameters, "network"), ("samples", section.samples, "learning")):
        if sweeps[name].section != varied or sweeps[name].limb != section.limb:
            yield (*place, key), misfit(name, f"a sweep of section {varied} for {section.limb}")
            return
    sizes = sweeps[section.parameters]
    for k, base_method in enumerate(sweeps[section.samples].of):
        if base_method not in sizes.of:
            text = not_accepted(f"method of sweep {section.parameters}", base_method, sizes.of)
            yield ("sweeps", section.samples, "of", k), text


def kept_table_problems(section: KeptTable, results: Results, place: Place) -> Iterator[Problem]:
    """Yield a table of trials that there is not."""
    if not re.fullmatch(r"docs/trials/[a-z0-9_]+\.csv", section.data):
        yield (*place, "data"), not_accepted("file", section.data, ["a .csv file of docs/trials"])


def why_share_problems(section: WhyShare, results: Results, place: Place) -> Iterator[Problem]:
    """Yield names that the section, or the trial, does not have."""
    yield from kept_table_problems(section, results, place)
    known = results.settings.trials.why.ways
    for name in section.ways:
        if name not in known:
            yield (*place, "ways", name), not_accepted("way of learning", name, known)
    for title, panel in section.panels.items():
        for k, name in enumerate(panel.networks):
            if name not in section.networks:
                yield (*place, "panels", title, "networks", k), not_accepted("network", name, section.networks)
        for k, name in enumerate(panel.sets):
            if name not in section.sets:
                yield (*place, "panels", title, "sets", k), not_accepted("set", name, section.sets)


def fine_tuning_problems(section: FineTuning, results: Results, place: Place) -> Iterator[Problem]:
    """Yield a joint that the limb does not have."""
    joints = [*results.joints(section.limb), "avg"]
    if section.joint not in joints:
        yield (*place, "joint"), not_accepted("joint", section.joint, joints)


CHECKS: Mapping[type[Section], Check] = {
    Figure05: figure_05_problems,
    Figure06: figure_06_problems,
    ComparedRuns: compared_runs_problems,
    Figure10: figure_10_problems,
    Figure17: figure_17_problems,
    Figure20: figure_20_problems,
    KeptTable: kept_table_problems,
    WhyShare: why_share_problems,
    FineTuning: fine_tuning_problems,
}
