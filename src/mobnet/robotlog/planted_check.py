"""Which detector finds most of the pushes that are planted into the held-out part of logs, without a false alarm there.

`./reproduce calibrate` compares again, at the wanted rate of false alarms, on logs that trained nothing.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.estimator import Estimate
from mobnet.detection.always import always_on, setup_of
from mobnet.detection.choice import ALONE, BARE, NETWORK, SEED, pushing_of
from mobnet.detection.gate import Spans
from mobnet.detection.limb import watched_signal
from mobnet.detection.planted import found_pushes, plant
from mobnet.detection.signals import MEAN, RATIO
from mobnet.detection.watch import LegRecording
from mobnet.estimation.sampling import Sampling
from mobnet.kernel.detecting import Signal
from mobnet.robot.nominal import NominalModel
from mobnet.settings.lab import Lab

NETWORKS = NETWORK.format(MEAN), NETWORK.format(RATIO)
WATCHED: Mapping[str, Signal] = {BARE: MEAN, ALONE: MEAN, NETWORKS[0]: MEAN, NETWORKS[1]: RATIO}


@dataclass(frozen=True)
class PlantedCheck:
    """How many of some pushes each detector finds, in the order from the simplest to the one with most in it."""

    pushes: int
    found: Mapping[str, int]

    @property
    def kept(self) -> str:
        """The detector that finds most, the simplest of equals."""
        return max(self.found, key=lambda name: self.found[name])

    @property
    def has_network(self) -> bool:
        """Whether that one has a network."""
        return self.kept in NETWORKS

    def note(self) -> dict[str, Any]:
        """Return it as JSON for `run.json`."""
        return {"pushes": self.pushes, "found": dict(self.found), "kept": self.kept}

    def line(self) -> str:
        """Return what the command prints."""
        shares = ", ".join(
            f"{name.replace(',', ' by its')} {count / self.pushes:.0%}" for name, count in self.found.items()
        )
        return f"of {self.pushes} pushes planted there, found without a false alarm: {shares}; kept: {self.kept}"


def planted_check(
    nominal: NominalModel,
    limb: str,
    sampling: Sampling,
    q: NDArray[Any],
    segments: Spans,
    network: Estimate,
    observers: Sequence[NDArray[Any]],
    settings: Lab,
) -> PlantedCheck | None:
    """Plant pushes into a part of logs, and return which detectors find them; None where it is too short for a push.

    Args:
        nominal: model of the robot.
        limb: limb of the robot.
        sampling: of the logs.
        q: position of the robot (T, nq).
        segments: contiguous stretches of the part.
        network: errors of the external torque with a network (T, n) [N m], and their standard deviation.
        observers: errors of the observer alone (T, n) [N m], after those of one that does not know the friction of the
            table where this has some.
        settings: all numbers.
    """
    setup = setup_of(settings.detection, nominal.robot, limb, sampling.rate_hz, walks=False)
    gate = always_on(len(q), segments, settings.robotlog.settle_s, sampling.rate_hz)
    leg = LegRecording(Path(), segments, np.zeros((len(q), 0)), gate, (), ())
    planted = plant(setup, nominal, sampling.gain_hz, [leg], [q], pushing_of(settings), SEED)
    if not planted:
        return None
    count = len(observers)
    names = [*(BARE, ALONE)[-count:], *NETWORKS]
    estimates = [*map(Estimate, observers), *(network,) * len(NETWORKS)]
    counts = dict[str, int]()
    for name, estimate in zip(names, estimates, strict=True):
        watched = watched_signal(WATCHED[name])
        low = setup.low_passed(watched.of(estimate, leg.command), segments)
        # Nothing touched the robot here: these are the lowest thresholds that raise no false alarm.
        thresholds = np.abs(low[gate.watched]).max(axis=0)
        hits = found_pushes(setup, watched, thresholds, [leg], [estimate], planted)
        counts[name] = int(np.count_nonzero(hits))
    return PlantedCheck(sum(len(push.spans) for push in planted), counts)
