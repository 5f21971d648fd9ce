"""What lower and higher thresholds do: collisions and delays over false alarms; and found shares over the force."""

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import StrMethodFormatter

from experiments.evaluation.figures.style import LOOKS, Look, beside, entitle, legend, save_figure
from experiments.evaluation.measure.detection.results import (
    MS,
    Detections,
    Try,
    alarms_in,
    found_share,
    hours_per_swing,
    owners,
    rows_of,
    tries_of,
)
from experiments.evaluation.number.clusters import ClusterKey, share_in
from experiments.evaluation.number.number import Number
from experiments.settings.detection_tables import DetectionCurves
from experiments.settings.runs import Statistics
from mobnet.core.detections import COLLISION, HELD_OUT, CurvePoint, FreeSwing, Promise
from mobnet.core.style import styled
from mobnet.settings.detection import Detection

COLUMNS = ("panel", "level", "detector", "x", "value", "low", "high", "count", "unit")
FOUND = "found collisions"
DELAY = "delay"
FORCE = "found by force"
AREA = "area"
LABELS = {
    FOUND: ("false alarms of a leg [1/h]", "found share [-]"),
    DELAY: ("false alarms of a leg [1/h]", "delay [ms]"),
    FORCE: ("largest force [N]", "found share [-]"),
}
HEIGHT_INCH = 2.5
RATE_MOST = 1000.0  # false alarms in an hour above which nobody detects
RATE_FLOOR = 0.3  # false alarms in an hour below which a rate is drawn here: none was counted
BREAK = 0.4  # where the axis breaks between no false alarm and one
RATES = (RATE_FLOOR, 1.0, 10.0, 100.0, 1000.0)  # that are named
BAND_ALPHA = 0.12  # opacity of intervals
OTHERS = (
    ((0, (1.5, 1)), "v"),
    ((0, (6, 1.5, 1, 1.5)), "X"),
)  # dash and marker of the second and third detector of a method


@dataclass(frozen=True)
class DetectorLine:
    """A line of a panel: numbers (n,) over x (n,), each made of so many collisions."""

    panel: str
    detector: str
    x: Sequence[float]
    numbers: Sequence[Number]
    counts: Sequence[int]


def detection_curves(
    settings: DetectionCurves, detection: Detection, statistics: Statistics, detections: Detections, figure_dir: Path
) -> None:
    """Write detection_curves.pdf, .png and .csv, which has the area under the curve of found collisions too.

    The area is the probability that a collision's largest signal lies above that of a swing which nothing pushes, with
    the interval of Hanley and McNeil (1982, Radiology 143).
    """
    names = owners(detections, settings.level, detection.levels)
    leg = settings.leg
    points = {robot: rows_of(detections, [robot], "curves", CurvePoint, leg=leg) for robot in names}
    promises = rows_of(detections, names, "promises", Promise, leg=leg)
    swings = rows_of(detections, names, "swings", FreeSwing, leg=leg, scenario=detection.random, part=HELD_OUT)
    hits = tries_of(detections, names, detection.collisions, leg, COLLISION)
    sweep = tries_of(detections, names, detection.sweep, leg, settings.kind)
    courses = list[DetectorLine]()
    rows = []
    for name in (name for name in settings.detectors if name in hits):
        quiet = [row for row in swings if row.detector == name]
        hours = len(quiet) * hours_per_swing([row for row in promises if row.detector == name])
        own: dict[str, list[CurvePoint]] = {}
        for robot, found in points.items():
            own[robot] = [row for row in found if row.detector == name]
        courses += _over_rates(name, own, quiet, hours, statistics)
        courses.append(_over_force(name, sweep[name], settings.force_bins, statistics))
        hit = np.array([one.detected.ratio for one in hits[name]])
        area = area_of(hit, np.array([row.ratio for row in quiet]), statistics)
        rows.append((AREA, settings.level, name, None, *area.with_ends, len(hits[name]), "-"))
    for one in courses:
        unit = "ms" if one.panel == DELAY else "-"
        for x, number, count in zip(one.x, one.numbers, one.counts, strict=True):
            rows.append((one.panel, settings.level, one.detector, x, *number.with_ends, count, unit))
    save_figure(draw_courses(courses), figure_dir / "detection_curves", COLUMNS, rows)


