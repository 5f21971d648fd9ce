"""The compiled recursion against SciPy's filter, to the bit, for any shape of the samples."""

import subprocess
import sys

import numpy as np
import pytest
from scipy.signal import lfilter

from mobnet.kernel.first_order import decay
from mobnet.kernel.low_pass import exact_pole, filter_in_place, low_pass

GAIN_HZ, RATE_HZ = 100.0, 1000.0
START = """import sys
import numpy as np
from mobnet.kernel.low_pass import filter_in_place
filter_in_place(np.ones((5, 2)), 0.9)
print("scipy.signal" in sys.modules)
"""


@pytest.mark.parametrize("shape", [(1000,), (1000, 39), (50, 3, 2), (1, 4), (0, 4), (7, 0)])
def test_equal_to_scipy_to_the_bit(shape):
    x = 100 * np.random.default_rng(0).normal(size=shape)
    for pole in (exact_pole(GAIN_HZ, RATE_HZ), 0.5, 0.0):
        np.testing.assert_array_equal(filter_in_place(x.copy(), pole), lfilter([1 - pole], [1, -pole], x, axis=0))


def test_no_samples_are_filtered_where_there_are_none():
    memory = np.ones(3)
    decay(memory[:0], np.zeros(2), 0.5)
    np.testing.assert_array_equal(memory, 1.0)


@pytest.mark.parametrize("order", ["C", "F"])
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_any_memory_order_and_float_type_is_taken(dtype, order):
    x = np.array(np.random.default_rng(0).normal(size=(50, 3)), dtype=dtype, order=order)
    given = x.copy()
    expected = low_pass(x.astype(np.float64), GAIN_HZ, RATE_HZ)
    np.testing.assert_array_equal(low_pass(np.repeat(x, 2, axis=0)[::2], GAIN_HZ, RATE_HZ), expected)
    np.testing.assert_array_equal(low_pass(x, GAIN_HZ, RATE_HZ), expected)
    np.testing.assert_array_equal(x, given)


def test_it_starts_without_scipy_s_filters():
    """Their import takes longer than the filter of a whole recording."""
    assert subprocess.check_output([sys.executable, "-c", START], text=True).strip() == "False"
