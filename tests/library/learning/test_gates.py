"""The gates' tanh; test_gru.py compares whole steps with torch's."""

import numpy as np

from mobnet.learning.gates import rational_tanh


def test_tanh_is_within_a_few_roundings():
    x = np.linspace(-12, 12, 100_001).astype(np.float32)
    y = np.array([rational_tanh(value) for value in x])
    np.testing.assert_allclose(y, np.tanh(x.astype(np.float64)), rtol=1e-6, atol=1e-7)
    assert np.isnan(rational_tanh(np.float32(np.nan)))
