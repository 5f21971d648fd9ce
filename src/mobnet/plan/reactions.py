"""Walks into obstacles on which reactions are tried: what runs in them, and the files that say what comes of them."""

from collections.abc import Mapping
from pathlib import Path

from mobnet.plan.detection import level_of_detectors
from mobnet.plan.files import Files
from mobnet.settings.reaction import Watch

Reactions = Mapping[str, Mapping[str, Path]]  # level of a robot -> case -> file of its trials


def watches_of(files: Files, case: str) -> tuple[Watch, ...]:
    """Return our detector, then what a case compares with it."""
    reaction = files.settings.reaction
    return reaction.ours, *reaction.cases[case].compared


def methods_of(files: Files, case: str) -> tuple[str, ...]:
    """Return the methods that run in a case: that in the loop, and those of detectors."""
    reaction, detectors = files.settings.reaction, files.settings.detection.detectors
    names = [watch.detector for watch in watches_of(files, case)]
    return tuple(dict.fromkeys([reaction.estimator, *(detectors[name].method for name in names if name in detectors)]))


def walks_in(files: Files, case: str) -> int:
    """Return how many walks a robot makes of a case."""
    sizes = files.settings.sizes.reactions
    return sizes.runs + min(sizes.compared, sizes.runs) * (len(watches_of(files, case)) - 1)


def reaction_file(files: Files, case: str) -> Path:
    """Return the file of a robot's trials of a case."""
    return files.results / "reactions" / f"{case}.csv"


def course_file(files: Files, case: str) -> Path:
    """Return the course of the first walk of a robot into the obstacle of a case, without its ending."""
    return files.results / "reactions" / case


def all_courses(files: Files) -> Mapping[str, Path]:
    """Return the courses of the first robot, by case."""
    own = next(own for own in files.owners if level_of_detectors(own))
    return {case: course_file(own, case) for case in files.settings.reaction.cases}


def all_reactions(files: Files) -> Reactions:
    """Return the files of the trials of every robot."""
    cases = files.settings.reaction.cases
    levels = {level: own for own in files.owners if (level := level_of_detectors(own))}
    return {level: {case: reaction_file(own, case) for case in cases} for level, own in levels.items()}
