"""A line on the terminal that says that a command is at work while it prints nothing. Standard library only.

The line is written anew every second, and is gone before anything else is printed. Where standard error is no terminal,
as in a pipe, there is none. A job of the workflow, whose lines go to a file too, logs one now and then instead.
"""

import contextlib
import logging
import os
import sys
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Self, TextIO

QUIET_S = 2.0  # without a word, before the line comes
EVERY_S = 1.0
LOGGED_S = 8.0  # between the lines of a job
ERASE = "\r\x1b[K"  # to the start of the line, and clear it
WORKING = "working"


class Heartbeat:
    """The line, from a thread of its own: what is being done, and for how long."""

    def __init__(self, doing: Callable[[], str] = lambda: WORKING, stream: TextIO | None = None) -> None:
        """Take a function that returns what is being done now, and where the line is written (standard error)."""
        self._doing = doing
        self._stream = stream or sys.stderr
        self._begun = self._printed = time.monotonic()
        self._is_shown = False
        self._lock = threading.Lock()
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._beat, daemon=True)

    def __enter__(self) -> Self:
        """Begin, where there is a terminal."""
        if self._stream.isatty():
            self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        """End, and leave no line."""
        self._ended.set()
        if self._thread.is_alive():
            self._thread.join()
        self.erase()

    def erase(self) -> None:
        """Take the line away, as something else is printed now."""
        with self._lock:
            if self._is_shown:
                self._write(ERASE)
            self._is_shown = False
            self._printed = time.monotonic()

    def _beat(self) -> None:
        """Write the line every second until the end."""
        while not self._ended.wait(EVERY_S):
            with self._lock:
                now = time.monotonic()
                if now - self._printed >= QUIET_S:
                    seconds = f": {now - self._begun:.0f} s"
                    room = self._columns() - 1 - len(seconds)
                    self._write(f"{ERASE}{self._doing()[:room]}{seconds}")
                    self._is_shown = True

    def _columns(self) -> int:
        """Return the width of the terminal; one that tells none, as some do, has 80."""
        with contextlib.suppress(OSError):
            return os.get_terminal_size(self._stream.fileno()).columns or 80
        return 80

    def _write(self, text: str) -> None:
        """Write at once; a terminal that is closed stops no command."""
        with contextlib.suppress(OSError):
            self._stream.write(text)
            self._stream.flush()


@contextlib.contextmanager
def heartbeat(doing: Callable[[], str] = lambda: WORKING) -> Iterator[Heartbeat]:
    """Show a line of progress while a block runs; each line of the log erases it first, so that they do not mix."""
    with Heartbeat(doing) as line:

        def erase(record: logging.LogRecord) -> bool:
            del record
            line.erase()
            return True

        handlers = list(logging.getLogger().handlers)
        for handler in handlers:
            handler.addFilter(erase)
        try:
            yield line
        finally:
            for handler in handlers:
                handler.removeFilter(erase)


@contextlib.contextmanager
def telling(log: logging.Logger, doing: Callable[[], str]) -> Iterator[None]:
    """Log every few seconds meanwhile what is being done, and for how long."""
    begun = time.monotonic()
    ended = threading.Event()

    def tell() -> None:
        while not ended.wait(LOGGED_S):
            log.info("%s: %.0f s", doing(), time.monotonic() - begun)

    thread = threading.Thread(target=tell, daemon=True)
    thread.start()
    try:
        yield
    finally:
        ended.set()
        thread.join()


def last_line(path: Path, start: int = 0) -> str:
    """Return the last line that a program has written to a file behind its first `start` bytes, if any."""
    with path.open("rb") as file:
        file.seek(start)
        lines = file.read().decode(errors="replace").splitlines()
    return next((" ".join(line.split()) for line in reversed(lines) if line.strip()), "")
