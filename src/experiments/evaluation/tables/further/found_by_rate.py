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
from experiments.evaluation.number.files import Field
from experiments.evaluation.number.number import Number
from experiments.evaluation.tables.layout import Table, in_blocks, percent, write_table
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
    rows: list[Sequence[Field]] = []
    blocks: list[tuple[list[str], list[list[str]]]] = []
    sentences: list[str] = []
    for level in settings.levels:
        shares = dict[str, list[Number]]()
        lines = list[list[str]]()
        for name in tries[rates[0][0]][level]:
            lines.append([name])
            for kind, _ in rates:
                own = tries[kind][level][name]
                found = found_share(own, statistics)
                late = mean_of(own, delay_of, statistics)
                place = level, name, settings.leg, kind, ALL
                rows.append((*place, FOUND, *found.with_ends, len(own), "-", None))
                rows.append((*place, DELAY, *late.with_ends, sum(one.is_found for one in own), "ms", None))
                lines[-1] += [found.text(), found.interval(), late.text(1)]
                shares.setdefault(name, []).append(found)
        shown = level.replace("_", " ")
        blocks.append(([shown], lines))
        if shares:
            sentences.append(f"{shown.capitalize()}: {gain_text([rate for _, rate in rates], shares, settings.beside)}")
    share = f"{statistics.confidence:.0%}"
    heads: list[str] = []
    for _, rate in rates:
        heads += [f"found at {rate:g}/h", share, "delay [ms]"]
    table = Table(DETECTION, rows, ["Level", "Detector", *heads], in_blocks(blocks), left=2, note=" ".join(sentences))
    write_table(table_dir / "found_by_rate", table)


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
