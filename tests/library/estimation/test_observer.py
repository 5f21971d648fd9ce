"""The observer against closed forms: (10), second order in time, linearity, symmetry, the law of its noise."""

import tracemalloc
from dataclasses import replace

import numpy as np
import pytest

from mobnet.core.errors import ConfigError, DataError
from mobnet.core.recording import Sensed
from mobnet.estimation.observer import RobotObserver
from mobnet.kernel.low_pass import exact_pole, low_pass
from mobnet.robot.dynamics import mass_matrix, momentum_and_beta

GAIN_HZ, RATE_HZ = 100.0, 1000.0
STEP_NM, SECONDS = 30.0, 0.2
BOUND_NM = 0.004  # holds at 1 ms for the scheme and for none of its mutants


@pytest.fixture
def pushed(nominal, follow):
    """A function rate_hz -> what is sensed and the true external torque while LL3 is pushed by 30 N m."""
    external = np.zeros(nominal.robot.layout.nu)
    external[nominal.robot.layout.actuated.index("LL3")] = STEP_NM
    return lambda rate_hz: follow(rate_hz, SECONDS, external)


def closed_form(count, rate_hz):
    """Return the answer of (10) to the push, (count,) [N m]."""
    return STEP_NM * (1 - np.exp(-GAIN_HZ * np.arange(count) / rate_hz))


def push_error(nominal, residual, rate_hz):
    """Return the largest departure of LL3 from the closed form [N m]."""
    column = nominal.robot.layout.columns(["LL3"])[0]
    return float(np.abs(residual[:, column] - closed_form(len(residual), rate_hz)).max())


def recursion(nominal, sensed, pole, shift=0, share=0.5):
    """Return r of (9) by the plain loop; a pole, a torque `shift` samples late or a one-sided beta make a mutant."""
    p, beta = momentum_and_beta(nominal, sensed.q, sensed.v)
    u = np.concatenate([np.zeros((len(p), 6)), sensed.tau_motor], axis=1)
    residual = np.zeros_like(p)
    for k in range(1, len(p)):
        raw = (p[k] - p[k - 1]) * RATE_HZ - u[max(k - shift, 0)] - share * beta[k] - (1 - share) * beta[k - 1]
        residual[k] = pole * residual[k - 1] + (1 - pole) * raw
    return residual


def test_answer_to_a_push_converges_to_the_closed_form_with_second_order(nominal, pushed):
    rates = np.array([500.0, 1000.0, 2000.0])
    errors = [push_error(nominal, RobotObserver(nominal, GAIN_HZ, r).residual(pushed(r)[0]), r) for r in rates]
    np.testing.assert_array_less(errors, [0.016, BOUND_NM, 0.001])
    orders = np.diff(np.log(errors)) / np.diff(np.log(1 / rates))
    np.testing.assert_allclose(orders, 2, atol=0.1)


@pytest.mark.parametrize("mutant", [
    {"pole": np.exp(-GAIN_HZ / RATE_HZ), "shift": 1},
    {"pole": np.exp(-GAIN_HZ / RATE_HZ), "share": 1.0},
    {"pole": np.exp(-GAIN_HZ / RATE_HZ), "share": 0.0},
    {"pole": 1 - GAIN_HZ / RATE_HZ},
], ids=["late torque", "beta after the step", "beta before the step", "Euler's pole"])  # fmt: skip
def test_mutants_of_the_scheme_miss_the_bound(nominal, pushed, mutant):
    assert push_error(nominal, recursion(nominal, pushed(RATE_HZ)[0], **mutant), RATE_HZ) > 10 * BOUND_NM


def test_all_joints_and_the_base_follow_the_low_passed_truth(observer, pushed):
    sensed, truth = pushed(RATE_HZ)
    error = observer.residual(sensed) - low_pass(truth, GAIN_HZ, RATE_HZ)
    assert np.abs(error).max() < 0.02  # second order in 1 ms of forces of some 1000 N


def test_batch_equals_the_recursion_and_stepping(nominal, observer, pushed):
    """Three forms of the observer are equivalent; the recursion of (7) is the reference."""
    sensed, _ = pushed(RATE_HZ)
    batch = observer.residual(sensed)
    np.testing.assert_allclose(recursion(nominal, sensed, observer.pole), batch, atol=1e-9)
    state, rows = observer.init(), []
    for k in range(len(sensed)):
        state, residual = observer.step(state, sensed[k])
        rows.append(residual)
    np.testing.assert_allclose(rows, batch, atol=1e-9)


