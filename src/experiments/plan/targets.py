"""What the words of a call name: the scale that they belong to, and the nearest target to one that is none."""

import difflib
import re
from collections.abc import Iterable, Sequence

from mobnet.core.errors import ConfigError

MAIN = "default"  # the scale whose tables stand where a reader looks for them; others have folders of their own


def scale_of(target: str) -> str | None:
    """Return the scale that the path of a target names, None where it is no path of a result."""
    found = re.match(r"(?:\./)*(?:results|tables|figures|paper)/(?:([^/]+)/)?", target)
    return (found[1] or MAIN) if found else None


def scale_of_targets(words: Iterable[str], given: object = None) -> str | None:
    """Return the scale to which the targets among the words of a call belong; None where they name none.

    Args:
        words: of the call.
        given: the scale that the call gives by its name.

    Raises:
        ConfigError: targets belong to several scales, or to another one than is given.
    """
    found = {scale: word for word in words if (scale := scale_of(word))}
    if given is not None:
        found.pop(str(given), None)
        for scale, word in found.items():
            raise ConfigError(f"{word}: is not made at scale={given}; accepted: --config scale={scale}")
        return str(given)
    if len(found) > 1:
        raise ConfigError(f"targets of the scales {', '.join(sorted(found))}: one scale can be made at a time")
    return next(iter(found), None)


def one_of(names: Iterable[str]) -> str:
    """Return the pattern of a wildcard that stands for some names; of no name where there is none."""
    return "|".join(map(re.escape, names)) or "(?!)"


def nearest(target: str, known: Sequence[str]) -> str:
    """Return the one line that says that a target is none, with the names nearest to it."""
    near = difflib.get_close_matches(target, known, 3)
    return f"{target}: is no target; " + (f"did you mean {', '.join(near)}?" if near else "--list says which there are")


def in_set(target: str, folder: str) -> str:
    """Return the one line that says that a target is a file of a set, which one job makes whole."""
    return f"{target}: is a file of a set; the target is its folder, {folder}"
