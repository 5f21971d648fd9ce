"""What a training knows of its target before it begins: the friction of a model that was fitted."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from mobnet.core.arrays import Array
from mobnet.core.columns import MOTOR, VELOCITY, named
from mobnet.core.joints import JointLayout
from mobnet.core.store import read_array, spans_and_rate
from mobnet.estimation.kinds.friction import FittedFriction, read_friction
from mobnet.kernel.low_pass import low_pass
from mobnet.learning.dataset import Known
from mobnet.settings.methods import ObserverSettings


def known_of(layout: JointLayout, observer: ObserverSettings, fitted: Path) -> Known:
    """Return what is known of the target where `fitted` is what rule `fit` wrote: the friction of a recording's joints.

    Raises:
        DataError: the fit is damaged.
    """
    friction = read_friction(fitted, layout.actuated)

    # (O14): friction enters behind the observer's low-pass, because r and the truth of the target are behind it too.
    def known(recording: Path, joints: Sequence[str]) -> Array:
        return filtered_friction(layout, friction, observer.gain_hz, recording, joints)

    return known


def filtered_friction(
    layout: JointLayout, friction: FittedFriction, gain_hz: float, recording: Path, joints: Sequence[str]
) -> Array:
    """Return the friction of some joints in a recording behind the low-pass of K_0 [1/s], (T, n) [N, N m].

    Every segment starts anew, as the observer does; joints without a motor have none.
    """
    read, meta = read_array(recording, [*named(VELOCITY, layout.actuated), *named(MOTOR, layout.actuated)])
    velocity, torque = np.split(read, 2, axis=1)
    spans, rate_hz = spans_and_rate(meta)
    found = np.zeros((len(read), layout.nv))
    motors = slice(len(layout.virtual), None)
    for span in (slice(*ends) for ends in spans):
        found[span, motors] = low_pass(friction.torque(velocity[span], torque[span]), gain_hz, rate_hz)
    return found[:, layout.columns(joints)]
