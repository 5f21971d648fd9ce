"""The rule `train`: it trains networks that learn from the same recordings."""

from collections.abc import Sequence
from itertools import groupby
from pathlib import Path

from experiments.plan.parts import Repetition
from experiments.running.stage import Stage
from mobnet.core.files import METRICS, RUN, WEIGHTS
from mobnet.core.joints import JointLayout
from mobnet.learning.dataset import Known, load_limb_data
from mobnet.learning.job import TrainingJob
from mobnet.learning.swings import Margins
from mobnet.learning.train import train_on


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
