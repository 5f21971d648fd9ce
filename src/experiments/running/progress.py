"""How far a run of the workflow is: its jobs in words, what each says in its log, and the time left.

A job tells its progress by lines of its log: "recording 2 of 8" begins the second of eight parts, and "30 of 120 s
simulated" says how much of a part is done. Nothing else is needed, so that a job on another machine is followed too.
"""

import re
import time
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from experiments.running.logs import account_name

LINE = re.compile(r"\d\d:\d\d:\d\d [A-Z]+ (?P<text>.*)")  # of a job's log
PART = re.compile(r"[a-z]+ (?P<begun>\d+) of (?P<all>[1-9]\d*)\b")  # at the start of a text
AMOUNT = re.compile(r"(?P<done>\d+) of (?P<all>[1-9]\d*) [a-z]")
COMPILING = "compiling code"
LEAST = 0.03  # share of a job that is done before the rest of its time is told from it
START_S = 6.0  # that a job takes besides what it is priced with: Python and its packages are loaded
WORDS = {  # kind of jobs -> what they do
    "motion": "motion",
    "collect": "record",
    "observe": "observe",
    "fit": "fit",
    "train": "train",
    "train_stack": "train side by side",
    "estimate": "estimate",
    "score": "score",
    "detect": "detectors",
    "watch": "thresholds",
    "react": "reaction",
    "falls": "falls",
    "table": "table",
    "figure": "figure",
    "trials": "trial",
}


def in_words(rule: str, log: str | None) -> str:
    """Return the name of a job as a person reads it: what it does, and to what, by its log."""
    kind, _, rest = account_name(Path(log)).partition("/") if log else (rule, "", "")
    names = rest.replace("/", ", ")
    return f"{WORDS.get(kind, kind.replace('_', ' '))} {names}".strip()


def in_time(seconds: float) -> str:
    """Return a duration in the units in which a person reads it."""
    if seconds < 60:
        return f"{seconds:.0f} s"
    minutes = round(seconds / 60)
    hours, rest = divmod(minutes, 60)
    return f"{hours} h {rest:02d} min" if hours else f"{minutes} min"


@dataclass
class JobLog:
    """What the log of a job says of its progress.

    Attributes:
        path: the log; None of a job without one.
        since_s: start of the job [s since 1970]; an older file is that of an earlier run.
        done: share of the job that is done; 0 where it says nothing.
        text: its last line, without time and level; empty before the first.
    """

    path: Path | None
    since_s: float
    done: float = 0.0
    text: str = ""
    _read: int = 0
    _part: tuple[float, float] = (0.0, 1.0)  # where the present part begins, and its share

    def follow(self) -> None:
        """Read what was written since the last time."""
        if self.path is None:
            return
        try:
            if self.path.stat().st_mtime < self.since_s:
                return
            with self.path.open("rb") as file:
                file.seek(self._read)
                new = file.read()
        except OSError:
            return
        whole = new[: new.rfind(b"\n") + 1]
        self._read += len(whole)
        for line in whole.decode("utf-8", errors="replace").splitlines():
            if found := LINE.match(line):
                self.take(found["text"])

    def take(self, text: str) -> None:
        """Take one line of the log."""
        self.text = text
        done = self.done
        if part := PART.match(text):
            share = 1.0 / int(part["all"])
            self._part = (int(part["begun"]) - 1) * share, share
            done = self._part[0]
        elif amount := AMOUNT.match(text):
            begin, share = self._part
            done = begin + share * int(amount["done"]) / int(amount["all"])
        self.done = min(1.0, max(self.done, done))


@dataclass
class Underway:
    """A job that was started: its name in words, its log, when it began, and what it was to take [s]; None: unknown."""

    name: str
    log: JobLog
    began_s: float
    expected_s: float | None = None

    def left_s(self, now_s: float, pace: float) -> float | None:
        """Return the time left [s]: by what it says itself, or else by its price; None where neither is known.

        Args:
            now_s: the time.
            pace: what jobs took so far, as a multiple of their prices.
        """
        took_s = now_s - self.began_s
        if self.log.done > LEAST:
            return took_s * (1.0 - self.log.done) / self.log.done
        return None if self.expected_s is None else max(0.0, self.expected_s * pace - took_s)


@dataclass
class RunState:
    """How far a run is.

    Attributes:
        total: jobs of the run.
        done: those that have ended.
        slots: jobs that run at once.
        running: those that were started, by their numbers.
        expected: number -> what a job is to take [s]; empty where it is not known.
        began_s: the start [s since 1970].
    """

    total: int = 0
    done: int = 0
    slots: int = 1
    running: dict[int, Underway] = field(default_factory=dict)
    expected: dict[int, float] = field(default_factory=dict)
    began_s: float = field(default_factory=time.time)
    _waiting_s: float = 0.0  # price of the jobs that have not begun
    _ended_s: float = 0.0  # price of those that have ended
    _took_s: float = 0.0  # what they took

    def expect(self, prices: Mapping[int, float]) -> None:
        """Take what each job that will run is to take [s], without what it takes to start."""
        self.expected = {number: price + START_S for number, price in prices.items()}
        self._waiting_s = sum(self.expected.values())

    def begin(self, number: int, name: str, log: Path | None, now_s: float) -> Underway:
        """Take the start of a job; return it."""
        expected_s = self.expected.get(number)
        self._waiting_s -= expected_s or 0.0
        self.running[number] = Underway(name, JobLog(log, now_s), now_s, expected_s)
        return self.running[number]

    def end(self, number: int, now_s: float) -> Underway | None:
        """Take the end of a job; return it, None where its start was not seen."""
        job = self.running.pop(number, None)
        if job is not None and job.expected_s is not None:
            self._ended_s += job.expected_s
            self._took_s += now_s - job.began_s
        return job

    @property
    def pace(self) -> float:
        """What jobs took so far, as a multiple of their prices."""
        return self._took_s / self._ended_s if self._ended_s else 1.0

    @property
    def share(self) -> float:
        """Share of the run that is done: by prices where they are known, else by the number of jobs."""
        whole_s = sum(self.expected.values())
        if not whole_s:
            return self.done / self.total if self.total else 0.0
        jobs = self.running.values()
        return min(1.0, (self._ended_s + sum(job.log.done * (job.expected_s or 0.0) for job in jobs)) / whole_s)

    def left_s(self, now_s: float) -> float | None:
        """Return the time left of the run [s]; None while nothing tells it."""
        if not self.expected:
            took_s = now_s - self.began_s
            return took_s / self.done * (self.total - self.done) if self.done else None
        rest = [left for job in self.running.values() if (left := job.left_s(now_s, self.pace)) is not None]
        whole_s = sum(rest) + max(0.0, self._waiting_s) * self.pace
        return max([whole_s / self.slots, *rest])

    def follow(self) -> None:
        """Read the logs of all running jobs."""
        for job in tuple(self.running.values()):
            job.log.follow()


def first(logs: Iterable[str]) -> str | None:
    """Return the first of some logs, if there is one."""
    return next(iter(logs), None)
