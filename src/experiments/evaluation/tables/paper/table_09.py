"""Table 9: collisions of a leg that detectors find, and how late."""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import pandas as pd

from experiments.evaluation.measure.detection.results import ALL, CELLS, force_text, half_force, hits_of, with_all
from experiments.evaluation.number.frames import records_of, rows_of
from experiments.evaluation.number.laws import mean, measured, share
from experiments.evaluation.number.number import Number, interval_text, is_missing, number_text, published_row
from experiments.evaluation.tables.layout import PART, RULE, Line, Table, text_table, write_table
from experiments.plan.detection import Detections
from experiments.records.collisions import READINGS
from experiments.settings.detection_tables import ReadingTable, SmallestForce
from experiments.settings.published import PublishedTable
from experiments.settings.runs import Statistics
from experiments.settings.table_columns import DETECTION
from mobnet.settings.detection import Detection

FOUND = "found"
DELAY = "delay"
ONSET = "delay_onset"
PERFECT = "perfect_delay"
HALF_FORCE = "half_force"  # quantity of the pushes of all sizes
DETECTED, DELAY_MS = "detected", "delay_ms"  # places of the paper's numbers
TIMES = {DELAY: "delay_ms", ONSET: "onset_ms", PERFECT: "perfect_ms"}  # quantity -> column of hits
TRIED = 10  # collisions of each cell in the paper
IN_CELLS = "cells"  # the mean over cells, in place of a cell
PLACE = ["level", "kind", "detector", "leg"]


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
    hits = hits_of(settings, detections, detection.collisions, settings.kinds)
    sweep = hits_of(settings, detections, detection.sweep, settings.kinds)
    rows = numbers_of(hits, sweep, smallest_force, statistics)
    rows["published"] = [
        printed_value(published, str(row.detector), str(row.cell), str(row.quantity))
        for row in rows.itertuples(index=False)
    ]
    lines: list[Line] = []
    taus: list[str] = []
    force_taus: list[str] = []
    for (level, kind), shown in rows.groupby(["level", "kind"], observed=True):
        title = f"{str(level).replace('_', ' ')}, {READINGS.get(str(kind), kind)}"
        lines += [RULE] if lines else []
        for name, of_detector in shown.groupby("detector", observed=True):
            lines.append([title, str(name), "ours", *our_texts(of_detector)])
            lines += printed_lines(published, str(name))
        totals = rows_of(shown, cell=ALL, quantity=FOUND).set_index("detector")["value"]
        halves = rows_of(shown, cell=ALL, quantity=HALF_FORCE)
        ranks = {str(row.detector): -_rank(row.value, row.low) for row in halves[halves["count"] > 0].itertuples()}
        taus.append(f"{order_text(dict(zip(totals.index.astype(str), totals, strict=True)), published)} ({title})")
        force_taus.append(f"{order_text(ranks, published)} ({title})")
    cells = list(map(_initials, CELLS))
    leading = ["Level, normal walking", "Detector", ""]
    heads = [*cells, "all", f"{statistics.confidence:.0%}", "half [N]"]
    delays = [*(f"{cell} [ms]" for cell in cells), "cells", "found", "perfect", "from onset"]
    note = (
        "F, A, K: foot, ankle, knee; F, S: front, side. "
        f"Kendall's tau of the order of the found totals against the original's: {', '.join(taus)}; "
        f"of the forces of which half are found: {', '.join(force_taus)}."
    )
    # in TeX all columns side by side are wider than a page: what is found stands above how late
    end = len(leading) + len(heads)
    found_lines = [line if isinstance(line, str) else line[:end] for line in lines]
    delay_lines = [line if isinstance(line, str) else [*line[: len(leading)], *line[end:]] for line in lines]
    above = text_table("lll" + "r" * len(heads), [*leading, *heads], found_lines)
    below = text_table("lll" + "r" * len(delays), [*leading, *delays], delay_lines)
    header = [*leading, *heads, *delays]
    table = Table(DETECTION, records_of(rows, DETECTION), header, lines, left=len(leading), note=note)
    write_table(table_dir / "table_09", table, above + PART + below)


