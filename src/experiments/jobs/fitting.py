"""The rule `fit`: it fits a method without networks to the training sets; and what a training knows by such a fit."""

import logging
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from mobnet.core.arrays import Array
from mobnet.core.columns import MOTOR, VELOCITY, named
from mobnet.core.errors import ConfigError, not_accepted
from mobnet.core.files import write_json
from mobnet.core.joints import JointLayout
from mobnet.core.store import read_array, spans_and_rate
from mobnet.estimation.kinds import kind_of
from mobnet.estimation.kinds.friction import FittedFriction, read_friction
from mobnet.estimation.recipe import options_of
from mobnet.kernel.low_pass import low_pass
from mobnet.learning.dataset import Known
from mobnet.settings.methods import Method, ObserverSettings
from mobnet.settings.networks import Network

log = logging.getLogger(__name__)


def write_fit(
    layout: JointLayout,
    observer: ObserverSettings,
    method: Method,
    networks: Mapping[str, Network],
    training: Mapping[str, Sequence[tuple[Path, Path]]],
    out: Path,
) -> None:
    """Fit a method to training sets and write what `build` of its kind reads, as JSON; section 5.2 fits MOB-fric.

    For each of the method's `fitted` limbs there are its network of Table 1, whose joints are fitted, and the stems of
    the recordings and residuals of its training set.

    Raises:
        ConfigError: the method's kind is not one that is fitted, or the limbs are not those that the method names.
        DataError: a recording is damaged.
    """
    kind = kind_of(out.stem, method.kind)
    if not hasattr(kind, "fit") or not method.fitted:
        raise ConfigError(
            f"{out}: method of kind {method.kind!r} with `fitted` {list(method.fitted)} is not fitted; "
            "accepted: a kind with a function `fit`, and one or more limbs"
        )
    if set(method.fitted) != set(training):
        raise ConfigError(not_accepted(f"{out}: limbs to fit", sorted(training), [sorted(method.fitted)]))
    write_json(out, kind.fit(layout, observer, options_of(out.stem, method, kind.Options), networks, training))
    log.info("%s is fitted to %s", out.stem, ", ".join(method.fitted))


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
    friction_torque = np.zeros((len(read), layout.nv))
    motors = slice(len(layout.virtual), None)
    for span in (slice(*ends) for ends in spans):
        friction_torque[span, motors] = low_pass(friction.torque(velocity[span], torque[span]), gain_hz, rate_hz)
    return friction_torque[:, layout.columns(joints)]
