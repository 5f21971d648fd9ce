"""Names of the tensors of a trained network."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

GRU_TENSORS = (
    *("cell.weight_ih_l0", "cell.weight_hh_l0", "cell.bias_ih_l0", "cell.bias_hh_l0"),
    *("head.weight", "head.bias"),
)
Z_SCORES = ("input.mean", "input.std", "target.mean", "target.std")
STD_SCALE = "std.scale"  # factors on the standard deviations, learned after the training; absent means 1
Array = NDArray[np.float32]


def std_scale_of(tensors: Mapping[str, Array]) -> Array:
    """Return the factors in a network's standard deviations (n,), learned after its training."""
    return tensors.get(STD_SCALE, np.ones_like(tensors["target.std"]))
