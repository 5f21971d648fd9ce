"""What a reaction is worth: falls, forces and impulses of robots that walk into obstacles."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from experiments.evaluation.measure.detection.results import MS
from experiments.evaluation.measure.reaction.results import (
    ALARM,
    BASE_WITHIN,
    EARLY,
    FALLS,
    FIRST,
    HEAVY,
    IMPULSE,
    MEDIAN,
    PEAK,
    WITHIN,
    groups_of,
    outcome_of,
    printed_of,
    read_trials,
)  # fmt: skip
from experiments.evaluation.number.files import Field
from experiments.evaluation.number.number import Number
from experiments.evaluation.tables.layout import RULE, Line, Table, write_table
from experiments.plan.reactions import Reactions
from experiments.settings.published import PublishedContacts
from experiments.settings.reaction_tables import Safety
from experiments.settings.runs import Statistics
from mobnet.core.columns import SAFETY

DIGITS = {FALLS: 2, PEAK: 0, FIRST: 1, IMPULSE: 1, MEDIAN: 1, HEAVY: 2, ALARM: 0, WITHIN: 2, BASE_WITHIN: 2, EARLY: 2}


def safety(
    settings: Safety, statistics: Statistics, published: PublishedContacts, reactions: Reactions, table_dir: Path
) -> None:
    """Write safety.csv, .tex and .md: what comes of walks into obstacles, by case and detector.

    Falls and reactions to nothing are shares of all walks; forces [N], impulses [N s], times from the first contact to
    the alarm [ms] and directions are of walks that met the obstacle before any reaction. Intervals are over robots and
    walks.
    """
    rows: list[Sequence[Field]] = []
    lines: list[Line] = []
    before = ""
    for (case, detector, rule, wait_s, *_), trials in groups_of(read_trials(reactions, settings.cases)).items():
        outcome = outcome_of(trials, settings, statistics)
        for measure, number in outcome.numbers.items():
            printed = printed_of(published, case, measure)
            counts = outcome.walks, outcome.touched
            rows.append((case, detector, rule, wait_s, measure, *number.with_ends, *counts, number.unit, printed))
        lines += [RULE] if before and before != case else []
        numbers = [f"{outcome.touched} of {outcome.walks}", *_texts(outcome.numbers)]
        later = f"{detector}, {MS * wait_s:.0f} ms later" if wait_s else detector
        lines.append([case if case != before else "", later, rule, *numbers])
        before = case
    share = f"{statistics.confidence:.0%}"
    header = [
        "Case", "Detector", "thresholds", "touched", "falls", share, "first peak [N]", share, "its impulse [N s]",
        "all contacts [N s]", share, "median", f"above {settings.heavy_ns:g} N s", "alarm [ms]",
        f"within {settings.within_deg:g} deg", "by (24)", "before contact",
    ]  # fmt: skip
    write_table(table_dir / "safety", Table(SAFETY, rows, header, lines, left=3))


def _texts(numbers: Mapping[str, Number]) -> list[str]:
    """Return the cells of a line."""
    with_interval = (FALLS, PEAK, IMPULSE)
    found = list[str]()
    for measure, number in numbers.items():
        found.append(number.text(DIGITS[measure]))
        if measure in with_interval:
            found.append(number.interval(DIGITS[measure]))
    return found
