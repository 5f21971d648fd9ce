"""Errors of variants of methods on the development walks."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from experiments.evaluation.compare.rmse import rmse
from experiments.plan.runs import Tried, TriedTask
from mobnet.core.arrays import Array
from mobnet.core.columns import EXTERNAL_LP, named
from mobnet.core.estimator import TorqueEstimator
from mobnet.core.store import read_array
from mobnet.estimation.estimate import ObservedRecording, rate_of, read_observed, run_segments
from mobnet.estimation.kinds import build_estimator
from mobnet.estimation.recipe import Recipe
from mobnet.formats.robot import RobotTable
from mobnet.robot.description import describe
from mobnet.settings.methods import ObserverSettings
from mobnet.settings.surrogate import Level


@dataclass(frozen=True)
class ObservedWalks:
    """Recordings that were observed, and the true torque of n joints behind the low-pass, (T_i, n) [N m].

    Attributes:
        robot: the robot, as every estimator knows it.
        gravity_m_s2: gravity [m/s^2].
        observer: the observer's settings.
        level: how wrong the observer's nominal model is.
        joints: names of the joints (n,).
        read: the recordings with the observer's residuals.
        truths: the torques of each recording.
    """

    robot: RobotTable
    gravity_m_s2: float
    observer: ObserverSettings
    level: Level
    joints: Sequence[str]
    read: Sequence[ObservedRecording]
    truths: Sequence[Array]

    @property
    def rate_hz(self) -> float:
        """How many samples all recordings have in a second [Hz]."""
        return rate_of(self.read)


def read_walks(
    robot: RobotTable, gravity_m_s2: float, observer: ObserverSettings, task: TriedTask, rate_hz: float
) -> ObservedWalks:
    """Read the walks on which methods are chosen, all at a rate [Hz]; gravity is in [m/s^2]."""
    layout = describe(robot).layout
    read = [read_observed(layout, *pair, rate_hz) for pair in zip(task.recordings, task.residuals, strict=True)]
    names = named(EXTERNAL_LP, task.joints)
    truths = [read_array(residual, names)[0].astype(np.float64) for residual in task.residuals]
    return ObservedWalks(robot, gravity_m_s2, observer, task.level, task.joints, read, truths)


def errors_of(tried: Tried, walks: ObservedWalks) -> Array:
    """Return the RMSE of a variant on each of w walks and joint (w, n) [N m]."""
    errors: list[Array] = []
    for estimate, truth, read in zip(estimates_of(tried, walks), walks.truths, walks.read, strict=True):
        errors.append(rmse(estimate, truth, read.recording.segments))
    return np.array(errors)


def estimates_of(tried: Tried, walks: ObservedWalks) -> list[Array]:
    """Return what a variant estimates of the joints of all walks, which run side by side, (T_i, n) [N m]."""
    estimator = estimator_of(tried, walks)
    columns = [estimator.joints.index(joint) for joint in walks.joints]
    return [result.tau_ext[:, columns] for result in run_segments(estimator, walks.read)]


def estimator_of(tried: Tried, walks: ObservedWalks) -> TorqueEstimator:
    """Return the estimator of a variant for walks."""
    given = walks.robot, walks.level.nominal_mass_ratio, walks.gravity_m_s2, walks.observer
    return build_estimator(Recipe(tried.name, tried.methods, *given, walks.rate_hz, tried.networks, tried.fitted))
