"""Walking with what is estimated in place of force sensors: falls, reactions to nothing, the base's velocity."""

from pathlib import Path

import pandas as pd

from experiments.evaluation.measure.reaction.results import (
    FALLEN,
    GROUP,
    POWER,
    REACTED,
    TRACKING,
    VELOCITY,
    walked_laws,
    with_walked,
)
from experiments.evaluation.number.frames import read_trials
from experiments.evaluation.number.laws import measured
from experiments.evaluation.tables.look import Row, ShownColumn, TableLook, column, write_look
from experiments.plan.reactions import Reactions
from experiments.settings.reaction_tables import Sensorless
from experiments.settings.runs import Statistics
from experiments.settings.table_columns import SENSORLESS

MINUTES = 60.0  # in an hour


def sensorless(settings: Sensorless, statistics: Statistics, reactions: Reactions, table_dir: Path) -> None:
    """Write sensorless.csv, .tex and .md: what happens in walks that nothing stands in the way of.

    Falls and reactions are counted, and in an hour of walking [1/h]. The rest are means of the walks: the errors of the
    base's velocity [mm/s] and of the joints of the leg that swings [mrad], and the power of the motors [W]. Intervals
    are over robots and walks.
    """
    trials = with_walked(read_trials(reactions, settings.cases))
    trials["row"] = trials.groupby(GROUP, sort=False).ngroup()  # in the order of the files
    rows = measured(trials, ["row", *GROUP], walked_laws(statistics))
    of_row = trials.groupby("row")
    rows["hours"] = rows["row"].map(of_row["hours"].sum())
    rows["walks"] = rows["count"]
    counts = of_row[[FALLEN, REACTED]].sum().stack()
    places = pd.MultiIndex.from_frame(rows[["row", "quantity"]])
    rows["events"] = counts.reindex(places).to_numpy()
    rows = rows.rename(columns={"rule": "thresholds", "quantity": "event"})
    share = f"{statistics.confidence:.0%}"
    shown = [
        ShownColumn("minutes", text=_minutes),
        ShownColumn("falls", {"event": FALLEN}, text=column("events", ".0f")),
        ShownColumn("in an hour", {"event": FALLEN}, 1, ends=share),
        ShownColumn("reactions", {"event": REACTED}, text=column("events", ".0f")),
        ShownColumn("in an hour", {"event": REACTED}, 1, ends=share),
        ShownColumn("base's velocity [mm/s]", {"event": VELOCITY}, 1),
        ShownColumn("swing leg [mrad]", {"event": TRACKING}, 1),
        ShownColumn("power [W]", {"event": POWER}, 1),
    ]
    labels = {
        "case": "Case",
        "wrench": "feet's wrench",
        "detector": "detector",
        "thresholds": "thresholds",
        "feed_forward": "fed",
    }
    write_look(table_dir / "sensorless", rows, SENSORLESS, TableLook(labels, shown, left=4))


def _minutes(row: Row) -> str:
    """Return for how long the robots of a row walked [min]."""
    return f"{MINUTES * row['hours']:.1f}"
