"""What a reaction is worth: falls, forces and impulses of robots that walk into obstacles."""

from pathlib import Path

import pandas as pd

from experiments.evaluation.measure.detection.results import MS
from experiments.evaluation.measure.reaction.results import (
    ALARM,
    BASE_WITHIN,
    EARLY,
    FALLS,
    GROUP,
    HEAVY,
    IMPULSE,
    MEDIAN,
    NOTICED,
    PEAK,
    SWING,
    WITHIN,
    in_swing,
    outcome_laws,
    printed_of,
    trials_of,
    with_measures,
)
from experiments.evaluation.number.frames import read_trials, rows_of
from experiments.evaluation.number.laws import measured
from experiments.evaluation.tables.look import ShownColumn, TableLook, column, write_look
from experiments.plan.reactions import Reactions
from experiments.settings.published import PublishedContacts
from experiments.settings.reaction_tables import Safety
from experiments.settings.runs import Statistics
from experiments.settings.table_columns import SAFETY
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
    trials = with_measures(read_trials(reactions, settings.cases), settings)
    trials = in_lines(trials, settings, reaction)
    place = ["row", "title", *GROUP]
    rows = measured(trials, place, outcome_laws(statistics))
    rows["walks"] = rows["count"]
    rows["touched"] = rows["row"].map(trials.groupby("row")["touched"].sum())
    rows["published"] = [printed_of(published, str(row.case), str(row.quantity)) for row in rows.itertuples()]
    rows["hit"] = rows["touched"].astype(str) + " of " + rows["walks"].astype(str)
    late = rows["detector"] + (MS * rows["wait_s"]).map(", {:.0f} ms later".format)
    rows["line"] = rows["detector"].where(rows["wait_s"] == 0.0, late)
    rows = rows.drop(columns="case").rename(columns={"title": "case", "rule": "thresholds", "quantity": "measure"})
    share = f"{statistics.confidence:.0%}"
    shown = [
        ShownColumn("touched", text=column("hit")),
        ShownColumn("falls", {"measure": FALLS}, ends=share),
        ShownColumn("peak [N]", {"measure": PEAK}, 0, ends=share),
        ShownColumn("impulse [N s]", {"measure": IMPULSE}, 1, ends=share),
        ShownColumn("median", {"measure": MEDIAN}, 1),
        ShownColumn(f"over {settings.heavy_ns:g}", {"measure": HEAVY}),
        ShownColumn("noticed", {"measure": NOTICED}),
        ShownColumn("alarm [ms]", {"measure": ALARM}, 0),
        ShownColumn(f"{settings.within_deg:g} deg", {"measure": WITHIN}),
        ShownColumn("by (24)", {"measure": BASE_WITHIN}),
        ShownColumn("early", {"measure": EARLY}),
    ]
    labels = {"case": "Case", "line": "Detector", "thresholds": "thresholds"}
    write_look(table_dir / "safety", rows, SAFETY, TableLook(labels, shown, blocks=("case",)))


def in_lines(trials: pd.DataFrame, settings: Safety, reaction: Reaction) -> pd.DataFrame:
    """Return each walk in every line of the table that it is part of: `row` numbers them, `title` names the case."""
    parts: list[pd.DataFrame] = []
    for case in settings.cases:
        parts.append(rows_of(trials, case=case).assign(title=case))
        parts.append(in_swing(trials_of(trials, case, reaction.ours)).assign(title=SWING.format(case)))
    lines = pd.concat(parts, ignore_index=True)
    # Lines stand in the order in which their walks come.
    return lines.assign(row=lines.groupby(["title", *GROUP], sort=False).ngroup())
