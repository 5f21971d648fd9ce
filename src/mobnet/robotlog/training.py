"""How a network of a limb learns from a log of one's own: as MOB-Net's networks do, at the log's own rate.

A network counts time in samples, so that it runs at the rate at which it learned; the times of a training are kept.
"""

from collections.abc import Sequence

from mobnet.estimation.own import LEARNED
from mobnet.learning.precision import in_precision, of_processor
from mobnet.settings.lab import Lab
from mobnet.settings.networks import Coarse, Learning, Limb, Network, Training
from mobnet.settings.robot import RobotTable


def training_of(settings: Lab, table: RobotTable, limb: str, labels: str, rate_hz: float, epochs: int) -> Training:
    """Return how a limb's network learns from a log at a rate [Hz]: as MOB-Net's does, of the same cell.

    A limb without an entry in the table's `networks` sees its own joints.
    """
    numbers = settings.robotlog.learn
    ports = table.networks.get(limb) or Limb(joints=(limb,), Q=(limb,), T=(limb,))
    # In free motion the residual follows from motion and torque alone. A network that sees both would learn to be the
    # observer, and take away every push with it.
    ports = ports.model_copy(update={"T": ()}) if labels == "free" else ports
    row = settings.networks.get(limb) or settings.networks[numbers.cell]
    learning = in_precision(settings.learning, of_processor())
    horizon = row.horizon_steps
    return Training(
        method=LEARNED,
        limb=limb,
        target="uncertainty",
        network=Network.model_validate({**vars(ports), **vars(row)}),
        learning=_at_rate(learning, rate_hz / settings.rates.data_hz),
        epochs=epochs,
        epoch_samples=max(numbers.epoch_samples, horizon * numbers.updates),
    )


def _at_rate(learning: Learning, ratio: float) -> Learning:
    """Return how a network learns at a rate that is so many times that of the configuration: strides are times."""
    phases = [(max(1, round(phase.stride * ratio)), phase.share) for phase in learning.coarse]
    strides = dict.fromkeys(stride for stride, _ in phases if stride > 1)
    coarse = list[Coarse]()
    for stride in strides:
        share = sum(share for other, share in phases if other == stride)
        coarse.append(Coarse(stride=stride, share=share))
    return learning.model_copy(update={"coarse": tuple(coarse)})


def filled(training: Training, segments: Sequence[tuple[int, int]], settings: Lab) -> Training:
    """Return a training whose batches a log fills: of a short log, fewer lanes learn at once."""
    stride = max((phase.stride for phase in training.learning.coarse), default=1)
    horizons = sum(end - start for start, end in segments) // (training.network.horizon_steps * stride)
    lanes = max(1, min(training.learning.batch_size, horizons // 4))
    epoch = training.epoch_samples or settings.robotlog.learn.epoch_samples
    lanes = max(1, min(lanes, epoch // (training.network.horizon_steps * settings.robotlog.learn.updates)))
    return training.model_copy(update={"learning": training.learning.model_copy(update={"batch_size": lanes})})
