"""The folder of the stored push: which files are in it, and from which files of a run they are made."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from experiments.plan.detection import detection_files
from experiments.plan.files import ARRAY, NOTE, Files
from mobnet.core.files import RUN, WEIGHTS

FOLDER = "demo"
SOURCES = "sources.json"  # what each of the other files is made from
RECORDING = "recording"
ROWS = ("collisions", "thresholds", "detected")  # files of detectors, of which rows are kept
ENDINGS = (ARRAY, NOTE)


def network_place(method: str, limb: str) -> str:
    """Return the folder of a network."""
    return f"networks/{method}-{limb}"


def fit_place(method: str) -> str:
    """Return the file of what a method was fitted to."""
    return f"fits/{method}.json"


def estimate_place(method: str) -> str:
    """Return a method's estimate without its ending."""
    return f"estimates/{method}"


def demo_needs(files: Files) -> Mapping[str, Any]:
    """Return what the stored push is made from: files of the first recording of its test, networks and fits."""
    settings = files.settings
    story = files.settings.evaluation.story
    walked = files.robots.get(story.level, files)
    layout = settings.layout
    copied = dict[str, Path]()
    limb = layout.limb_of[story.joint]
    runs = {method: walked.runs(story.scenario, story.level, [method])[0] for method in story.methods}
    for method in story.methods:
        source = walked.catalogue.network_source_of(method)
        if limb in walked.catalogue.method(source).limbs:
            folder = walked.network(source, limb, walked.network_seeds(source, limb)[0])
            copied |= {f"{network_place(source, limb)}/{name}": folder / name for name in (WEIGHTS, RUN)}
        copied |= {fit_place(walked.catalogue.source_of(method)): path for path in walked.fit(method)}
    return {
        "settings": story,
        "limb": limb,
        "pushes": settings.scenarios[story.scenario].pushes,
        "recording": runs[story.methods[0]].recording,
        "estimates": {method: run.estimate for method, run in runs.items()},
        "copied": copied,
        "detections": {name: path for name, path in detection_files(walked).items() if name in ROWS},
    }


def demo_outputs(needs: Mapping[str, Any]) -> list[str]:
    """Return the names of the files of the stored push, below its folder, `SOURCES` first."""
    arrays = [RECORDING, *map(estimate_place, needs["estimates"])]
    rows = [f"{name}.csv" for name in ROWS]
    return [SOURCES, *(f"{name}{ending}" for name in arrays for ending in ENDINGS), *rows, *needs["copied"]]
