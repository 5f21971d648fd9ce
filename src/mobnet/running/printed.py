"""How a command that takes the caller's files ends: with lines, or with one line that says what is wrong."""

import logging
import sys
from collections.abc import Callable, Iterable

from mobnet.core.errors import MobnetError


def printed(log: logging.Logger, lines: Callable[[], Iterable[str]]) -> int:
    """Print what a command has to say once it is done; return its exit status, 1 where it was refused."""
    logging.basicConfig(level=logging.INFO, format="%(message)s", stream=sys.stdout)
    try:
        found = list(lines())
    except MobnetError as error:
        log.error("%s", error)
        return 1
    for line in found:
        log.info("%s", line)
    return 0
