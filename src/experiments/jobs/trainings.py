"""The rule `train`: it trains networks that learn from the same recordings."""

from collections.abc import Sequence
from itertools import groupby
from pathlib import Path

import numpy as np

from experiments.plan.parts import Repetition
from experiments.running.stage import Stage
from mobnet.core.arrays import Array
from mobnet.core.columns import MOTOR, VELOCITY, named
from mobnet.core.files import METRICS, RUN, WEIGHTS
from mobnet.core.joints import JointLayout
from mobnet.core.store import read_array, spans_and_rate
from mobnet.estimation.kinds.friction import FittedFriction, read_friction
from mobnet.estimation.low_pass import low_pass
from mobnet.learning.dataset import Known, load_limb_data
from mobnet.learning.job import TrainingJob
from mobnet.learning.swings import Margins
from mobnet.learning.train import train_on
from mobnet.settings.methods import ObserverSettings


def train_all(
    root_seed: int,
    layout: JointLayout,
    networks: Sequence[Repetition],
    recordings: Sequence[Path],
    residuals: Sequence[Path],
    stage: Stage,
    rate_hz: float | None = None,
    known: Known | None = None,
    margins: Margins | None = None,
) -> None:
    """Train networks on the same recordings, one after another; data that several learn from are read once.

    One job trains them all. One that was killed goes on with the network that it was at, from its last epoch. The
    recordings are at `rate_hz` [Hz] where that is given. What is `known` of the target is subtracted from it. Where
    swings label, `margins` say what is left out of them.

    Raises:
        DataError: a recording or a residual is damaged or too short.
        TrainingError: a loss diverged, where `learning.may_diverge` does not allow it.
    """
    stage.begin()
    waiting = [network for network in networks if not stage.has(_files(network))]
    for _, alike in groupby(waiting, key=_reads):
        same = list(alike)
        training = same[0].training
        data = load_limb_data(
            layout,
            training.network,
            training.target,
            recordings,
            residuals,
            rate_hz,
            training.held_out,
            known,
            training.learning.data_s,
            margins,
        )
        for network in same:
            job = TrainingJob(network.training, network.seed, root_seed)
            train_on(data, job, stage.place(network.out), network.state, network.start)
    stage.publish(file for network in networks for file in _files(network))


def _files(network: Repetition) -> tuple[Path, ...]:
    # The note is written last, so that a network with a note is whole.
    return tuple(network.out / name for name in (WEIGHTS, METRICS, RUN))


def _reads(repetition: Repetition) -> tuple[object, ...]:
    """Return what `load_limb_data` takes of a training: trainings with the same have the same data."""
    training = repetition.training
    network = repetition.training.network
    return network.Q, network.T, network.joints, training.target, training.held_out, training.learning.data_s


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
