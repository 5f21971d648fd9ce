"""Walking with what is estimated in place of force sensors: falls, reactions to nothing, the base's velocity."""

from collections.abc import Sequence
from pathlib import Path

from experiments.evaluation.measure.reaction.results import groups_of, read_trials, walked_of
from experiments.evaluation.number.files import Field
from experiments.evaluation.tables.layout import Line, Table, write_table
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
    rows: list[Sequence[Field]] = []
    lines: list[Line] = []
    for (case, detector, rule, _, wrench, fed), trials in groups_of(read_trials(reactions, settings.cases)).items():
        walked = walked_of(trials, statistics)
        place = (case, wrench, detector, rule, fed)
        line = [wrench, detector, rule, f"{fed:g}", f"{MINUTES * walked.hours:.1f}"]
        for event, count in walked.events.items():
            found = walked.rates[event]
            rows.append((*place, event, walked.hours, count, *found.with_ends, len(trials), found.unit))
            line += [str(count), found.text(1), found.interval(1)]
        for name, mean in walked.means.items():
            rows.append((*place, name, walked.hours, None, *mean.with_ends, len(trials), mean.unit))
            line.append(mean.text(1))
        lines.append(line)
    share = f"{statistics.confidence:.0%}"
    header = [
        "Feet's wrench", "Detector", "thresholds", "fed", "minutes", "falls", "in an hour", share, "reactions",
        "in an hour", share, "base's velocity [mm/s]", "swing leg [mrad]", "power [W]",
    ]  # fmt: skip
    write_table(table_dir / "sensorless", Table(SENSORLESS, rows, header, lines, left=3))
