"""Arrays on the stack: the right shape, apart from each other, no allocation in code that owns no memory."""

import numpy as np
import pytest
from numba.core.errors import NumbaError

from mobnet.control.compiled import compiled
from mobnet.control.geometry import multiply
from mobnet.control.stack import matrix3, on_stack, vector3

wide = on_stack(2, 3, 4)


@compiled
def _shapes(out):
    a, b = vector3(), wide()
    out[0], out[1], out[2], out[3] = a.shape[0], b.shape[0], b.shape[1], b.shape[2]


@compiled
def _cube(a, out):
    square = matrix3()
    multiply(a, a, square)
    multiply(square, a, out)


@compiled
def _kept_apart(out):
    a, b = vector3(), vector3()
    for i in range(3):
        a[i], b[i] = i, 10 + i
    for i in range(3):
        out[i], out[3 + i] = a[i], b[i]


@compiled
def _allocates(out):
    out[0] = np.zeros(3).sum()


def test_shapes_are_those_asked_for():
    out = np.zeros(4)
    _shapes(out)
    assert out.tolist() == [3, 2, 3, 4]


def test_a_matrix_on_the_stack_is_laid_out_like_any_other():
    a, out = np.random.default_rng(0).normal(size=(3, 3)), np.zeros((3, 3))
    _cube(a, out)
    np.testing.assert_allclose(out, a @ a @ a, rtol=1e-13)


def test_two_arrays_do_not_share_room():
    out = np.zeros(6)
    _kept_apart(out)
    assert out.tolist() == [0, 1, 2, 10, 11, 12]


def test_code_that_allocates_does_not_compile():
    with pytest.raises(NumbaError):
        _allocates(np.zeros(1))
