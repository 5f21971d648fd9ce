"""A number with its interval and what the paper prints, and how numbers are written."""

from dataclasses import dataclass
from math import isnan

LARGEST = 1e6  # from here on a number is written with a power of ten: a training that diverges has such losses


@dataclass(frozen=True)
class Number:
    """A number made of runs.

    Attributes:
        value: the number [unit]; None where there is none.
        low: lower end of its interval, or the lowest run [unit]; None with a single run.
        high: upper end of its interval, or the highest run [unit]; None with a single run.
        networks: how many networks it is made of, method by method; 1 also of a method without networks.
        walks: how many walks it is made of, test by test where they differ; 1 of a training.
        std_networks: its standard deviation if each method had one network [unit]; None with no second one.
        std_walks: its standard deviation if there were one walk [unit]; None with no second one.
        unit: unit of all of them.
        published: the paper's number [unit]; None where it prints none.
    """

    value: float | None
    low: float | None = None
    high: float | None = None
    unit: str = "-"
    published: float | None = None
    networks: tuple[int, ...] = ()
    walks: tuple[int, ...] = ()
    std_networks: float | None = None
    std_walks: float | None = None

    @property
    def runs(self) -> int:
        """How many runs it is made of: of the method with the most networks, where there are several."""
        return max(self.networks, default=0) * max(self.walks, default=0)

    @property
    def spread(self) -> tuple[str, str, float | None, float | None]:
        """The columns `SPREAD` of a file: counts, a plus between those of several, and standard deviations [unit]."""
        networks, walks = ("+".join(map(str, each)) for each in (self.networks, self.walks))
        return networks, walks, self.std_networks, self.std_walks

    @property
    def with_ends(self) -> tuple[float | None, float | None, float | None]:
        """The number and the ends of its interval [unit]."""
        return self.value, self.low, self.high

    @property
    def range(self) -> tuple[float | None, float | None, float | None]:
        """The number and the ends of its interval, or itself where it has none [unit]."""
        return (self.value, self.value, self.value) if self.low is None else self.with_ends

    def text(self, digits: int = 2) -> str:
        """Return the number as text."""
        return number_text(self.value, digits)

    def interval(self, digits: int = 2) -> str:
        """Return the interval as text."""
        return interval_text(self.low, self.high, digits)

    def texts(self) -> tuple[str, str]:
        """Return the number and its interval as text; a number below 1 that has a unit gets a digit more."""
        digits = 2 if self.unit == "-" or abs(self.value or 0.0) >= 1 else 3
        return self.text(digits), self.interval(digits)


def is_missing(value: float | None) -> bool:
    """Return whether there is no number: None, or NaN as in a frame."""
    return value is None or isnan(value)


def number_text(value: float | None, digits: int = 2) -> str:
    """Return a number with fixed digits and no minus before zero, or a dash where there is none: None, or NaN.

    A number from `LARGEST` on has one digit after the point and a power of ten.
    """
    if value is None or isnan(value):
        return "-"
    if abs(value) >= LARGEST:
        return f"{value:.1e}"
    return f"{round(value, digits) + 0.0:.{digits}f}"


def interval_text(low: float | None, high: float | None, digits: int = 2) -> str:
    """Return an interval in brackets, or nothing where there is none."""
    return "" if is_missing(low) or is_missing(high) else f"[{number_text(low, digits)}, {number_text(high, digits)}]"