def test_blocks_of_samples_change_no_bit(observer, pushed, monkeypatch):
    sensed, _ = pushed(RATE_HZ)
    whole = observer.residual(sensed)
    monkeypatch.setattr("mobnet.kernel.recursion.BLOCK_ROWS", 7)
    out = np.empty(whole.shape)
    assert observer.residual(sensed, out) is out
    np.testing.assert_array_equal(out, whole)


def test_needs_little_memory_beside_its_result(observer, pushed):
    sensed, _ = pushed(RATE_HZ)
    rows = np.resize(np.arange(len(sensed)), 20_000)
    many = Sensed(*(getattr(sensed, name)[rows] for name in Sensed.__dataclass_fields__))
    observer.residual(many[:10])
    tracemalloc.start()
    result = observer.residual(many)
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert most < 2 * result.nbytes


def test_is_the_form_of_bledt_2018(nominal, observer, pushed):
    """Its filter has p itself as an input and starts at b p_0 (docs/notes/observer.md)."""
    sensed, _ = pushed(RATE_HZ)
    p, beta = momentum_and_beta(nominal, sensed.q, sensed.v)
    b = (1 - observer.pole) * RATE_HZ / observer.pole
    y, expected = b * p[0], np.zeros_like(p)
    for k in range(1, len(p)):
        known = np.concatenate([np.zeros(6), sensed.tau_motor[k]]) + (beta[k] + beta[k - 1]) / 2
        y = observer.pole * y + (1 - observer.pole) * (b * p[k] + known)
        expected[k] = b * p[k] - y
    np.testing.assert_allclose(observer.residual(sensed), expected, atol=1e-9)


def test_single_precision_logs_lose_nothing_that_matters(observer, pushed):
    sensed, _ = pushed(RATE_HZ)
    logged = Sensed(*(getattr(sensed, name).astype(np.float32) for name in Sensed.__dataclass_fields__))
    assert np.abs(observer.residual(logged) - observer.residual(sensed))[:, 6:].max() < 0.01


def test_is_linear_in_the_torque(observer, pushed):
    """More motor torque is its closed form, low-passed and subtracted."""
    sensed, _ = pushed(RATE_HZ)
    extra = np.random.default_rng(0).normal(size=sensed.tau_motor.shape)
    heavier = replace(sensed, tau_motor=sensed.tau_motor + 2 * extra)
    expected = observer.residual(sensed)[:, 6:] - 2 * low_pass(extra, GAIN_HZ, RATE_HZ)
    np.testing.assert_allclose(observer.residual(heavier)[:, 6:], expected, atol=1e-9)


def test_noise_of_velocity_obeys_its_law(nominal, observer):
    rng, count, layout = np.random.default_rng(1), 20_000, nominal.robot.layout
    q = np.zeros(layout.nq)
    q[3] = 1.0
    std = np.concatenate([np.full(3, 1e-3), np.full(3, 5e-3), np.full(layout.nu, 2e-3)])
    v = std * rng.normal(size=(count, layout.nv))
    still = np.zeros((count, layout.nu))
    acc, swing, command = (np.zeros((count, width)) for width in (3, 2, 5))
    sensed = Sensed(np.tile(q, (count, 1)), v, acc, still, still, swing, command, swing)
    factor = (1 - observer.pole) * RATE_HZ * np.sqrt(2 / (1 + observer.pole))
    assert factor == pytest.approx(97.5, abs=0.05)
    expected = factor * np.sqrt((mass_matrix(nominal, q) * std) ** 2 @ np.ones(layout.nv))
    np.testing.assert_allclose(observer.residual(sensed)[100:].std(axis=0), expected, rtol=0.03)


def test_low_pass_has_the_observer_s_pole(observer):
    answer = low_pass(np.ones((20, 2)), GAIN_HZ, RATE_HZ)
    np.testing.assert_allclose(answer[:, 0], 1 - observer.pole ** np.arange(20), atol=1e-12)
    assert exact_pole(GAIN_HZ, RATE_HZ) == observer.pole == pytest.approx(0.904837, abs=1e-6)


@pytest.mark.parametrize(("gain_hz", "rate_hz"), [(0.0, 1000.0), (100.0, -1.0)])
def test_gain_or_rate_not_above_zero_is_named(nominal, gain_hz, rate_hz):
    with pytest.raises(ConfigError, match=f"gain {gain_hz} 1/s at {rate_hz} Hz"):
        RobotObserver(nominal, gain_hz, rate_hz)


def test_samples_of_another_robot_are_refused(observer, pushed):
    sensed, _ = pushed(RATE_HZ)
    with pytest.raises(DataError, match=r"\(201, 39\), \(201, 39\), \(201, 33\)\]; accepted"):
        observer.residual(replace(sensed, q=sensed.q[:, :-1]))
