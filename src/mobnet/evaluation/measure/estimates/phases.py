"""Errors in parts of a walk: by phase of the leg's gait, and by whether the joint is stuck or moves."""

import numpy as np

from mobnet.core.metrics import Metric
from mobnet.evaluation.compare.masks import masked_mean, parts_of
from mobnet.evaluation.compare.pair import Pair
from mobnet.evaluation.compare.scene import Scene
from mobnet.evaluation.compare.values import Measured, Measures
from mobnet.settings.measures import Phases

METRICS = (Metric("rmse_(swing|touch_down|stance|stuck|moving)"),)


def measure(pair: Pair, scene: Scene, settings: Phases) -> Measures:
    """Yield the root-mean-square error of each joint (n,) [N m], V1..V3 [N], in each part of a walk: `rmse_<part>`."""
    squares = (pair.estimate.astype(np.float64) - pair.truth) ** 2
    for name, mask in parts_of(pair, scene).items():
        yield Measured(f"rmse_{name}", np.sqrt(masked_mean(squares, mask)))
