"""Gain and phase of filters whose response is known in closed form."""

import numpy as np
import pytest

from experiments.evaluation.measure.estimates.bode import observer_response, transfer
from mobnet.kernel.low_pass import low_pass

RATE_HZ, GAIN_HZ = 1000.0, 100.0
LINES_HZ = (0.5, 2.0, 10.0, 50.0)
TIME = np.arange(50_000) / RATE_HZ
SINES = sum((k + 1) * np.sin(2 * np.pi * f * TIME + k) for k, f in enumerate(LINES_HZ))


@pytest.mark.parametrize("frequency_hz", LINES_HZ)
def test_a_share_of_the_input_is_its_gain_without_phase(frequency_hz: float) -> None:
    assert transfer(SINES, 0.7 * SINES, frequency_hz, RATE_HZ) == pytest.approx(0.7, abs=1e-6)


@pytest.mark.parametrize("frequency_hz", LINES_HZ)
def test_a_delay_is_a_phase_alone(frequency_hz: float) -> None:
    """Of 8 samples: 360 deg times frequency times 8 ms."""
    found = transfer(SINES[1000:], SINES[992:-8], frequency_hz, RATE_HZ)
    assert abs(found) == pytest.approx(1.0, abs=1e-3)
    lag_deg = -np.angle(found, deg=True) % 360.0
    assert lag_deg == pytest.approx(360.0 * frequency_hz * 0.008, abs=0.1)


@pytest.mark.parametrize("frequency_hz", LINES_HZ)
def test_the_observers_low_pass_has_the_response_that_is_drawn_as_reference(frequency_hz: float) -> None:
    found = transfer(SINES, low_pass(SINES[:, None], GAIN_HZ, RATE_HZ)[:, 0], frequency_hz, RATE_HZ)
    expected = observer_response(np.array([frequency_hz]), GAIN_HZ, RATE_HZ)[0]
    assert found == pytest.approx(expected, abs=2e-3)


def test_a_first_order_lag_has_its_gain_and_phase_at_its_corner() -> None:
    """At K_0 / 2 pi Hz a lag has a gain of 1 / sqrt(2) and a phase of -45 deg; a sampled one is near to it."""
    response = observer_response(np.array([GAIN_HZ / (2 * np.pi)]), GAIN_HZ, 100 * RATE_HZ)[0]
    assert abs(response) == pytest.approx(2**-0.5, abs=1e-3)
    assert np.angle(response, deg=True) == pytest.approx(-45.0, abs=0.1)


def test_noise_and_a_gait_between_the_lines_change_little_and_no_injection_has_no_response(
    rng: np.random.Generator,
) -> None:
    walking = 30.0 * np.sign(np.sin(2 * np.pi * TIME / 1.4)) + rng.normal(size=len(TIME))
    assert abs(transfer(SINES, SINES + walking, 2.0, RATE_HZ)) == pytest.approx(1.0, abs=0.02)
    assert np.isnan(transfer(0.0 * SINES, SINES, 2.0, RATE_HZ))
