"""Errors a user can act on: one line that names the bad value and what is accepted."""

from collections.abc import Collection, Iterable, Iterator
from difflib import get_close_matches
from reprlib import Repr

MOST = 20  # faults of a file that are told
LONGEST = 240  # characters of a value that are shown
SHOWN = Repr()  # a value takes a part of a line, whatever it is
SHOWN.maxstring = SHOWN.maxother = 120
SHOWN.maxlist = SHOWN.maxtuple = SHOWN.maxdict = 12


class MobnetError(Exception):
    """Root of every error this package raises on purpose."""


class ConfigError(MobnetError):
    """A key or a value of the configuration is not accepted."""


class CommandError(MobnetError):
    """A command of ./reproduce cannot be done on this machine, or in this folder."""


class DataError(MobnetError):
    """A recording or a result file is missing, damaged or incomplete."""


class TrainingError(MobnetError):
    """Training diverged or met numbers that are not finite."""


class SimulationError(MobnetError):
    """The plant could not be simulated as asked."""


class DrawingError(MobnetError):
    """The machine lacks what drawing needs."""


def not_accepted(what: str, value: object, accepted: Iterable[object]) -> str:
    """Return the house's one-line message for a value outside a closed set; what it was meant to be comes first."""
    names = sorted(set(map(str, accepted)))
    ordered = dict.fromkeys([*get_close_matches(str(value), names, n=1), *names])
    shown = SHOWN.repr(value)
    shown = shown if len(shown) <= LONGEST else f"{shown[:LONGEST]}..."
    return f"{what}: {shown} is not accepted; accepted: {', '.join(ordered) or 'none'}"


def unknown_command(name: str, commands: Collection[str]) -> str:
    """Return the message about a command that there is not, with the one that was probably meant."""
    near = get_close_matches(name, commands, 1)
    hint = f"; did you mean {near[0]}?" if near else ""
    return not_accepted("command", name, commands) + hint


def beyond(what: str, value: float, bounds: tuple[float, float]) -> Iterator[str]:
    """Yield the message about a number outside of its bounds, if it is."""
    low, high = bounds
    if not low <= value <= high:
        yield not_accepted(what, value, [f"a number from {low:g} to {high:g}"])


def misfit(value: object, accepted: object) -> str:
    """Return the message about a value that does not fit others, and what would."""
    return f"{value} is not accepted; accepted: {accepted}"


def refusal(path: object, faults: Iterable[str]) -> DataError:
    """Return the error that tells the faults of a file, one line for each, of which only the first are told."""
    return _error_of([f"{path}: {fault}" for fault in faults])


def refuse(path: object, faults: Iterable[str]) -> None:
    """Raise a DataError with one line for each fault of a file, if there are any."""
    refuse_lines(f"{path}: {fault}" for fault in faults)


def refuse_lines(faults: Iterable[str]) -> None:
    """Raise a DataError with these lines, of which only the first are told, if there are any."""
    lines = list(dict.fromkeys(faults))
    if lines:
        raise _error_of(lines)


def _error_of(lines: list[str]) -> DataError:
    """Return an error of some lines, of which only the first are told."""
    if len(lines) > MOST:
        lines = [*lines[:MOST], f"{lines[0].partition(': ')[0]}: {len(lines) - MOST} further faults"]
    return DataError("\n".join(" ".join(line.split()) for line in lines))  # a name in a file may hold a line break
