"""What a run shows: Snakemake's plug-in `--logger mobnet`, which every run in this folder uses (`profiles/default`).

On a terminal one line for each running job and one for the whole run, in place; elsewhere a line at the start and at
the end of each job. Errors, warnings and all that Snakemake says besides stay; its complete log is in `.snakemake/log`,
that of each job in `results/<scale>/logs`. A dry run, and one that was asked for details, print what Snakemake prints.
"""

import atexit
import logging
import os
import re
import sys
import threading
import time
from collections.abc import Iterable
from pathlib import Path
from typing import Any, TextIO

from snakemake_interface_logger_plugins.base import LogHandlerBase
from snakemake_interface_logger_plugins.common import LogEvent

from experiments.running.progress import COMPILING, RunState, Underway, first, in_time, in_words
from mobnet.core.printed import end_where_full

# What Snakemake says of itself in each run. Whatever is not named here is printed.
NOISE = re.compile(
    r"Select jobs to execute|Using shell: |Provided (cores|resources|remote nodes): |Rules claiming more threads|"
    r"Group jobs: inactive|Building DAG of jobs|Complete log\(s\): |Removing temporary output|host: |"
    r"Assuming unrestricted shared filesystem|Updating job|Terminating processes on user request|"
    # A job has said why itself.
    r"RuleException:\nCalledProcessError in (.*\n)+.*returned non-zero exit status (1|130|143)\.|"
    r"Elapsed time: |SLURM run ID: |Job \d+ has been submitted with SLURM|None$|$"
)
SHOWN_S = 0.5  # between two pictures of the terminal
ROWS_BESIDE = 4  # lines of the terminal that are no jobs
NARROW, WIDE = 10, 24  # columns of a bar
WIDE_FROM = 76  # columns of a terminal
PERCENT = 100.0


