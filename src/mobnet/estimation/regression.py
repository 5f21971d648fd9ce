"""Regression of models of friction, that of (23) first, on r - tau_e, joint by joint, one recording at a time.

Derived in docs/notes/observer.md, (O10) to (O13); docs/notes/friction.md has what it finds.
"""

import logging
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import scipy  # its parts are imported where they are used first: the workflow imports kinds before it starts
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.core.columns import MOTOR, RESIDUAL, VELOCITY, named
from mobnet.core.store import check_pair, label_of, read_array, spans_and_rate
from mobnet.kernel.low_pass import low_pass

Pair = tuple[Path, Path]  # stems of a recording and of its residual
# Of a joint's velocity [rad/s] and motor torque [N m], (T,) each, at a rate [Hz]: the regressors (T, m - 1).
Columns = Callable[[Array, Array, float], Array]
TERMS = {"coulomb": "coulomb_nm", "static": "static_nm", "viscous": "viscous_nms", "load": "load_per_nm"}
SIGN, VISCOUS, LOAD, STATIC = range(4)  # columns; one of `static` for each Stribeck velocity, then the target
log = logging.getLogger(__name__)


@dataclass(frozen=True)
class Law:
    """What is regressed.

    Attributes:
        smoothing: width of the sign function [rad/s].
        stribeck: Stribeck velocities of which each joint takes one (k,) [rad/s].
        gain_hz: K_0 of (7) [1/s], of the low-pass that the regressors pass.
    """

    smoothing: float
    stribeck: Sequence[float]
    gain_hz: float


def regress(law: Law, joints: Mapping[str, Sequence[str]], pairs: Sequence[Pair]) -> dict[str, dict[str, float]]:
    """Regress the friction of actuated joints: joint -> terms of `TERMS` that it is made of.

    Return joint -> factors of (23), units in the keys, and the root mean squares of the target and of the error [N m].
    """
    sums = square_sums(partial(_columns, law), list(joints), law.gain_hz, pairs)
    factors = dict[str, dict[str, float]]()
    for joint, wanted in joints.items():
        chosen = [term for term in TERMS if term in wanted]
        factors[joint] = logged(joint, _solve(sums[joint], chosen, law.stribeck))
    return factors


def logged(joint: str, factors: dict[str, float]) -> dict[str, float]:
    """Log how much friction a fit leaves of a joint, and return it."""
    log.info("%s: %.2f of %.2f N m left", joint, factors["left_rms_nm"], factors["target_rms_nm"])
    return factors


def regressors(
    velocity: NDArray[Any], torque: NDArray[Any], smoothing: float, stribeck: float | Array
) -> dict[str, Array]:
    """Return term -> what its factor multiplies in -tau_f of (23), of joint velocity [rad/s] and motor torque [N m].

    Both are (..., n). The width of the sign function and v_s of (23), one or (n,), are in rad/s.
    """
    # (O10). tanh for the sign: a sign would switch with the noise of a joint at rest, where friction takes any value.
    sign = np.tanh(velocity / smoothing)
    fade = np.exp(-np.abs(velocity) / stribeck)
    return {"coulomb": sign * (1 - fade), "static": sign * fade, "viscous": velocity, "load": sign * torque**2}


def square_sums(columns: Columns, joints: Sequence[str], gain_hz: float, pairs: Sequence[Pair]) -> dict[str, Array]:
    """Return joint -> mean products (m, m) over recordings of its regressors behind the low-pass of K_0, and target."""
    # Sums of products are all that (O13) needs, and do not grow with the hours of data.
    sums: dict[str, Any] = dict.fromkeys(joints, 0.0)
    count = 0
    for number, (recording, residual) in enumerate(pairs, start=1):
        log.info("recording %d of %d, %s", number, len(pairs), recording.name)
        check_pair(recording, residual)
        velocity, torque, spans, rate_hz = _halves(recording, (VELOCITY, MOTOR), joints)
        observed, external, _, _ = _halves(residual, (RESIDUAL, label_of(residual)), joints)
        for span in (slice(*ends) for ends in spans):
            # (O11): the factors are constant, so filtered columns have the factors of unfiltered ones.
            for i, joint in enumerate(joints):
                filtered = low_pass(columns(velocity[span, i], torque[span, i], rate_hz), gain_hz, rate_hz)
                with_target = np.column_stack([filtered, external[span, i] - observed[span, i]])
                sums[joint] += with_target.T @ with_target
            count += span.stop - span.start
    return {joint: products / max(1, count) for joint, products in sums.items()}


