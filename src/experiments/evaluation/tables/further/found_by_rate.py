"""Collisions that detectors find at wanted rates of false alarms: what lower thresholds are worth."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from experiments.evaluation.measure.detection.results import (
    ALL,
    Detections,
    Try,
    at_counted_rate,
    delay_of,
    found_share,
    hours_per_swing,
    mean_of,
    only_one,
    owners,
    rows_of,
    shown_tries,
    sign_test,
)
from experiments.evaluation.number.clusters import ClusterKey, share_in
from experiments.evaluation.number.number import Number
from experiments.evaluation.number.rows import Field
from experiments.evaluation.tables.layout import percent
from experiments.evaluation.tables.rows import Rows, View, ViewColumn
from experiments.settings.detection_tables import FoundByRate
from experiments.settings.runs import Statistics
from mobnet.core.columns import DETECTION
from mobnet.core.detections import COLLISION, HELD_OUT, UNPUSHED, CurvePoint, FreeSwing, Promise
from mobnet.settings.detection import Detection

FOUND = "found"
DELAY = "delay"
COUNTED = "found at a counted rate"
FIRST_ONLY, THIS_ONLY = "reference alone", "this alone"  # numbers of collisions
CHANCE = "sign test"
LEAST_CHANCE = 0.01  # that is written out
MEASURED = "counted"  # rule of thresholds at which a rate of false alarms was counted
Shares = Mapping[str, Sequence[Number]]  # detector -> found shares at each rate [-]


def found_by_rate(
    settings: FoundByRate, detection: Detection, statistics: Statistics, detections: Detections, table_dir: Path
) -> None:
    """Write found_by_rate.csv, .tex and .md: shares of collisions that are found [-], and mean delays [ms].

    Thresholds are those for each wanted rate of false alarms in random walking, and those at which a rate was counted.
    Collision by collision the reference of section `found_by_rate` is compared with each other detector, robot by robot
    and together, with the exact probability of such a difference by chance. A sentence says of each level what the
    rates are worth with the detector that finds most at the lowest one, and with that of section `found_by_rate`.
    """
    rates = sorted(detection.thresholds.rates_per_h.items(), key=lambda row: row[1])
    tries = {kind: dict(shown_tries(settings, detections, detection.collisions, kind)) for kind, _ in rates}
    rows = Rows(DETECTION)
    for level in settings.levels:
        for name in tries[rates[0][0]][level]:
            for kind, _ in rates:
                own = tries[kind][level][name]
                place = {"level": level, "detector": name, "leg": settings.leg, "kind": kind, "cell": ALL}
                late = mean_of(own, delay_of, statistics)
                rows.add(found_share(own, statistics), **place, quantity=FOUND, count=len(own))
                rows.add(late, **place, quantity=DELAY, count=sum(one.is_found for one in own))
    for level in settings.levels:
        own = tries[COLLISION][level]
        names = owners(detections, level, settings.levels)
        for name, tried in own.items():
            place = {"level": level, "detector": name, "leg": settings.leg}
            _add_counted(rows, place, settings, detection, statistics, {robot: detections[robot] for robot in names})
            if name != settings.reference and settings.reference in own:
                _add_pairs(rows, place, own[settings.reference], tried)
    sentences: list[str] = []
    for level in settings.levels:
        shares = dict[str, list[Number]]()
        for name in tries[rates[0][0]][level]:
            shares[name] = [rows.number(level=level, detector=name, kind=kind, quantity=FOUND) for kind, _ in rates]
        if shares:
            gain = gain_text([rate for _, rate in rates], shares, settings.beside)
            sentences.append(f"{level.replace('_', ' ').capitalize()}: {gain}")
    share = f"{statistics.confidence:.0%}"
    columns: list[ViewColumn] = []
    # A page has room for the interval and the delay of one rate; the CSV file has all of them.
    for kind, rate in rates:
        ends = share if kind == COLLISION else ""
        columns.append(ViewColumn(f"at {rate:g}/h", {"kind": kind, "quantity": FOUND}, ends=ends))
        if kind == COLLISION:
            columns.append(ViewColumn("delay [ms]", {"kind": kind, "quantity": DELAY}, digits=1))
    of_pairs = {"kind": COLLISION, "cell": ALL}
    columns += [
        ViewColumn(f"at {settings.counted_per_h:g}/h counted", {"quantity": COUNTED}, ends=share),
        ViewColumn("reference alone", {**of_pairs, "quantity": FIRST_ONLY}, digits=0),
        ViewColumn("this alone", {**of_pairs, "quantity": THIS_ONLY}, digits=0),
        ViewColumn("by chance", {**of_pairs, "quantity": CHANCE}, text=lambda row: chance_text(row.number.value)),
    ]
    labels = {"level": "Level", "detector": "Detector"}
    view = View(labels, columns, blocks=("level",), note=" ".join(sentences))
    rows.write(table_dir / "found_by_rate", view)


def _add_counted(
    rows: Rows,
    place: Mapping[str, Field],
    settings: FoundByRate,
    detection: Detection,
    statistics: Statistics,
    robots: Detections,
) -> None:
    """Add the share that a detector finds at the lowest thresholds with at most a counted rate of false alarms."""
    held = {"detector": place["detector"], "leg": settings.leg}
    points: dict[str, list[CurvePoint]] = {}
    quiet: list[FreeSwing] = []
    promises: list[Promise] = []
    for robot in robots:
        points[robot] = rows_of(robots, [robot], "curves", CurvePoint, **held)
        swings = rows_of(robots, [robot], "swings", FreeSwing, **held)
        quiet += [row for row in swings if row.part == UNPUSHED]
        quiet += [row for row in swings if (row.part, row.scenario) == (HELD_OUT, detection.random)]
        promises += rows_of(robots, [robot], "promises", Promise, **held)
    hours = len(quiet) * hours_per_swing(promises)
    flags: list[bool] = []
    walks: list[ClusterKey] = []
    for robot, point in at_counted_rate(points, quiet, hours, settings.counted_per_h).items():
        flags += [True] * point.found + [False] * (point.collisions - point.found)
        # A point is of all walks of a robot together: one cluster.
        walks += [ClusterKey(robot, 0)] * point.collisions
    found = share_in(flags, walks, statistics) if flags else Number(None)
    rows.add(found, **place, kind=MEASURED, cell=ALL, quantity=COUNTED, count=len(flags))


def _add_pairs(rows: Rows, place: Mapping[str, Field], reference: Sequence[Try], tried: Sequence[Try]) -> None:
    """Add how many collisions the reference alone and a detector alone find, robot by robot and together."""
    pairs = only_one(reference, tried)
    firsts = sum(first for first, _ in pairs.values())
    seconds = sum(second for _, second in pairs.values())
    for cell, (first, second) in {**pairs, ALL: (firsts, seconds)}.items():
        cells = {**place, "kind": COLLISION, "cell": cell}
        rows.add(Number(float(first)), **cells, quantity=FIRST_ONLY, count=len(tried))
        rows.add(Number(float(second)), **cells, quantity=THIS_ONLY, count=len(tried))
        rows.add(Number(sign_test(first, second)), **cells, quantity=CHANCE, count=first + second)


def chance_text(chance: float | None) -> str:
    """Return a probability as text [-], small ones as a bound."""
    if chance is None:
        return "-"
    return f"{chance:.2f}" if chance >= LEAST_CHANCE else f"< {LEAST_CHANCE:g}"


def gain_text(rates: Sequence[float], shares: Shares, beside: str) -> str:
    """Return what rates of false alarms [1/h] are worth with the best detector, and with another one where it ran."""
    best = max(shares, key=lambda name: [number.value or 0.0 for number in shares[name]])
    accepted = listed([f"{rate:g}" for rate in rates])
    found = {name: listed(list(map(percent, shares[name]))) for name in (best, beside) if name in shares}
    text = f"whoever accepts {accepted} false alarms of a leg in an hour of random walking finds {found[best]} % of"
    other = f"; {beside} finds {found[beside]} %" if beside in found else ""
    return f"{text} these collisions with {best}, the detector that finds most at {rates[0]:g}{other}."


def listed(words: Sequence[str]) -> str:
    """Return alternatives as text: `1, 10 or 60`."""
    return f"{', '.join(words[:-1])} or {words[-1]}" if len(words) > 1 else words[0]
