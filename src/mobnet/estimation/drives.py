"""Friction of a robot's drives by the rows of its table."""

from collections.abc import Mapping, Sequence

import numpy as np

from mobnet.kernel.drive import DriveParameters
from mobnet.settings.parts import FrictionRow


def drives_of(friction: Mapping[str, FrictionRow], joints: Sequence[str]) -> DriveParameters | None:
    """Return the drives of actuated joints (nu,) by the rows of a table; None where it has none."""
    if not friction:
        return None
    rows = [friction.get(joint) for joint in joints]
    return DriveParameters(
        coulomb=np.array([row.coulomb_nm if row else 0.0 for row in rows]),
        viscous=np.array([row.viscous_nms if row else 0.0 for row in rows]),
        load=np.array([row.load if row else 0.0 for row in rows]),
        offset=np.array([row.offset_nm if row else 0.0 for row in rows]),
        scale=np.array([row.scale if row else 1.0 for row in rows]),
        smoothing=np.array([row.smoothing_rad_s if row else 1.0 for row in rows]),
        breakaway=np.array([(row.breakaway_rad if row else None) or 0.0 for row in rows]),
    )
