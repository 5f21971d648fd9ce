"""Losses and errors of kinds of networks: epoch by epoch, and where a training ends, with intervals over its runs."""

# pandas has no complete types, which the strict rules of this folder ask for.
# pyright: standard

from collections.abc import Sequence

import pandas as pd

from experiments.evaluation.measure.learning.trainings import MEASURES, over_networks
from experiments.evaluation.number.frames import ordered
from experiments.evaluation.number.laws import measured
from experiments.evaluation.number.number import Number
from experiments.settings.runs import Statistics
from mobnet.core.errors import DataError

COURSES = {  # columns of `TRAININGS` -> measure
    "train_loss": "training loss",
    "validation_loss": "validation loss",
    "validation_rmse": "validation RMSE",
}
ENDS = {  # of MEASURES -> its course
    "training loss at the end": "training loss",
    "validation loss": "validation loss",
    "validation RMSE": "validation RMSE",
}
UNITS = {ENDS[name]: MEASURES[name][1] for name in ENDS}
END = 0  # in place of an epoch: where a training ends
PLACE = ["method", "at_end", "measure", "epoch"]


def runs_of(networks: pd.DataFrame, epochs: pd.DataFrame) -> pd.DataFrame:
    """Return the losses (22) [-] and the RMSE [N m] of every epoch of runs, which did not diverge, and of their end.

    At the end, epoch `END`, it is the training loss of the last epoch, or that in validation of the epoch kept.
    `stride` is the distance between two time steps of the epoch [samples]: losses at unlike strides are those of unlike
    tasks.

    Raises:
        DataError: the runs of a method have different numbers of epochs.
    """
    lengths = epochs.groupby(["method", "seed"], sort=False).size()
    for method, counts in lengths.groupby("method", sort=False):
        if counts.nunique() > 1:
            texts = ", ".join(map(str, sorted(counts.unique())))
            raise DataError(f"{method}: runs of {texts} epochs do not make one curve")
    parts: list[pd.DataFrame] = []
    for column, measure in COURSES.items():
        parts.append(epochs[["method", "epoch", "stride"]].assign(measure=measure, value=epochs[column], at_end=False))
    ends = networks.assign(epoch=END)
    for name, measure in ENDS.items():
        column = MEASURES[name][0]
        parts.append(ends[["method", "epoch", "stride"]].assign(measure=measure, value=ends[column], at_end=True))
    return pd.concat(parts, ignore_index=True)


def losses_of(runs: pd.DataFrame, statistics: Statistics) -> pd.DataFrame:
    """Return the mean over runs, as `runs_of` returns them, by method, of each epoch and of the end."""
    methods: Sequence[str] = list(runs["method"].unique())
    ranked = ordered(runs, method=methods, measure=list(COURSES.values()))

    def law(rows: pd.DataFrame) -> Number:
        return over_networks("value", UNITS[rows["measure"].iloc[0]], statistics)(rows)

    losses = measured(ranked, PLACE, {"mean": law})
    strides = ranked.groupby(PLACE, observed=True)["stride"].first().astype("int64")
    return losses.merge(strides.reset_index(), how="left", on=PLACE)
