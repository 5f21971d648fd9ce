"""What must hold for the products beside errors: pushes, lines for every band, lags within what is looked at."""

import re
from collections.abc import Iterator, Sequence

from experiments.settings.checks.results import Results
from mobnet.core.errors import misfit, not_accepted
from mobnet.settings.checks.limits import at_most
from mobnet.settings.reading import Place, Problem

ROOT: Place = ("evaluation",)
MS = 1000.0


def measured_problems(results: Results) -> Iterator[Problem]:
    """Yield what does not fit in the sections of measures and in the table of methods."""
    evaluation = results.settings.evaluation
    yield from _push_problems(results)
    yield from _learned_problems(results)
    yield from _line_problems(results)
    yield from _sigma_problems(results)
    yield from _changed_problems(results)
    for k, row in enumerate(evaluation.methods):
        if text := results.not_scored(row.scenario, row.metric):
            yield (*ROOT, "methods", k, "metric"), text
    tuning = evaluation.fine_tuning
    if tuning.joint not in (joints := [*results.joints(tuning.limb), "avg"]):
        yield (*ROOT, "fine_tuning", "joint"), not_accepted("joint", tuning.joint, joints)


def _push_problems(results: Results) -> Iterator[Problem]:
    """Yield more steps than begin during the pushes, where swing and stance take their shortest time."""
    settings = results.settings
    drift = results.settings.evaluation.drift
    place = (*ROOT, "drift", "steps")
    for test in drift.tests.values():
        pushes = [settings.pushes[name] for name in settings.scenarios[test.scenario].pushes]
        longest = max((push.duration_s[1] for push in pushes), default=0.0)
        most = 1 + int(longest / (2.0 * settings.commands.duration_s[0]))
        yield from at_most(place, drift.steps, most, f"the steps that begin in the longest push of {test.scenario}")


def _learned_problems(results: Results) -> Iterator[Problem]:
    """Yield a learning curve of trials that there are not."""
    curve = results.settings.evaluation.learning_curve
    if not re.fullmatch(r"docs/trials/[a-z0-9_]+\.csv", curve.data):
        yield (*ROOT, "learning_curve", "data"), not_accepted("file", curve.data, ["a .csv file of docs/trials"])


def _line_problems(results: Results) -> Iterator[Problem]:
    """Yield joints that are driven at another number of lines than there are bands, or not at all, and shown anyhow."""
    settings = results.settings
    bode = results.settings.evaluation.bode
    pushes = [settings.pushes[name] for name in settings.scenarios[bode.scenario].pushes]
    lines = {push.joint: push.sines.frequency_hz for push in pushes if push.joint and push.sines}
    if len(lines) < len(pushes):
        yield (*ROOT, "bode", "scenario"), misfit(bode.scenario, "a test whose pushes are sines, each on its own joint")
    if not set(lines) & set(results.joints(bode.limb)):
        yield (*ROOT, "bode", "scenario"), misfit(bode.scenario, f"a test with sines on joints of {bode.limb}")
    for k, joint in enumerate(bode.shown):
        if joint not in (driven := [name for name in results.joints(bode.limb) if name in lines]):
            yield (*ROOT, "bode", "shown", k), not_accepted("joint with sines", joint, driven)
    for joint, frequencies in lines.items():
        if len(frequencies) != len(bode.bands_hz):
            text = misfit(f"{len(bode.bands_hz)} bands", f"{len(frequencies)}, one for each line on {joint}")
            yield (*ROOT, "bode", "bands_hz"), text
        elif any(set(frequencies) & set(other) for name, other in lines.items() if name != joint):
            name = next(name for name in settings.pushes if settings.pushes[name].joint == joint)
            text = misfit(list(frequencies), f"lines of its own for each joint of {bode.scenario}")
            yield ("pushes", name, "sines", "frequency_hz"), text
        elif frequencies[-1] >= settings.rates.data_hz / 2:
            yield (*ROOT, "bode", "scenario"), misfit(frequencies[-1], "lines below half of data_hz")


def _sigma_problems(results: Results) -> Iterator[Problem]:
    """Yield lags that are not looked at, and names of tests that there are not."""
    sigma = results.settings.evaluation.sigma
    if sigma.lags_ms[-1] > sigma.longest_s * MS:
        yield (*ROOT, "sigma", "lags_ms"), misfit(sigma.lags_ms[-1], f"at most longest_s, {sigma.longest_s * MS:g} ms")
    names: Sequence[str] = list(sigma.tests)
    for title, base in sigma.against.items():
        for name in (title, base):
            if name not in names:
                yield (*ROOT, "sigma", "against", title), not_accepted("test of sigma", name, names)
        if title == base:
            yield (*ROOT, "sigma", "against", title), misfit(base, "another test of sigma than itself")


def _changed_problems(results: Results) -> Iterator[Problem]:
    """Yield windows that no recording is long enough for, and tests that are named elsewhere and do not exist."""
    settings = results.settings
    changed = results.settings.evaluation.changed
    for index, title in enumerate(settings.evaluation.hourly.known):
        if title not in changed.tests:
            yield (*ROOT, "hourly", "known", index), not_accepted("test of section changed", title, changed.tests)
    for test in changed.tests.values():
        longest = min(settings.test_s(test.scenario), settings.recording.episode_s)
        place = (*ROOT, "changed", "window_s")
        what = f"for {test.scenario} lasts so long"
        yield from at_most(place, changed.window_s, longest, what)
