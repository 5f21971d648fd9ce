"""The factor puts the share it is asked for inside, and is measured where it was not learned."""

import json

import numpy as np
import pytest
import torch
from safetensors import safe_open
from scipy.special import ndtr

from mobnet.core.files import RUN, WEIGHTS
from mobnet.learning.calibration import calibrate, coverage, half_width, predict, scale_for
from mobnet.learning.deployed.tensors import STD_SCALE
from mobnet.learning.optimisation import Samples
from mobnet.learning.streams import deal

HORIZON = 10


@pytest.fixture
def rng():
    return np.random.default_rng(0)


def test_scaled_deviations_cover_the_share_whatever_the_tails(rng):
    error, std = rng.standard_t(2, (9000, 2)), rng.uniform(0.2, 3.0, (9000, 2))
    for share in (0.5, 0.68):
        scaled = std * scale_for(error, std, share)
        np.testing.assert_allclose(coverage(error, scaled, [share])[0], share, atol=1e-3)


def test_true_deviations_stay_and_wrong_ones_are_corrected(rng):
    std = rng.uniform(0.2, 3.0, (20000, 2))
    found = calibrate(std * rng.normal(size=std.shape), std * [0.5, 2.0], 0.68, [0.68])
    np.testing.assert_allclose(found.scale, [2.0, 0.5], rtol=0.03)
    np.testing.assert_allclose(found.likelihood_scale, [2.0, 0.5], rtol=0.03)
    np.testing.assert_allclose(found.after.coverage, 0.68, atol=0.02)
    assert found.before.coverage[0, 0] < 0.5
    assert found.before.coverage[0, 1] > 0.9
    assert (found.after.nll < found.before.nll).all()
    assert (found.after.crps < found.before.crps).all()


def test_large_errors_widen_the_likely_factor_alone(rng):
    error = rng.normal(size=(5000, 1))
    error[::100] *= 50.0
    found = calibrate(error, np.ones_like(error), 0.68, [0.68])
    assert found.scale[0] == pytest.approx(1.0, abs=0.05)
    assert found.likelihood_scale[0] > 4.0


def test_the_fit_is_measured_where_it_was_not_learned(rng):
    """Errors that double half way: the first half's factor makes the second's interval half as wide as it should be."""
    error = rng.normal(size=(20000, 1)) * np.repeat([1.0, 2.0], 10000)[:, None]
    after = calibrate(error, np.ones_like(error), 0.68, [0.68]).after.coverage[0, 0]
    assert after == pytest.approx(2.0 * ndtr(half_width(0.68) / 2.0) - 1.0, abs=0.02)


def test_predictions_come_in_the_order_of_time():
    class Echo(torch.nn.Module):
        """Predicts zero with the input as its deviation, so that samples can be told apart."""

        def forward(self, x, state):
            return torch.zeros_like(x), x, state

        def fresh_state(self, lanes, device=None):
            return torch.zeros(1, lanes, 1)

    rows = torch.arange(1.0, 121.0)[:, None]
    error, std = predict(Echo(), Samples(rows, -rows), deal([(0, 60), (60, 120)], 3, HORIZON), HORIZON)
    np.testing.assert_array_equal(std[:, 0], np.arange(1.0, 121.0))
    np.testing.assert_array_equal(error, std)


@pytest.mark.parametrize("wanted", [True, False])
def test_factors_are_stored_where_they_are_declared_and_noted_in_any_case(small, tmp_path, wanted):
    out = small.train(small.training(calibrate=wanted, epochs=1), tmp_path)
    note = json.loads((out / RUN).read_text())["calibration"]
    with safe_open(out / WEIGHTS, framework="numpy") as file:
        assert (STD_SCALE in file.keys()) == wanted  # noqa: SIM118, not a dict
        if wanted:
            np.testing.assert_allclose(file.get_tensor(STD_SCALE), note["scale"], rtol=1e-6)
    assert note["joints"] == [f"LL{i}" for i in range(1, 7)]
    assert np.shape(note["before"]["coverage"]) == (len(note["shares"]), 6)
    assert np.shape(note["after"]["crps"]) == (6,)