def _over_rates(
    name: str,
    points: Mapping[str, Sequence[CurvePoint]],
    quiet: Sequence[FreeSwing],
    hours: float,
    statistics: Statistics,
) -> list[DetectorLine]:
    """Return the found share and the mean delay [ms] at multiples of the thresholds, over the false alarms [1/h].

    The points are those of each robot.
    """
    pooled = [(robot, row) for robot, rows in points.items() for row in rows]
    factors = sorted({row.factor for _, row in pooled})
    factors = [factor for factor in factors if alarms_in(quiet, factor) <= RATE_MOST * hours]
    quiet_at = next((k for k, factor in enumerate(factors) if not alarms_in(quiet, factor)), len(factors))
    factors = factors[: quiet_at + 1]  # higher thresholds only find less
    rates = list[float]()
    shares = list[Number]()
    delays = list[Number]()
    counts = list[int]()
    for factor in factors:
        own = [(robot, row) for robot, row in pooled if row.factor == factor]
        found = sum(row.found for _, row in own)
        count = sum(row.collisions for _, row in own)
        flags: list[bool] = []
        places: list[ClusterKey] = []
        for robot, row in own:
            flags += [True] * row.found + [False] * (row.collisions - row.found)
            # A point is of all walks of a robot together: one cluster.
            places += [ClusterKey(robot, 0)] * row.collisions
        rates.append(alarms_in(quiet, factor) / hours if hours else 0.0)
        shares.append(share_in(flags, places, statistics))
        late = MS * sum(row.delay_sum_s for _, row in own) / found if found else None
        delays.append(Number(late, unit="ms"))
        counts.append(count)
    return [DetectorLine(FOUND, name, rates, shares, counts), DetectorLine(DELAY, name, rates, delays, counts)]


def _over_force(name: str, tries: Sequence[Try], bins: int, statistics: Statistics) -> DetectorLine:
    """Return the found share in bins of the largest force with as many collisions each, over their mean force [N]."""
    ordered = sorted(tries, key=lambda one: one.collision.force_n)
    parts = [list(part) for part in np.array_split(np.array(ordered, dtype=object), bins) if len(part)]
    x: list[float] = []
    for part in parts:
        x.append(float(np.mean([one.collision.force_n for one in part])))
    shares = [found_share(part, statistics) for part in parts]
    return DetectorLine(FORCE, name, x, shares, [len(part) for part in parts])


def area_of(hits: np.ndarray, quiet: np.ndarray, statistics: Statistics) -> Number:
    """Return the area under the curve of collisions (n,) against swings that nothing pushes (m,) [-]."""
    if not len(hits) or not len(quiet):
        return Number(None)
    from scipy.stats import norm, rankdata  # here, as it takes a second to import

    n = len(hits)
    m = len(quiet)
    area = float((rankdata(np.concatenate([hits, quiet]))[:n].sum() - n * (n + 1) / 2) / (n * m))
    one = area / (2 - area)
    two = 2 * area**2 / (1 + area)
    variance = (area * (1 - area) + (n - 1) * (one - area**2) + (m - 1) * (two - area**2)) / (n * m)
    reach = float(norm.ppf((1.0 + statistics.confidence) / 2.0)) * max(variance, 0.0) ** 0.5
    return Number(area, max(area - reach, 0.0), min(area + reach, 1.0))


@styled
def draw_courses(courses: Sequence[DetectorLine]) -> Figure:
    """Draw the three panels side by side, those over false alarms with a break left of which none was counted."""
    styles = looks_of(one.detector for one in courses)
    figure, axes = beside(len(LABELS), HEIGHT_INCH)
    for k, (panel, axis) in enumerate(zip(LABELS, axes, strict=True)):
        for one in (one for one in courses if one.panel == panel):
            _draw(axis, one, styles[one.detector])
        axis.set(xlabel=LABELS[panel][0], ylabel=LABELS[panel][1], xscale="log")
        axis.xaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
        if panel != FORCE:
            axis.minorticks_off()
            axis.set_xticks(RATES, ["0", *(f"{rate:g}" for rate in RATES[1:])])
            axis.axvline(BREAK, color="0.6", linewidth=0.6, linestyle=(0, (2, 2)), zorder=0)
        axis.set_ylim(0.0, None if panel == DELAY else 1.05)
        entitle(axis, k, panel)
    legend(figure, axes)
    return figure


def looks_of(detectors: Iterable[str]) -> dict[str, Look]:
    """Return the looks of detectors: the first one of a method has the method's, others its colour and another dash."""
    found = dict[str, Look]()
    seen = Counter[str]()
    for name in dict.fromkeys(detectors):
        method = max((known for known in LOOKS if name.startswith(known)), key=len)
        others = dict(zip(("dash", "marker"), OTHERS[seen[method] - 1], strict=True)) if seen[method] else {}
        found[name] = replace(LOOKS[method], **others)
        seen[method] += 1
    return found


def _draw(axis: Axes, one: DetectorLine, look: Look) -> None:
    """Draw a line with its intervals, where it has any: bars at the forces, bands over the rates."""
    mean, low, high = np.array([number.range for number in one.numbers], dtype=np.float64).reshape(-1, 3).T
    x = np.asarray(one.x) if one.panel == FORCE else np.maximum(one.x, RATE_FLOOR)
    marker = look.marker if one.panel == FORCE else ""
    axis.plot(x, mean, label=one.detector, marker=marker, markersize=3, **look.line)
    if one.panel == FORCE:
        axis.vlines(x, low, high, color=look.colour, linewidth=0.6, alpha=0.7, zorder=look.order)
    else:
        axis.fill_between(x, low, high, color=look.colour, alpha=BAND_ALPHA, linewidth=0.0)
