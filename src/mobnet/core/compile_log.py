"""Words on compiling: the first process that needs a function compiles it, which takes up to half a minute for a plant.

It says so every few seconds; processes that find the function in the cache say nothing.
"""

import logging
import threading
import time

from numba.core import event as events

TOLD_S = 5.0  # between two words on how far the compiler is
log = logging.getLogger(__name__)


class Compilations(events.Listener):
    """Logs that a process compiles: at its first compilation, then how many functions it has compiled, every while.

    Functions that a function calls are compiled within it; how many there will be is not known before.
    """

    def __init__(self) -> None:
        """Wait for the first."""
        self.count = 0
        self.took_s = 0.0  # of all that have ended, each with those within it
        self.begun_s: list[float] = []  # of those that are going on, the outermost first
        self.ended = threading.Event()

    def on_start(self, event: events.Event) -> None:
        """Say so at the first one; while any goes on, a thread says how far it is."""
        if not self.count and not self.begun_s:
            log.info("compiling code for this processor, which may take a minute, once")
        self.begun_s.append(time.monotonic())
        if len(self.begun_s) == 1:
            self.ended = threading.Event()
            threading.Thread(target=self.tell, args=[self.ended, self.begun_s[0]], daemon=True).start()

    def on_end(self, event: events.Event) -> None:
        """Count."""
        begun_s = self.begun_s.pop()
        self.count += 1
        if not self.begun_s:
            self.took_s += time.monotonic() - begun_s
            self.ended.set()

    def tell(self, ended: threading.Event, begun_s: float) -> None:
        """Say every while how far a compilation is, until it has ended."""
        while not ended.wait(TOLD_S):
            took_s = self.took_s + time.monotonic() - begun_s
            log.info("compiling code for this processor: %d functions in %.0f s so far", self.count, took_s)
