"""Which link a collision hits, from which side, and how hard: the push that best explains the torques of the joints.

A force F at a point turns the joints above it by F g, where g (6,) is known of each point and direction. Of all
candidates that one is taken whose g explains most of the estimated torque, in units of what this does in free walking.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import Array


class IsolatedPush(NamedTuple):
    """The candidate that explains a torque best, counted from 0, and its force [N]."""

    candidate: int
    force_n: float


def name_push(torque: NDArray[Any], units: Array, whitening: Array) -> IsolatedPush:
    """Return which of k pushes explains the torque of the joints (6,) [N m].

    Units (k, 6) are the torques of 1 N of each [N m/N]; the whitening (6, 6) is that of the torque in free walking. A
    push cannot pull; where none explains anything, the first one has a force of zero.
    """
    # (D10): least squares of one unknown, the force. Whitened, as an error of 5 N m says nothing at a hip that is wrong
    # by as much in every step, and everything at an ankle.
    seen = whitening @ torque
    expected = units @ whitening.T
    sizes = np.maximum((expected**2).sum(axis=1), 1e-12)
    # A push cannot pull: the best force of a candidate that explains the torque with the wrong sign is zero.
    forces = np.maximum(expected @ seen / sizes, 0.0)
    best = int(np.argmax(forces**2 * sizes))
    return IsolatedPush(best, float(forces[best]))
