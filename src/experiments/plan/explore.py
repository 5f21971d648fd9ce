"""The page on which a reader plays with pushes: its scenes, and from which files of a run they are made."""

from experiments.plan.detection import detection_files
from experiments.plan.files import Files
from experiments.plan.items.detectors import pushes_of
from experiments.plan.parts import PageScene
from experiments.settings.runs import Runs


def explore_needs(files: Files) -> dict[str, object]:
    """Return the scenes of the page by name, that of the story first, and what its detector said of the collisions."""
    evaluation = files.settings.evaluation
    story = evaluation.story
    page = evaluation.explore
    methods = (*story.methods, *page.story.further)
    runs = files.first_runs(Runs(scenario=story.scenario, level=story.level, methods=methods))
    limb = files.settings.layout.limb_of[story.joint]
    first_row = page.story
    pushes = pushes_of(files, story.scenario)
    gate = files.settings.detection.gate.method
    first = PageScene(
        first_row.push,
        first_row.plant,
        runs,
        (limb,),
        story.joint,
        first_row.threshold_nm,
        gate,
        pushes,
        story.push,
    )
    scenes = {"story": first}
    for name, row in page.scenes.items():
        scenes[name] = PageScene(
            row.push, row.plant, files.first_runs(row), row.limbs, row.joint, row.threshold_nm,
            row.gate or gate, pushes_of(files, row.scenario), from_s=row.from_s,
        )  # fmt: skip
    detectors = detection_files(files.robots.get(story.level, files))
    return {
        "scenes": scenes,
        "story": story,
        "collisions": detectors["collisions"],
        "detected": detectors["detected"],
    }
