"""What a reaction is worth: falls, forces and impulses of robots that walk into obstacles."""

from collections.abc import Iterator, Sequence
from pathlib import Path

from experiments.evaluation.measure.detection.results import MS
from experiments.evaluation.measure.reaction.results import (
    ALARM,
    BASE_WITHIN,
    EARLY,
    FALLS,
    HEAVY,
    IMPULSE,
    MEDIAN,
    NOTICED,
    PEAK,
    SWING,
    WITHIN,
    groups_of,
    in_swing,
    outcome_of,
    printed_of,
    read_trials,
    trials_of,
)
from experiments.evaluation.tables.rows import Rows, View, ViewColumn, field_text
from experiments.plan.reactions import Reactions
from experiments.settings.published import PublishedContacts
from experiments.settings.reaction_tables import Safety
from experiments.settings.runs import Statistics
from mobnet.core.columns import SAFETY
from mobnet.core.reactions import Trial
from mobnet.settings.reaction import Reaction


def safety(
    settings: Safety,
    reaction: Reaction,
    statistics: Statistics,
    published: PublishedContacts,
    reactions: Reactions,
    table_dir: Path,
) -> None:
    """Write safety.csv, .tex and .md: what comes of walks into obstacles, by case and detector.

    Falls and reactions to nothing are shares of all walks; forces [N], impulses [N s], times from the first contact to
    the alarm [ms] and directions are of walks that met the obstacle before any reaction. Where the obstacle is in front
    of a leg, our detector has a second row, of contacts that begin in mid-swing. Intervals are over robots and walks.
    """
    rows = Rows(SAFETY)
    trials = read_trials(reactions, settings.cases)
    for case, title, group in rows_of(trials, settings, reaction):
        outcome = outcome_of(group, settings, statistics)
        first = group[0]
        late = f"{first.detector}, {MS * first.wait_s:.0f} ms later"
        place = {
            "case": title,
            "detector": first.detector,
            "thresholds": first.rule,
            "wait_s": first.wait_s,
            "line": late if first.wait_s else first.detector,
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
        ViewColumn("peak [N]", {"measure": PEAK}, 0, ends=share),
        ViewColumn("impulse [N s]", {"measure": IMPULSE}, 1, ends=share),
        ViewColumn("median", {"measure": MEDIAN}, 1),
        ViewColumn(f"over {settings.heavy_ns:g}", {"measure": HEAVY}),
        ViewColumn("noticed", {"measure": NOTICED}),
        ViewColumn("alarm [ms]", {"measure": ALARM}, 0),
        ViewColumn(f"{settings.within_deg:g} deg", {"measure": WITHIN}),
        ViewColumn("by (24)", {"measure": BASE_WITHIN}),
        ViewColumn("early", {"measure": EARLY}),
    ]
    labels = {"case": "Case", "line": "Detector", "thresholds": "thresholds"}
    rows.write(table_dir / "safety", View(labels, columns, blocks=("case",)))


def rows_of(
    trials: Sequence[Trial], settings: Safety, reaction: Reaction
) -> Iterator[tuple[str, str, Sequence[Trial]]]:
    """Yield case, its name in the table, and the walks of each row."""
    groups = groups_of(trials)
    for case in settings.cases:
        own = [group for group in groups.values() if group[0].case == case]
        for group in own:
            yield case, case, group
        watched = in_swing(trials_of(trials, case, reaction.ours))
        if watched:
            yield case, SWING.format(case), watched
