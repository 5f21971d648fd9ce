"""The modules of measures by the names of their sections, and what entries of `measures` give them as numbers."""

import importlib
from collections.abc import Iterator
from types import ModuleType

from pydantic import ValidationError

from experiments.settings.measures import Measure
from experiments.settings.metrics import SECTIONS
from experiments.settings.settings import Settings
from mobnet.core.errors import not_accepted
from mobnet.settings.base import Section
from mobnet.settings.faults import problems
from mobnet.settings.reading import Place

ESTIMATES = "experiments.evaluation.measure.estimates"


def module_of(name: str) -> ModuleType:
    """Return the module that measures what a section asks for."""
    return importlib.import_module(f"{ESTIMATES}.{name}")


def numbers_of(name: str, section: Section) -> Section:
    """Return a section as its module takes it: of an entry of `measures`, the module's section `Options`."""
    return module_of(name).Options.model_validate(section.options) if isinstance(section, Measure) else section


def measure_problems(settings: Settings) -> Iterator[tuple[Place, str]]:
    """Yield the place and the text of every entry of `measures` that names no module, or numbers that it refuses."""
    for name, measure in settings.evaluation.measures.items():
        place: Place = ("evaluation", "measures", name)
        if name not in SECTIONS:
            yield place, not_accepted("module of measures", name, SECTIONS)
            continue
        try:
            numbers_of(name, measure)
        except ValidationError as error:
            found = problems(error, module_of(name).Options, measure.options)
            yield from (((*place, "options", *inner), text) for inner, text in found)
