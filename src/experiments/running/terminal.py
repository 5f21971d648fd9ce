"""What a run shows: Snakemake's plug-in `--logger mobnet`, which every run in this folder uses (`profiles/default`).

On a terminal one line for each running job and one for the whole run, in place; elsewhere a line at the start and at
the end of each job. Errors and warnings stay, and what Snakemake says where there is nothing to run; its complete log
is in `.snakemake/log`, that of each job in `results/<scale>/logs`. What a dry run prints, or a run that was asked for
details, is left to Snakemake.
"""

import logging
import os
import re
import select
import sys
import threading
import time
from typing import Any

from snakemake_interface_logger_plugins.base import LogHandlerBase
from snakemake_interface_logger_plugins.common import LogEvent

from experiments.running.progress import Job, RunState, in_time, in_words

SAID_BY_JOB = "returned non-zero exit status 1."  # Python's words; a job that was killed has said nothing itself
SHOWN_S = 0.25  # between two pictures of the terminal
CLOSED_S = 1.0  # that the last one may take
COLUMNS, ROWS = 80, 24  # of a terminal that does not tell them
ROWS_BESIDE = 4  # which show no jobs
BAR = 20  # columns
NAME = 16  # columns, at least
PERCENT = 100.0


class RunHandler(LogHandlerBase):
    """Shows what Snakemake says of a run, and what its jobs say in their logs."""

    def __post_init__(self) -> None:
        """Open the screen at once: reading the workflow takes seconds."""
        asked = self.common_settings
        quiet = [word.name.lower() for word in asked.quiet or ()]
        details = asked.dryrun or asked.verbose or asked.printshellcmds or asked.debug_dag
        self._shows = not (details or "all" in quiet or "progress" in quiet)
        self._said: list[str] | None = []  # by Snakemake, until it is known that there are jobs to run
        self.course = RunState()
        self._begun: set[int] = set()  # numbers of jobs
        is_terminal = sys.stderr.isatty() and os.environ.get("TERM", "dumb") != "dumb"
        self._screen = Screen(self.course) if self._shows and is_terminal else None
        SHOWN_BY.append(self)

    @property
    def writes_to_stream(self) -> bool:
        """Whether it writes to the terminal, in place of Snakemake's own handler."""
        return self._shows

    @property
    def writes_to_file(self) -> bool:
        """Whether it writes to a file: Snakemake's log has all."""
        return False

    @property
    def has_filter(self) -> bool:
        """Whether it chooses itself."""
        return True

    @property
    def has_formatter(self) -> bool:
        """Whether it has words of its own."""
        return True

    @property
    def needs_rulegraph(self) -> bool:
        """Whether it draws the rules."""
        return False

    def expect(self, prices: dict[int, float], waiting: int, made: int) -> None:
        """Take what each job that will run is to take [s], how many these are, and how many are made already."""
        self.course.expect(prices)
        already = f"; {made} {'is' if made == 1 else 'are'} made already" if made else ""
        say(f"{waiting} of {counted(waiting + made)}{already}" if made else counted(waiting))

    def stop(self) -> str:
        """Show nothing any more, as somebody has stopped the run; return how far it is."""
        self._shows = False
        self.close()
        done, total = self.course.done, self.course.total
        return f"{done} of {total} jobs are made" if total else ""

    def emit(self, record: logging.LogRecord) -> None:
        """Show a record of Snakemake."""
        try:
            if self._shows:
                self._show(record, getattr(record, "event", None), record.__dict__)
        except Exception:  # noqa: BLE001 a fault of what is shown ends no run
            self.handleError(record)

    def _show(self, record: logging.LogRecord, event: LogEvent | None, record_fields: dict[str, Any]) -> None:
        """Show what a record tells."""
        if event == LogEvent.RESOURCES_INFO:
            self._said = None
            self.course.slots = max(1, int(record_fields.get("cores", self.course.slots)))
        elif event == LogEvent.RUN_INFO:
            self.course.total = int(record_fields["stats"]["total"])
        elif event == LogEvent.JOB_INFO:
            number = int(record_fields["jobid"])
            again = " again" if number in self._begun else ""  # a queue lost it, or gave it too little
            self._begun.add(number)
            job = self.course.begin(
                number, named(record_fields), next(iter(record_fields["log"]), None), record.created
            )
            self._tell(f"begins{again}: {job.name}")
        elif event == LogEvent.JOB_FINISHED:
            job = self.course.end(int(record_fields["job_id"]), record.created)
            self._tell(f"done: {job.name}, {in_time(record.created - job.began_s)} ({how_far(self.course)})")
        elif event == LogEvent.JOB_ERROR:
            self.course.running.pop(int(record_fields["jobid"]), None)
            if not record_fields.get("indent"):  # in a group that failed
                say(f"failed: {named(record_fields)} (log: {', '.join(record_fields['log']) or 'none'})")
        elif event == LogEvent.GROUP_ERROR:
            say(f"failed: jobs that went into the queue together (log: {', '.join(record_fields['aux_logs'])})")
        elif event in (None, LogEvent.ERROR) and not record.getMessage().rstrip().endswith(SAID_BY_JOB):
            if record.levelno >= logging.WARNING:
                write(record.getMessage())
            elif self._said is not None:
                self._said.append(record.getMessage())

    def _tell(self, text: str) -> None:
        """Print a line where no terminal shows it in place."""
        if self._screen is None:
            say(text)

    def close(self) -> None:
        """Give the terminal back, and print what Snakemake said where there was nothing to run."""
        if self._screen is not None:
            self._screen.close()
            self._screen = None
        if self._shows and self._said:
            write("\n".join(self._said))
            self._said = None
        super().close()


