"""Which scale a file of the workflow belongs to. Standard library only: `./reproduce` asks it before anything else."""

import re
from collections.abc import Iterable

from mobnet.core.errors import ConfigError

MAIN = "default"  # the scale whose tables stand where a reader looks for them; others have folders of their own


def scale_of(target: str) -> str | None:
    """Return the scale that the path of a target names, None where it is no path of a result."""
    found = re.match(r"(?:\./)*(?:results|tables|figures|paper)/(?:([^/]+)/)?", target)
    return (found[1] or MAIN) if found else None


def check_scale(words: Iterable[str], scale: str) -> None:
    """Check that the targets among the words of a call belong to the scale that it makes.

    Raises:
        ConfigError: a target belongs to another scale.
    """
    other = next((word for word in words if scale_of(word) not in (None, scale)), None)
    if other is not None:
        raise ConfigError(f"{other}: is not made at scale={scale}; accepted: --config scale={scale_of(other)}")
