"""What Ctrl-C and the signal to terminate do to a run of the workflow: its jobs end, and the last line is ours.

While jobs run, the run is left to Snakemake, whose own answer to the signal to terminate is to begin no further job: it
removes what the ended jobs had not finished and gives its lock back. Before that, and where a queue holds the jobs, an
exception makes it clean up. In both cases nothing is printed any more, and the exit status says which signal it was.
"""

import atexit
import contextlib
import os
import signal
import threading
from collections.abc import Callable
from typing import Any

from experiments.running.processes import end_jobs
from experiments.running.terminal import SHOWN_BY

AGAIN_S = 5  # after which an exception was lost on its way, as Python ignores those in calls from C
TOLD_S = 5.0  # that the line may take
GO_ON = "the same command goes on from here"


class Interrupts:
    """Answers the signals from now on.

    Attributes:
        status: exit status of the run once it was stopped; 0 until then.
    """

    def __init__(self) -> None:
        """Answer."""
        self.status = 0
        self._teller = threading.Thread(target=self._tell, daemon=True)
        self._begin_no_job: Callable[..., Any] | None = None  # Snakemake's own answer, while its local jobs run
        self._is_in_queue = False
        atexit.register(self._exit)
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGALRM):
            signal.signal(number, self._answer)
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})  # `./reproduce` holds it back until here

    def jobs_begin(self, *, are_local: bool) -> None:
        """Take that jobs will run, here or in the queue of a cluster."""
        snakemakes = signal.signal(signal.SIGTERM, self._answer)
        self._begin_no_job = snakemakes if are_local and callable(snakemakes) else None
        self._is_in_queue = not are_local

    def jobs_ended(self) -> None:
        """Take that no job runs any more."""
        self._begin_no_job = None
        self._is_in_queue = False

    def _answer(self, number: int, frame: object) -> None:
        """Answer a signal; those after the first one tell the jobs again."""
        if not self.status:
            self.status = 128 + number
            self._teller.start()  # this thread may be writing to the same stream
            self._teller.join(TOLD_S)
        if not self._is_in_queue:
            # This thread may hold the lock that Snakemake's answer waits for.
            threading.Thread(target=self._end_jobs, daemon=True).start()
        if self._begin_no_job is not None:
            return
        if not self._is_in_queue:
            signal.alarm(AGAIN_S)
        raise SystemExit(self.status)

    def _end_jobs(self) -> None:
        """End the jobs of this machine, after which Snakemake would begin others."""
        if self._begin_no_job is not None:
            self._begin_no_job()
        end_jobs()

    def _tell(self) -> None:
        """Print the last line: what is printed by this process after it goes nowhere."""
        parts = ["stopped", *[handler.stop() for handler in SHOWN_BY], GO_ON]
        line = f"{'; '.join(filter(None, parts))}\n"
        with contextlib.suppress(OSError):
            os.write(2, line.encode())  # the thread that was interrupted may hold the lock of Python's own streams
        nowhere = os.open(os.devnull, os.O_WRONLY)
        for stream in (1, 2):
            os.dup2(nowhere, stream)

    def _exit(self) -> None:
        """Leave a run that was stopped with its status: Snakemake knows success and failure alone."""
        if self.status:
            self._teller.join(TOLD_S)
            os._exit(self.status)
