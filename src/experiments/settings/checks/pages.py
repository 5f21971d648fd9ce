"""What must hold for the page of pushes: what scenes show is there, and sliders begin between their ends."""

from collections.abc import Iterator
from itertools import chain

from experiments.settings.checks.results import Results
from mobnet.core.errors import misfit
from mobnet.settings.checks.limits import within
from mobnet.settings.reading import Place, Problem

ROOT: Place = ("evaluation",)


def page_problems(results: Results) -> Iterator[Problem]:
    """Yield joints and methods that a scene does not have, and numbers beyond a slider."""
    settings = results.settings
    story = results.settings.evaluation.story
    page = results.settings.evaluation.explore
    gate = settings.detection.gate.method
    methods = {"story": (*story.methods, *page.story.further)}
    places: dict[str, Place] = {"story": (*ROOT, "explore", "story")}
    for name, scene in page.scenes.items():
        place = places[name] = (*ROOT, "explore", "scenes", name)
        joints = list(chain.from_iterable(map(results.joints, scene.limbs)))
        pushed = results.pushed_joints(scene.scenario)
        if scene.joint not in joints or scene.joint not in pushed:
            yield (*place, "joint"), misfit(scene.joint, f"a joint of {', '.join(scene.limbs)} that its push turns")
        methods[name] = scene.methods
    for name, place in places.items():
        scene = page.story if name == "story" else page.scenes[name]
        yield from within((*place, "threshold_nm"), scene.threshold_nm, page.thresholds_nm, "thresholds_nm")
        if gate not in methods[name]:
            yield (*place, "methods"), misfit(", ".join(methods[name]), f"methods with {gate}, that of the gate")
    gain_hz = settings.observer.gain_hz
    yield from within((*ROOT, "explore", "gains_hz"), gain_hz, page.gains_hz, "gains_hz: that of the observer")
