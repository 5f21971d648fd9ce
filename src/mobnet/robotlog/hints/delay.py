"""Hints on delays: how late torques are against the motion that they make."""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.core.recording import Sensed
from mobnet.robot.dynamics import momentum_and_beta
from mobnet.robot.nominal import NominalModel
from mobnet.robot.wrench import feet_torque
from mobnet.robotlog.hints.columns import held_share, listed
from mobnet.settings.robotlog import RobotLog

LEAST = 2  # samples below which a delay is none
STRETCH_S, STRETCHES = 2.0, 30  # of contiguous samples that are looked at, and how many
SMOOTH_S = 0.05  # mean over which the noise of velocities is small
APART_S = 0.01  # between two rows that are looked at
STEADY = 0.05  # speed [rad/s] at which dry friction has turned round
MOVES_RAD_S = 0.05  # root mean square of a speed below which a joint tells nothing
BETTER = 0.5  # share of the unexplained part that is left when the delay is undone


def delay_hints(
    nominal: NominalModel, sensed: Sensed, spans: Sequence[slice], rate_hz: float, wrenches: Mapping[str, Array],
    joints: NDArray[np.bool_], bounds: RobotLog,
) -> Iterator[str]:  # fmt: skip
    """Yield a hint if the torques of some joints (nu,) fit the motion better when they are moved in time."""
    most, smooth = round(bounds.delay_s * rate_hz), max(1, round(SMOOTH_S * rate_hz))
    kept = stretches(spans, round(STRETCH_S * rate_hz) + 2 * most + smooth)
    if most < LEAST or not kept or not joints.any():
        return
    own = nominal, sensed, rate_hz, wrenches, joints, most, smooth
    left = np.mean([_unexplained(rows, *own) for rows in kept], axis=0)
    best = int(np.argmin(left))
    lag = best - most
    if LEAST <= abs(lag) < most and left[best] < BETTER * left[most]:
        fits = f"{left[best]:.1%} of it unexplained in place of {left[most]:.1%}"
        way = "late" if lag > 0 else "early"
        yield f"tau_motor: {abs(lag) / rate_hz * 1e3:.3g} ms {way} against the motion ({fits}); give it as delay_s"


def speed_delay_hints(
    q: Array, v: Array, spans: Sequence[slice], rate_hz: float, joints: Sequence[str], bounds: RobotLog
) -> Iterator[str]:
    """Yield a hint if velocities (T, n) [rad/s] fit the changes of positions (T, n) [rad] better when moved in time."""
    most, smooth = round(bounds.delay_s * rate_hz), max(1, round(SMOOTH_S * rate_hz))
    kept = stretches(spans, round(STRETCH_S * rate_hz) + 2 * most + smooth)
    moves = ~np.any(held_share(v)[None] > bounds.held, axis=0)
    if most < LEAST or not kept or not moves.any():
        return
    lags = np.arange(-most, most + 1)
    left, size = np.zeros((len(lags), len(joints))), np.zeros(len(joints))
    for rows in kept:
        turned = (q[rows][smooth:] - q[rows][:-smooth]) * (rate_hz / smooth)
        mean = _means((v[rows][1:] + v[rows][:-1]) / 2, smooth)
        middle = np.arange(most, len(turned) - most, max(1, round(APART_S * rate_hz)))
        left += np.square(turned[middle] - mean[middle + lags[:, None]]).sum(axis=1)
        size += np.square(turned[middle]).sum(axis=0)
    moves &= size > MOVES_RAD_S**2 * len(kept) * STRETCH_S / APART_S
    shares = left[:, moves] / size[moves]
    best = np.argmin(shares, axis=0)
    late = (np.abs(lags[best]) >= LEAST) & (np.abs(lags[best]) < most)
    late &= shares[best, np.arange(len(best))] < BETTER * shares[most]
    if late.any():
        which = np.zeros(len(joints), dtype=bool)
        which[np.flatnonzero(moves)[late]] = True
        lag = float(np.median(lags[best][late])) / rate_hz
        way = "late" if lag > 0 else "early"
        yield f"v of {listed(joints, which)}: {abs(lag) * 1e3:.3g} ms {way} against q; give it as delay_s"


def stretches(spans: Sequence[slice], rows: int) -> list[slice]:
    """Return stretches of so many contiguous rows, evenly spread over the spans."""
    found = [slice(first, first + rows) for s in spans for first in range(s.start, s.stop - rows + 1, rows)]
    picked = np.unique(np.linspace(0, len(found) - 1, min(STRETCHES, len(found))).round().astype(int)) if found else []
    return [found[k] for k in picked]


def _unexplained(
    rows: slice, nominal: NominalModel, sensed: Sensed, rate_hz: float, wrenches: Mapping[str, Array],
    joints: NDArray[np.bool_], most: int, smooth: int,
) -> Array:  # fmt: skip
    """Return the share of torque that motion and friction leave unexplained, mean over joints, by lag (2 most + 1,)."""
    first = len(nominal.robot.layout.virtual)
    p, beta = momentum_and_beta(nominal, sensed.q[rows], sensed.v[rows])
    needed = np.diff(p, axis=0) * rate_hz - (beta[1:] + beta[:-1]) / 2
    needed -= feet_torque(nominal, sensed.q[rows], {side: wrench[rows] for side, wrench in wrenches.items()})[1:]
    speed = sensed.v[rows][1:, first:].astype(np.float64)
    parts = [needed[:, first:], speed, np.tanh(speed / STEADY), sensed.tau_motor[rows][1:].astype(np.float64)]
    smoothed = [_means(part[:, joints], smooth) for part in parts]
    middle = np.arange(most, len(smoothed[0]) - most, max(1, round(APART_S * rate_hz)))
    lags = np.arange(-most, most + 1)
    shares = []
    for k in range(int(joints.sum())):
        given = smoothed[3][middle[:, None] + lags, k]
        given = given - given.mean(axis=0)
        # Friction leads the torque that accelerates, so that it would look like a delay if nothing else explained it.
        design = np.stack([part[middle, k] for part in smoothed[:3]], axis=1)
        basis = np.linalg.qr(design - design.mean(axis=0))[0]
        size = np.maximum(np.square(given).sum(axis=0), np.finfo(float).tiny)
        shares.append(1.0 - np.square(basis.T @ given).sum(axis=0) / size)
    return np.mean(shares, axis=0)


def _means(values: Array, count: int) -> Array:
    """Return means over `count` successive rows (T - count + 1, n)."""
    sums = np.concatenate([np.zeros((1, values.shape[1])), np.cumsum(values, axis=0)])
    return (sums[count:] - sums[:-count]) / count
