"""What of the sections of further measures does not fit the rest of the configuration."""

from collections.abc import Iterator, Mapping, Sequence

from experiments.settings.checks.results import Check, Results
from experiments.settings.measures import MS, Bode, CalibrationTest, Changed, Coverage, CoverageTest, Drift, Sigma
from mobnet.core.errors import misfit, not_accepted
from mobnet.formats.base import Section
from mobnet.formats.faults import at_most
from mobnet.formats.reading import Place, Problem


def coverage_test_problems(section: CoverageTest, results: Results, place: Place) -> Iterator[Problem]:
    """Yield a level at which nothing is run, and a joint that no push of the test turns."""
    levels = results.catalogue.tests.get(section.scenario, {})
    if section.level not in levels:
        yield (*place, "level"), not_accepted(f"level of test {section.scenario}", section.level, levels)
    if section.pushed is not None and (text := results.not_pushed(section.scenario, section.pushed)):
        yield (*place, "pushed"), text


def coverage_problems(section: Coverage, results: Results, place: Place) -> Iterator[Problem]:
    """Yield a limb that is no leg, and blocks that are longer than a test at some scale."""
    settings = results.settings
    if section.limb not in results.legs or section.limb not in settings.robot.networks[section.limb].T:
        accepted = f"a leg whose network sees its torques, `T`: {' or '.join(results.legs)}"
        yield (*place, "limb"), misfit(section.limb, accepted)
    for name, scale in settings.scales.items():
        # Where figures start elsewhere, a scale is too short for what is looked at.
        if scale.figure_start_s is None:
            what = f"a test at scale {name}"
            yield from at_most((*place, "block_s"), section.block_s, scale.test.shard_s, what)


def calibration_test_problems(section: CalibrationTest, results: Results, place: Place) -> Iterator[Problem]:
    """Yield what does not fit in any test, and limbs that no method predicts."""
    yield from coverage_test_problems(section, results, place)
    predicted = set[str]()
    for name in section.methods:
        predicted.update(results.catalogue.estimated(name, section.scenario, section.level))
    if not predicted.issuperset(results.layout.limbs(section.limbs)):
        text = misfit("a limb that no method predicts", "limbs of the networks of `methods`")
        yield (*place, "limbs"), text


def bode_problems(section: Bode, results: Results, place: Place) -> Iterator[Problem]:
    """Yield pushes that are no sines, or not on the limb, shown joints without sines, and lines that do not fit."""
    settings = results.settings
    pushes = [settings.pushes[name] for name in settings.scenarios[section.scenario].pushes]
    lines = {push.joint: push.sines.frequency_hz for push in pushes if push.joint and push.sines}
    joints = results.joints(section.limb)
    driven = [name for name in joints if name in lines]
    if len(lines) < len(pushes):
        text = misfit(section.scenario, "a test whose pushes are sines, each on its own joint")
        yield (*place, "scenario"), text
    if not driven:
        yield (*place, "scenario"), misfit(section.scenario, f"a test with sines on joints of {section.limb}")
    for k, joint in enumerate(section.shown):
        if joint not in driven:
            yield (*place, "shown", k), not_accepted("joint with sines", joint, driven)
    yield from _line_problems(section, results, lines, place)


def _line_problems(
    section: Bode, results: Results, lines: Mapping[str, Sequence[float]], place: Place
) -> Iterator[Problem]:
    """Yield joints with another number of lines than there are bands, with lines of others, or too high ones."""
    settings = results.settings
    for joint, frequencies in lines.items():
        others = set[float]()
        for name, other in lines.items():
            others.update(other if name != joint else ())
        if len(frequencies) != len(section.bands_hz):
            text = misfit(f"{len(section.bands_hz)} bands", f"{len(frequencies)}, one for each line on {joint}")
            yield (*place, "bands_hz"), text
        elif others.intersection(frequencies):
            name = next(name for name in settings.pushes if settings.pushes[name].joint == joint)
            text = misfit(list(frequencies), f"lines of its own for each joint of {section.scenario}")
            yield ("pushes", name, "sines", "frequency_hz"), text
        elif frequencies[-1] >= settings.rates.data_hz / 2:
            yield (*place, "scenario"), misfit(frequencies[-1], "lines below half of data_hz")


def drift_problems(section: Drift, results: Results, place: Place) -> Iterator[Problem]:
    """Yield more steps than begin during the pushes, where swing and stance take their shortest time."""
    settings = results.settings
    for test in section.tests.values():
        pushes = [settings.pushes[name] for name in settings.scenarios[test.scenario].pushes]
        longest = max((push.duration_s[1] for push in pushes), default=0.0)
        most = 1 + int(longest / (2.0 * settings.commands.duration_s[0]))
        what = f"the steps that begin in the longest push of {test.scenario}"
        yield from at_most((*place, "steps"), section.steps, most, what)


def sigma_problems(section: Sigma, results: Results, place: Place) -> Iterator[Problem]:
    """Yield lags that are not looked at, and names of tests that there are not."""
    if section.lags_ms[-1] > section.longest_s * MS:
        text = misfit(section.lags_ms[-1], f"at most longest_s, {section.longest_s * MS:g} ms")
        yield (*place, "lags_ms"), text
    for title, other in section.against.items():
        for name in (title, other):
            if name not in section.tests:
                yield (*place, "against", title), not_accepted("test of sigma", name, section.tests)
        if title == other:
            yield (*place, "against", title), misfit(other, "another test of sigma than itself")


def changed_problems(section: Changed, results: Results, place: Place) -> Iterator[Problem]:
    """Yield windows that no recording is long enough for."""
    settings = results.settings
    for test in section.tests.values():
        longest = min(settings.test_s(test.scenario), settings.recording.episode_s)
        what = f"for {test.scenario} lasts so long"
        yield from at_most((*place, "window_s"), section.window_s, longest, what)


CHECKS: Mapping[type[Section], Check] = {
    CoverageTest: coverage_test_problems,
    Coverage: coverage_problems,
    CalibrationTest: calibration_test_problems,
    Bode: bode_problems,
    Drift: drift_problems,
    Sigma: sigma_problems,
    Changed: changed_problems,
}
