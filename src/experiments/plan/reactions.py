"""Walks into obstacles on which reactions are tried: what runs in them, and the files that say what comes of them."""

from collections.abc import Iterable, Mapping
from pathlib import Path

from experiments.plan.detection import level_of_detectors
from experiments.plan.files import Files
from experiments.settings.scales import ReactionSizes
from mobnet.settings.reaction import watches_of

# Of the time of a walk with all networks, that of one with the legs' alone, which lasts to its end where those into
# obstacles end after the contact: .63 in a second of walking (docs/notes/reaction.md), 1.27 times as long.
LEGS_SHARE = 0.8
Reactions = Mapping[str, Mapping[str, Path]]  # level of a robot -> case -> file of its trials, or a course


def methods_of(files: Files, cases: Iterable[str]) -> tuple[str, ...]:
    """Return the methods that run in some cases: that in the loop, and those of detectors."""
    reaction = files.settings.reaction
    detectors = files.settings.detection.detectors
    methods = [reaction.estimator]
    for case in cases:
        names = [watch.detector for watch in watches_of(reaction, case)]
        # Force sensors, and a robot that does not react, run no method.
        methods += [detectors[name].method for name in names if name in detectors]
    return tuple(dict.fromkeys(methods))


def sizes_of(files: Files, case: str) -> ReactionSizes:
    """Return how many walks a robot makes of a case, and of what length."""
    sizes = files.settings.sizes.reactions
    return sizes.cases.get(case) or (sizes.pushed if is_pushed(files, case) else sizes.free)


def is_pushed(files: Files, case: str) -> bool:
    """Return whether robots walk into something in a case, or something pushes them."""
    scenario = files.settings.scenarios[files.settings.reaction.cases[case].scenario]
    return bool(scenario.obstacles or scenario.pushes)


def walks_in(files: Files, case: str) -> float:
    """Return how many walks a robot makes in a case, in those into obstacles that cost as much."""
    sizes = sizes_of(files, case)
    usual_s = files.settings.sizes.reactions.pushed.longest_s
    walks = sizes.runs + min(sizes.compared, sizes.runs) * (len(watches_of(files.settings.reaction, case)) - 1)
    share = LEGS_SHARE if files.settings.reaction.cases[case].limbs else 1.0
    return share * walks * sizes.longest_s / usual_s


def watch_file(files: Files) -> Path:
    """Return the file of a robot's thresholds of limbs and of the feet's sensors."""
    return files.results / "reactions" / "thresholds.csv"


def reaction_file(files: Files, case: str) -> Path:
    """Return the file of a robot's trials of a case."""
    return files.results / "reactions" / f"{case}.csv"


def course_file(files: Files, case: str) -> Path:
    """Return the course of the first walk of a robot into the obstacle of a case, without its ending."""
    return files.results / "reactions" / case


def courses_of(files: Files, cases: Iterable[str]) -> Mapping[str, Path]:
    """Return the courses of the first robot in some cases."""
    first = next(first for first in files.owners if level_of_detectors(first))
    return {case: course_file(first, case) for case in cases}


def courses_of_robots(files: Files, cases: Iterable[str]) -> Reactions:
    """Return the courses of every robot in some cases."""
    courses: dict[str, dict[str, Path]] = {}
    for owner in files.owners:
        if level := level_of_detectors(owner):
            courses[level] = {case: course_file(owner, case) for case in cases}
    return courses


def all_reactions(files: Files) -> Reactions:
    """Return the files of the trials of every robot."""
    cases = files.settings.reaction.cases
    trials: dict[str, dict[str, Path]] = {}
    for owner in files.owners:
        if level := level_of_detectors(owner):
            trials[level] = {case: reaction_file(owner, case) for case in cases}
    return trials