class RunHandler(LogHandlerBase):
    """Shows what Snakemake says of a run, and what its jobs say in their logs."""

    def __post_init__(self) -> None:
        """Open the screen at once: reading the workflow takes seconds."""
        asked = self.common_settings
        self.course = RunState()
        self.is_stopped = False
        self.screen: Screen | None = None
        self.own: logging.Handler | None = None  # Snakemake's, where it was asked for what it says
        if asked.dryrun or asked.verbose or asked.printshellcmds or asked.debug_dag or is_quiet(asked.quiet):
            self.own = snakemakes(asked)
        elif is_terminal():
            self.screen = Screen(self.course, nocolor=asked.nocolor)
            atexit.register(self.close)

    @property
    def writes_to_stream(self) -> bool:
        """Whether it writes to the terminal: in place of Snakemake's handler."""
        return True

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

    def expect(self, prices: dict[int, float]) -> None:
        """Take what each job that will run is to take [s]."""
        self.course.expect(prices)

    def stopped(self) -> None:
        """Take that somebody has stopped the run: no job fails any more."""
        self.is_stopped = True

    def emit(self, record: logging.LogRecord) -> None:
        """Show a record of Snakemake."""
        try:
            if self.own is None:
                self.show(record)
            else:
                self.own.handle(record)
        except BrokenPipeError:
            raise
        except Exception:  # noqa: BLE001 a fault of what is shown ends no run
            self.handleError(record)

    def show(self, record: logging.LogRecord) -> None:
        """Show a record of a run."""
        event, told = getattr(record, "event", None), record.__dict__
        if event == LogEvent.RUN_INFO:
            self.course.total = int(told["stats"].get("total", 0))
            self.say(f"{self.course.total} {plural(self.course.total)}")
        elif event == LogEvent.RESOURCES_INFO:
            self.course.slots = max(1, int(told.get("cores", self.course.slots)))
        elif event == LogEvent.JOB_INFO:
            self.begun(told)
        elif event == LogEvent.JOB_FINISHED:
            self.ended(int(told["job_id"]))
        elif event == LogEvent.PROGRESS:
            self.course.done = int(told["done"])
            self.course.total = int(told["total"])
        elif event == LogEvent.JOB_ERROR and not told.get("indent"):
            self.failed(int(told["jobid"]), in_words(told["rule_name"], first(told["log"])), told["log"])
        elif event == LogEvent.GROUP_ERROR:
            self.say(f"failed: jobs that went into the queue together (log: {', '.join(told['aux_logs'])})")
        elif event in (None, LogEvent.ERROR) or record.levelno >= logging.WARNING:
            self.other(record)

    def begun(self, told: dict[str, Any]) -> None:
        """Take the start of a job."""
        log = first(told["log"])
        name = in_words(told["rule_name"], log)
        self.course.begin(int(told["jobid"]), name, Path(log) if log else None, time.time())
        if self.screen is None:
            self.say(f"begins: {name}")

    def ended(self, number: int) -> None:
        """Take the end of a job."""
        now_s = time.time()
        job = self.course.end(number, now_s)
        self.course.done += 1
        if job is not None and self.screen is None:
            count = f"{self.course.done} of {self.course.total} {plural(self.course.total)}"
            share = f"{count}, {PERCENT * self.course.share:.0f} %"
            left_s = self.course.left_s(now_s)
            left = "" if left_s is None or self.course.done == self.course.total else f", {in_time(left_s)} left"
            self.say(f"done: {job.name}, {in_time(now_s - job.began_s)} ({share}{left})")

    def failed(self, number: int, name: str, logs: list[str]) -> None:
        """Say that a job has failed, and where its log is; the job has printed its own error."""
        self.course.running.pop(number, None)
        if not self.is_stopped:
            self.say(f"failed: {name} (log: {', '.join(logs) or 'none'})")

    def other(self, record: logging.LogRecord) -> None:
        """Print what is no event of a run, if it is not among what Snakemake says in every one."""
        text = record.getMessage()
        if not NOISE.match(text) and not (self.is_stopped and text.startswith("RuleException")):
            write(self.stream, text)

    def say(self, text: str) -> None:
        """Print one line with the time."""
        write(self.stream, f"{time.strftime('%H:%M:%S')} {text}")

    @property
    def stream(self) -> TextIO:
        """Where it writes: what it prints beside the lines in place goes the way of all that jobs print."""
        return sys.stderr

    def close(self) -> None:
        """Give the terminal back."""
        if self.screen is not None:
            self.screen.close()
            self.screen = None
        super().close()


def is_quiet(quiet: Iterable[Any] | None) -> bool:
    """Return whether a run was asked not to tell how far it is."""
    return any(own.name.lower() in ("all", "progress") for own in quiet or ())


def snakemakes(asked: Any) -> logging.Handler:
    """Return Snakemake's handler, as it has it without a plug-in."""
    from snakemake.logging import ColorizingTextHandler, DefaultFilter, DefaultFormatter

    chosen = DefaultFilter(asked.quiet, asked.debug_dag, asked.verbose, asked.dryrun, asked.printshellcmds)
    words = DefaultFormatter(asked.quiet, asked.show_failed_logs)
    stream = sys.stdout if asked.stdout else sys.stderr
    handler = ColorizingTextHandler(nocolor=asked.nocolor, stream=stream, formatter=words)
    handler.addFilter(chosen)
    if asked.dryrun:
        end_where_full([handler])
    return handler


def write(stream: TextIO, text: str) -> None:
    """Write one line at once."""
    stream.write(f"{text}\n")
    stream.flush()


def is_terminal() -> bool:
    """Return whether errors go to a terminal on which lines can be written anew."""
    return sys.stderr.isatty() and os.environ.get("TERM", "dumb") != "dumb"


