"""Hints on delays: how late torques are against the motion that they make."""

from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.core.recording import Sensed
from mobnet.kernel.drive import TorqueKind
from mobnet.robot.dynamics import momentum_and_beta
from mobnet.robot.nominal import NominalModel
from mobnet.robot.wrench import feet_torque
from mobnet.robotlog.hints.bounds import HintBounds
from mobnet.robotlog.hints.columns import held_share, listed
from mobnet.robotlog.hints.fits import dissipation, positive_fit, quotient
from mobnet.robotlog.long_arrays import give_back

LEAST = 0.75  # samples below which a delay is none
STRETCH_S, STRETCHES = 2.0, 30  # of contiguous samples that are looked at, and how many
SMOOTH_S = 0.05  # mean over which the noise of velocities is small
SWING_S = 0.25  # within which torques must change
APART_S = 0.01  # between two rows that are looked at
ROWS_S, STEP_S = 0.02, 0.001  # the same for torques, and between two delays that are tried
MOVES_RAD_S = 0.05  # root mean square of a speed below which a joint tells nothing
BETTER = 0.88  # share of the unexplained part that is left when the delay is undone
EACH, AGREE = 0.9, 0.6  # the same of a single joint, and the share of joints of which it must be so
EXACT = 1e-9  # share that counts as nothing


class Delay(NamedTuple):
    """How late torques are, in samples, and the hint that says so."""

    samples: float
    text: str


def torque_delay(
    nominal: NominalModel,
    sensed: Sensed,
    spans: Sequence[slice],
    rate_hz: float,
    wrenches: Mapping[str, Array],
    joints: NDArray[np.bool_],
    kind: TorqueKind,
    bounds: HintBounds,
) -> Delay | None:
    """Return the delay of torques of a kind, if those of some joints (nu,) fit the motion better when moved in time."""
    step = max(1, round(STEP_S * rate_hz))
    span = round(STRETCH_S * rate_hz)
    count = round(bounds.delay_s * rate_hz) // step
    most = count * step
    smooth = max(1, round(SMOOTH_S * rate_hz))
    swing = max(1, round(SWING_S * rate_hz))
    kept = stretches(spans, span + 2 * most + smooth + swing)
    columns = np.flatnonzero(joints & (held_share(sensed.tau_motor) <= bounds.held))  # a held torque is late by itself
    if most < 1 or not kept or not len(columns):
        return None
    columns = columns[np.linspace(0, len(columns) - 1, min(bounds.few, len(columns))).round().astype(int)]
    middle = np.arange(0, span, max(1, round(ROWS_S * rate_hz)))
    lags = np.arange(0, 2 * most + 1, step)
    terms = []
    given = []
    for rows in kept:
        asked, torque = _asked(rows, nominal, sensed, rate_hz, wrenches, kind)
        # Errors of the model change slowly, as gravity does, and say nothing of a delay: changes are compared.
        near, far = (_swings(values[:, columns], smooth, swing) for values in (asked, torque))
        terms.append(near[most + middle])
        given.append(far[middle[:, None] + lags])
        give_back()
    shares = _unexplained(np.concatenate(terms), np.concatenate(given))
    left = np.exp(np.log(shares).mean(axis=0))  # every joint counts alike, however well its model fits
    best = int(np.argmin(left))
    late = step * (_lowest_at(left, best) - count)
    # Most joints must fit better, so that the slow reaction of one gear is no delay.
    agree = float(np.mean(shares[:, best] < EACH * shares[:, count]))
    if not 0 < best < 2 * count or abs(late) < LEAST or left[best] > BETTER * left[count] or agree < AGREE:
        return None
    fits = f"{left[best]:.1%} of it unexplained in place of {left[count]:.1%}"
    way = "late" if late > 0 else "early"
    much = abs(late) / rate_hz * 1e3
    return Delay(late, f"tau_motor: {much:.3g} ms {way} against the motion ({fits}); give it as delay_s")


