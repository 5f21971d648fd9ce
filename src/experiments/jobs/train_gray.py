"""Training of gray boxes: the target is what a fitted friction model leaves of the uncertainty."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from experiments.jobs.trainings import train_all
from experiments.plan.parts import Repetition
from experiments.running.stage import Stage
from mobnet.core.arrays import Array
from mobnet.core.columns import MOTOR, VELOCITY, named
from mobnet.core.joints import JointLayout
from mobnet.core.store import read_array, spans_and_rate
from mobnet.estimation.kinds.friction import FittedFriction, read_friction
from mobnet.estimation.low_pass import low_pass
from mobnet.settings.methods import ObserverSettings


def train_gray(
    root_seed: int,
    layout: JointLayout,
    observer: ObserverSettings,
    networks: Sequence[Repetition],
    recordings: Sequence[Path],
    residuals: Sequence[Path],
    fitted: Path,
    stage: Stage,
    rate_hz: float | None = None,
) -> None:
    """Train networks on r - tau_e - friction, where `fitted` is what rule `fit` wrote; else as `train_all`.

    Raises:
        DataError: a recording, a residual or the fit is damaged.
        TrainingError: a loss diverged, where `learning.may_diverge` does not allow it.
    """
    friction = read_friction(fitted, layout.actuated)

    # (O14): friction enters behind the observer's low-pass, because r and the truth of the target are behind it too.
    def known(recording: Path, joints: Sequence[str]) -> Array:
        return filtered_friction(layout, friction, observer.gain_hz, recording, joints)

    train_all(root_seed, layout, networks, recordings, residuals, stage, rate_hz, known)


def filtered_friction(
    layout: JointLayout, friction: FittedFriction, gain_hz: float, recording: Path, joints: Sequence[str]
) -> Array:
    """Return the friction of some joints in a recording behind the low-pass of K_0 [1/s], (T, n) [N, N m].

    Every segment starts anew, as the observer does; joints without a motor have none.
    """
    read, meta = read_array(recording, [*named(VELOCITY, layout.actuated), *named(MOTOR, layout.actuated)])
    velocity, torque = np.split(read, 2, axis=1)
    spans, rate_hz = spans_and_rate(meta)
    found = np.zeros((len(read), layout.nv))
    motors = slice(len(layout.virtual), None)
    for span in (slice(*ends) for ends in spans):
        found[span, motors] = low_pass(friction.torque(velocity[span], torque[span]), gain_hz, rate_hz)
    return found[:, layout.columns(joints)]
