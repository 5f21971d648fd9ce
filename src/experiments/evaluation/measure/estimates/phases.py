"""Errors in parts of a walk: by phase of the leg's gait, and by whether the joint is stuck or moves."""

import numpy as np

from experiments.evaluation.compare.masks import masked_mean, parts_of
from experiments.evaluation.compare.pair import Measured, Measures, Pair
from experiments.evaluation.compare.scene import Scene
from experiments.settings.measures import Phases


def measure(pair: Pair, scene: Scene, settings: Phases) -> Measures:
    """Yield the root-mean-square error of each joint (n,) [N m], V1..V3 [N], in each part of a walk: `rmse_<part>`."""
    squares = (pair.estimate.astype(np.float64) - pair.truth) ** 2
    for name, mask in parts_of(pair, scene).items():
        yield Measured(f"rmse_{name}", np.sqrt(masked_mean(squares, mask)))
