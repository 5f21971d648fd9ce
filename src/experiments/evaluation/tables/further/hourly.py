"""Table of what happens in an hour: falls, and flags of the check on robots that the networks know."""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

import pandas as pd

from experiments.evaluation.measure.estimates.changed import FLAGS, HOUR_S, WATCHED
from experiments.evaluation.number.frames import read_scores, rows_of
from experiments.evaluation.number.laws import fields_of
from experiments.evaluation.number.scored import AVERAGE
from experiments.evaluation.tables.look import ShownColumn, TableLook, column, write_look
from experiments.intervals.single import rate_of
from experiments.settings.measures import Changed
from experiments.settings.runs import LegRuns, Statistics
from experiments.settings.table_columns import HOURLY
from experiments.settings.tables import Hourly
from mobnet.core.notes import read_array_note
from mobnet.core.store import NOTE, file_of

FALL = "fall"
FLAG = "false flag"
ALL = "all of these"
Counted = tuple[str, str, str, float, int]  # event, walks, method, time [h], number of events


def hourly(
    settings: Hourly,
    changed: Changed,
    statistics: Statistics,
    walks: Mapping[str, Sequence[Path]],
    scores: Sequence[Path],
    table_dir: Path,
) -> None:
    """Write hourly.csv, .tex and .md: how often a robot falls and the check is wrong, counted and in an hour [1/h]."""
    tests = {title: changed.tests[title] for title in settings.known}
    rows: list[dict[str, object]] = []
    for event, walked, method, hours, count in (*falls(walks), *flags(read_scores(*scores), tests)):
        rate = fields_of(rate_of(count, hours, statistics))
        rows.append({**rate, "event": event, "walks": walked, "method": method, "hours": hours, "count": count})
    shown = [
        ShownColumn("Hours", text=column("hours", ".2f")),
        ShownColumn("Events", text=column("count")),
        ShownColumn("In an hour", ends=f"{statistics.confidence:.0%}"),
    ]
    labels = {"event": "Event", "walks": "Walks", "method": "Method"}
    write_look(table_dir / "hourly", pd.DataFrame(rows), HOURLY, TableLook(labels, shown))


def falls(walks: Mapping[str, Sequence[Path]]) -> Iterator[Counted]:
    """Yield the falls in recordings by kind of walk; what a fall ends or drops is no part of their time."""
    for title, stems in walks.items():
        notes = [read_array_note(file_of(stem, NOTE)) for stem in stems]
        hours = sum(note["rows"] / note["rate_hz"] for note in notes) / HOUR_S
        yield FALL, title, "", hours, sum(note["falls"] for note in notes)


def flags(scores: pd.DataFrame, tests: Mapping[str, LegRuns]) -> Iterator[Counted]:
    """Yield the flagged windows of each method that has standard deviations, test by test and in all of them."""
    methods: list[str] = []
    for test in tests.values():
        methods += test.methods
    for method in dict.fromkeys(methods):
        by_test = {title: totals(scores, test, method) for title, test in tests.items() if method in test.methods}
        kept = {title: total for title, total in by_test.items() if total[0] > 0.0}
        for title, (hours, count) in kept.items():
            yield FLAG, title, method, hours, count
        if kept:
            hours, count = map(sum, zip(*kept.values(), strict=True))
            yield FLAG, ALL, method, hours, round(count)


def totals(scores: pd.DataFrame, test: LegRuns, method: str) -> tuple[float, int]:
    """Return for how long a method was watched in a test [h], and how many windows were flagged, over all runs."""
    watched = rows_of(scores, scenario=test.scenario, level=test.level, method=method, joint=AVERAGE)
    watched = watched[watched["limb"].isin(test.limbs)]
    hours, count = (float(rows_of(watched, metric=metric)["value"].sum()) for metric in (WATCHED, FLAGS))
    return hours, round(count)
