"""What lower and higher thresholds do: collisions and delays over false alarms; and found shares over the force."""

# pandas has no complete types, which the strict rules of this folder ask for.
# pyright: standard

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.colors import to_hex, to_rgb
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from experiments.evaluation.figures.style import LOOKS, Look, beside, entitle, legend, save_figure
from experiments.evaluation.measure.detection.results import (
    MS,
    alarms_in,
    found_at,
    hours_per_swing,
    owners,
)
from experiments.evaluation.number.frames import read_detection, read_hits, records_of, rows_of
from experiments.evaluation.number.laws import fields_of, number_from, share
from experiments.evaluation.number.number import Number, is_missing
from experiments.intervals.clusters import share_in
from experiments.plan.detection import Detections
from experiments.records.collisions import UNPUSHED
from experiments.settings.detection_tables import DetectionCurves
from experiments.settings.runs import Statistics
from mobnet.core.detections import COLLISION, HELD_OUT
from mobnet.core.style import styled
from mobnet.settings.detection import Detection

COLUMNS = ("panel", "level", "detector", "x", "value", "low", "high", "count", "unit")
FOUND = "found collisions"
DELAY = "delay"
FORCE = "found by force"
AREA = "area"
SET = {FOUND: f"{FOUND} at {{:g}}/h", DELAY: f"{DELAY} at {{:g}}/h"}  # by thresholds for the promised rate [1/h]
NO_HIT = "found without a hit"
LABELS = {
    FOUND: ("false alarms of a leg [1/h]", "found share [-]"),
    DELAY: ("false alarms of a leg [1/h]", "delay [ms]"),
    FORCE: ("largest force [N]", "found share [-]"),
}
HEIGHT_INCH, WIDTHS = 2.1, (1.3, 1.0, 1.1)  # of the figure; of its panels
RATE_MOST = 1000.0  # false alarms in an hour above which nobody detects
RATE_FLOOR = 0.3  # false alarms in an hour below which a rate is drawn here: none was counted
BREAK = 0.4  # where the axis breaks between no false alarm and one
RATES = (RATE_FLOOR, 1.0, 10.0, 100.0, 1000.0)  # that are named
NO_HIT_N, NO_HIT_BREAK_N = 0.9, 1.3  # where swings without a hit are drawn, and the axis breaks [N]
FORCES = (NO_HIT_N, 3.0, 10.0, 30.0, 100.0)  # that are named [N]
BROKEN: Mapping[str, Any] = {"color": "0.6", "linewidth": 0.6, "linestyle": (0, (2, 2)), "zorder": 0}
BAND_ALPHA = 0.12  # opacity of intervals
MARKER_POINTS = 3.0  # size of a point of a line
RING: Mapping[str, Any] = {"marker": "o", "markersize": 6.5, "markerfacecolor": "none", "markeredgewidth": 0.9}
# Of the second and third detector of a method: marker, and lightness of the colour, -1 for black and 1 for white.
FURTHER = (("v", -0.35), ("X", 0.4))


def detection_curves(
    settings: DetectionCurves, detection: Detection, statistics: Statistics, detections: Detections, figure_dir: Path
) -> None:
    """Write detection_curves.pdf, .png and .csv, which has the area under the curve of found collisions too.

    The area is the probability that a collision's largest signal lies above that of a swing which nothing pushes, with
    the interval of Hanley and McNeil (1982, Radiology 143).
    """
    robots = owners(detections, settings.level, detection.levels)
    leg = settings.leg
    points = rows_of(read_detection(detections, robots, "curves"), leg=leg)
    promises = rows_of(read_detection(detections, robots, "promises"), leg=leg)
    swings = rows_of(read_detection(detections, robots, "swings"), leg=leg)
    held_out = rows_of(swings, scenario=detection.random, part=HELD_OUT)
    between = rows_of(swings, part=UNPUSHED)
    every_hit = rows_of(read_hits(detections, robots), leg=leg)
    hits = rows_of(every_hit, scenario=detection.collisions, kind=COLLISION)
    sweep = rows_of(every_hit, scenario=detection.sweep, kind=settings.kind)
    areas: list[dict[str, object]] = []
    points_of: list[dict[str, object]] = []
    for name in settings.detectors:
        hit = rows_of(hits, detector=name)
        if hit.empty:
            continue
        quiet = rows_of(held_out, detector=name)
        hours = len(quiet) * hours_per_swing(rows_of(promises, detector=name))
        of_detector = rows_of(points, detector=name)
        points_of += _over_rates(name, of_detector, quiet, hours, statistics)
        promised_per_h = detection.thresholds.rates_per_h[COLLISION]
        points_of += _at_promise(name, of_detector, quiet, hours, promised_per_h, statistics)
        points_of += _over_force(name, rows_of(sweep, detector=name), settings.force_bins, statistics)
        points_of.append(_without_hit(name, rows_of(between, detector=name), statistics))
        area = area_of(hit["ratio"].to_numpy(), quiet["ratio"].to_numpy(), statistics)
        areas.append(_point(AREA, name, None, area, len(hit)))
    rows = pd.DataFrame([*areas, *points_of], columns=list(COLUMNS)).assign(level=settings.level)
    save_figure(draw_courses(rows), figure_dir / "detection_curves", COLUMNS, records_of(rows, COLUMNS))