def numbers_of(
    hits: pd.DataFrame, sweep: pd.DataFrame, smallest_force: SmallestForce, statistics: Statistics
) -> pd.DataFrame:
    """Return a row for each number of a detector: found shares [-], delays [ms], and forces of half [N] of a sweep."""
    in_cells = with_all(hits)
    by_cell = [measured(in_cells, PLACE, {FOUND: share("found", statistics)}, each="cell")]
    for quantity, column in TIMES.items():
        timed = in_cells.assign(timed=in_cells["found"] & in_cells[column].notna())
        by_cell.append(measured(timed, PLACE, {quantity: mean(column, "ms", statistics)}, each="cell", of="timed"))
    _, delays, *_ = by_cell
    # The paper's average is that of its four cells, however many collisions each of them found.
    averages = delays[delays["cell"] != ALL].groupby(PLACE, observed=True)["value"].agg(["mean", "count"])
    # With the types of the other parts, as a concatenation would else lose the order of detectors.
    averages = averages.reset_index().rename(columns={"mean": "value"}).astype(delays.dtypes[PLACE].to_dict())

    def force(hits_of: pd.DataFrame) -> Number:
        return half_force(hits_of, smallest_force, statistics)

    both = pd.concat([hits.assign(swept=False), sweep.assign(swept=True)])
    halves = measured(both, PLACE, {HALF_FORCE: force}, of="swept")
    parts = [
        pd.concat(by_cell).sort_index(kind="stable"),
        averages.assign(cell=IN_CELLS, quantity=DELAY, unit="ms"),
        halves.assign(cell=ALL),
    ]
    return pd.concat(parts).sort_values(PLACE, kind="stable", ignore_index=True)


def _initials(cell: str) -> str:
    return " ".join(word[0].upper() for word in cell.split())


def order_text(strengths: Mapping[str, float], published: PublishedTable) -> str:
    """Return Kendall's tau of the order of detectors, weakest first, against that of the paper's totals, as text."""
    from scipy.stats import kendalltau  # here, as it takes a second to import

    totals = {name: row[ALL] for name in strengths if (row := published_row(published, DETECTED, name))}
    ours = [strengths[name] for name in totals]
    return number_text(float(kendalltau(ours, list(totals.values())).statistic) if len(ours) > 1 else None)


def _rank(value: Any, low: Any) -> float:
    """Return a force [N], or that it lies below or above all that were tried."""
    if value is None or is_missing(value):
        return float("inf") if is_missing(low) else 0.0
    return value


def printed_value(published: PublishedTable, detector: str, cell: str, quantity: str) -> float | None:
    """Return what the paper prints: a share [-] of a cell or of all, a delay of a cell or the mean of these [ms]."""
    if quantity == FOUND:
        count = published_row(published, DETECTED, detector).get(cell)
        return None if count is None else count / (TRIED * (len(CELLS) if cell == ALL else 1))
    if quantity == DELAY and cell != ALL:
        return published_row(published, DELAY_MS, detector).get(ALL if cell == IN_CELLS else cell)
    return None


def our_texts(rows: pd.DataFrame) -> list[str]:
    """Return what a detector finds in each cell, half of which forces, and how late."""
    delays = rows_of(rows, quantity=DELAY).set_index("cell")
    total = rows_of(rows, quantity=FOUND, cell=ALL).iloc[0]
    half = rows_of(rows, quantity=HALF_FORCE).iloc[0]
    counts = [str(delays.loc[cell, "count"]) for cell in CELLS]
    all_found = f"{delays.loc[ALL, 'count']}/{total['count']}"
    interval = interval_text(total["low"], total["high"])
    late = [*delays.loc[[*CELLS, IN_CELLS, ALL], "value"]]
    late += [rows_of(rows, quantity=quantity, cell=ALL)["value"].iloc[0] for quantity in (PERFECT, ONSET)]
    texts = [number_text(time, 1) for time in late]
    return [*counts, all_found, interval, force_text(half["value"], half["low"], half["high"]), *texts]


def printed_lines(published: PublishedTable, name: str) -> Iterator[Line]:
    """Yield what the paper prints of a detector, if it does."""
    printed, late = (published_row(published, place, name) for place in (DETECTED, DELAY_MS))
    if printed and late:
        weighted = [(printed[cell] or 0.0, late[cell]) for cell in CELLS]
        count_found = sum(count for count, _ in weighted)
        mean_ms = sum(count * (delay or 0.0) for count, delay in weighted) / count_found if count_found else None
        numbers = [number_text(printed[cell], 0) for cell in CELLS]
        total_text = f"{number_text(printed[ALL], 0)}/{TRIED * len(CELLS)}"
        paper = [number_text(late[cell], 1) for cell in (*CELLS, ALL)]
        yield ["", "", "original", *numbers, total_text, "", "", *paper, number_text(mean_ms, 1), "", ""]
