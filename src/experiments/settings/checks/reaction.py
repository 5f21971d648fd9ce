"""What must hold for reactions: cases that sizes name, and a closed loop where wrenches are estimated."""

from collections.abc import Iterator

from experiments.settings.checks.results import Results
from mobnet.core.errors import misfit, not_accepted
from mobnet.settings.reading import Place, Problem

ROOT: Place = ("reaction",)


def reaction_problems(results: Results) -> Iterator[Problem]:
    """Yield cases of sizes that there are not, loops without all legs, and scenarios that no loop walks but must."""
    settings = results.settings
    reaction = results.settings.reaction
    walked = {row.scenario for row in reaction.cases.values()}
    for scale, sizes in settings.scales.items():
        for name in sizes.reactions.cases:
            if name not in reaction.cases:
                yield ("scales", scale, "reactions", "cases", name), not_accepted("case", name, reaction.cases)
    limbs = settings.methods[reaction.estimator].limbs
    legs = settings.detection.legs
    if not {"V", *legs} <= {*limbs}:
        text = misfit(reaction.estimator, f"a method with networks of V, {', '.join(legs)}: the base and all legs")
        yield (*ROOT, "estimator"), text
    for name, row in settings.scenarios.items():
        if row.wrench == "estimated" and name not in walked:
            yield ("scenarios", name, "wrench"), misfit(row.wrench, "`sensed` where reaction.cases does not walk it")