def _point(panel: str, detector: str, x: float | None, number: Number, count: int) -> dict[str, object]:
    """Return a point of a line, made of so many collisions: `COLUMNS` without the level."""
    unit = "ms" if panel.startswith(DELAY) else "-"
    return {**fields_of(number), "panel": panel, "detector": detector, "x": x, "count": count, "unit": unit}


def _over_rates(
    name: str, points: pd.DataFrame, quiet: pd.DataFrame, hours: float, statistics: Statistics
) -> list[dict[str, object]]:
    """Return the found share and the mean delay [ms] at multiples of the thresholds, over the false alarms [1/h].

    The points are those of all robots.
    """
    factors = sorted(points["factor"].unique().tolist())
    factors = [factor for factor in factors if alarms_in(quiet, factor) <= RATE_MOST * hours]
    quiet_at = next((k for k, factor in enumerate(factors) if not alarms_in(quiet, factor)), len(factors))
    factors = factors[: quiet_at + 1]  # higher thresholds only find less
    shares: list[dict[str, object]] = []
    delays: list[dict[str, object]] = []
    for factor in factors:
        rate = _rate(quiet, factor, hours)
        share, delay, count = _at_factor(points, factor, statistics)
        shares.append(_point(FOUND, name, rate, share, count))
        delays.append(_point(DELAY, name, rate, delay, count))
    return [*shares, *delays]


def _at_promise(
    name: str,
    points: pd.DataFrame,
    quiet: pd.DataFrame,
    hours: float,
    promised_per_h: float,
    statistics: Statistics,
) -> list[dict[str, object]]:
    """Return the found share and the mean delay [ms] by the thresholds for a promised rate, at what was counted [1/h].

    The points are those of all robots; the nearest multiple of the thresholds to 1 counts.
    """
    nearest = min(points["factor"].unique().tolist(), key=lambda factor: abs(np.log(factor)))
    share, delay, count = _at_factor(points, nearest, statistics)
    rate = _rate(quiet, nearest, hours)
    return [
        _point(SET[FOUND].format(promised_per_h), name, rate, share, count),
        _point(SET[DELAY].format(promised_per_h), name, rate, delay, count),
    ]


def _rate(quiet: pd.DataFrame, factor: float, hours: float) -> float:
    """Return the false alarms at a multiple of the thresholds [1/h]."""
    return alarms_in(quiet, factor) / hours if hours else 0.0


def _at_factor(points: pd.DataFrame, factor: float, statistics: Statistics) -> tuple[Number, Number, int]:
    """Return found share [-] and mean delay [ms] at a multiple of the thresholds, and of how many collisions."""
    at_factor = rows_of(points, factor=factor)
    found_count = int(at_factor["found"].sum())
    late = MS * float(at_factor["delay_sum_s"].sum()) / found_count if found_count else None
    flags, places = found_at(at_factor)
    return share_in(flags, places, statistics), Number(late, unit="ms"), len(flags)


def _without_hit(name: str, swings: pd.DataFrame, statistics: Statistics) -> dict[str, object]:
    """Return the share of the swings without a hit in which a detector has an alarm, by the paper's rule."""
    alarms = swings.assign(alarm=swings["ratio_largest"] > 1.0)
    return _point(NO_HIT, name, 0.0, share("alarm", statistics)(alarms), len(alarms))


def _over_force(name: str, hits: pd.DataFrame, bins: int, statistics: Statistics) -> list[dict[str, object]]:
    """Return the found share in bins of the largest force with as many collisions each, over their mean force [N]."""
    ordered = hits.sort_values("force_n", kind="stable")
    parts = [ordered.iloc[rows] for rows in np.array_split(np.arange(len(ordered)), bins) if len(rows)]
    points: list[dict[str, object]] = []
    for part in parts:
        force_n = float(part["force_n"].mean())
        points.append(_point(FORCE, name, force_n, share("found", statistics)(part), len(part)))
    return points


def area_of(hits: np.ndarray, quiet: np.ndarray, statistics: Statistics) -> Number:
    """Return the area under the curve of collisions (n,) against swings that nothing pushes (m,) [-]."""
    if not len(hits) or not len(quiet):
        return Number(None)
    from scipy.stats import norm, rankdata  # here, as it takes a second to import

    n = len(hits)
    m = len(quiet)
    area = float((rankdata(np.concatenate([hits, quiet]))[:n].sum() - n * (n + 1) / 2) / (n * m))
    two_collisions = area / (2 - area)
    two = 2 * area**2 / (1 + area)
    variance = (area * (1 - area) + (n - 1) * (two_collisions - area**2) + (m - 1) * (two - area**2)) / (n * m)
    reach = float(norm.ppf((1.0 + statistics.confidence) / 2.0)) * max(variance, 0.0) ** 0.5
    return Number(area, max(area - reach, 0.0), min(area + reach, 1.0))


