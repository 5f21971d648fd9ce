"""How a command that takes the caller's files ends: with lines, or with one line that says what is wrong."""

import atexit
import errno
import io
import logging
import os
import signal
import sys
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TextIO

from mobnet.core.errors import MobnetError
from mobnet.core.files import REFUSALS, refusal
from mobnet.core.heartbeat import heartbeat

STOPPED = "stopped; files that were there are whole, and the same command begins anew"
INTERRUPTED = 130  # exit status of a command that was stopped by Ctrl-C


class Output(logging.StreamHandler[TextIO]):
    """Standard output, to which a command logs; where it is full, one line says so, and the work goes on without it."""

    def __init__(self) -> None:
        """Take standard output as it is now."""
        super().__init__(sys.stdout)
        self.is_cut = False

    def handleError(self, record: logging.LogRecord) -> None:
        """Take that a line could not be written."""
        error = sys.exc_info()[1]
        if not isinstance(error, OSError):
            super().handleError(record)
            return
        self.is_cut = True
        tell_cut(error)


def to_output() -> Output:
    """Let all that is logged go to standard output, a line each; return what tells whether it was whole."""
    output = Output()
    logging.basicConfig(level=logging.INFO, format="%(message)s", handlers=[output])
    return output


def watch_output() -> None:
    """Let a program end with one line, and not well, where standard output is full: Python would say nothing, or two.

    The parser of words takes no notice of what it cannot print.
    """
    if type(sys.stdout) is io.TextIOWrapper and sys.stdout.write_through:
        # PYTHONUNBUFFERED: what could not be written would be gone, and with it the error.
        encoding, errors = sys.stdout.encoding, sys.stdout.errors
        sys.stdout = os.fdopen(sys.stdout.fileno(), "w", encoding=encoding, errors=errors, closefd=False)
    atexit.register(flush_output)


def flush_output() -> None:
    """Write what is left for standard output; end the process where that cannot be."""
    try:
        sys.stdout.flush()
    except OSError as error:
        tell_cut(error)
        os._exit(1)  # an exception would be printed and forgotten here


def end_where_full(handlers: Iterable[logging.Handler]) -> None:
    """Let handlers of others end the process where they cannot write, instead of a traceback for each line."""
    for handler in handlers:
        handler.handleError = lambda _: end_cut()


def end_cut() -> None:
    """End the process, as what it is for cannot be written."""
    error = sys.exc_info()[1]
    tell_cut(error if isinstance(error, OSError) else OSError(errno.EIO, str(error)))
    os._exit(1)


def tell_cut(error: OSError) -> None:
    """Say that standard output takes no more, and let nothing else be written to it; who reads a pipe knows it."""
    if error.errno != errno.EPIPE:
        sys.stderr.write(f"standard output: cannot be written: {error.strerror}; what was to be printed is lost\n")
    nothing = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nothing, sys.stdout.fileno())
    os.close(nothing)


def printed(log: logging.Logger, lines: Callable[[], Iterable[str]], stopped: str = STOPPED) -> int:
    """Print what a command has to say once it is done; return its exit status, 1 where it was refused.

    Until then a line on the terminal says that it is at work. Where Ctrl-C stops it, the line `stopped` says what is
    left of it.
    """
    output = to_output()
    # A reader that has seen enough, such as `head`, ends the command without a traceback of Python's.
    before = signal.signal(signal.SIGPIPE, signal.SIG_DFL)
    try:
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})  # `./reproduce` holds it back until it is answered
        with heartbeat():
            output_lines = list(lines())
        for line in output_lines:
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
        return 1 if output.is_cut else 0
    finally:
        signal.signal(signal.SIGPIPE, before)
    return 1


def shown(text: str) -> str:
    """Return a text whose control characters, which a name in a file may hold, are written as Python does."""
    return "".join(
        character if character.isprintable() or character == "\n" else repr(character)[1:-1] for character in text
    )
