"""Trainings of one size of the network or of the data: loss, error, and its ratio to that of the printed size."""

# pandas has no complete types, which the strict rules of this folder ask for.
# pyright: standard

from collections.abc import Sequence
from typing import Any

import pandas as pd

from experiments.evaluation.measure.learning.trainings import read_trainings
from experiments.evaluation.number.number import Number
from experiments.intervals.crossed import RATIO, RunGrid, summarise
from experiments.intervals.single import extremes
from experiments.plan.runs import SweptSize
from experiments.settings.runs import Statistics
from experiments.settings.table_columns import SIZES

SAMPLES = "samples"  # panel of the sizes of the data; the largest of them is all data, by a network of the printed size


def sizes_of(sweeps: Sequence[SweptSize], statistics: Statistics) -> pd.DataFrame:
    """Return the sizes of all panels and bases, columns `SIZES`, from small to large; none where all runs diverged.

    A panel varies `parameters` or `samples`. Validation loss (22) and root-mean-square error [N m], the mean over
    joints, are those of the epoch kept on held-out data: mean, lowest and highest run. The loss is of z-scored targets,
    the error is not. The ratio is the error over that of the printed size that learned from all data [-].
    """
    kept: list[tuple[SweptSize, pd.DataFrame]] = []
    for swept in sweeps:
        networks, _ = read_trainings(swept.folders)
        sound = networks[~networks["diverged"]]
        kept += [(swept, of_method) for _, of_method in sound.groupby("method", sort=False)]
    largest = {swept.base: of_method for swept, of_method in sorted(kept, key=_samples) if swept.panel == SAMPLES}
    rows = [_size_of(swept, of_method, largest.get(swept.base), statistics) for swept, of_method in kept]
    return pd.DataFrame(sorted(rows, key=lambda row: row[row["panel"]]), columns=list(SIZES))


def _samples(trained: tuple[SweptSize, pd.DataFrame]) -> int:
    return trained[1]["samples"].iloc[0]


def _size_of(
    swept: SweptSize, networks: pd.DataFrame, printed: pd.DataFrame | None, statistics: Statistics
) -> dict[str, Any]:
    """Return one size, a row of `SIZES`, from its networks and those of the printed size, if there are any."""
    first = networks.iloc[0]
    loss, rmse = extremes(networks[["validation_loss", "validation_rmse"]].to_numpy())
    ratio = Number(None)
    if printed is not None:
        ratio = summarise([_errors(networks), _errors(printed)], statistics, RATIO)
    of = swept.panel, swept.base, first["method"], int(first["parameters"]), int(first["samples"]), len(networks)
    return dict(zip(SIZES, (*of, *loss.with_ends, *rmse.with_ends, *ratio.with_ends), strict=True))


def _errors(networks: pd.DataFrame) -> RunGrid:
    """Return the errors of networks of one method on held-out data, (n, 1) [N m], on one walk."""
    return RunGrid(networks[["validation_rmse"]].to_numpy(), networks["method"].iloc[0])
