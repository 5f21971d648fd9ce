"""Detectors that are compared in a walk, on estimators of their own."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from experiments.jobs.react import CaseWalker
from experiments.jobs.reacting_robot import ReactingRobot
from experiments.plan.jobs import walk_settings
from experiments.plan.parts import MethodRun
from experiments.settings.catalogue import Catalogue
from mobnet.core.detections import Threshold
from mobnet.core.estimator import Estimate
from mobnet.estimation.kinds import build_estimator
from mobnet.estimation.observer import RobotObserver
from mobnet.estimation.residual import ResidualEstimator
from mobnet.reaction.loop import columns_of
from mobnet.settings.reaction import Watch

LEVEL = "sensor_noise"


@pytest.fixture
def walker(settings, layout):
    """A robot with the observer alone in its loop, or as another method, and thresholds of the detector `MOB`."""
    methods = Catalogue(settings).all_methods
    mob = MethodRun("MOB", methods, {}, None, 0, layout.names)
    other = replace(mob, method="other", methods={**methods, "other": methods["MOB"]})
    numbers = settings.reaction.model_copy(update={"estimator": "other"})
    walk = walk_settings(settings, "walk_test", LEVEL)
    robot = ReactingRobot(walk, numbers, settings.detection, settings.observer, {"MOB": mob, "other": other})
    rows = []
    for limb in settings.detection.legs:
        rows += [Threshold("MOB", limb, "reaction", f"mean.{joint}", 1, 12.0, "N m") for joint in layout.limb(limb)]
    return CaseWalker(robot, rows)


@pytest.fixture
def steps(monkeypatch):
    """Steps of all observers and of all estimators, counted by class."""
    counted = {RobotObserver: 0, ResidualEstimator: 0}

    def count(kind, step):
        def counting(self, state, sample):
            counted[kind] += 1
            return step(self, state, sample)

        monkeypatch.setattr(kind, "step", counting)

    for kind in counted:
        count(kind, kind.step)
    return counted


def test_in_a_tick_the_observer_runs_once_and_each_estimator_once(walker, steps, made_up, layout, recipe_of):
    sensed = made_up(5, 0.2).sensed
    sensed.swing[:] = 0.0
    sensed.swing[20:, 0] = 1.0  # the left leg swings
    sensed.landing[20:, 0] = 1.0
    watchers = walker.watchers(Watch(detector="MOB", rule="reaction"), np.zeros((2, 6)))
    assert list(watchers) == ["LL", "RL"]
    states = {limb: watcher.init() for limb, watcher in watchers.items()}
    in_loop = walker.estimator("other")
    state = in_loop.init()
    ratios = []
    for k in range(len(sensed)):
        sample = sensed[k]
        state, estimate = in_loop.step(state, sample)
        ratios.append([watcher.ratio(states[limb], sample, estimate) for limb, watcher in watchers.items()])
    assert steps == {RobotObserver: len(sensed), ResidualEstimator: 2 * len(sensed)}
    # A leg's own detector with its own observer is the reference.
    alone = build_estimator(recipe_of("MOB", LEVEL))
    watcher, state = watchers["LL"], alone.init()
    detecting = watcher.detector.init()
    for k in range(len(sensed)):
        state, own = alone.step(state, sensed[k])
        tau = own.tau_ext[watcher.columns]
        assert watcher.detector.step(detecting, sensed[k], Estimate(tau), tau).ratio == ratios[k][0]
    assert max(ratio for ratio, _ in ratios) > 0.0
    assert not any(ratio for _, ratio in ratios)


def test_where_limbs_are_named_no_other_one_is_watched(walker, layout):
    watch = Watch(detector="MOB", rule="reaction")
    rows = list(walker.thresholds)
    ours = walker.robot.reaction.ours
    for limb in walker.robot.reaction.watched:
        for joint in walker.robot.joints_of(limb):
            rows.append(Threshold(ours.detector, limb, ours.rule, f"ratio.{joint}", 1, 5.0, "-"))
    in_loop = walker.robot.reaction.model_copy(update={"estimator": "MOB"})
    whole = CaseWalker(replace(walker.robot, reaction=in_loop), rows)
    wrenches = np.zeros((2, 6))
    assert set(whole.watchers(watch, wrenches)) == {"LL", "RL", *in_loop.watched}
    assert set(whole.watchers(watch, wrenches, ["LL", "RL"])) == {"LL", "RL"}
    assert set(whole.watchers(watch, wrenches, ["LL", "RL", "V"])) == {"LL", "RL", "V"}


def test_mid_swing_is_where_the_gate_is_open_by_the_plan(walker, settings, layout):
    places = columns_of(layout)
    rows = np.zeros((1000, max(span.stop for span in places.values())), np.float32)
    rows[:, places["q"].start + 3] = 1.0
    rows[100:600, places["swing"].start] = 1.0  # the left foot
    rows[100:600, places["landing"].start] = 0.001 * np.arange(500, 0, -1)
    gate = settings.detection.gate
    opens = 100 + round(1000 * gate.lift_off_s) - 1  # samples in the air are counted from 1
    closes = 600 - round(1000 * gate.landing_s)
    found = walker.mid_swing("LL", SimpleNamespace(rows=rows))
    assert np.flatnonzero(found).tolist() == list(range(opens, closes))
    assert not walker.mid_swing("RL", SimpleNamespace(rows=rows)).any()
    assert walker.mid_swing(None, SimpleNamespace(rows=rows)) is None
