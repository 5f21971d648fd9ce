"""Parts of a walk, as masks: by phase of the leg's gait, by whether a joint is stuck or moves, and by pushes."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from experiments.evaluation.compare.pair import Pair
from experiments.evaluation.compare.scene import Scene
from experiments.evaluation.compare.windows import rows_in
from mobnet.core.arrays import Array

STUCK = "stuck"
MOVING = "moving"
PUSHED = "pushed"
CALM = "calm"
Masks = Mapping[str, NDArray[np.bool_]]  # part of a walk -> whether each joint is in it (T, n)


def parts_of(pair: Pair, scene: Scene) -> dict[str, NDArray[np.bool_]]:
    """Return the parts of a walk, (T, n) each: phases of the own leg, and joints that are stuck or move.

    Rows outside of the spans of the estimate are in none.
    """
    places = scene.layout.columns(pair.joints)
    speed = scene.speed[:, places]
    by_part = {name: mask[:, places] for name, mask in scene.phases.items()}
    by_part |= {STUCK: speed < scene.asked.stuck_rad_s, MOVING: speed >= scene.asked.stuck_rad_s}
    inside = rows_in(pair.spans, len(speed))
    return {name: mask & inside[:, None] for name, mask in by_part.items()}


def push_parts(pair: Pair, scene: Scene) -> dict[str, NDArray[np.bool_]]:
    """Return where a push acts and where none does, (T, n) each; nothing where the scenario has no pushes."""
    if not scene.pushed.any():
        return {}
    is_pushed = np.repeat(scene.pushed[:, None], len(pair.joints), axis=1)
    return {PUSHED: is_pushed, CALM: ~is_pushed}


def masked_mean(values: NDArray[np.float64], mask: NDArray[np.bool_]) -> Array:
    """Return the mean of each column (n,) of values (T, n) over the rows of its mask (T, n); nan where it has none."""
    count = mask.sum(axis=0)
    total = np.einsum("tn,tn->n", values, mask)
    return np.where(count > 0, total / np.maximum(count, 1), np.nan)
