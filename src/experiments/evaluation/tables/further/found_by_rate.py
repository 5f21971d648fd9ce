"""Collisions that detectors find at wanted rates of false alarms: what lower thresholds are worth."""

from collections.abc import Mapping, Sequence
from math import isnan
from pathlib import Path

import numpy as np
import pandas as pd

from experiments.evaluation.measure.detection.results import (
    ALL,
    at_counted_rate,
    found_at,
    hits_of,
    hours_per_swing,
    only_one,
    read_of_leg,
    sign_test,
)
from experiments.evaluation.number.frames import rows_of
from experiments.evaluation.number.laws import fields_of, mean, measured, share
from experiments.evaluation.number.number import Number
from experiments.evaluation.tables.look import Row, ShownColumn, TableLook, percent_text, write_look
from experiments.intervals.clusters import ClusterKey, share_in
from experiments.plan.detection import Detections
from experiments.records.collisions import UNPUSHED
from experiments.settings.detection_tables import FoundByRate
from experiments.settings.runs import Statistics
from experiments.settings.table_columns import DETECTION
from mobnet.core.detections import COLLISION, HELD_OUT
from mobnet.settings.detection import Detection

FOUND = "found"
DELAY = "delay"
COUNTED = "found at a counted rate"
FIRST_ONLY, THIS_ONLY = "reference alone", "this alone"  # numbers of collisions
CHANCE = "sign test"
PREFERRED = "reference's share"  # of the collisions that only one of both finds
LEAST_CHANCE = 0.01  # that is written out
MEASURED = "counted"  # rule of thresholds at which a rate of false alarms was counted
PLACE = ["level", "detector", "leg", "kind", "cell"]


def found_by_rate(
    settings: FoundByRate, detection: Detection, statistics: Statistics, detections: Detections, table_dir: Path
) -> None:
    """Write found_by_rate.csv, .tex and .md: shares of collisions that are found [-], and mean delays [ms].

    Thresholds are those for each wanted rate of false alarms in random walking, and those at which a rate was counted.
    Collision by collision the reference of section `found_by_rate` is compared with each other detector, robot by robot
    and together, with the exact probability of such a difference by chance. A sentence says of each level what the
    rates are worth with the detector that finds most at the lowest one, and with that of section `found_by_rate`.
    """
    rates = dict(sorted(detection.thresholds.rates_per_h.items(), key=lambda row: row[1]))
    hits = hits_of(settings, detections, detection.collisions, list(rates)).assign(cell=ALL)
    shares_found = measured(hits, PLACE, {FOUND: share("found", statistics)})
    late = measured(hits, PLACE, {DELAY: mean("delay_ms", "ms", statistics)}, of="found")
    by_rate = pd.concat([shares_found, late]).sort_index(kind="stable")
    at_collisions = hits[hits["kind"] == COLLISION]
    tried = at_collisions[["level", "detector"]].drop_duplicates()
    counted = counted_of(settings, detection, statistics, detections, tried)
    parts: list[pd.DataFrame] = [by_rate]
    for (level, name), of_detector_at in at_collisions.groupby(["level", "detector"], observed=True):
        parts.append(rows_of(counted, level=level, detector=name))
        reference = rows_of(at_collisions, level=level, detector=settings.reference)
        if name != settings.reference and len(reference):
            parts.append(pairs_of(reference, of_detector_at, statistics))
    rows = pd.concat(parts, ignore_index=True)
    sentences: list[str] = []
    for level, of_level in shares_found.groupby("level", observed=True):
        shares = of_level.pivot(index="detector", columns="kind", values="value")
        by_detector = {str(name): row.to_list() for name, row in shares.iterrows()}
        gain = gain_text(list(rates.values()), by_detector, settings.beside)
        sentences.append(f"{str(level).replace('_', ' ').capitalize()}: {gain}")
    confidence = f"{statistics.confidence:.0%}"
    shown: list[ShownColumn] = []
    # A page has room for the interval and the delay of one rate; the CSV file has all of them.
    for kind, rate in rates.items():
        ends = confidence if kind == COLLISION else ""
        shown.append(ShownColumn(f"at {rate:g}/h", {"kind": kind, "quantity": FOUND}, ends=ends))
        if kind == COLLISION:
            shown.append(ShownColumn("delay [ms]", {"kind": kind, "quantity": DELAY}, digits=1))
    of_pairs = {"kind": COLLISION, "cell": ALL}
    shown += [
        ShownColumn(f"at {settings.counted_per_h:g}/h counted", {"quantity": COUNTED}, ends=confidence),
        ShownColumn("reference alone", {**of_pairs, "quantity": FIRST_ONLY}, digits=0),
        ShownColumn("this alone", {**of_pairs, "quantity": THIS_ONLY}, digits=0),
        ShownColumn("by chance", {**of_pairs, "quantity": CHANCE}, text=_chance_text),
    ]
    look = TableLook({"level": "Level", "detector": "Detector"}, shown, blocks=("level",), note=" ".join(sentences))
    write_look(table_dir / "found_by_rate", rows, DETECTION, look)


