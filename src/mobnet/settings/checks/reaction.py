"""What must hold for reactions: robots walk into something, and a closed loop is where wrenches are estimated."""

from collections.abc import Iterator

from mobnet.core.errors import misfit
from mobnet.settings.checks.results import Results
from mobnet.settings.reading import Place, Problem

ROOT: Place = ("reaction",)


def reaction_problems(results: Results) -> Iterator[Problem]:
    """Yield cases without an obstacle, loops without all legs, and scenarios that no loop walks but that need one."""
    settings, reaction = results.settings, results.settings.reaction
    walked = {row.scenario for row in reaction.cases.values()}
    for name, row in reaction.cases.items():
        if not settings.scenarios[row.scenario].obstacles:
            yield (*ROOT, "cases", name, "scenario"), misfit(row.scenario, "a scenario with `obstacles`")
    limbs, legs = settings.methods[reaction.estimator].limbs, settings.detection.legs
    if not {"V", *legs} <= {*limbs}:
        text = misfit(reaction.estimator, f"a method with networks of V, {', '.join(legs)}: the base and all legs")
        yield (*ROOT, "estimator"), text
    for name, row in settings.scenarios.items():
        if row.wrench == "estimated" and name not in walked:
            yield ("scenarios", name, "wrench"), misfit(row.wrench, "`sensed` where reaction.cases does not walk it")
