"""Tables of what was tried for each method: errors on the development walks, the best variant of each marked."""

import logging
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import astuple
from pathlib import Path

import numpy as np

from experiments.evaluation.measure.estimates.scores import AVERAGE
from experiments.evaluation.measure.learning.trials import Known, VariantResult, outcome_of, read_walks
from experiments.evaluation.number.number import number_text
from experiments.evaluation.tables.layout import Line, Table, in_blocks, write_table
from experiments.plan.runs import TriedTask
from experiments.records.trial_errors import TRIALS, TrialError
from experiments.settings.trials import EXPERIMENT, RECIPE
from mobnet.settings.methods import ObserverSettings
from mobnet.settings.robot import RobotTable

BEST = "best"
DIVERGED = "diverged"
MILLION = 1e6
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
    known = Known(robot, gravity_m_s2, observer)
    rows = list[TrialError]()
    lines = list[Line]()
    for name, task in tasks.items():
        walks = read_walks(known, task, rate_hz)
        outcomes = list[VariantResult]()
        for tried in task.tried:
            outcomes.append(outcome_of(tried, known, walks))
            log.info("%s, %s, network %d: %.3f N m", name, tried.name, tried.network_seed, outcomes[-1].average)
        # once all are known: a row says whether its variant is the best of them
        for outcome in outcomes:
            rows += rows_of(name, task.joints, outcome, outcomes)
        lines += trial_lines(name, outcomes)
    write_table(out, Table(TRIALS, [astuple(row) for row in rows], HEADER, lines, left=3))


def is_best(outcome: VariantResult, outcomes: Sequence[VariantResult]) -> bool:
    """Return whether a variant has the smallest mean error of its method, among those of its length where they differ.

    The mean is over its networks. A method that is not changed is no choice.
    """
    rivals: dict[str, list[float]] = {}
    for one in outcomes:
        if _kind_of(one) == _kind_of(outcome):
            rivals.setdefault(one.tried.name, []).append(one.average)
    return bool(outcome.tried.changes) and outcome.tried.name == min(rivals, key=lambda name: np.mean(rivals[name]))


def _kind_of(outcome: VariantResult) -> tuple[str, object]:
    """Return the method of which a variant is, and its length if that is what is tried."""
    return outcome.tried.base, outcome.tried.changes.get(EXPERIMENT)


def rows_of(
    task: str, joints: Sequence[str], outcome: VariantResult, outcomes: Sequence[VariantResult]
) -> Iterator[TrialError]:
    """Yield the rows of a variant: each joint, then their mean; with the standard deviation over the walks [N m]."""
    by_walk = np.column_stack([outcome.errors, outcome.errors.mean(axis=1)])
    changes, steps, loss, state = facts_of(outcome)
    recipe = str(outcome.tried.changes.get(RECIPE, ""))
    for joint, errors in zip((*joints, AVERAGE), by_walk.T, strict=True):
        std = float(errors.std(ddof=1)) if len(errors) > 1 else None
        yield TrialError(
            task,
            outcome.tried.base,
            changes,
            recipe,
            outcome.tried.network_seed,
            steps,
            outcome.seconds,
            state,
            loss,
            joint,
            float(errors.mean()),
            std,
            len(errors),
            int(is_best(outcome, outcomes)),
        )


HEADER = [
    "Task",
    "Method",
    "Tried",
    "Steps [million]",
    "Processor time [s]",
    "Networks",
    "Val. loss",
    "RMSE",
    "Std.",
    "",
]


def trial_lines(task: str, outcomes: Sequence[VariantResult]) -> list[Line]:
    """Return the rows of text of a task, method by method, each variant with the mean of its networks."""
    variants: dict[tuple[str, str], list[VariantResult]] = {}
    for one in outcomes:
        variants.setdefault((one.tried.base, one.tried.name), []).append(one)
    blocks: dict[str, list[list[str]]] = {}
    for (method, _), own in variants.items():
        blocks.setdefault(method, []).append(_cells(own, outcomes))
    return in_blocks(([task, method], cells) for method, cells in blocks.items())


def _cells(networks: Sequence[VariantResult], outcomes: Sequence[VariantResult]) -> list[str]:
    """Return the cells of a variant after its method: means over its networks, and their spread [N m]."""
    facts = [facts_of(one) for one in networks]
    changes, steps, _, _ = facts[0]
    losses = [loss for _, _, loss, _ in facts]
    seconds = [one.seconds for one in networks]
    errors = [one.average for one in networks]
    cells = [
        changes,
        number_text(None if steps is None else steps / MILLION, 1),
        number_text(_mean(seconds), 0),
        str(len(networks)) if steps is not None else number_text(None),
        number_text(_mean(losses)),
        number_text(float(np.mean(errors))),
        number_text(float(np.std(errors, ddof=1)) if len(errors) > 1 else None),
    ]
    state = next((state for *_, state in facts if state), "")
    return [*cells, BEST if is_best(networks[0], outcomes) else state]


def _mean(values: Sequence[float | None]) -> float | None:
    """Return the mean of the numbers that are there; None if none is."""
    known = [value for value in values if value is not None]
    return float(np.mean(known)) if known else None


def facts_of(outcome: VariantResult) -> tuple[str, int | None, float | None, str]:
    """Return what is changed, such as `loss squared, rate_first 0.005`, and what came of the training.

    That is how many time steps the network has learned from, the validation loss (22) of the epoch kept, and in a word
    whether it diverged; there is none of a method without networks.
    """
    changes = ", ".join(f"{key} {value}" for key, value in outcome.tried.changes.items())
    training = outcome.training
    if training is None:
        return changes, None, None, ""
    loss = training.kept.validation_loss if training.epochs else None
    return changes, training.steps, loss, DIVERGED if training.diverged else ""
