"""What must hold for detectors: walks differ, collisions meet points, numbers fit each other."""

import re
from collections.abc import Iterator

from experiments.records.collisions import READINGS
from experiments.settings.checks.results import Results
from mobnet.core.detections import COLLISION
from mobnet.core.errors import misfit, not_accepted
from mobnet.formats.faults import below
from mobnet.formats.reading import Place, Problem

POINT = re.compile(r"(left|right)_[a-z]+_[a-z]+")  # side, link and direction of what a collision meets
ROOT: Place = ("detection",)
REACTION: Place = ("reaction",)


def detection_problems(results: Results) -> Iterator[Problem]:
    """Yield what does not fit in the section of detectors."""
    yield from _walk_problems(results)
    yield from _number_problems(results)


def _walk_problems(results: Results) -> Iterator[Problem]:
    """Yield walks that are the same, and points that are not named after what a collision hits."""
    settings = results.settings
    detection = results.settings.detection
    for key in ("collisions", "sweep", "place", "random"):
        scenario = getattr(detection, key)
        if settings.detection_walks.count(scenario) > 1:
            yield (*ROOT, key), misfit(scenario, "a test of its own for each of the walks")
        for name in settings.scenarios[scenario].pushes:
            if not POINT.fullmatch(settings.pushes[name].point or ""):
                text = misfit(settings.pushes[name].point, "a point named <side>_<link>_<direction>")
                yield ("pushes", name, "point"), text


def _number_problems(results: Results) -> Iterator[Problem]:
    """Yield filters above what is sampled, signals that a method does not have, and names of rules that are taken."""
    settings = results.settings
    detection = results.settings.detection
    yield from below((*ROOT, "low_pass_hz"), detection.low_pass_hz, settings.rates.data_hz / 2, "half of data_hz")
    for name, row in detection.detectors.items():
        if set(row.signals) - {"mean"} and (text := results.not_learned(row.method)):
            yield (*ROOT, "detectors", name, "signals"), f"a standard deviation of {text}"
        if row.norm and row.signals != ("mean",):
            yield (*ROOT, "detectors", name, "norm"), misfit(list(row.signals), "the signal `mean` with `norm`")
    rates = detection.thresholds.rates_per_h
    if READINGS.keys() & rates.keys() or COLLISION not in rates:
        accepted = f"{COLLISION} and others, but for {' and '.join(READINGS)}, the paper's rule"
        yield (*ROOT, "thresholds", "rates_per_h"), misfit(", ".join(rates), accepted)


def reaction_problems(results: Results) -> Iterator[Problem]:
    """Yield what does not fit of cases, obstacles and loops, and scenarios that no loop walks but must."""
    settings = results.settings
    reaction = results.settings.reaction
    walked = {row.scenario for row in reaction.cases.values()}
    for scale, sizes in settings.scales.items():
        for name in sizes.reactions.cases:
            if name not in reaction.cases:
                yield ("scales", scale, "reactions", "cases", name), not_accepted("case", name, reaction.cases)
    limbs = settings.methods[reaction.estimator].limbs
    legs = settings.detection.legs
    for name, case in reaction.cases.items():
        if case.leg is not None and case.leg not in legs:
            yield (*REACTION, "cases", name, "leg"), not_accepted("leg", case.leg, legs)
        # The controller walks on the wrenches of both feet, which follow from the torques of the legs.
        if case.limbs and not {*legs} <= {*case.limbs} <= {*limbs}:
            text = misfit(", ".join(case.limbs), f"some of {', '.join(limbs)}, and all legs: {', '.join(legs)}")
            yield (*REACTION, "cases", name, "limbs"), text
        row = settings.scenarios[case.scenario]
        if case.limbs and (row.obstacles or row.pushes):
            text = misfit(", ".join(case.limbs), "all limbs, where something is in the way or pushes")
            yield (*REACTION, "cases", name, "limbs"), text
    if not {"V", *legs} <= {*limbs}:
        text = misfit(reaction.estimator, f"a method with networks of V, {', '.join(legs)}: the base and all legs")
        yield (*REACTION, "estimator"), text
    for name, obstacle in settings.obstacles.items():
        for number, part in enumerate(obstacle.parts):
            if part.bevel_m is not None and (part.type != "box" or part.bevel_m >= min(part.size[:2])):
                text = misfit(part.bevel_m, "less than half of the length and width of a box")
                yield ("obstacles", name, "parts", number, "bevel_m"), text
    for name, row in settings.scenarios.items():
        if row.wrench == "estimated" and name not in walked:
            yield ("scenarios", name, "wrench"), misfit(row.wrench, "`sensed` where reaction.cases does not walk it")
