"""Errors a user can act on: one line that names the bad value and what is accepted."""

from collections.abc import Iterable, Iterator, Sequence
from difflib import SequenceMatcher, get_close_matches
from itertools import islice
from reprlib import Repr

MOST = 20  # faults of a file that are told
LONGEST = 240  # characters of a value that are shown, and by which names are compared
NEAREST = 5  # names that are shown of many
FEW = 15  # names that are all shown
LOOKED = 1000  # names among which those like a wanted one are looked for
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
    """Return the house's one-line message for a value outside a closed set.

    Of many names it shows those that are most like the value, and says how many there are.
    """
    names = sorted(set(map(str, accepted)))
    shown = SHOWN.repr(value)
    shown = shown if len(shown) <= LONGEST else f"{shown[:LONGEST]}..."
    return f"{what}: {shown} is not accepted; accepted: {nearest_of(names, str(value))}"


def nearest_of(names: Sequence[str], wanted: str) -> str:
    """Return names as one text, the most like a wanted one first; of many the nearest, and how many there are."""
    if len(names) <= FEW:
        first = get_close_matches(wanted[:LONGEST], names, 1)
        return ", ".join(dict.fromkeys([*first, *names])) or "none"
    return f"{', '.join(near_names(names, wanted))} (the nearest of {len(names)})"


def near_names(names: Iterable[str], wanted: str, most: int = NEAREST) -> Sequence[str]:
    """Return the few names that are most like a wanted one, the most alike first.

    A path counts by itself and by the name of its file, without folder and ending.
    """
    matcher = SequenceMatcher(b=wanted[:LONGEST].lower(), autojunk=False)

    def alike(name: str) -> float:
        last_part = name.rpartition("/")[2].partition(".")[0] if "/" in name else name
        ratios: list[float] = []
        for form in {name, last_part}:
            matcher.set_seq1(form[:LONGEST].lower())
            ratios.append(matcher.ratio())
        return max(ratios)

    return sorted(islice(names, LOOKED), key=alike, reverse=True)[:most]


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
