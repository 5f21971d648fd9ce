"""Walking with what is estimated in place of force sensors: falls, reactions to nothing, the base's velocity."""

from pathlib import Path

from experiments.evaluation.measure.reaction.results import (
    FALLEN,
    POWER,
    REACTED,
    TRACKING,
    VELOCITY,
    groups_of,
    read_trials,
    walked_of,
)
from experiments.evaluation.tables.rows import NumberRow, Rows, View, ViewColumn, field_text
from experiments.plan.reactions import Reactions
from experiments.settings.reaction_tables import Sensorless
from experiments.settings.runs import Statistics
from mobnet.core.columns import SENSORLESS

MINUTES = 60.0  # in an hour


def sensorless(settings: Sensorless, statistics: Statistics, reactions: Reactions, table_dir: Path) -> None:
    """Write sensorless.csv, .tex and .md: what happens in walks that nothing stands in the way of.

    Falls and reactions are counted, and in an hour of walking [1/h]. The rest are means of the walks: the errors of the
    base's velocity [mm/s] and of the joints of the leg that swings [mrad], and the power of the motors [W]. Intervals
    are over robots and walks.
    """
    rows = Rows(SENSORLESS)
    for (case, detector, rule, _, wrench, fed), trials in groups_of(read_trials(reactions, settings.cases)).items():
        walked = walked_of(trials, statistics)
        place = {
            "case": case,
            "wrench": wrench,
            "detector": detector,
            "thresholds": rule,
            "feed_forward": fed,
            "hours": walked.hours,
            "walks": len(trials),
        }
        for event, count in walked.events.items():
            rows.add(walked.rates[event], **place, event=event, events=count)
        for name, mean in walked.means.items():
            rows.add(mean, **place, event=name, events=None)
    share = f"{statistics.confidence:.0%}"
    columns = [
        ViewColumn("minutes", text=_minutes),
        ViewColumn("falls", {"event": FALLEN}, text=field_text("events")),
        ViewColumn("in an hour", {"event": FALLEN}, 1, ends=share),
        ViewColumn("reactions", {"event": REACTED}, text=field_text("events")),
        ViewColumn("in an hour", {"event": REACTED}, 1, ends=share),
        ViewColumn("base's velocity [mm/s]", {"event": VELOCITY}, 1),
        ViewColumn("swing leg [mrad]", {"event": TRACKING}, 1),
        ViewColumn("power [W]", {"event": POWER}, 1),
    ]
    labels = {
        "case": "Case",
        "wrench": "feet's wrench",
        "detector": "detector",
        "thresholds": "thresholds",
        "feed_forward": "fed",
    }
    rows.write(table_dir / "sensorless", View(labels, columns, left=4))


def _minutes(row: NumberRow) -> str:
    """Return for how long the robots of a row walked [min]."""
    return f"{MINUTES * float(row.place['hours'] or 0.0):.1f}"
