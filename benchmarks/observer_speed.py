"""Speed of the observer over a recording against stepping it sample by sample in Python; one thread, in turns.

Smooth random motion of all joints: the time does not depend on it.
"""

import statistics
import time
from typing import Any

import numpy as np

from mobnet.core.columns import COMMAND, FEET
from mobnet.core.joints import NQ_BASE, JointLayout
from mobnet.core.recording import Sensed
from mobnet.estimation.observe import observer_of
from mobnet.estimation.observer import MomentumObserver
from mobnet.robot.description import describe
from mobnet.settings.load import load_settings

LEVEL = "all_uncertainty"
SAMPLES, ROUNDS = 5000, 5


def main() -> list[dict[str, float | str]]:
    """Return one row: microseconds a sample of both, and their ratio over the turns."""
    settings = load_settings()
    robot, rate, observing = describe(settings.robot), settings.rates.data_hz, settings.observer
    level, gravity = settings.levels[LEVEL], settings.plant.gravity_m_s2
    observer = observer_of(robot, level, gravity, observing.gain_hz, rate, observing.torque)
    sensed = motion(robot.layout, rate)
    turns = [_turn(observer, sensed) for _ in range(ROUNDS + 1)][1:]
    ours, loop = (statistics.median(column) / SAMPLES * 1e6 for column in zip(*turns, strict=True))
    ratios = [theirs / mine for mine, theirs in turns]
    return [
        {
            "name": "observer, a recording at once, against a loop of single samples",
            "ours": ours,
            "reference": loop,
            "unit": "us/sample",
            "ratio": statistics.median(ratios),
            "ratio_min": min(ratios),
        }
    ]


def _turn(observer: MomentumObserver, sensed: Sensed) -> tuple[float, float]:
    """Return the CPU time [s] of the recording at once and sample by sample."""
    started = time.process_time()
    residual = observer.residual(sensed)
    between = time.process_time()
    state, last = observer.init(), residual[0]
    for k in range(SAMPLES):
        state, last = observer.step(state, sensed[k])
    ended = time.process_time()
    np.testing.assert_allclose(residual[-1], last, atol=1e-6)
    return between - started, ended - between


def motion(layout: JointLayout, rate_hz: float) -> Sensed:
    """Return smooth motion of all joints about an upright base, (SAMPLES, ...)."""
    rng = np.random.default_rng(0)
    phase = np.arange(SAMPLES)[:, None] / rate_hz * rng.uniform(1.0, 10.0, layout.nv)
    q, v = np.zeros((SAMPLES, layout.nq)), np.cos(phase)
    q[:, NQ_BASE - 4] = 1.0
    q[:, NQ_BASE:] = np.sin(phase[:, layout.nv - layout.nu :])
    torque: Any = 30.0 * np.sin(phase[:, layout.nv - layout.nu :])
    flags, command = np.zeros((SAMPLES, len(FEET))), np.zeros((SAMPLES, len(COMMAND)))
    return Sensed(q, v, np.zeros((SAMPLES, 3)), torque, torque, flags, command, flags)


if __name__ == "__main__":
    for row in main():
        print(
            "{name}: {ours:.1f} against {reference:.1f} {unit}, ratio {ratio:.2f}, least {ratio_min:.2f}".format(**row)
        )
