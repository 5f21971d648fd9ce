"""Table of falls by random torque: from which largest torque on legs and waist does a robot fall (section 4.3)?"""

# pandas has no complete types, which the strict rules of this folder ask for.
# pyright: standard

from collections.abc import Sequence
from pathlib import Path
from statistics import median_low

import pandas as pd

from experiments.evaluation.number.frames import FALLS, ordered, read_frame, rows_of
from experiments.evaluation.number.laws import measured
from experiments.evaluation.number.number import Number
from experiments.evaluation.tables.look import ShownColumn, TableLook, column, write_look
from experiments.intervals.single import rate_of
from experiments.settings.runs import Statistics
from experiments.settings.table_columns import FALLEN

ALL = "all"
CHOSEN = "largest without a fall"
RATE = "falls an hour"
HOUR_S = 3600.0
PLACE = ["robot", "amplitude_nm"]


def falls(counted: Sequence[Path], statistics: Statistics, out: Path) -> None:
    """Write a CSV, .tex and .md: falls of each robot with each largest random torque [N m], and of all [1/h].

    `counted` are the files of the robots, `out` is a path without a suffix. The torque that is raised until a robot
    falls is marked: the largest one up to which it did not. That of all is the median robot's, the lower one of two.
    """
    counts = pd.concat([read_frame(path, FALLS) for path in counted], ignore_index=True)
    robots = list(counts["robot"].unique())
    chosen_nm = {robot: largest_stood(rows_of(counts, robot=robot)) for robot in robots}
    chosen_nm[ALL] = median_low(list(chosen_nm.values()))

    def rate(rows: pd.DataFrame) -> Number:
        return rate_of(int(rows["falls"].sum()), float(rows["walked_s"].sum()) / HOUR_S, statistics)

    # All robots together are one more of them.
    every = ordered(pd.concat([counts, counts.assign(robot=ALL)]), robot=[*robots, ALL])
    sums = every.groupby(PLACE, observed=True)[["walked_s", "falls"]].sum().reset_index()
    rates = measured(every, PLACE, {RATE: rate})
    rows = rates.merge(sums, on=PLACE).rename(columns={"value": "per_hour"})
    rows = rows.assign(value=rows["per_hour"], text=rows["falls"].astype(str))
    rows["chosen"] = (rows["amplitude_nm"] == rows["robot"].map(chosen_nm).astype(float)).astype(int)
    last = pd.DataFrame(
        {"robot": chosen_nm.keys(), "amplitude_nm": CHOSEN, "text": map("{:g}".format, chosen_nm.values())}
    )
    shown = [ShownColumn(robot, {"robot": robot}, text=column("text")) for robot in chosen_nm]
    of_rate = {"robot": ALL, "quantity": RATE}
    shown.append(ShownColumn(RATE, of_rate, digits=1, ends=f"{statistics.confidence:.0%}", none=""))
    look = TableLook({"amplitude_nm": "Largest torque [N m]"}, shown)
    write_look(out, pd.concat([rows.astype({"robot": str}), last]), FALLEN, look, filed=rows)


def largest_stood(counts: pd.DataFrame) -> float:
    """Return the largest torque [N m], of a robot's rows in rising order, up to which it did not fall, or 0."""
    stood = counts[counts["falls"].cumsum() == 0]
    return float(stood["amplitude_nm"].iloc[-1]) if len(stood) else 0.0
