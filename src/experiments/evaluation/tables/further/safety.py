"""What a reaction is worth: falls, forces and impulses of robots that walk into obstacles."""

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
)
from experiments.evaluation.tables.rows import Rows, View, ViewColumn, field_text
from experiments.plan.reactions import Reactions
from experiments.settings.published import PublishedContacts
from experiments.settings.reaction_tables import Safety
from experiments.settings.runs import Statistics
from mobnet.core.columns import SAFETY


def safety(
    settings: Safety, statistics: Statistics, published: PublishedContacts, reactions: Reactions, table_dir: Path
) -> None:
    """Write safety.csv, .tex and .md: what comes of walks into obstacles, by case and detector.

    Falls and reactions to nothing are shares of all walks; forces [N], impulses [N s], times from the first contact to
    the alarm [ms] and directions are of walks that met the obstacle before any reaction. Intervals are over robots and
    walks.
    """
    rows = Rows(SAFETY)
    for (case, detector, rule, wait_s, *_), trials in groups_of(read_trials(reactions, settings.cases)).items():
        outcome = outcome_of(trials, settings, statistics)
        line = f"{detector}, {MS * wait_s:.0f} ms later" if wait_s else detector
        place = {
            "case": case,
            "detector": detector,
            "thresholds": rule,
            "wait_s": wait_s,
            "line": line,
            "walks": outcome.walks,
            "touched": outcome.touched,
        }
        hit = f"{outcome.touched} of {outcome.walks}"
        for measure, number in outcome.numbers.items():
            printed = printed_of(published, case, measure)
            rows.add(number, **place, hit=hit, measure=measure, published=printed)
    share = f"{statistics.confidence:.0%}"
    columns = [
        ViewColumn("touched", text=field_text("hit")),
        ViewColumn("falls", {"measure": FALLS}, ends=share),
        ViewColumn("first peak [N]", {"measure": PEAK}, 0, ends=share),
        ViewColumn("its impulse [N s]", {"measure": FIRST}, 1),
        ViewColumn("all contacts [N s]", {"measure": IMPULSE}, 1, ends=share),
        ViewColumn("median", {"measure": MEDIAN}, 1),
        ViewColumn(f"above {settings.heavy_ns:g} N s", {"measure": HEAVY}),
        ViewColumn("alarm [ms]", {"measure": ALARM}, 0),
        ViewColumn(f"within {settings.within_deg:g} deg", {"measure": WITHIN}),
        ViewColumn("by (24)", {"measure": BASE_WITHIN}),
        ViewColumn("before contact", {"measure": EARLY}),
    ]
    labels = {"case": "Case", "line": "Detector", "thresholds": "thresholds"}
    rows.write(table_dir / "safety", View(labels, columns, blocks=("case",)))
