"""What watches limbs all the time: the signals of a detector against thresholds."""

import numpy as np
import pytest

from mobnet.core.estimator import Estimate
from mobnet.core.recording import Sensed
from mobnet.detection.chain import make_chain
from mobnet.detection.signals import Watched
from mobnet.formats.plain import as_plain
from mobnet.kernel.detecting import WatchedSignals
from mobnet.reaction.numbers import WrenchDamping
from mobnet.reaction.watchers import BaseForce, BaseWatcher, LimbWatcher

THRESHOLD, TORQUE_NM = 3.0, 12.0


@pytest.mark.parametrize(("std_nm", "ratio"), [(2.0, 2.0), (10.0, 0.4)])
def test_a_limb_is_watched_by_its_torque_over_the_standard_deviation(std_nm, ratio):
    """A network that is less sure of itself, as in a hard step, raises no alarm by the same torque."""
    columns = np.array([4, 5])
    watched = Watched(WatchedSignals(signals=("ratio",)))
    watcher = LimbWatcher(watched, make_chain(15.0, 0.005, 1000.0, np.full((1, 2), THRESHOLD)), columns)
    sample = Sensed(*(np.zeros(5) for _ in Sensed.__dataclass_fields__))
    tau = np.zeros(6)
    tau[5] = -TORQUE_NM
    state = watcher.init()
    found = [watcher.ratio(state, sample, Estimate(tau, np.full(6, std_nm))) for _ in range(500)]
    assert found[0] < found[-1] == pytest.approx(ratio, rel=1e-3)


@pytest.fixture
def base(robot, settings):
    numbers = as_plain(settings.reaction.identification, WrenchDamping)
    return BaseForce.of(robot, numbers, settings.detection.gate.contact_height_m)


def test_a_stretch_has_the_forces_of_its_samples(base, made_up, layout):
    sensed, rng = made_up(3, 0.05).sensed, np.random.default_rng(3)
    estimate = Estimate(rng.normal(size=(len(sensed), layout.nv)) * 20.0, np.full((len(sensed), layout.nv), 2.0))
    whole = base.run(sensed, estimate)
    for k in range(len(sensed)):
        one = base.step(sensed[k], Estimate(estimate.tau_ext[k], estimate.std[k]))
        assert (one.tau_ext.tolist(), one.std.tolist()) == (whole.tau_ext[k].tolist(), whole.std[k].tolist())


@pytest.mark.parametrize(("push_n", "is_alarm"), [(60.0, True), (20.0, False)])
def test_a_force_on_the_base_that_no_foot_explains_is_an_alarm(base, made_up, layout, push_n, is_alarm):
    watched = Watched(WatchedSignals(signals=("ratio",)))
    watcher = BaseWatcher(watched, make_chain(15.0, 0.005, 1000.0, np.full((1, 3), THRESHOLD)), base)
    sample, tau = made_up(4, 0.01).sensed[0], np.zeros(layout.nv)
    tau[0] = push_n
    std = np.zeros(layout.nv)
    std[:3] = 10.0
    state = watcher.init()
    found = [watcher.ratio(state, sample, Estimate(tau, std)) for _ in range(500)]
    # Along the axis of the base that is nearest to the force, the ratio is at most that of the force.
    assert (found[-1] > 1.0) == is_alarm
    assert found[-1] <= push_n / 10.0 / THRESHOLD + 1e-6


def test_without_a_standard_deviation_the_force_has_none(base, made_up, layout):
    sample = made_up(4, 0.01).sensed[0]
    assert base.step(sample, Estimate(np.zeros(layout.nv))).std is None