def speed_delay_hints(
    q: Array, v: Array, spans: Sequence[slice], rate_hz: float, joints: Sequence[str], bounds: HintBounds
) -> Iterator[str]:
    """Yield a hint if velocities (T, n) [rad/s] fit the changes of positions (T, n) [rad] better when moved in time."""
    most = round(bounds.delay_s * rate_hz)
    smooth = max(1, round(SMOOTH_S * rate_hz))
    kept = stretches(spans, round(STRETCH_S * rate_hz) + 2 * most + smooth)
    # A speed that is held between updates is late by itself.
    moves = ~np.any(held_share(v)[None] > bounds.held, axis=0)
    if most < 1 or not kept or not moves.any():
        return
    lags = np.arange(-most, most + 1)
    left = np.zeros((len(lags), len(joints)))
    size = np.zeros(len(joints))
    for rows in kept:
        turned = (q[rows][smooth:] - q[rows][:-smooth]) * (rate_hz / smooth)
        mean = _means((v[rows][1:] + v[rows][:-1]) / 2, smooth)
        middle = np.arange(most, len(turned) - most, max(1, round(APART_S * rate_hz)))
        left += np.square(turned[middle] - mean[middle + lags[:, None]]).sum(axis=1)
        size += np.square(turned[middle]).sum(axis=0)
        give_back()
    moves &= size > MOVES_RAD_S**2 * len(kept) * STRETCH_S / APART_S
    shares = left[:, moves] / size[moves]
    best = np.argmin(shares, axis=0)
    inside = (best > 0) & (best < 2 * most)
    lags = np.array([_lowest_at(column, k) - most for column, k in zip(shares.T, best.tolist(), strict=True)])
    late = inside & (np.abs(lags) >= LEAST) & (shares[best, np.arange(len(best))] < BETTER * shares[most])
    if late.any():
        which = np.zeros(len(joints), dtype=bool)
        which[np.flatnonzero(moves)[late]] = True
        lag = float(np.median(lags[late])) / rate_hz
        way = "late" if lag > 0 else "early"
        yield f"v of {listed(joints, which)}: {abs(lag) * 1e3:.3g} ms {way} against q; give it as delay_s"


def stretches(spans: Sequence[slice], rows: int) -> list[slice]:
    """Return stretches of so many contiguous rows, evenly spread over the spans."""
    slices = list[slice]()
    for span in spans:
        slices += [slice(first, first + rows) for first in range(span.start, span.stop - rows + 1, rows)]
    picked = (
        np.unique(np.linspace(0, len(slices) - 1, min(STRETCHES, len(slices))).round().astype(int)) if slices else []
    )
    return [slices[k] for k in picked]


def _lowest_at(left: Array, best: int) -> float:
    """Return where the parabola through the least of some values and those beside it is lowest, as an index."""
    if not 0 < best < len(left) - 1:
        return float(best)
    before, least, after = left[best - 1 : best + 2]
    bend = float(before - 2 * least + after)
    return best + 0.5 * float(before - after) / bend if bend > 0 else float(best)


def _asked(
    rows: slice, nominal: NominalModel, sensed: Sensed, rate_hz: float, wrenches: Mapping[str, Array], kind: TorqueKind
) -> tuple[Array, Array]:
    """Return what the motors' torques are made of (T - 1, nu, p), and these torques (T - 1, nu) [N m]: both as means.

    What they are made of are the torque that the motion needs, friction and rotor inertia.
    """
    first = len(nominal.robot.layout.virtual)
    p, beta = momentum_and_beta(nominal, sensed.q[rows], sensed.v[rows])
    feet = feet_torque(nominal, sensed.q[rows], {side: wrench[rows] for side, wrench in wrenches.items()})
    needed = np.diff(p, axis=0) * rate_hz - _between(beta + feet)
    speed = sensed.v[rows, first:].astype(np.float64)
    torque = sensed.tau_motor[rows].astype(np.float64)
    friction = dissipation(_between(speed), np.diff(speed, axis=0) * rate_hz)
    made = np.concatenate([needed[:, first:, None], friction], axis=-1)
    return made, _between(torque) if kind == "sample" else torque[1:]


def _unexplained(terms: Array, given: Array) -> Array:
    """Return the share of torque that motion and friction leave unexplained, by joint and lag (joints, n).

    Terms are (R, joints, p), torques (R, n, joints); those of a wrong sign are taken with the other one.
    """
    shares = []
    for joint_terms, torque in zip(np.moveaxis(terms, 1, 0), np.moveaxis(given, 2, 0), strict=True):
        size = np.square(torque).sum(axis=0)
        cross = joint_terms.T @ torque
        explained = [(sign * cross * positive_fit(joint_terms, sign * torque)).sum(axis=0) for sign in (1.0, -1.0)]
        shares.append(np.maximum(1.0 - quotient(np.maximum(*explained), size), EXACT))
    return np.array(shares)


def _swings(values: Array, smooth: int, swing: int) -> Array:
    """Return by how much means over so many rows change within so many others (T - smooth - swing + 1, ...).

    What a model is wrong about changes slowly, as gravity does, and tells nothing of a delay.
    """
    means = _means(values.reshape(len(values), -1), smooth)
    return (means[swing:] - means[:-swing]).reshape(-1, *values.shape[1:])


def _between(values: Array) -> Array:
    """Return means of successive rows (T - 1, ...)."""
    return (values[1:] + values[:-1]) / 2


def _means(values: Array, count: int) -> Array:
    """Return means over `count` successive rows (T - count + 1, n)."""
    sums = np.concatenate([np.zeros((1, values.shape[1])), np.cumsum(values, axis=0)])
    return (sums[count:] - sums[:-count]) / count
