"""What must hold for the push of demo, film and explorer: a robot of every scale feels it by methods of detectors."""

from collections.abc import Iterator

from experiments.settings.checks.results import Results
from mobnet.core.errors import misfit, not_accepted
from mobnet.settings.checks.limits import below
from mobnet.settings.reading import Place, Problem

ROOT: Place = ("evaluation", "story")


def story_problems(results: Results) -> Iterator[Problem]:
    """Yield a test, push, joint, method or detector of the story that the results do not have."""
    settings = results.settings
    story = results.settings.evaluation.story
    detection = results.settings.detection
    if story.scenario != detection.collisions:
        yield (*ROOT, "scenario"), misfit(story.scenario, f"{detection.collisions}, that of detection.collisions")
        return
    if story.push not in (pushes := settings.scenarios[story.scenario].pushes):
        yield (*ROOT, "push"), not_accepted(f"push of {story.scenario}", story.push, pushes)
        return
    if story.level not in (first := settings.fleet.robots[:1]):  # later robots are not there at every scale
        yield (*ROOT, "level"), not_accepted("first robot of the fleet", story.level, first)
    watched = results.layout.limbs(detection.legs)
    turned = [joint for joint in results.turned_joints(story.push) if joint in watched]
    if story.joint not in turned:
        yield (*ROOT, "joint"), not_accepted(f"joint that {story.push} turns", story.joint, turned)
    yield from below((*ROOT, "settle_s"), story.settle_s, story.before_s, "before_s")
    yield from _method_problems(results)


def _method_problems(results: Results) -> Iterator[Problem]:
    """Yield methods that do not run in the test, and a detector that needs others, or more than thresholds."""
    story = results.settings.evaluation.story
    detection = results.settings.detection
    known = {row.method for row in detection.detectors.values()}
    for k, method in enumerate(story.methods):
        if method not in known:
            yield (*ROOT, "methods", k), not_accepted("method of a detector", method, known)
    row = detection.detectors[story.detector]
    for name in (row.method, detection.gate.method):
        if name not in story.methods:
            text = misfit(story.detector, f"a detector that needs no method but {', '.join(story.methods)}, not {name}")
            yield (*ROOT, "detector"), text
    if row.norm or row.commanded:
        text = misfit(story.detector, "a detector without `norm` and `commanded`, whose thresholds alone are stored")
        yield (*ROOT, "detector"), text
