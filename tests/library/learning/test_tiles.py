"""Products in tiles are those of their factors, whatever their sizes, in both formats and on any processor."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import torch

from mobnet.learning import tiles
from mobnet.learning.tiles import PADDED, add_product, lay_right, left_factor, room, rounded, up

VALUES = torch.tensor(
    [0.0, -0.0, 1.0, 1.00390625, 1.01171875, -3.14159, 3e-39, 65504.0, torch.inf, -torch.inf, torch.nan]
)
OLDER = {"NUMBA_CPU_NAME": "haswell", "NUMBA_CPU_FEATURES": "+sse4.2,+avx,+avx2,+fma,+f16c,+bmi2"}
SHAPES = [(6, 4, 64), (13, 7, 80), (1, 1, 16), (5, 3, 144), (450, 150, 64)]


def worst(shape, paired):
    """Return the largest error of a product (m, k) (k, n), relative to the sum of the magnitudes of its terms."""
    m, k, n = shape
    generator = torch.Generator().manual_seed(sum(shape))
    precision = torch.bfloat16 if paired else torch.float32
    a, b, c = (torch.randn(size, generator=generator) for size in ((m, k), (k, n), (m, n)))
    right, out = room(k, n, paired), c.numpy().copy()
    lay_right(b.numpy(), right)
    add_product(out, left_factor(a.numpy(), paired), right)
    a, b, c = a.to(precision).double(), b.to(precision).double(), c.double()
    return float(((torch.from_numpy(out) - c - a @ b).abs() / (a.abs() @ b.abs() + c.abs())).max())


@pytest.mark.parametrize("paired", [False, True], ids=["float32", "bfloat16"])
@pytest.mark.parametrize("shape", SHAPES)
def test_products_are_those_of_the_rounded_factors(shape, paired):
    """Sums are in float32: they err by its roundings, however coarse the factors are."""
    assert worst(shape, paired) < 2e-6


@pytest.mark.parametrize("rows", [1, 3])
def test_what_lies_behind_a_factor_is_not_read(rows):
    """An odd row has no partner: what follows in memory may be no number, and zero times that is none either."""
    memory = np.full((rows + 1, 16), np.nan, np.float32)
    memory[:rows] = 1.0
    right, out = room(rows, 16, paired=True), np.zeros((2, 16), np.float32)
    lay_right(memory[:rows], right)
    add_product(out, left_factor(np.ones((2, rows), np.float32), paired=True), right)
    np.testing.assert_array_equal(out, rows)


def test_a_processor_without_wide_vectors_and_pairs_multiplies_too():
    """The same products on code for AVX2, in a process whose compiler is told that there is nothing else."""
    told = subprocess.run(
        [sys.executable, __file__],
        env={**os.environ, **OLDER, "PYTHONPATH": str(Path(tiles.__file__).parents[2])},
        capture_output=True,
        text=True,
        check=True,
    )
    width, pairs, *errors = told.stdout.split()
    assert (width, pairs) == ("8", "False")
    assert len(errors) == 2 * len(SHAPES)
    assert all(float(error) < 2e-6 for error in errors)


def test_numbers_are_rounded_as_torch_rounds_them():
    """Halves between two bfloat16 numbers, 1.00390625 and 1.01171875, go to the even one."""
    values = torch.cat([VALUES, torch.randn(1000, generator=torch.Generator().manual_seed(0))])
    found = np.array([rounded(value) << 16 for value in values.numpy()], np.uint32).view(np.float32)
    assert np.array_equal(found, values.bfloat16().float().numpy(), equal_nan=True)


def test_columns_are_filled_up():
    assert [up(count) for count in (0, 1, PADDED, PADDED + 1)] == [0, PADDED, PADDED, 2 * PADDED]


if __name__ == "__main__":
    print(tiles.WIDE, tiles.PAIRS_AT_ONCE, *(worst(shape, paired) for shape in SHAPES for paired in (False, True)))  # noqa: T201