@styled
def draw_courses(rows: pd.DataFrame) -> Figure:
    """Draw the three panels side by side, those over false alarms with a break left of which none was counted.

    Of the found share over false alarms the first and the last detector have their intervals. The rows have columns
    `COLUMNS`.
    """
    rows = rows[rows["panel"] != AREA]
    styles = looks_of(rows["detector"].unique())
    named = list(styles)
    banded = {*named[:1], *named[-1:]}  # of more bands nothing is seen
    figure, axes = beside(len(LABELS), HEIGHT_INCH, width_ratios=WIDTHS)
    for k, (panel, axis) in enumerate(zip(LABELS, axes, strict=True)):
        for name, look in styles.items():
            of_detector = rows_of(rows, detector=name)
            line = rows_of(of_detector, panel=panel)
            if len(line):
                _draw(axis, line, look, is_banded=name in banded)
            for point in of_detector[of_detector["panel"].str.startswith(f"{panel} at ")].to_dict("records"):
                _ring(axis, point, look)
            for point in rows_of(of_detector, panel=NO_HIT).to_dict("records") if panel == FORCE else ():
                _mark(axis, NO_HIT_N, point, look)
        axis.set(xlabel=LABELS[panel][0], ylabel=LABELS[panel][1], xscale="log")
        axis.minorticks_off()
        first = "none" if panel == FORCE else "0"
        ticks = FORCES if panel == FORCE else RATES
        axis.set_xticks(ticks, [first, *(f"{tick:g}" for tick in ticks[1:])])
        axis.axvline(NO_HIT_BREAK_N if panel == FORCE else BREAK, **BROKEN)
        axis.set_ylim(0.0, None if panel == DELAY else 1.05)
        entitle(axis, k, panel)
    rates = {name.rpartition(" ")[2] for name in rows["panel"].unique() if name.startswith(f"{DELAY} at ")}
    keys = [Line2D([], [], linestyle="", label=f"thresholds for {rate}", **RING, color="0.3") for rate in rates]
    axes[1].legend(handles=keys, loc="lower left", frameon=False, handletextpad=0.2, borderpad=0.0)
    legend(figure, axes[:1], columns=4)
    return figure


def looks_of(detectors: Iterable[str]) -> dict[str, Look]:
    """Return the looks of detectors: the first one of a method has the method's, others differ in marker and shade."""
    looks = dict[str, Look]()
    seen = Counter[str]()
    for name in dict.fromkeys(detectors):
        method = max((known for known in LOOKS if name.startswith(known)), key=len)
        look = LOOKS[method]
        if seen[method]:
            marker, lightness = FURTHER[seen[method] - 1]
            look = replace(look, marker=marker, colour=shaded(look.colour, lightness))
        looks[name] = look
        seen[method] += 1
    return looks


def shaded(colour: str, lightness: float) -> str:
    """Return a colour mixed with white, or with black where the lightness is below zero."""
    rgb = np.array(to_rgb(colour))
    mixed = rgb + abs(lightness) * (float(lightness > 0.0) - rgb)
    return to_hex(tuple(mixed.tolist()))


def _draw(axis: Axes, line: pd.DataFrame, look: Look, *, is_banded: bool) -> None:
    """Draw a line with its intervals, where it has any: bars at the forces, bands over the rates where it has one."""
    is_force = line["panel"].iloc[0] == FORCE
    mean = line["value"].to_numpy(dtype=np.float64)
    low, high = (line[name].astype(float).fillna(line["value"].astype(float)).to_numpy() for name in ("low", "high"))
    at = line["x"].to_numpy(dtype=np.float64)
    x = at if is_force else np.maximum(at, RATE_FLOOR)
    axis.plot(x, mean, marker=look.marker, markersize=MARKER_POINTS, label=line["detector"].iloc[0], **look.line)
    if is_force:
        axis.vlines(x, low, high, color=look.colour, linewidth=0.6, alpha=0.7, zorder=look.order)
    elif is_banded:
        axis.fill_between(x, low, high, color=look.colour, alpha=BAND_ALPHA, linewidth=0.0)


def _ring(axis: Axes, point: Mapping[Any, Any], look: Look) -> None:
    """Draw a ring around where the thresholds for a promised rate are, at the rate that was counted."""
    if not is_missing(point["value"]):
        axis.plot(max(point["x"], RATE_FLOOR), point["value"], color=look.colour, zorder=4, **RING)


def _mark(axis: Axes, x: float, point: Mapping[Any, Any], look: Look) -> None:
    """Draw a single number with its interval at a place."""
    mean, low, high = np.array(number_from(point).range, dtype=np.float64)
    axis.plot(x, mean, marker=look.marker, markersize=MARKER_POINTS, color=look.colour, zorder=look.order)
    axis.vlines(x, low, high, color=look.colour, linewidth=0.6, alpha=0.7, zorder=look.order)
