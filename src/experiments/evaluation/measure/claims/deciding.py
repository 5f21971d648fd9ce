"""What would decide a claim that is open: how many runs it needs, if its number stays.

An interval over n robots, networks or walks gets shorter with the square root of n, and with Student's quantile for n;
that of a share is Wilson's (1927) and that of a rate Garwood's (1936), for the independent trials or the time that have
the interval. The number itself is taken to stay: this is a size of effort and no promise.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import ceil, exp, inf, log, sqrt

from experiments.evaluation.number.number import Number
from experiments.intervals.bounds import Bounds, apart, within
from experiments.intervals.crossed import quantile_of
from experiments.intervals.independent import garwood, wilson
from experiments.settings import counts
from experiments.settings.claims import MadeNumber
from experiments.settings.runs import Statistics

ROBOTS, NETWORKS, WALKS = "robots", "networks", "walks"
TRIALS, HOURS, AS_MANY = "independent trials", "hours of walking", "times as much data"
# [own] How many of each are affordable: twice a fleet of eight robots, four times the three networks of a method and
# the fifteen walks of a test, twice the paper's 60 collisions, twice the hour that false reactions are counted in.
AFFORDABLE = {ROBOTS: 16.0, NETWORKS: 12.0, WALKS: 60.0, TRIALS: 120.0, HOURS: 2.0, AS_MANY: 2.0}
MOST = 1e4  # times as many runs: beyond, no number of them decides
EXACT = 100.0  # so many runs are told exactly; more to two digits, as the number that they come from is not exact
LEAST_SIZE, MOST_SIZE = 1e-3, 1e9  # of trials [-] or hours [h] that are looked for
HALVINGS = 60  # of the logarithm of a number that is looked for
ON_LOGS = ("value", "ratio", "least ratio")  # quantities whose interval is on a log scale where it is above zero
SINGLE = "more runs, which give it an interval, decide it"
Ends = tuple[float, float]


@dataclass(frozen=True)
class Effort:
    """What decides an open size or sign: a part of a sentence, and whether it is more than anybody would walk."""

    text: str
    is_beyond: bool


@dataclass(frozen=True)
class Shrinking:
    """The interval of a number by how many runs it is made of.

    Attributes:
        kind: of the runs, a key of `AFFORDABLE`.
        count: how many there are; of `AS_MANY` 1.
        ends: how many times as many there are -> the ends of the interval [unit of the number].
    """

    kind: str
    count: float
    ends: Callable[[float], Ends]


def effort_of(made: MadeNumber, number: Number, bounds: Bounds, word: str, statistics: Statistics) -> Effort:
    """Return what decides whether a number [its unit] lies within bounds; `word` is what is open, "size" or "sign"."""
    if number.value is None or number.low is None or number.high is None:
        return Effort(SINGLE, is_beyond=False)
    runs = shrinking(made, (number.value, number.low, number.high), number, statistics)
    times = least_times(runs.ends, bounds)
    if times == inf:
        return Effort(f"no number of runs decides the {word}, as it lies at a bound", is_beyond=True)
    side = "for the claim" if within(runs.ends(times), bounds) else "against the claim"
    needed = times * runs.count
    text = f"{count_text(needed, runs)} decide the {word}, {side}"
    if needed <= AFFORDABLE[runs.kind]:
        return Effort(text, is_beyond=False)
    return Effort(f"{text}: more than is affordable", is_beyond=True)


def text_of(efforts: Sequence[Effort], scales: Sequence[str]) -> str:
    """Return what decides all that is open of a claim, empty where nothing is; `scales` are those that decide it."""
    if not efforts:
        return ""
    # Size and sign of a single run are decided by the same: it is said once.
    texts = "; ".join(dict.fromkeys(effort.text for effort in efforts))
    walked = f" Scale {' or '.join(scales)} is made for it." if scales else ""
    return f"Open: if the number stays, {texts}.{walked}"


def count_text(needed: float, runs: Shrinking) -> str:
    """Return how many runs are needed as text, with how many there are."""
    several = f"{needed:.1f}" if runs.kind in (AS_MANY, HOURS) else f"{ceil(needed)}"
    if needed > EXACT:
        several = f"{float(f'{needed:.1e}'):.0f}"
    if runs.kind == AS_MANY:
        return f"{several} {runs.kind}"
    if runs.kind == HOURS:
        return f"{several} {runs.kind} (here {runs.count:.1f})"
    return f"{several} {runs.kind} (here {runs.count:.0f})"


def least_times(ends: Callable[[float], Ends], bounds: Bounds) -> float:
    """Return the least number of times as many runs whose interval is within bounds or apart from them.

    It is infinite where no number of them has one. The interval gets shorter the more runs there are.
    """

    def decides(times: float) -> bool:
        return within(ends(times), bounds) or apart(ends(times), bounds)

    if not decides(MOST):
        return inf
    low = 0.0
    high = log(MOST)
    for _ in range(HALVINGS):
        middle = (low + high) / 2.0
        if decides(exp(middle)):
            high = middle
        else:
            low = middle
    return exp(high)


def shrinking(
    made: MadeNumber, interval: tuple[float, float, float], number: Number, statistics: Statistics
) -> Shrinking:  # fmt: skip
    """Return how the interval of a number, (value, low, high) [its unit], depends on how many runs it is made of."""
    value, low, high = interval
    table = made.cells[0].table or "" if made.quantity == "value" else ""
    if table in counts.HOURS:
        hours = size_of(lambda size: rate_ends(value, size, statistics)[1], high)
        return Shrinking(HOURS, hours, lambda times: rate_ends(value, times * hours, statistics))
    if made.quantity == "share" or (table in counts.TRIALS and number.unit == "-"):
        trials = size_of(lambda size: width_of(wilson(value, size, statistics.confidence)), high - low)
        kind = NETWORKS if made.quantity == "share" else TRIALS
        return Shrinking(kind, trials, lambda times: wilson(value, times * trials, statistics.confidence))
    kind, count = runs_of(made, number)

    def shorter(times: float) -> float:
        """Return by which factor an interval gets shorter with so many times as many runs [-]."""
        if count == 1:
            return 1.0 / sqrt(times)
        then, now = (quantile_of(degrees, statistics.confidence) for degrees in (times * count - 1.0, count - 1.0))
        return then / now / sqrt(times)

    def ends(times: float) -> Ends:
        """Return the ends with so many times as many runs; a cut has them on a log scale of what it leaves."""
        part = shorter(times)
        if made.quantity == "cut" and high < 1.0:
            left = 1.0 - value
            return 1.0 - left * ((1.0 - low) / left) ** part, 1.0 - left * ((1.0 - high) / left) ** part
        if made.quantity in ON_LOGS and low > 0.0:
            return value * (low / value) ** part, value * (high / value) ** part
        return value + (low - value) * part, value + (high - value) * part

    return Shrinking(kind, count, ends)


def size_of(made: Callable[[float], float], wanted: float) -> float:
    """Return the number of trials, or hours, with which something that falls with them is what is wanted."""
    low = log(LEAST_SIZE)
    high = log(MOST_SIZE)
    for _ in range(HALVINGS):
        middle = (low + high) / 2.0
        if made(exp(middle)) > wanted:
            low = middle
        else:
            high = middle
    return exp(high)


def rate_ends(rate: float, hours: float, statistics: Statistics) -> Ends:
    """Return the interval of a rate [1/h] that is found in so many hours."""
    low, high = garwood(rate * hours, statistics.confidence)
    return low / hours, high / hours


def width_of(ends: Ends) -> float:
    """Return how wide an interval is [its unit]."""
    return ends[1] - ends[0]


def runs_of(made: MadeNumber, number: Number) -> tuple[str, int]:
    """Return what runs a number is over, and how many, of which several are drawn; else that it has so much data."""
    cell = made.cells[0]
    networks = max(number.networks, default=1)
    walks = max(number.walks, default=1)
    if networks > 1:
        return (ROBOTS if cell.level == ROBOTS else NETWORKS), networks
    return (WALKS, walks) if walks > 1 else (AS_MANY, 1)