def _halves(
    stem: Path, signals: tuple[str, str], joints: Sequence[str]
) -> tuple[Array, Array, Sequence[tuple[int, int]], float]:
    """Return two signals of some joints (T, n) each from a file, its segments and its rate [Hz]."""
    array, meta = read_array(stem, [*named(signals[0], joints), *named(signals[1], joints)])
    first, second = np.split(array.astype(np.float64), 2, axis=1)
    return first, second, *spans_and_rate(meta)


def _columns(law: Law, velocity: Array, torque: Array, _: float) -> Array:
    """Return the regressors of one joint, (T, m - 1): sign, viscous, load, static for each Stribeck velocity."""
    tried = regressors(velocity[:, None], torque[:, None], law.smoothing, np.array(law.stribeck))
    # Coulomb friction depends on v_s too; (O12) needs one column for all v_s instead of one for each.
    sign = tried["coulomb"][:, :1] + tried["static"][:, :1]
    return np.column_stack([sign, tried["viscous"], tried["load"], tried["static"]])


def _solve(products: Array, terms: Sequence[str], grid: Sequence[float]) -> dict[str, float]:
    """Return the factors of (23) of one joint and the root mean squares before and after [N m].

    The mean products of the columns are (m, m), the grid has Stribeck velocities [rad/s].
    """
    # v_s is the only number that does not enter linearly: the grid is searched, the rest is solved.
    fits = [_factors(products, terms, STATIC + i) for i in range(len(grid))]
    best = min(range(len(grid)), key=lambda i: fits[i][1])
    factors, left = fits[best]
    # Without a static term sgn v is not split, (O12): friction at rest is then that of motion.
    if "static" not in terms:
        factors["static"] = factors.get("coulomb", 0.0)
    return {
        **{key: factors.get(term, 0.0) for term, key in TERMS.items()},
        "stribeck_rad_s": grid[best],
        "target_rms_nm": float(np.sqrt(products[-1, -1])),
        "left_rms_nm": left,
    }


def _factors(products: Array, terms: Sequence[str], static: int) -> tuple[dict[str, float], float]:
    """Return the factors of (23) with the Stribeck velocity of a column of `static`, and what they leave [N m]."""
    unit = np.eye(len(products))
    faded = unit[static] if "static" in terms else 0.0
    mixed = {"coulomb": unit[SIGN] - faded, "static": unit[static], "viscous": unit[VISCOUS], "load": unit[LOAD]}
    return non_negative(products, {term: mixed[term] for term in terms})


def non_negative(
    products: Array, columns: Mapping[str, Array], free: Sequence[str] = ()
) -> tuple[dict[str, float], float]:
    """Return the factors, none negative but `free` ones, with the smallest mean square error, and its root [N m].

    Mean products are (m, m), the target's last; a column (m,) of each factor says how it mixes those of the products.
    """
    chosen = np.array([*columns.values(), np.eye(len(products))[-1]])
    # (O13): this root has the products of the columns, so it gives their least squares without them. Rounding can make
    # the least eigenvalue of nearly collinear columns negative.
    values, vectors = np.linalg.eigh(chosen @ products @ chosen.T)
    root = (vectors * np.sqrt(np.maximum(values, 0.0))).T
    # N m s and 1 / (N m) differ by orders of magnitude, which would spoil the condition of the problem.
    size = np.linalg.norm(root[:, :-1], axis=0)
    size[size == 0] = 1.0  # a joint that never moved
    scaled = root[:, :-1] / size
    # A factor of either sign is the difference of two that are not negative. The second column is the first one negated
    # to the bit: columns that rounding makes differ could both be taken, with huge factors that cancel.
    either = [name in free for name in columns]
    factors, left = scipy.optimize.nnls(np.hstack([scaled, -scaled[:, either]]), root[:, -1])
    positive, negated = np.split(factors, [len(columns)])
    positive[either] -= negated
    return dict(zip(columns, (positive / size).tolist(), strict=True)), float(left)
