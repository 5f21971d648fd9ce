"""Table 9: collisions of a leg that detectors find, and how late."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import product
from pathlib import Path

from experiments.evaluation.measure.detection.results import (
    ALL,
    CELLS,
    MS,
    Detections,
    Try,
    delay_of,
    force_text,
    found_share,
    half_force,
    mean_of,
    shown_tries,
)
from experiments.evaluation.number.number import Number, number_text, published_row
from experiments.evaluation.number.rows import Field
from experiments.evaluation.tables.layout import PART, RULE, Line, Table, text_table, write_table
from experiments.settings.detection_tables import ReadingTable, SmallestForce
from experiments.settings.published import PublishedTable
from experiments.settings.runs import Statistics
from mobnet.core.columns import DETECTION
from mobnet.core.detections import READINGS
from mobnet.settings.detection import Detection

FOUND = "found"
DELAY = "delay"
ONSET = "delay_onset"
PERFECT = "perfect_delay"
HALF_FORCE = "half_force"  # quantity of the pushes of all sizes
DETECTED, DELAY_MS = "detected", "delay_ms"  # places of the paper's numbers
TRIED = 10  # collisions of each cell in the paper
Tries = Mapping[str, Sequence[Try]]  # by detector


def table_09(
    settings: ReadingTable,
    smallest_force: SmallestForce,
    detection: Detection,
    statistics: Statistics,
    published: PublishedTable,
    detections: Detections,
    table_dir: Path,
) -> None:
    """Write table_09.csv, .tex and .md: found collisions, and delays [ms], with intervals over robots.

    A delay is the mean of a cell over the collisions that are found; of all together it is that of the cells, as the
    paper's, and beside it that over all found collisions. `perfect` is the delay of an estimate without error at the
    same thresholds, on the same collisions. Totals near all collisions rank no detectors: beside them is the force of
    which one half is found, from pushes of all sizes. Rows of a level are by each rule of thresholds.
    """
    rows: list[Sequence[Field]] = []
    lines: list[Line] = []
    taus: list[str] = []
    force_taus: list[str] = []
    tried: dict[tuple[str, str], tuple[Tries, Tries]] = {}  # level, rule -> collisions, and pushes of all sizes
    for kind in settings.kinds:
        swept = dict(shown_tries(settings, detections, detection.sweep, kind))
        for level, shown in shown_tries(settings, detections, detection.collisions, kind):
            tried[level, kind] = shown, swept[level]
    for level, kind in product(settings.levels, settings.kinds):
        shown, swept_here = tried[level, kind]
        title = f"{level.replace('_', ' ')}, {READINGS.get(kind, kind)}"
        lines += [RULE] if lines else []
        halves: dict[str, Number] = {}
        for name, own in shown.items():
            of_all_sizes = swept_here.get(name, [])
            halves[name] = half_force(of_all_sizes, smallest_force, statistics)
            place = level, name, settings.leg, kind
            rows += _rows(place, own, statistics, published)
            rows.append((*place, ALL, HALF_FORCE, *halves[name].with_ends, len(of_all_sizes), "N", None))
            lines += _lines(title, name, own, halves[name], statistics, published)
        shares = {name: len([one for one in own if one.is_found]) / len(own) for name, own in shown.items()}
        weakness = {name: -_rank(number) for name, number in halves.items() if swept_here.get(name)}
        taus.append(f"{order_text(shares, published)} ({title})")
        force_taus.append(f"{order_text(weakness, published)} ({title})")
    cells = list(map(_initials, CELLS))
    leading = ["Level, normal walking", "Detector", ""]
    found = [*cells, "all", f"{statistics.confidence:.0%}", "half [N]"]
    delays = [*(f"{cell} [ms]" for cell in cells), "cells", "found", "perfect", "from onset"]
    note = (
        "F, A, K: foot, ankle, knee; F, S: front, side. "
        f"Kendall's tau of the order of the found totals against the original's: {', '.join(taus)}; "
        f"of the forces of which half are found: {', '.join(force_taus)}."
    )
    # in TeX all columns side by side are wider than a page: what is found stands above how late
    end = len(leading) + len(found)
    found_lines = [line if isinstance(line, str) else line[:end] for line in lines]
    delay_lines = [line if isinstance(line, str) else [*line[: len(leading)], *line[end:]] for line in lines]
    above = text_table("lll" + "r" * len(found), [*leading, *found], found_lines)
    below = text_table("lll" + "r" * len(delays), [*leading, *delays], delay_lines)
    table = Table(DETECTION, rows, [*leading, *found, *delays], lines, left=len(leading), note=note)
    write_table(table_dir / "table_09", table, above + PART + below)


def _initials(cell: str) -> str:
    return " ".join(word[0].upper() for word in cell.split())


def order_text(strengths: Mapping[str, float], published: PublishedTable) -> str:
    """Return Kendall's tau of the order of detectors, weakest first, against that of the paper's totals, as text."""
    from scipy.stats import kendalltau  # here, as it takes a second to import

    totals = {name: row[ALL] for name in strengths if (row := published_row(published, DETECTED, name))}
    ours = [strengths[name] for name in totals]
    return number_text(float(kendalltau(ours, list(totals.values())).statistic) if len(ours) > 1 else None)


def _rank(force: Number) -> float:
    """Return a force [N], or that it lies below or above all that were tried."""
    if force.value is not None:
        return force.value
    return 0.0 if force.low is not None else float("inf")


def _in_cells(tries: Sequence[Try]) -> dict[str, list[Try]]:
    found = {}
    for cell in CELLS:
        found[cell] = [one for one in tries if one.cell == cell]
    return found


def _onset_delay(one: Try) -> float | None:
    """Return the delay from when the force exceeds that of the second definition of a beginning [s]."""
    late = one.detected.delay_s
    onset = one.collision.onset_s
    return None if late is None or onset is None else late - (onset - one.collision.start_s)


DELAYS: Mapping[str, Callable[[Try], float | None]] = {  # of a collision that was found [s]
    DELAY: delay_of,
    ONSET: _onset_delay,
    PERFECT: lambda one: one.detected.perfect_s,
}


def _delays(tries: Sequence[Try], quantity: str = DELAY) -> list[float]:
    """Return delays of the collisions that were found [ms], one of `DELAYS`."""
    found = [DELAYS[quantity](one) for one in tries if one.is_found]
    return [MS * delay for delay in found if delay is not None]


def _rows(
    detector: tuple[str, str, str, str], tries: Sequence[Try], statistics: Statistics, published: PublishedTable
) -> Iterator[Sequence[Field]]:
    """Yield the rows of a detector, which is told by level, name, leg and rule of thresholds."""
    printed = {place: published_row(published, place, detector[1]) for place in (DETECTED, DELAY_MS)}
    for cell, own in {**_in_cells(tries), ALL: list(tries)}.items():
        place = *detector, cell
        count = TRIED * (len(CELLS) if cell == ALL else 1)
        of_paper = printed[DETECTED].get(cell)
        found = found_share(own, statistics)
        share = None if of_paper is None else of_paper / count
        yield (*place, FOUND, *found.with_ends, len(own), "-", share)
        for quantity, delay in DELAYS.items():
            values = _delays(own, quantity)
            number = mean_of([one for one in own if one.is_found], delay, statistics)
            paper = printed[DELAY_MS].get(cell) if quantity == DELAY and cell != ALL else None
            yield (*place, quantity, *number.with_ends, len(values), "ms", paper)
    # The paper's average is that of its four cells, however many collisions each of them found.
    cells = [mean for own in _in_cells(tries).values() if (mean := _mean(_delays(own)))]
    average = sum(cells) / len(cells) if cells else None
    yield (*detector, "cells", DELAY, average, None, None, len(cells), "ms", printed[DELAY_MS].get(ALL))


def _lines(
    title: str, name: str, tries: Sequence[Try], half: Number, statistics: Statistics, published: PublishedTable
) -> Iterator[Line]:
    """Yield what a detector finds in each cell, half of which forces, and how late; below it what the paper prints."""
    in_cells = _in_cells(tries)
    counts = [str(len(_delays(own))) for own in in_cells.values()]
    total = found_share(tries, statistics)
    all_found = f"{len(_delays(tries))}/{len(tries)}"
    means = [_mean(_delays(own)) for own in in_cells.values()]
    known = [mean for mean in means if mean is not None]
    further = [_mean(known), *(_mean(_delays(tries, quantity)) for quantity in (DELAY, PERFECT, ONSET))]
    delays = [number_text(mean, 1) for mean in (*means, *further)]
    yield [title, name, "ours", *counts, all_found, total.interval(), force_text(half), *delays]
    printed, late = (published_row(published, place, name) for place in (DETECTED, DELAY_MS))
    if printed and late:
        weighted = [(printed[cell] or 0.0, late[cell]) for cell in CELLS]
        found = sum(count for count, _ in weighted)
        mean = sum(count * (delay or 0.0) for count, delay in weighted) / found if found else None
        numbers = [number_text(printed[cell], 0) for cell in CELLS]
        total_text = f"{number_text(printed[ALL], 0)}/{TRIED * len(CELLS)}"
        paper = [number_text(late[cell], 1) for cell in (*CELLS, ALL)]
        yield ["", "", "original", *numbers, total_text, "", "", *paper, number_text(mean, 1), "", ""]


def _mean(values: Sequence[float]) -> float | None:
    return sum(values) / len(values) if values else None
