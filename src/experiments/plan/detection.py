"""Walks on which detectors of collisions are tried, and the files that say what they find."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from experiments.plan.files import Files
from experiments.records.collisions import FILES
from mobnet.settings.data import Push
from mobnet.settings.detection import Detection

Detections = Mapping[str, Mapping[str, Path]]  # level of the plant or of a robot -> name of a file -> its path


@dataclass(frozen=True)
class Walk:
    """Recordings of a scenario, with their residuals and, by method, estimates, in the same order; and its pushes."""

    recordings: tuple[Path, ...]
    residuals: tuple[Path, ...]
    estimates: Mapping[str, tuple[Path, ...]]
    pushes: Mapping[str, Push]


def level_of_detectors(files: Files) -> str:
    """Return the level at which the detectors of a robot, or of the plant of section 5.1, are tried; else nothing."""
    settings = files.settings
    levels = settings.detection.levels if files.is_whole else ()
    first = next((level for level in levels if files.has(level)), "")
    return settings.fleet.level_of(files.robot, first) if first and files.robot else first


def numbers_of(files: Files) -> Detection:
    """Return the section of detectors with the numbers of the chosen scale."""
    detection = files.settings.detection
    least = files.settings.sizes.least_swings
    if least is None:
        return detection
    return detection.model_copy(update={"thresholds": detection.thresholds.model_copy(update={"least_swings": least})})


def walks_of(files: Files) -> dict[str, Walk]:
    """Return the walks of the detectors of a robot, or of the plant, by scenario."""
    settings = files.settings
    level = level_of_detectors(files)
    detection = settings.detection
    # All detectors have one gate, whose method tells of an early contact even where no detector watches it.
    methods = dict.fromkeys([detection.gate.method, *(row.method for row in detection.detectors.values())])
    walks: dict[str, Walk] = {}
    for scenario in settings.detection_walks:
        estimates: dict[str, tuple[Path, ...]] = {}
        for method in methods:
            if method in files.catalogue.tests[scenario][level]:
                estimates[method] = tuple(run.estimate for run in files.runs(scenario, level, [method]))
        walks[scenario] = Walk(
            files.tests(scenario, level),
            files.tests(scenario, level, "residuals"),
            estimates,
            {name: settings.pushes[name] for name in settings.scenarios[scenario].pushes},
        )
    return walks


def detection_files(files: Files) -> dict[str, Path]:
    """Return the files of the detectors of a robot, or of the plant, by name."""
    return {name: files.results / "detection" / f"{name}.csv" for name in FILES}


def all_detections(files: Files) -> Detections:
    """Return the files of all detectors: those of the plant first, then those of each robot of the fleet."""
    return {level: detection_files(owner) for owner in files.owners if (level := level_of_detectors(owner))}
