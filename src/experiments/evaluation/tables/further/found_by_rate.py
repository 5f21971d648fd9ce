"""Collisions that detectors find at wanted rates of false alarms: what lower thresholds are worth."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from experiments.evaluation.measure.detection.results import (
    ALL,
    Detections,
    delay_of,
    found_share,
    mean_of,
    shown_tries,
)
from experiments.evaluation.number.number import Number
from experiments.evaluation.tables.layout import percent
from experiments.evaluation.tables.rows import Rows, View, ViewColumn
from experiments.settings.detection_tables import FoundByRate
from experiments.settings.runs import Statistics
from mobnet.core.columns import DETECTION
from mobnet.settings.detection import Detection

FOUND = "found"
DELAY = "delay"
Shares = Mapping[str, Sequence[Number]]  # detector -> found shares at each rate [-]


def found_by_rate(
    settings: FoundByRate, detection: Detection, statistics: Statistics, detections: Detections, table_dir: Path
) -> None:
    """Write found_by_rate.csv, .tex and .md: shares of collisions that are found [-], and mean delays [ms].

    Thresholds are those for each wanted rate of false alarms in random walking. A sentence says of each level what the
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
    for kind, rate in rates:
        columns.append(ViewColumn(f"found at {rate:g}/h", {"kind": kind, "quantity": FOUND}, ends=share))
        columns.append(ViewColumn("delay [ms]", {"kind": kind, "quantity": DELAY}, digits=1))
    labels = {"level": "Level", "detector": "Detector"}
    view = View(labels, columns, blocks=("level",), note=" ".join(sentences))
    rows.write(table_dir / "found_by_rate", view)


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
