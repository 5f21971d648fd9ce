"""Random torque exploration obeys the law of section 4.3."""

from itertools import pairwise

import numpy as np
import pytest
from library_settings import walk_settings
from scipy.stats import kstest

from mobnet.control.random_torque import advance_random_torque, make_exploration
from mobnet.core.errors import ConfigError

TICK_S, TICKS = 0.0005, 100_000
P_VALUE = 1e-3


@pytest.fixture(scope="module")
def history(settings, layout):
    """The law and 50 s of its torque (T, nu)."""
    law = make_exploration(settings.random_torque, layout, True)
    rng, rows = np.random.default_rng(4), np.zeros((TICKS, layout.nu))
    for row in rows:
        advance_random_torque(law, rng, TICK_S)
        row[:] = law.value
    return law, rows


@pytest.mark.parametrize(("scenario", "largest"), [("robot_walk_plain", 0.0), ("robot_walk", 50.0)])
def test_a_scenario_has_the_random_torque_or_none(settings, layout, scenario, largest):
    walk = walk_settings(settings, scenario, "robot_1")
    law = make_exploration(walk.random_torque, layout, bool(walk.scenario.random_torque))
    own = dict(zip(layout.actuated, law.amplitude, strict=True))
    assert [own[joint] for joint in (*layout.limb("LL"), *layout.limb("RL"), *layout.limb("W"))] == [largest] * 15
    assert (own["LA1"] > 0.0) == (largest > 0.0)


def periods(torque):
    """Return on or off, length [ticks] and torque of the whole periods of one joint."""
    edges = np.flatnonzero(np.diff(torque)) + 1
    return [(torque[a] != 0, b - a, torque[a]) for a, b in pairwise(edges)]


def test_on_and_off_periods_are_uniform(history):
    """The reference is U(0.1, 0.5) s of section 4.3, by a Kolmogorov-Smirnov test."""
    law, rows = history
    drawn = [period for column in rows.T for period in periods(column)]
    for state in (True, False):
        lengths = np.array([length for on, length, _ in drawn if on == state]) * TICK_S
        assert len(lengths) > 1000
        uniform = (law.shortest, law.longest - law.shortest)
        assert kstest(lengths, "uniform", args=uniform).pvalue > P_VALUE


def test_torque_is_uniform_up_to_each_joint_s_amplitude(history):
    """The reference is U(-a, a) of section 4.3, by a Kolmogorov-Smirnov test."""
    law, rows = history
    sizes = [value / law.amplitude[j] for j, column in enumerate(rows.T) for on, _, value in periods(column) if on]
    assert kstest(sizes, "uniform", args=(-1, 2)).pvalue > P_VALUE
    assert (np.abs(rows) <= law.amplitude).all()


def test_joints_switch_independently_and_on_alternates_with_off(history):
    on = (history[1] != 0).astype(float)
    correlation = np.corrcoef(on.T) - np.eye(on.shape[1])
    assert np.abs(correlation).max() < 0.5
    assert abs(correlation.mean()) < 0.02
    for column in history[1].T:
        states = [period[0] for period in periods(column)]
        assert all(a != b for a, b in pairwise(states))


def test_amplitudes_are_those_of_section_4_3(settings, layout):
    law = make_exploration(settings.random_torque, layout, True)
    amplitude = dict(zip(layout.actuated, law.amplitude, strict=True))
    for limb in ("LL", "RL", "W"):
        assert {amplitude[joint] for joint in layout.limb(limb)} == {50.0}
    for limb in ("LA", "RA"):
        assert [amplitude[joint] for joint in layout.limb(limb)] == [3, 15, 15, 10, 10, 5, 5, 5]
    assert (law.shortest, law.longest) == (0.1, 0.5)


def test_amplitudes_that_do_not_fit_their_limb_are_refused(settings, layout):
    law = settings.random_torque.model_copy(update={"arms_nm": (3.0, 15.0)})
    with pytest.raises(ConfigError, match=r"random_torque.arms_nm: 2 values; accepted: 8 \(LA\)"):
        make_exploration(law, layout, True)
