"""What the page on which a reader plays with pushes is made from."""

from experiments.plan.detection import detection_files
from experiments.plan.files import Files
from experiments.plan.scenes import PageScene
from experiments.settings.runs import Runs
from mobnet.settings.data import Push


def explore_needs(files: Files) -> dict[str, object]:
    """Return the scenes of the page by name, that of the story first, and what its detector said of the collisions."""
    evaluation = files.settings.evaluation
    story = evaluation.story
    page = evaluation.explore
    methods = (*story.methods, *page.story.further)
    runs = files.first_runs(Runs(scenario=story.scenario, level=story.level, methods=methods))
    limb = files.settings.layout.limb_of[story.joint]
    told = page.story
    pushes = _pushes(files, story.scenario)
    first = PageScene(told.push, told.plant, runs, (limb,), story.joint, told.threshold_nm, pushes, story.push)
    scenes = {"story": first}
    for name, row in page.scenes.items():
        scenes[name] = PageScene(
            row.push, row.plant, files.first_runs(row), row.limbs, row.joint, row.threshold_nm,
            _pushes(files, row.scenario), from_s=row.from_s,
        )  # fmt: skip
    found = detection_files(files.robots.get(story.level, files))
    return {
        "scenes": scenes, "story": story, "peaks": evaluation.peaks,
        "collisions": found["collisions"], "detected": found["detected"],
    }  # fmt: skip


def _pushes(files: Files, scenario: str) -> dict[str, Push]:
    """Return the pushes of a scenario by name, in their order."""
    return {name: files.settings.pushes[name] for name in files.settings.scenarios[scenario].pushes}