SHOWN_BY: list[RunHandler] = []  # what shows the run of this process: nothing, or one


class Screen:
    """Lines in place, below all that is printed meanwhile.

    What this process and its jobs print goes through a pipe, so that it stands above these lines and never in them. A
    run that is killed outright leaves a terminal as it should be: the cursor is never hidden.
    """

    def __init__(self, course: RunState) -> None:
        """Take over the streams of this process that are the terminal."""
        self._course = course
        self._kept = {number: os.dup(number) for number in (1, 2) if os.isatty(number)}
        self._is_closed = threading.Event()
        reading, writing = os.pipe()
        for number in self._kept:
            os.dup2(writing, number)
        os.close(writing)
        self._thread = threading.Thread(target=self._show, args=[reading, os.dup(self._kept[2])], daemon=True)
        self._thread.start()

    def _show(self, reading: int, terminal: int) -> None:
        """Print what comes, and the lines in place anew, until they are closed and all is printed."""
        text, erase = b"", b""
        with os.fdopen(terminal, "wb") as out:
            while True:
                is_last = self._is_closed.is_set()
                is_there, _, _ = select.select([reading], [], [], 0.0 if is_last else SHOWN_S)
                new = os.read(reading, 1 << 16) if is_there else b""
                whole, end, text = (text + new).rpartition(b"\n")
                out.write(erase + whole + end)
                if is_last and not new:
                    break
                lines = drawn(self._course, time.time(), os.get_terminal_size(terminal))
                out.write("".join(f"{line}\n" for line in lines).encode())
                out.flush()
                erase = f"\x1b[{len(lines)}F\x1b[J".encode()  # up to the first of them, and clear what follows
            out.write(text)

    def close(self) -> None:
        """Give the streams back, and remove the lines when all is printed."""
        sys.stdout.flush()
        sys.stderr.flush()
        for number, kept in self._kept.items():
            os.dup2(kept, number)
            os.close(kept)
        self._is_closed.set()
        self._thread.join(CLOSED_S)


def write(text: str) -> None:
    """Print at once; in a run with lines in place it goes the way of all that jobs print."""
    sys.stderr.write(f"{text}\n")
    sys.stderr.flush()


def say(text: str) -> None:
    """Print one line with the time."""
    write(f"{time.strftime('%H:%M:%S')} {text}")


def named(record_fields: dict[str, Any]) -> str:
    """Return the name of a job of which a record tells."""
    return in_words(record_fields["rule_name"], next(iter(record_fields["log"]), None))


def counted(jobs: int) -> str:
    """Return a number of jobs in words."""
    return f"{jobs} job" if jobs == 1 else f"{jobs} jobs"


def how_far(course: RunState) -> str:
    """Return how far a run is where a job has ended."""
    text = f"{course.done} of {counted(course.total)}, {PERCENT * course.share:.0f} %"
    left_s = course.left_s(time.time())
    return text if left_s is None or course.done == course.total else f"{text}, {in_time(left_s)} left"


def drawn(course: RunState, now_s: float, size: os.terminal_size) -> list[str]:
    """Return the lines of the first running jobs and of the run: name, bar, share and time."""
    columns, most = size.columns or COLUMNS, max(1, (size.lines or ROWS) - ROWS_BESIDE)
    took = in_time(now_s - course.began_s)
    if not course.total:
        return [f"reading the workflow, {took}"]
    jobs = sorted(course.running.values(), key=lambda job: (not job.text, job.began_s))
    for job in jobs:
        job.follow()
    lines = [fitted(job.name, state_of(job, now_s, course.pace), columns) for job in jobs[:most]]
    if len(jobs) > most:
        lines.append(f"and {len(jobs) - most} more")
    left_s = course.left_s(now_s)
    if left_s is not None or course.done == course.total:
        state = barred(course.share, f"{in_time(left_s or 0.0)} left")
    elif any(job.is_compiling for job in jobs):
        state = "time left: not known while code compiles"
    else:
        state = "time left: not known yet"
    return [*lines, fitted(f"{course.done} of {counted(course.total)}, {took}", state, columns)]


def state_of(job: Job, now_s: float, pace: float | None) -> str:
    """Return what a job does, or how far it is."""
    took = in_time(now_s - job.began_s)
    if not job.text:
        return f"starts, {took}"
    if job.is_compiling:
        functions = re.search(r"\d+ functions", job.text)
        return f"compiles code, once: {f'{functions[0]}, ' if functions else ''}{took}"
    left_s = job.left_s(now_s, pace)
    return barred(job.done, f"{in_time(left_s)} left" if left_s else took)


def barred(share: float, text: str) -> str:
    """Return a bar, the share that it shows, and a text."""
    return f"{'━' * round(BAR * share):<{BAR}} {PERCENT * share:3.0f}% {text:>15}"


def fitted(name: str, state: str, columns: int) -> str:
    """Return a name, cut if need be, and a state in a line that a terminal does not wrap."""
    room = max(NAME, columns - len(state) - 2)
    name = name if len(name) <= room else f"{name[: room - 1]}…"
    return f"{name:<{room}} {state}"[: columns - 1]
