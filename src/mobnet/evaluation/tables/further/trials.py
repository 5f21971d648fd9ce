"""Table of what was tried for each method: errors on the development walks, the best variant of each marked."""

import logging
from collections.abc import Iterator, Sequence
from dataclasses import astuple
from pathlib import Path

import numpy as np

from mobnet.core.columns import TRIALS, TrialError
from mobnet.evaluation.measure.estimates.scores import AVERAGE
from mobnet.evaluation.measure.learning.trials import Known, Outcome, outcome_of, read_walks
from mobnet.evaluation.number.number import number_text
from mobnet.evaluation.tables.layout import Line, Table, in_blocks, write_table
from mobnet.plan.runs import Tried
from mobnet.settings.methods import Observer
from mobnet.settings.plant import Level
from mobnet.settings.robot import RobotTable

BEST, DIVERGED, MILLION = "best", "diverged", 1e6
log = logging.getLogger(__name__)


def trials(
    robot: RobotTable, level: Level, gravity_m_s2: float, observer: Observer, joints: Sequence[str],
    tried: Sequence[Tried], recordings: Sequence[Path], residuals: Sequence[Path], rate_hz: float, out: Path,
) -> None:  # fmt: skip
    """Write a CSV, .tex and .md: RMSE [N m] of each variant by joint, means over the development walks.

    Recordings and residuals, at a rate [Hz], and `out` are paths without a suffix; gravity is in [m/s^2].
    """
    known = Known(robot, level, gravity_m_s2, observer)
    walks = read_walks(known, joints, recordings, residuals, rate_hz)
    outcomes: list[Outcome] = []
    for one in tried:
        outcomes.append(outcome_of(one, known, walks))
        log.info("%s: %.3f N m", one.name, outcomes[-1].average)
    header = ["Method", "Tried", "Steps [million]", "Val. loss", *joints, AVERAGE, ""]
    records = [astuple(row) for outcome in outcomes for row in rows_of(outcome, joints, outcomes)]
    write_table(out, Table(TRIALS, records, header, trial_lines(outcomes), left=2))


def is_best(outcome: Outcome, outcomes: Sequence[Outcome]) -> bool:
    """Return whether a variant has the smallest mean error of its method, among those of its length where they differ.

    A method that is not changed is no choice.
    """
    rivals = [one for one in outcomes if _kind_of(one) == _kind_of(outcome)]
    return bool(outcome.tried.changes) and outcome is min(rivals, key=lambda one: one.average)


def _kind_of(outcome: Outcome) -> tuple[str, object]:
    """Return the method of which a variant is, and its length if that is what is tried."""
    return outcome.tried.base, outcome.tried.changes.get("experiment")


def rows_of(outcome: Outcome, joints: Sequence[str], outcomes: Sequence[Outcome]) -> Iterator[TrialError]:
    """Yield the rows of a variant: each joint, then their mean; with the standard deviation over the walks [N m]."""
    by_walk = np.column_stack([outcome.errors, outcome.errors.mean(axis=1)])
    changes, steps, loss, state = facts_of(outcome)
    for joint, errors in zip((*joints, AVERAGE), by_walk.T, strict=True):
        std = float(errors.std(ddof=1)) if len(errors) > 1 else None
        yield TrialError(
            outcome.tried.base, changes, outcome.tried.network_seed, steps, state, loss, joint, float(errors.mean()),
            std, len(errors), int(is_best(outcome, outcomes)),
        )  # fmt: skip


def trial_lines(outcomes: Sequence[Outcome]) -> list[Line]:
    """Return the rows of text, method by method."""
    methods = dict.fromkeys(outcome.tried.base for outcome in outcomes)
    blocks = [
        ([method], [_cells(one, is_best(one, outcomes)) for one in outcomes if one.tried.base == method])
        for method in methods
    ]
    return in_blocks(blocks)


def _cells(outcome: Outcome, best: bool) -> list[str]:
    """Return the cells of a variant after its method."""
    changes, steps, loss, state = facts_of(outcome)
    errors = [number_text(value) for value in (*outcome.errors.mean(axis=0).tolist(), outcome.average)]
    sizes = [number_text(None if steps is None else steps / MILLION, 1), number_text(loss)]
    return [changes, *sizes, *errors, BEST if best else state]


def facts_of(outcome: Outcome) -> tuple[str, int | None, float | None, str]:
    """Return what is changed, such as `loss squared, rate_first 0.005`, and what came of the training.

    That is how many time steps the network has learned from, the validation loss (22) of the epoch kept, and in a word
    whether it diverged; there is none of a method without networks.
    """
    changes, training = ", ".join(f"{key} {value}" for key, value in outcome.tried.changes.items()), outcome.training
    if training is None:
        return changes, None, None, ""
    loss = training.kept.validation_loss if training.epochs else None
    return changes, training.steps, loss, DIVERGED if training.diverged else ""
