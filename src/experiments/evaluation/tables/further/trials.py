"""Tables of what was tried for each method: errors on the development walks, the best variant of each marked."""

# pandas has no complete types, which the strict rules of this folder ask for.
# pyright: standard

import logging
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from experiments.evaluation.measure.estimates.scores import AVERAGE
from experiments.evaluation.measure.learning.trainings import read_training, training_seconds
from experiments.evaluation.measure.learning.trials import errors_of, read_walks
from experiments.evaluation.number.frames import rows_of
from experiments.evaluation.number.number import number_text
from experiments.evaluation.tables.look import Row, ShownColumn, TableLook, column, write_look
from experiments.plan.runs import Tried, TriedTask
from experiments.records.trial_errors import TRIALS
from experiments.settings.trials import EXPERIMENT, RECIPE
from mobnet.core.arrays import Array
from mobnet.formats.robot import RobotTable
from mobnet.settings.methods import ObserverSettings

BEST = "best"
DIVERGED = "diverged"
MILLION = 1e6
CHOICE = ["task", "method", "length"]  # columns: of variants that have them in common the best one is marked
log = logging.getLogger(__name__)


def trials(
    robot: RobotTable,
    gravity_m_s2: float,
    observer: ObserverSettings,
    tasks: Mapping[str, TriedTask],
    rate_hz: float,
    out: Path,
) -> None:
    """Write a CSV, .tex and .md: RMSE [N m] of each variant at each task, means over its development walks.

    The CSV has every joint and network, the text means over the joints. Recordings and residuals, at a rate [Hz], and
    `out` are paths without a suffix; gravity is in [m/s^2].
    """
    rows: list[dict[str, object]] = []
    for name, task in tasks.items():
        walks = read_walks(robot, gravity_m_s2, observer, task, rate_hz)
        for tried in task.tried:
            errors = errors_of(tried, walks)
            log.info("%s, %s, network %d: %.3f N m", name, tried.name, tried.network_seed, errors.mean())
            rows += network_rows(name, task.joints, tried, errors)
    table = pd.DataFrame(rows).astype({"steps": "Int64", "seconds": float, "validation_loss": float, "std_nm": float})
    table = table.assign(best=is_best(table).astype(int))
    variants = variants_of(rows_of(table, joint=AVERAGE))
    write_look(out, variants, TRIALS, LOOK, filed=table)


def network_rows(task: str, joints: Sequence[str], tried: Tried, errors: Array) -> Iterator[dict[str, object]]:
    """Yield the rows of a network: each joint, then their mean; with the standard deviation over the walks [N m].

    The errors are those of each walk and joint (w, n) [N m]. `length` is what is chosen by itself, if lengths differ.
    """
    place = {
        "task": task,
        "method": tried.base,
        "tried": ", ".join(f"{key} {value}" for key, value in tried.changes.items()),
        "recipe": str(tried.changes.get(RECIPE, "")),
        "length": str(tried.changes.get(EXPERIMENT, "")),
        "network_seed": tried.network_seed,
        **facts_of(tried),
    }
    by_walk = np.column_stack([errors, errors.mean(axis=1)])
    for joint, values in zip((*joints, AVERAGE), by_walk.T, strict=True):
        std = float(values.std(ddof=1)) if len(values) > 1 else None
        yield {**place, "joint": joint, "rmse_nm": float(values.mean()), "std_nm": std, "walks": len(values)}


def facts_of(tried: Tried) -> dict[str, object]:
    """Return what came of the training of a variant's network, if it has one.

    That is how many time steps the network has learned from, the processor time of its training [s], the validation
    loss (22) of the epoch kept, and in a word whether it diverged.
    """
    folder = next(iter(tried.networks.values()), None)
    if folder is None:
        return {"steps": None, "seconds": None, "validation_loss": None, "state": ""}
    training = read_training(folder)
    return {
        "steps": training.steps,
        "seconds": training_seconds(folder),
        "validation_loss": training.kept.validation_loss if training.epochs else None,
        "state": DIVERGED if training.diverged else "",
    }


def is_best(rows: pd.DataFrame) -> "pd.Series[bool]":
    """Return of each row whether its variant has the smallest mean error of its method, or of a length of it.

    The mean is over its networks. A method that is not changed is no choice.
    """
    variants = [*CHOICE, "tried"]
    means = rows_of(rows, joint=AVERAGE).groupby(variants, sort=False)["rmse_nm"].mean()
    smallest = set(means.groupby(level=CHOICE, sort=False).idxmin())
    is_smallest = [variant in smallest for variant in rows[variants].itertuples(index=False, name=None)]
    return (rows["tried"] != "") & np.array(is_smallest)


def variants_of(averages: pd.DataFrame) -> pd.DataFrame:
    """Return a row for each variant, from the mean errors of its networks: their means, and their spread [N m].

    `mark` says that it is the best one, or else whether a training diverged.
    """
    variants = averages.groupby(["task", "method", "tried"], sort=False).agg(
        steps=("steps", "first"),
        seconds=("seconds", "mean"),
        networks=("network_seed", "size"),
        validation_loss=("validation_loss", "mean"),
        value=("rmse_nm", "mean"),
        std_nm=("rmse_nm", "std"),
        state=("state", "max"),
        best=("best", "max"),
    )
    return variants.assign(mark=variants["state"].where(variants["best"] == 0, BEST)).reset_index()


def _steps_text(row: Row) -> str:
    """Return how many million time steps a variant's networks have learned from."""
    return number_text(None if pd.isna(row["steps"]) else row["steps"] / MILLION, 1)


def _networks_text(row: Row) -> str:
    """Return how many networks a variant has."""
    return number_text(None) if pd.isna(row["steps"]) else str(row["networks"])


LOOK = TableLook(
    {"task": "Task", "method": "Method", "tried": "Tried"},
    [
        ShownColumn("Steps [million]", text=_steps_text),
        ShownColumn("Processor time [s]", text=lambda row: number_text(row["seconds"], 0)),
        ShownColumn("Networks", text=_networks_text),
        ShownColumn("Val. loss", text=lambda row: number_text(row["validation_loss"])),
        ShownColumn("RMSE"),
        ShownColumn("Std.", text=lambda row: number_text(row["std_nm"])),
        ShownColumn("", text=column("mark")),
    ],
    blocks=("task", "method"),
)
