"""The only conversion between MuJoCo and Pinocchio: the order of the base quaternion.

Both models carry the base as three translations in world axes and then a ball joint, so that a generalized velocity
(base linear in world, base angular in base, joints), momentum, mass matrix and torque mean the same in both.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.joints import NQ_BASE

POSITION = slice(0, 3)  # base position in a generalized position
QUATERNION = slice(3, NQ_BASE)  # base quaternion in a generalized position
WXYZ_TO_XYZW = (1, 2, 3, 0)


def to_pinocchio(q: NDArray[Any]) -> NDArray[np.float64]:
    """Return generalized positions (..., nq) [m], [-], [rad] of a recording, w x y z, as Pinocchio's, x y z w.

    The base floats. Quaternions are brought to unit length: float32 logs and noise leave it.
    """
    result = np.array(q, dtype=np.float64, order="C")
    quat = result[..., QUATERNION][..., list(WXYZ_TO_XYZW)]
    result[..., QUATERNION] = quat / np.linalg.norm(quat, axis=-1, keepdims=True)
    return result
