"""What of the sections of tables and figures does not fit the rest of the configuration, kind by kind of section."""

from collections.abc import Iterator, Mapping

from experiments.settings.checks import figures, measures, pages, reaction_tables, tables
from experiments.settings.checks.results import Check, Results
from experiments.settings.products import items_of
from mobnet.formats.base import Section
from mobnet.formats.reading import Place, Problem

CHECKS: Mapping[type[Section], Check] = {
    **figures.CHECKS,
    **measures.CHECKS,
    **pages.CHECKS,
    **reaction_tables.CHECKS,
    **tables.CHECKS,
}


def product_problems(section: object, results: Results, place: Place) -> Iterator[Problem]:
    """Yield what does not fit in a section that stands at a place, and in those that stand in it."""
    # A section without a check of its own has that of the nearest class that it is made from.
    kind = next((kind for kind in type(section).__mro__ if kind in CHECKS), None)
    if kind is not None:
        yield from CHECKS[kind](section, results, place)
    for key, item in items_of(section).items():
        yield from product_problems(item, results, (*place, key))