class Screen:
    """A line for each running job and one for the run, in place, below all that is printed meanwhile.

    What this process and its jobs print goes through a pipe, so that it stands above these lines and never in them. A
    run that is killed outright leaves a terminal as it should be: the cursor is never hidden.
    """

    def __init__(self, course: RunState, *, nocolor: bool) -> None:
        """Take over the streams of this process that are the terminal."""
        from rich.console import Console
        from rich.live import Live

        self._course = course
        self._kept = {number: os.dup(number) for number in (1, 2) if os.isatty(number)}
        self._terminal = os.fdopen(os.dup(2), "w", encoding="utf-8", errors="replace")
        self._console = Console(file=self._terminal, no_color=nocolor or None, highlight=False, markup=False)
        self._console.show_cursor = lambda show=True: True
        reading, writing = os.pipe()
        sys.stdout.flush()
        sys.stderr.flush()
        for number in self._kept:
            os.dup2(writing, number)
        os.close(writing)
        self._live = Live(
            get_renderable=self.picture,
            console=self._console,
            refresh_per_second=1.0 / SHOWN_S,
            transient=True,
            redirect_stdout=False,
            redirect_stderr=False,
        )
        self._reader = threading.Thread(target=self._print, args=[reading], daemon=True)
        self._reader.start()
        self._live.start()

    def _print(self, reading: int) -> None:
        """Print lines above the picture until nobody can write any more."""
        from rich.text import Text

        with os.fdopen(reading, encoding="utf-8", errors="replace") as lines:
            for line in lines:
                self._console.print(Text.from_ansi(line.rstrip("\r\n")), soft_wrap=True)

    def close(self) -> None:
        """Give the streams back, and remove the picture."""
        sys.stdout.flush()
        sys.stderr.flush()
        for number, kept in self._kept.items():
            os.dup2(kept, number)
            os.close(kept)
        self._reader.join(1.0)  # a process that outlives the run would keep the pipe open
        self._live.stop()
        self._terminal.flush()

    def picture(self) -> Any:
        """Return what is shown: the first of the running jobs, and the run."""
        self._course.follow()
        size = self._console.size
        return drawn(self._course, time.time(), size.width, max(1, size.height - ROWS_BESIDE))


def drawn(course: RunState, now_s: float, width: int, most: int) -> Any:
    """Return what rich draws of a run: name, bar, share and time of `most` jobs at most, and of the run."""
    from rich.progress_bar import ProgressBar
    from rich.table import Table

    table = Table.grid(padding=(0, 1, 0, 0), expand=True)
    bar_width = WIDE if width >= WIDE_FROM else NARROW
    table.add_column(ratio=1, no_wrap=True, overflow="ellipsis")
    table.add_column(width=bar_width)
    table.add_column(justify="right", width=4, no_wrap=True)
    table.add_column(justify="right", width=16, no_wrap=True)
    jobs = sorted(course.running.values(), key=lambda job: (not job.log.text, job.began_s))
    for job in jobs[:most]:
        bar = ProgressBar(total=1.0, completed=job.log.done, width=bar_width)
        table.add_row(job.name, bar, f"{PERCENT * job.log.done:.0f}%", told_time(job, now_s, course.pace))
    if len(jobs) > most:
        table.add_row(f"and {len(jobs) - most} more", "", "", "")
    took = in_time(now_s - course.began_s)
    if not course.total:
        table.add_row(f"reading the workflow, {took}", "", "", "")
        return table
    left_s = course.left_s(now_s)
    left = "" if left_s is None else f"{in_time(left_s)} left"
    if left_s and any(job.log.text.startswith(COMPILING) for job in jobs):
        left = f"then {in_time(left_s)}"  # nobody knows how long the compiler takes
    bar = ProgressBar(total=1.0, completed=course.share, width=bar_width)
    name = f"{course.done} of {course.total} {plural(course.total)}, {took}"
    table.add_row(name, bar, f"{PERCENT * course.share:.0f}%", left, style="bold")
    return table


def told_time(job: Underway, now_s: float, pace: float) -> str:
    """Return the time that a job still needs, or what it does before that is known, with the time that it took."""
    took = in_time(now_s - job.began_s)
    if not job.log.text:
        return f"starts, {took}"
    if job.log.text.startswith(COMPILING):
        return f"compiles, {took}"
    left_s = job.left_s(now_s, pace)
    return f"{in_time(left_s)} left" if left_s else took


def plural(jobs: int) -> str:
    """Return the word for a number of jobs."""
    return "job" if jobs == 1 else "jobs"
