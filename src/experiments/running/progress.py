"""How far a run of the workflow is: its jobs in words, what each says in its log, and the time left.

A job tells its progress by lines of its log: "recording 2 of 8" begins the second of eight parts, and "30 of 120 s
simulated" says how much of a part is done. Nothing else is needed, so that a job on another machine is followed too.
"""

import re
import time
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from experiments.running.logs import account_name

LINE = re.compile(r"\d\d:\d\d:\d\d [A-Z]+ (?P<text>.*)")  # of a job's log
PART = re.compile(r"[a-z]+ (?P<begun>\d+) of (?P<all>[1-9]\d*)\b")  # at the start of a text
AMOUNT = re.compile(r"(?P<done>\d+) of (?P<all>[1-9]\d*) [a-z]")
COMPILING = "compiling code"
LEAST = 0.03  # share of a job that is done before the rest of its time is told from it
START_S = 2.0  # that a job takes besides what it is priced with: Python and its packages are loaded
KNOWN_S, KNOWN = 20.0, 0.05  # price, and share of that of the run, that is measured before the time left is told
WORDS = {"collect": "record", "detect": "detectors", "watch": "thresholds", "react": "reaction"}  # rule -> what it does


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
class Job:
    """A job that was started at `began_s`, its price [s], and what its log says: the share done, and its last line."""

    name: str
    log: Path | None
    began_s: float
    price_s: float = 0.0
    done: float = 0.0
    text: str = ""
    has_compiled: bool = False
    _read: int = 0
    _part: tuple[float, float] = (0.0, 1.0)  # where the present part begins, and its share

    def follow(self) -> None:
        """Read what was written since the last time; an older log is that of an earlier run."""
        try:
            if self.log is None or self.log.stat().st_mtime < self.began_s:
                return
            with self.log.open("rb") as file:
                file.seek(self._read)
                new = file.read()
        except OSError:
            return
        whole = new[: new.rfind(b"\n") + 1]
        self._read += len(whole)
        for line in whole.decode("utf-8", errors="replace").splitlines():
            if match := LINE.match(line):
                self.take(match["text"])

    def take(self, text: str) -> None:
        """Take one line of the log, without time and level."""
        self.text = text
        self.has_compiled |= self.is_compiling
        done = self.done
        if part := PART.match(text):
            share = 1.0 / int(part["all"])
            self._part = (int(part["begun"]) - 1) * share, share
            done = self._part[0]
        elif amount := AMOUNT.match(text):
            begin, share = self._part
            done = begin + share * int(amount["done"]) / int(amount["all"])
        self.done = min(1.0, max(self.done, done))

    @property
    def is_compiling(self) -> bool:
        """Whether it compiles code, which happens once, and which no price contains."""
        return self.text.startswith(COMPILING)

    def left_s(self, now_s: float, pace: float | None) -> float | None:
        """Return the time left [s], by what it says itself or by its price and a pace; None where neither is known."""
        took_s = now_s - self.began_s
        if self.done > LEAST and not self.has_compiled:
            return max(0.0, took_s - START_S) * (1.0 - self.done) / self.done
        if pace is None:
            return None
        whole_s = pace * self.price_s
        return whole_s * (1.0 - self.done) if self.has_compiled else max(0.0, whole_s - took_s)


@dataclass
class RunState:
    """How far a run is: its jobs, those that have ended, and those that run, by their numbers; `slots` run at once."""

    total: int = 0
    done: int = 0
    slots: int = 1
    running: dict[int, Job] = field(default_factory=dict)
    prices: dict[int, float] = field(default_factory=dict)  # [s]
    began_s: float = field(default_factory=time.time)
    _waiting_s: float = 0.0  # price of the jobs that have not begun
    _ended_s: float = 0.0  # price of those that have ended
    _measured_s: float = 0.0  # price of those of them that compiled nothing
    _took_s: float = 0.0  # what these took

    def expect(self, prices: Mapping[int, float]) -> None:
        """Take what each job that will run is to take [s], without what it takes to start."""
        self.prices = {number: price_s + START_S for number, price_s in prices.items()}
        self._waiting_s = sum(self.prices.values())

    def begin(self, number: int, name: str, log: str | None, now_s: float) -> Job:
        """Take the start of a job; return it."""
        job = Job(name, Path(log) if log else None, now_s, self.prices.get(number, 0.0))
        self._waiting_s -= job.price_s
        self.running[number] = job
        return job

    def end(self, number: int, now_s: float) -> Job:
        """Take the end of a job; return it."""
        job = self.running.pop(number)
        job.follow()
        self.done += 1
        self._ended_s += job.price_s
        if not job.has_compiled:
            self._measured_s += job.price_s
            self._took_s += now_s - job.began_s
        return job

    @property
    def pace(self) -> float | None:
        """What jobs took, as a multiple of their prices; None before enough of them have ended.

        A job that compiled does not count: its time says nothing of the others.
        """
        least_s = min(KNOWN_S, KNOWN * sum(self.prices.values()))
        return self._took_s / self._measured_s if self._measured_s and self._measured_s >= least_s else None

    @property
    def share(self) -> float:
        """Share of the run that is done, by prices where they are known, else by the number of jobs."""
        if not self.prices:
            return self.done / max(1, self.total)
        done_s = self._ended_s + sum(job.done * job.price_s for job in tuple(self.running.values()))
        return min(1.0, done_s / sum(self.prices.values()))

    def left_s(self, now_s: float) -> float | None:
        """Return the time left of the run [s]; None while nothing tells it."""
        if self.pace is None:
            return None
        rest_s = [job.left_s(now_s, self.pace) or 0.0 for job in tuple(self.running.values())]
        whole_s = sum(rest_s) + max(0.0, self._waiting_s) * self.pace
        return max([whole_s / self.slots, *rest_s])
