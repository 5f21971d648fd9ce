"""What of the sections of reactions does not fit the rest of the configuration."""

from collections.abc import Iterator, Mapping

from experiments.settings.checks.results import Check, Results
from experiments.settings.reaction_tables import Figure22, Safety, Sensorless
from mobnet.formats.base import Section
from mobnet.formats.reading import Place, Problem


def safety_problems(section: Safety, results: Results, place: Place) -> Iterator[Problem]:
    """Yield cases in which nothing is pushed or stands in the way."""
    yield from results.not_cases((*place, "cases"), section.cases, pushed=True)
    yield from results.not_cases((*place, "stood_on"), section.stood_on, pushed=True)


def sensorless_problems(section: Sensorless, results: Results, place: Place) -> Iterator[Problem]:
    """Yield cases in which something is pushed or stands in the way."""
    yield from results.not_cases((*place, "cases"), section.cases, pushed=False)


def figure_22_problems(section: Figure22, results: Results, place: Place) -> Iterator[Problem]:
    """Yield cases in which nothing is pushed or stands in the way."""
    yield from results.not_cases((*place, "cases"), section.cases, pushed=True)


CHECKS: Mapping[type[Section], Check] = {
    Safety: safety_problems,
    Sensorless: sensorless_problems,
    Figure22: figure_22_problems,
}
