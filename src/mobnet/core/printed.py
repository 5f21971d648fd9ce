"""How a command that takes the caller's files ends: with lines, or with one line that says what is wrong."""

import logging
import signal
import sys
from collections.abc import Callable, Iterable
from pathlib import Path

from mobnet.core.errors import MobnetError
from mobnet.core.files import REFUSALS, refusal
from mobnet.core.heartbeat import heartbeat

STOPPED = "stopped; files that were there are whole, and the same command begins anew"
INTERRUPTED = 130  # exit status of a command that was stopped by Ctrl-C


def printed(log: logging.Logger, lines: Callable[[], Iterable[str]], stopped: str = STOPPED) -> int:
    """Print what a command has to say once it is done; return its exit status, 1 where it was refused.

    Until then a line on the terminal says that it is at work. Where Ctrl-C stops it, the line `stopped` says what is
    left of it.
    """
    logging.basicConfig(level=logging.INFO, format="%(message)s", stream=sys.stdout)
    # A reader that has seen enough, such as `head`, ends the command without a traceback of Python's.
    before = signal.signal(signal.SIGPIPE, signal.SIG_DFL)
    try:
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})  # `./reproduce` holds it back until it is answered
        with heartbeat():
            told = list(lines())
        for line in told:
            log.info("%s", shown(line))
    except MobnetError as error:
        log.error("%s", shown(str(error)))
    except MemoryError as error:
        log.error("out of memory: %s; accepted: a smaller file, or more memory", str(error) or "no room for more")
    except OSError as error:
        if error.errno not in REFUSALS or error.filename is None:
            raise
        log.error("%s", shown(refusal(error, Path(str(error.filename)))))
    except KeyboardInterrupt:
        log.error("%s", stopped)
        return INTERRUPTED
    else:
        return 0
    finally:
        signal.signal(signal.SIGPIPE, before)
    return 1


def shown(text: str) -> str:
    """Return a text whose control characters, which a name in a file may hold, are written as Python does."""
    return "".join(one if one.isprintable() or one == "\n" else repr(one)[1:-1] for one in text)
