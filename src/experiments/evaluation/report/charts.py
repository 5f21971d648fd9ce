"""Line charts of a web page as numbers: points on a grid and ticks; the page's template draws them."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import chain

from matplotlib.ticker import MaxNLocator

GRID = 1000  # steps of a drawing in each direction: finer than a screen shows, and few digits
TICKS = 5
DASH = GRID // 50  # half length of a curve of one point
FLAT = 0.5  # half height given to a curve that is zero throughout


@dataclass(frozen=True)
class Tick:
    """A mark on an axis: its place as share of the axis's length [-], and its text."""

    place: float
    text: str


@dataclass(frozen=True)
class Chart:
    """A drawing of GRID x GRID, y downwards: the SVG points of each curve, the x of a marked place, and the ticks.

    `spans` are the numbers at its left, right, lower and upper end.
    """

    key: str
    title: str
    lines: Mapping[str, str]
    marked: int
    x_ticks: Sequence[Tick]
    y_ticks: Sequence[Tick]
    spans: tuple[float, float, float, float]


def line_chart(key: str, title: str, x: Sequence[float], lines: Mapping[str, Sequence[float]], marked: float) -> Chart:
    """Scale curves, values (n,) at whole numbers x (n,), all on one axis, to the drawing; `marked` is a place of x."""
    across = span(x)
    up = span(list(chain.from_iterable(lines.values())))
    return Chart(
        key=key,
        title=title,
        lines={name: points(x, values, across, up) for name, values in lines.items()},
        marked=round(GRID * share(marked, across)),
        x_ticks=ticks(across, whole=True),
        y_ticks=ticks(up),
        spans=(*across, *up),
    )


def span(values: Sequence[float]) -> tuple[float, float]:
    """Return the smallest and largest value, drawn apart where they are equal."""
    low = min(values)
    high = max(values)
    apart = abs(low) / 2 or FLAT
    return (low, high) if low < high else (low - apart, high + apart)


def share(value: float, ends: tuple[float, float]) -> float:
    """Return how far a value lies between two ends [-]."""
    return (value - ends[0]) / (ends[1] - ends[0])


def points(x: Sequence[float], y: Sequence[float], across: tuple[float, float], up: tuple[float, float]) -> str:
    """Return a curve's points as SVG writes them; a single one as a dash."""
    places = [(round(GRID * share(a, across)), round(GRID * (1 - share(b, up)))) for a, b in zip(x, y, strict=True)]
    if len(places) == 1:
        ((a, b),) = places
        places = [(a - DASH, b), (a + DASH, b)]
    return " ".join(f"{a},{b}" for a, b in places)


def ticks(ends: tuple[float, float], *, whole: bool = False) -> list[Tick]:
    """Return marks at round values between two ends, with no more digits than tell them apart."""
    places = MaxNLocator(TICKS, integer=whole, min_n_ticks=1 if whole else 2).tick_values(*ends)
    return [Tick(share(place, ends), f"{place + 0.0:.4g}") for place in places if ends[0] <= place <= ends[1]]
