"""What must hold for detectors: their walks are run and estimated, collisions meet points, numbers fit each other."""

import re
from collections.abc import Iterator
from typing import Any

from pydantic import BaseModel

from mobnet.core.errors import misfit, not_accepted
from mobnet.settings.checks.results import Results
from mobnet.settings.reading import Place

POINT = re.compile(r"(left|right)_[a-z]+_[a-z]+")  # side, link and direction of what a collision meets
LARGEST, COLLISION = "largest", "collision"  # rules that tables show
SHOWN = (
    "table_09", "table_13", "false_alarms", "smallest_force", "links", "figure_13", "figure_14", "figure_15",
    "detection_curves",
)  # fmt: skip
Problem = tuple[Place, str]
ROOT: Place = ("detection",)


def detection_problems(results: Results) -> Iterator[Problem]:
    """Yield what does not fit in the section of detectors and in the products that show them."""
    yield from _walk_problems(results)
    yield from _number_problems(results)
    yield from _shown_problems(results)


def _walk_problems(results: Results) -> Iterator[Problem]:
    """Yield walks that are the same, pushes where there should be none, and legs that are none."""
    settings, detection = results.settings, results.settings.detection
    for key in ("collisions", "sweep", "place", "random"):
        scenario = getattr(detection, key)
        if settings.detection_walks.count(scenario) > 1:
            yield (*ROOT, key), misfit(scenario, "a test of its own for each of the walks")
        pushes = settings.scenarios[scenario].pushes
        if bool(pushes) != (key in ("collisions", "sweep")):
            accepted = "a test with pushes" if key in ("collisions", "sweep") else "a test without pushes"
            yield (*ROOT, key), misfit(scenario, accepted)
        for name in pushes:
            if not POINT.fullmatch(settings.pushes[name].point or ""):
                text = misfit(settings.pushes[name].point, "a point named <side>_<link>_<direction>")
                yield ("pushes", name, "point"), text
    for k, limb in enumerate(detection.legs):
        if limb not in results.legs:
            yield (*ROOT, "legs", k), not_accepted("leg", limb, results.legs)


def _number_problems(results: Results) -> Iterator[Problem]:
    """Yield filters above what is sampled, signals that a method does not have, and names of rules that are taken."""
    settings, detection = results.settings, results.settings.detection
    if detection.low_pass_hz >= settings.rates.data_hz / 2:
        text = misfit(detection.low_pass_hz, f"below half of data_hz, {settings.rates.data_hz / 2}")
        yield (*ROOT, "low_pass_hz"), text
    for name, row in detection.detectors.items():
        if set(row.signals) - {"mean"} and (text := results.not_learned(row.method)):
            yield (*ROOT, "detectors", name, "signals"), f"a standard deviation of {text}"
        if row.norm and row.signals != ("mean",):
            yield (*ROOT, "detectors", name, "norm"), misfit(list(row.signals), "the signal `mean` with `norm`")
    rates = detection.thresholds.rates_per_h
    if LARGEST in rates or COLLISION not in rates:
        accepted = f"{COLLISION} and others, but for {LARGEST}, the paper's rule"
        yield (*ROOT, "thresholds", "rates_per_h"), misfit(", ".join(rates), accepted)


def _shown_problems(results: Results) -> Iterator[Problem]:
    """Yield legs, levels, rules and cells of products that are not tried."""
    settings, evaluation = results.settings, results.settings.evaluation
    detection, robots = settings.detection, settings.fleet.robots
    kinds, levels = (LARGEST, *detection.thresholds.rates_per_h), (*detection.levels, *robots)
    points = [settings.pushes[name].point or "" for name in settings.scenarios[detection.collisions].pushes]
    cells = list(dict.fromkeys(" ".join(point.split("_")[1:]) for point in points))
    for name in SHOWN:
        section: BaseModel = getattr(evaluation, name)
        place: Place = ("evaluation", name)
        given: dict[str, Any] = {key: getattr(section, key) for key in type(section).model_fields}
        if given["leg"] not in detection.legs:
            yield (*place, "leg"), not_accepted("leg with detectors", given["leg"], detection.legs)
        shown = given.get("levels", (given.get("level"),))
        for k, level in enumerate(shown):
            if level not in levels:
                key = ("levels", k) if "levels" in given else ("level",)
                yield (*place, *key), not_accepted("level with detectors", level, levels)
        for k, kind in enumerate(given.get("kinds", ())):
            if kind not in kinds:
                yield (*place, "kinds", k), not_accepted("rule of thresholds", kind, kinds)
        if given.get("kind", LARGEST) not in kinds:
            yield (*place, "kind"), not_accepted("rule of thresholds", given["kind"], kinds)
        for k, cell in enumerate(given.get("cells", ())):
            if cell not in cells:
                yield (*place, "cells", k), not_accepted("cell of collisions", cell, cells)
