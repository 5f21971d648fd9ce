"""Signals of an estimate, their names, and the whitening after which they have one size."""

import numpy as np
import pytest

from mobnet.core.errors import DataError
from mobnet.core.estimator import Estimate
from mobnet.detection.signals import signal_names, signals_of, whitening_of
from mobnet.settings.detection import Detector

ESTIMATE = Estimate(np.array([[4.0, -2.0]]), np.array([[2.0, 0.5]]))


@pytest.mark.parametrize(("signals", "expected"), [
    (("mean",), [4, -2]), (("std",), [2, 0.5]), (("ratio",), [2, -4]), (("mean", "std"), [4, -2, 2, 0.5]),
])  # fmt: skip
def test_signals_are_those_of_the_estimate(signals, expected):
    row = Detector.model_validate({"method": "MOB-Net", "signals": signals})
    assert signals_of(row, ESTIMATE).tolist() == [expected]
    assert len(signal_names(row, ["LL1", "LL2"])) == len(expected)
    assert signal_names(row, ["LL1", "LL2"])[0] == f"{signals[0]}.LL1"


def test_a_method_without_standard_deviations_has_no_signal_of_them():
    row = Detector.model_validate({"method": "MOB", "signals": ["std"]})
    with pytest.raises(DataError, match="signal 'std': the estimate has no columns std"):
        signals_of(row, Estimate(ESTIMATE.tau_ext))


def test_whitened_signals_have_the_unit_matrix_as_second_moment():
    rng = np.random.default_rng(0)
    signals = rng.normal(size=(5000, 3)) @ np.array([[2.0, 0.5, 0.0], [0.0, 1.0, 0.3], [0.0, 0.0, 0.1]])
    white = signals @ whitening_of(signals).T
    np.testing.assert_allclose(white.T @ white / len(white), np.eye(3), atol=1e-6)
    assert signal_names(Detector(method="MOB", signals=("mean",), norm=True), ["LL1", "LL2"]) == ["norm"]
