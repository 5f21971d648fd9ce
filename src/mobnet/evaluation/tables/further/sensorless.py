"""Walking with what is estimated in place of force sensors: falls, reactions to nothing, the base's velocity."""

from collections.abc import Sequence
from pathlib import Path

from mobnet.core.columns import SENSORLESS
from mobnet.evaluation.measure.detection.results import rate_of
from mobnet.evaluation.measure.reaction.results import groups_of, read_trials, walked_of
from mobnet.evaluation.number.files import Field
from mobnet.evaluation.tables.layout import Line, Table, write_table
from mobnet.plan.reactions import Reactions
from mobnet.settings.evaluation import Sensorless, Statistics

MINUTES = 60.0  # in an hour
VELOCITY = "error of the base's velocity"


def sensorless(settings: Sensorless, statistics: Statistics, reactions: Reactions, table_dir: Path) -> None:
    """Write sensorless.csv, .tex and .md: what happens in walks that nothing stands in the way of.

    Falls and reactions are counted, and in an hour of walking [1/h] with the exact interval of Poisson's law; the error
    of the base's velocity [mm/s] is the mean of the walks, with the interval of Student's law.
    """
    rows: list[Sequence[Field]] = []
    lines: list[Line] = []
    for (case, detector, rule, _, wrench), trials in groups_of(read_trials(reactions, settings.cases)).items():
        walked, place = walked_of(trials, statistics), (case, wrench, detector, rule)
        line = [wrench, detector, rule, f"{MINUTES * walked.hours:.1f}"]
        for event, count in walked.events.items():
            found = rate_of(count, walked.hours, statistics)
            rows.append((*place, event, walked.hours, count, *found.with_ends, len(trials), found.unit))
            line += [str(count), found.text(1), found.interval(1)]
        speed = walked.velocity
        rows.append((*place, VELOCITY, walked.hours, None, *speed.with_ends, len(trials), speed.unit))
        lines.append([*line, speed.text(1), speed.interval(1)])
    share = f"{statistics.confidence:.0%}"
    header = [
        "Feet's wrench", "Detector", "thresholds", "minutes", "falls", "in an hour", share, "reactions",
        "in an hour", share, "velocity's error [mm/s]", share,
    ]  # fmt: skip
    write_table(table_dir / "sensorless", Table(SENSORLESS, rows, header, lines, left=3))