def counted_of(
    settings: FoundByRate, detection: Detection, statistics: Statistics, detections: Detections, tried: pd.DataFrame
) -> pd.DataFrame:
    """Return the share that a detector finds at the lowest thresholds with at most a counted rate of false alarms.

    It is that of each level and detector of `tried`.
    """
    swings = read_of_leg(settings, detections, "swings")
    is_random = (swings["part"] == HELD_OUT) & (swings["scenario"] == detection.random)
    quiet = swings[(swings["part"] == UNPUSHED) | is_random]
    promises = read_of_leg(settings, detections, "promises")
    curves = read_of_leg(settings, detections, "curves")
    rows: list[dict[str, object]] = []
    for level, name in tried.itertuples(index=False):
        of_detector = {"level": level, "detector": name}
        calm, promised, points = (rows_of(frame, **of_detector) for frame in (quiet, promises, curves))
        hours = len(calm) * hours_per_swing(promised)
        flags, places = found_at(at_counted_rate(points, calm, hours, settings.counted_per_h))
        place = {**of_detector, "leg": settings.leg, "kind": MEASURED, "cell": ALL, "quantity": COUNTED}
        rows.append({**place, **fields_of(share_in(flags, places, statistics)), "count": len(flags)})
    return pd.DataFrame(rows)


def pairs_of(reference: pd.DataFrame, tried: pd.DataFrame, statistics: Statistics) -> pd.DataFrame:
    """Return how many collisions the reference alone and a detector alone find, robot by robot and together.

    Of those that only one of both finds stands the share of the reference, with an interval over robots.
    """
    pairs = only_one(reference, tried)
    preferred = preferred_share(pairs, statistics)
    discordant = int(pairs.to_numpy().sum())
    pairs.loc[ALL] = pairs.sum()
    place = dict(tried[["level", "detector", "leg", "kind"]].iloc[0])
    rows: list[dict[str, object]] = []
    for cell, first, second in pairs.itertuples():
        numbers = {FIRST_ONLY: float(first), THIS_ONLY: float(second), CHANCE: sign_test(first, second)}
        counts = {FIRST_ONLY: len(tried), THIS_ONLY: len(tried), CHANCE: first + second}
        for quantity, value in numbers.items():
            number = fields_of(Number(value))
            rows.append({**place, "cell": cell, "quantity": quantity, **number, "count": counts[quantity]})
    rows.append({**place, "cell": ALL, "quantity": PREFERRED, **fields_of(preferred), "count": discordant})
    return pd.DataFrame(rows)


def preferred_share(pairs: pd.DataFrame, statistics: Statistics) -> Number:
    """Return the share of collisions that the first detector finds of those that only one finds, robot by robot [-]."""
    flags: list[bool] = []
    places: list[ClusterKey] = []
    for robot, first, second in pairs.itertuples():
        flags += [True] * first + [False] * second
        places += [ClusterKey(robot, 0)] * (first + second)
    return share_in(flags, places, statistics)


def _chance_text(row: Row) -> str:
    return chance_text(row["value"])


def chance_text(chance: float | None) -> str:
    """Return a probability as text [-], small ones as a bound."""
    if chance is None or isnan(chance):
        return "-"
    return f"{chance:.2f}" if chance >= LEAST_CHANCE else f"< {LEAST_CHANCE:g}"


def gain_text(rates: Sequence[float], shares: Mapping[str, Sequence[float]], beside: str) -> str:
    """Return what rates of false alarms [1/h] are worth with the best detector, and with another one where it ran.

    `shares` leads from a detector to the share that it finds at each rate [-].
    """
    best = max(shares, key=lambda name: np.nan_to_num(shares[name]).tolist())
    accepted = listed([f"{rate:g}" for rate in rates])
    texts = {name: listed(list(map(percent_text, shares[name]))) for name in (best, beside) if name in shares}
    text = f"whoever accepts {accepted} false alarms of a leg in an hour of random walking finds {texts[best]} % of"
    other = f"; {beside} finds {texts[beside]} %" if beside in texts else ""
    return f"{text} these collisions with {best}, the detector that finds most at {rates[0]:g}{other}."


def listed(words: Sequence[str]) -> str:
    """Return alternatives as text: `1, 10 or 60`."""
    return f"{', '.join(words[:-1])} or {words[-1]}" if len(words) > 1 else words[0]
