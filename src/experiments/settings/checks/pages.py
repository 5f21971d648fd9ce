"""What of the sections of pages and films does not fit the rest of the configuration."""

from collections.abc import Iterator, Mapping
from itertools import chain

from experiments.settings.checks.results import Check, Results
from experiments.settings.pages import ExploreScene, ExploreStory
from mobnet.core.errors import misfit
from mobnet.formats.base import Section
from mobnet.formats.reading import Place, Problem


def explore_story_problems(section: ExploreStory, results: Results, place: Place) -> Iterator[Problem]:
    """Yield methods without that of the gate, which the page draws."""
    methods = (*results.settings.evaluation.story.methods, *section.further)
    yield from results.not_gated((*place, "methods"), methods)


def explore_scene_problems(section: ExploreScene, results: Results, place: Place) -> Iterator[Problem]:
    """Yield a joint that the scene does not show pushed, and methods without that of the gate."""
    joints = chain.from_iterable(map(results.joints, section.limbs))
    if section.joint not in joints or section.joint not in results.pushed_joints(section.scenario):
        text = misfit(section.joint, f"a joint of {', '.join(section.limbs)} that its push turns")
        yield (*place, "joint"), text
    yield from results.not_gated((*place, "methods"), section.methods, section.gate)


CHECKS: Mapping[type[Section], Check] = {
    ExploreStory: explore_story_problems,
    ExploreScene: explore_scene_problems,
}
