"""How a command that takes the caller's files ends: with lines, or with one line that says what is wrong."""

import logging
import signal
import sys
from collections.abc import Callable, Iterable

from mobnet.core.errors import MobnetError


def printed(log: logging.Logger, lines: Callable[[], Iterable[str]]) -> int:
    """Print what a command has to say once it is done; return its exit status, 1 where it was refused."""
    logging.basicConfig(level=logging.INFO, format="%(message)s", stream=sys.stdout)
    # A reader that has seen enough, such as `head`, ends the command without a traceback of Python's.
    before = signal.signal(signal.SIGPIPE, signal.SIG_DFL)
    try:
        for line in list(lines()):
            log.info("%s", line)
    except MobnetError as error:
        log.error("%s", error)
        return 1
    finally:
        signal.signal(signal.SIGPIPE, before)
    return 0
