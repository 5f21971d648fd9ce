"""A robot that walks into a wall on the plant of section 5.1, with the observer alone in its loop."""

import numpy as np
import pytest
from library_settings import walk_settings

from mobnet.detection.chain import make_chain
from mobnet.detection.detector import LegDetector, LegGate
from mobnet.detection.signals import Watched
from mobnet.estimation.kinds import build_estimator
from mobnet.formats.plain import as_plain
from mobnet.kernel.detecting import GateNumbers, WatchedSignals
from mobnet.reaction.handler import Handler
from mobnet.reaction.loop import walk_with
from mobnet.reaction.numbers import ReactionNumbers
from mobnet.reaction.watchers import LegWatcher, LimbWatcher
from mobnet.simulation.simulator import Simulator

RATE_HZ = 1000.0
THRESHOLD_NM = 12.0  # several times the error of the observer under sensor noise


@pytest.fixture(scope="session")
def leg_watchers(settings, robot):
    """What watches both legs, by a threshold on the observer's torque."""

    def watcher(limb):
        detection = settings.detection
        chain = make_chain(detection.low_pass_hz, detection.hold_s, RATE_HZ, np.full((1, 6), THRESHOLD_NM))
        gate = LegGate.of(as_plain(detection.gate, GateNumbers), robot, limb, RATE_HZ)
        detector = LegDetector(Watched(WatchedSignals(signals=("mean",))), gate, chain)
        return LegWatcher(detector, robot.layout.columns(robot.layout.limb(limb)))

    return {limb: watcher(limb) for limb in ("LL", "RL")}


@pytest.fixture(scope="session")
def limb_watcher(settings, robot):
    """A function of a limb -> what watches it all the time, by a threshold on the observer's torque."""

    def watcher(limb):
        joints, detection = robot.layout.limb(limb), settings.detection
        chain = make_chain(detection.low_pass_hz, detection.hold_s, RATE_HZ, np.full((1, len(joints)), THRESHOLD_NM))
        watched = Watched(WatchedSignals(signals=("mean",)))
        return LimbWatcher(watched, chain, robot.layout.columns(joints))

    return watcher


@pytest.fixture(scope="session")
def into(robot, recipe_of, settings):
    """A function (scenario, seed, watchers, ...) -> the course of a walk that something ends, and the simulator."""

    def walk(scenario, seed, watchers, strategy="compliant", seconds=10.0, after_s=5.0):
        simulator = Simulator(walk_settings(settings, scenario, "sensor_noise"), seed)
        simulator.start()
        handler = Handler(
            robot, as_plain(settings.reaction, ReactionNumbers), settings.walking.foot_spacing_m, watchers, strategy
        )
        estimator = build_estimator(recipe_of("MOB", "sensor_noise"))
        samples, after = round(seconds * RATE_HZ), round(after_s * RATE_HZ)
        numbers = settings.reaction.touch_n, settings.detection.gate.contact_height_m
        return walk_with(simulator, estimator, handler, samples, after, *numbers), simulator

    return walk
