"""Time of a walk with MOB-Net and the pipeline of section 7 in its loop, against real time, and of one of its ticks.

Weights are random and the controller has the feet's sensors: the time depends on neither. Thresholds are never reached.
"""

import time
from typing import Any

import numpy as np
from benchmarks.step_latency import six_networks

from experiments.plan.jobs import walk_settings
from experiments.settings.load import load_settings
from experiments.settings.settings import Settings
from mobnet.core.machine import one_thread
from mobnet.detection.chain import make_chain
from mobnet.detection.detector import LegDetector, LegGate
from mobnet.detection.signals import Watched
from mobnet.estimation.observe import observer_of
from mobnet.estimation.residual import ResidualEstimator
from mobnet.formats.plain import as_plain
from mobnet.kernel.detecting import GateNumbers, WatchedSignals
from mobnet.reaction.handler import Handler
from mobnet.reaction.loop import walk_with
from mobnet.reaction.numbers import ReactionNumbers
from mobnet.reaction.watchers import LegWatcher, LimbWatcher
from mobnet.robot.description import describe
from mobnet.simulation.simulator import Simulator

SCENARIO, LEVEL, SEED = "walk_test", "sensor_noise", 1
WALKED, WARM_UP = 20_000, 500  # samples
FACTOR_BAR, TICK_BAR_US = 2.0, 250.0
Row = dict[str, float | str]


class Timed:
    """Something with `init` and `step`, and how long each step takes [s]."""

    def __init__(self, stepped: Any) -> None:
        self.stepped, self.times = stepped, list[float]()

    def __getattr__(self, name: str) -> Any:
        return getattr(self.stepped, name)

    def step(self, *words: Any) -> Any:
        """Step, and note how long it takes."""
        started = time.perf_counter()
        result = self.stepped.step(*words)
        self.times.append(time.perf_counter() - started)
        return result


def main() -> list[Row]:
    """Return rows of the speed of a walk and of a tick of estimator and pipeline."""
    one_thread()
    settings = load_settings(overrides={"scale": "default"})
    layout, level, rate_hz = settings.layout, settings.levels[LEVEL], settings.rates.data_hz
    known = describe(settings.robot), level.nominal_mass_ratio, settings.plant.gravity_m_s2
    observer = observer_of(*known, settings.observer.gain_hz, rate_hz, settings.observer.torque)
    estimator = Timed(ResidualEstimator(observer, layout, six_networks(settings)))
    handler = Timed(_handler(settings, rate_hz))
    simulator = Simulator(walk_settings(settings, SCENARIO, LEVEL), SEED)
    simulator.start()
    numbers = settings.reaction.touch_n, settings.detection.gate.contact_height_m
    walk_with(simulator, estimator, handler, WARM_UP, WARM_UP, *numbers)  # compiles
    estimator.times.clear()
    handler.times.clear()
    started = time.perf_counter()
    course = walk_with(simulator, estimator, handler, WALKED, WALKED, *numbers)
    took_s = time.perf_counter() - started
    ticks_us = 1e6 * (np.array(estimator.times) + np.array(handler.times))
    factor, (median, late) = len(course.rows) / rate_hz / took_s, np.percentile(ticks_us, [50, 99])
    return [
        {"name": "a walk with MOB-Net and the pipeline in its loop, over real time", "ours": factor, "unit": "-",
         "at_least": FACTOR_BAR},
        {"name": "estimator and pipeline, one tick, median", "ours": float(median), "unit": "us"},
        {"name": "estimator and pipeline, one tick, 99th percentile", "ours": float(late), "unit": "us",
         "at_most": TICK_BAR_US},
    ]  # fmt: skip


def _handler(settings: Settings, rate_hz: float) -> Handler:
    """Return the pipeline with watchers of all limbs that never say anything."""
    robot, detection = describe(settings.robot), settings.detection
    watched = Watched(as_plain(detection.detectors[settings.reaction.ours.detector], WatchedSignals))
    swing = as_plain(detection.gate, GateNumbers)
    watchers: dict[str, Any] = {}
    for limb in (*detection.legs, *settings.reaction.watched):
        joints, columns = robot.layout.limb(limb), robot.layout.columns(robot.layout.limb(limb))
        never = np.full((1, len(watched.names(joints))), np.inf)
        chain = make_chain(detection.low_pass_hz, detection.hold_s, rate_hz, never)
        gate = LegGate.of(swing, robot, limb, rate_hz) if limb in detection.legs else None
        leg = LegWatcher(LegDetector(watched, gate, chain), columns) if gate else None
        watchers[limb] = leg or LimbWatcher(watched, chain, columns)
    return Handler(
        robot, as_plain(settings.reaction, ReactionNumbers), settings.walking.foot_spacing_m, watchers, "compliant"
    )


if __name__ == "__main__":
    for row in main():
        print("{name}: {ours:.2f} {unit}".format(**row))
