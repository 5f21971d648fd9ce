"""Time of MOB-Net's estimates of a test: recordings side by side on their residuals, against each by itself.

By itself, a recording is observed anew, and each network takes it sample by sample. Weights are random and motion is
smooth: the time does not depend on them. One thread, CPU time, in turns; not counted: reading and writing files.
"""

import statistics
import time

import numpy as np
from benchmarks.observer_speed import LEVEL, motion
from benchmarks.step_latency import six_networks

from experiments.settings.load import load_settings
from mobnet.core.estimator import Stretch
from mobnet.estimation.observe import observer_of
from mobnet.estimation.residual import ResidualEstimator
from mobnet.robot.description import describe

RECORDINGS, ROUNDS = 15, 3
MINUTE_S = 60.0
BAR = 5.0  # 15 recordings in the time of three


def main() -> list[dict[str, float | str]]:
    """Return one row: CPU time [s] of a minute of recording by both ways, and their ratio over the turns."""
    settings = load_settings(overrides={"scale": "default"})
    robot, rate, observing = describe(settings.robot), settings.rates.data_hz, settings.observer
    known = (
        settings.levels[LEVEL].nominal_mass_ratio,
        settings.plant.gravity_m_s2,
        observing.gain_hz,
        rate,
        observing.torque,
    )
    observer, networks, sensed = observer_of(robot, *known), six_networks(settings), motion(robot.layout, rate)
    estimator, stretch = ResidualEstimator(observer, robot.layout, networks), Stretch(sensed, observer.residual(sensed))
    columns = robot.layout.columns(networks.joints)

    def turn() -> tuple[float, float]:
        started = time.process_time()
        together = estimator.estimate_all([stretch] * RECORDINGS)
        between = time.process_time()
        residual, state, means = observer.residual(sensed), networks.init(), []
        for k in range(len(sensed)):
            state, prediction = networks.step(state, sensed[k])
            means.append(prediction.mean)
        ended = time.process_time()
        alone = residual[:, columns] - np.stack(means)
        np.testing.assert_allclose(together[0].tau_ext, alone, rtol=0, atol=1e-3)
        minutes = len(sensed) / rate / MINUTE_S
        return (between - started) / RECORDINGS / minutes, (ended - between) / minutes

    turns = [turn() for _ in range(ROUNDS + 1)][1:]
    ours, alone = (statistics.median(column) for column in zip(*turns, strict=True))
    ratios = [theirs / mine for mine, theirs in turns]
    name = f"estimates of MOB-Net, {RECORDINGS} recordings side by side, against each by itself"
    return [
        {"name": name, "ours": ours, "reference": alone, "unit": "s/min", "ratio": statistics.median(ratios),
         "ratio_min": min(ratios), "bar": BAR},
    ]  # fmt: skip


if __name__ == "__main__":
    for row in main():
        print("{name}: {ours:.2f} against {reference:.2f} {unit}, ratio {ratio:.1f}".format(**row))
