"""One number against the limit that others set: nothing, or its place and what would be accepted."""

from collections.abc import Iterator

from mobnet.core.errors import misfit
from mobnet.settings.reading import Place, Problem


def at_most(place: Place, value: float, most: float, what: str) -> Iterator[Problem]:
    """Yield a value above the most that is accepted."""
    if value > most:
        yield place, misfit(value, f"at most {most:g}, {what}")


def below(place: Place, value: float, end: float, what: str) -> Iterator[Problem]:
    """Yield a value that is not below a limit."""
    if value >= end:
        yield place, misfit(value, f"below {end:g}, {what}")


def at_least(place: Place, value: float, least: float, what: str) -> Iterator[Problem]:
    """Yield a value below the least that is accepted."""
    if value < least:
        yield place, misfit(value, f"at least {least:g}, {what}")


def within(place: Place, value: float, ends: tuple[float, float], what: str) -> Iterator[Problem]:
    """Yield a value outside of a range, whose ends are accepted."""
    if not ends[0] <= value <= ends[1]:
        yield place, misfit(value, f"{ends[0]:g} to {ends[1]:g}, {what}")


def as_many(place: Place, count: int, wanted: int, what: str) -> Iterator[Problem]:
    """Yield a list of numbers that has another length than what it belongs to."""
    if count != wanted:
        yield place, misfit(f"{count} numbers", f"{wanted}, {what}")
