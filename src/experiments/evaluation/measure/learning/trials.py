"""Errors of variants of methods on the development walks."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from experiments.evaluation.compare.rmse import rmse
from experiments.evaluation.measure.learning.trainings import TrainedNetwork, read_training, training_seconds
from experiments.plan.runs import Tried, TriedTask
from mobnet.core.arrays import Array
from mobnet.core.columns import EXTERNAL_LP, named
from mobnet.core.store import read_array
from mobnet.estimation.estimate import ObservedRecording, rate_of, read_observed, run_segments
from mobnet.estimation.kinds import build_estimator
from mobnet.estimation.recipe import Recipe
from mobnet.robot.description import describe
from mobnet.settings.methods import ObserverSettings
from mobnet.settings.robot import RobotTable
from mobnet.settings.surrogate import Level


@dataclass(frozen=True)
class Known:
    """What every estimator knows: the robot, gravity [m/s^2] and the observer's settings."""

    robot: RobotTable
    gravity_m_s2: float
    observer: ObserverSettings


@dataclass(frozen=True)
class ObservedWalks:
    """Recordings that were observed, and the true torque of n joints behind the low-pass, (T_i, n) [N m].

    `level` says how wrong the observer's nominal model is.
    """

    level: Level
    joints: Sequence[str]
    read: Sequence[ObservedRecording]
    truths: Sequence[Array]


@dataclass(frozen=True)
class VariantResult:
    """A variant with the training of its network, if it has one, and its RMSE by walk and joint (w, n) [N m].

    `seconds` is the processor time of that training [s].
    """

    tried: Tried
    training: TrainedNetwork | None
    seconds: float | None
    errors: Array

    @property
    def average(self) -> float:
        """Mean over walks and joints [N m], by which variants are chosen."""
        return float(self.errors.mean())


def read_walks(known: Known, task: TriedTask, rate_hz: float) -> ObservedWalks:
    """Read the walks on which methods are chosen, all at a rate [Hz]."""
    layout = describe(known.robot).layout
    read = [read_observed(layout, *pair, rate_hz) for pair in zip(task.recordings, task.residuals, strict=True)]
    names = named(EXTERNAL_LP, task.joints)
    truths = [read_array(residual, names)[0].astype(np.float64) for residual in task.residuals]
    return ObservedWalks(task.level, task.joints, read, truths)


def outcome_of(tried: Tried, known: Known, walks: ObservedWalks) -> VariantResult:
    """Run a variant on all walks side by side."""
    errors = [
        rmse(estimate, truth, one.recording.segments)
        for estimate, truth, one in zip(estimates_of(tried, known, walks), walks.truths, walks.read, strict=True)
    ]
    folder = next(iter(tried.networks.values()), None)
    training, seconds = (read_training(folder), training_seconds(folder)) if folder else (None, None)
    return VariantResult(tried, training, seconds, np.array(errors))


def estimates_of(tried: Tried, known: Known, walks: ObservedWalks) -> list[Array]:
    """Return what a variant estimates of the joints of all walks, which run side by side, (T_i, n) [N m]."""
    given = known.robot, walks.level.nominal_mass_ratio, known.gravity_m_s2, known.observer
    recipe = Recipe(tried.name, tried.methods, *given, rate_of(walks.read), tried.networks, tried.fitted)
    estimator = build_estimator(recipe)
    columns = [estimator.joints.index(joint) for joint in walks.joints]
    return [result.tau_ext[:, columns] for result in run_segments(estimator, walks.read)]
