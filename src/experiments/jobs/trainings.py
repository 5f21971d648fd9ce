"""The rule `train`: it trains one network of a limb."""

import importlib
from collections.abc import Sequence
from pathlib import Path

from mobnet.core.joints import JointLayout
from mobnet.learning.dataset import Known, LimbData, load_limb_data
from mobnet.learning.job import TrainingJob
from mobnet.learning.swings import Margins
from mobnet.learning.train import train_on
from mobnet.settings.methods import ObserverSettings
from mobnet.settings.networks import Training


def train(
    root_seed: int,
    layout: JointLayout,
    training: Training,
    seed: int,
    recordings: Sequence[Path],
    residuals: Sequence[Path],
    state: Path,
    out: Path,
    rate_hz: float | None = None,
    start: Path | None = None,
    margins: Margins | None = None,
    observer: ObserverSettings | None = None,
    fitted: Path | None = None,
    lesson: tuple[Path, str] | None = None,
) -> None:
    """Train a network on recordings; a training that was killed goes on from its last epoch.

    Args:
        root_seed: of all random numbers.
        layout: the robot's joints.
        training: all that the training takes.
        seed: number of the repetition.
        recordings: without their endings.
        residuals: the observer's, in the same order.
        state: folder of the checkpoint.
        out: folder of the network.
        rate_hz: of the recordings [Hz], where it is given.
        start: weights from which it is fine-tuned; None of one that learns from the first.
        margins: where swings label, what is left out of them.
        observer: the observer's settings, of a network with a fit.
        fitted: what rule `fit` wrote, whose friction is known of the target; None where nothing is known.
        lesson: file of what it has learned in a stack, and its name there; None of one that learns alone.

    Raises:
        DataError: a recording, a residual or the fit is damaged, or they are too short.
        TrainingError: the loss diverged, where `learning.may_diverge` does not allow it.
    """
    known = None
    if fitted:
        # By its name, so that no other training has the code of friction in its hash.
        known = importlib.import_module("experiments.jobs.fitting").known_of(layout, observer, fitted)
    data = data_of(layout, training, recordings, residuals, rate_hz, margins, known)
    train_on(data, TrainingJob(training, seed, root_seed), out, state, start, lesson, in_place=True)


def data_of(
    layout: JointLayout,
    training: Training,
    recordings: Sequence[Path],
    residuals: Sequence[Path],
    rate_hz: float | None = None,
    margins: Margins | None = None,
    known: Known | None = None,
) -> LimbData:
    """Return what a training learns from, of arguments as `train` gets them.

    Raises:
        DataError: a recording or a residual is damaged.
    """
    return load_limb_data(
        layout=layout,
        limb=training.network,
        target=training.target,
        recordings=recordings,
        residuals=residuals,
        rate_hz=rate_hz,
        held_out=training.held_out,
        known=known,
        first_s=training.learning.data_s,
        margins=margins,
    )
