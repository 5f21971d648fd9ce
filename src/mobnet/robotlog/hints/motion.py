"""Hints from positions and velocities: a factor, a sign, an order or a delay between them."""

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.settings.robotlog import RobotLog

MOVES_RAD = 0.005  # mean turn in a window below which a joint tells nothing
ALIKE = 0.95  # correlation above which a column is what another one should be
FACTORS = {  # of the change of q over the integral of v -> what it means
    180 / np.pi: "q in degrees, or v in 57.3 rad/s",
    np.pi / 180: "v in deg/s",
    np.pi / 30: "v in rpm",
    -1.0: "one of them has the wrong sign",
    1e3: "q in mrad",
    1e-3: "the clock in ms, or v in mrad/s",
}


def motion_hints(
    q: Array, v: Array, spans: Sequence[slice], rate_hz: float, joints: Sequence[str], bounds: RobotLog
) -> Iterator[str]:
    """Yield hints on positions and velocities of joints (T, nu) [rad], [rad/s] within contiguous spans."""
    change, integral = turns(q, v, spans, rate_hz, bounds.window_s)
    size = np.sqrt(np.maximum(np.square(change).mean(axis=0), np.square(integral).mean(axis=0)))
    moves = size > MOVES_RAD
    match = _correlation(change, integral)
    slope = (change * integral).sum(axis=0) / np.maximum(np.square(integral).sum(axis=0), np.finfo(float).tiny)
    told: dict[str, list[str]] = {}
    for k in np.flatnonzero(moves).tolist():
        twin = int(np.argmax(np.abs(match[k])))
        if abs(match[k, k]) < ALIKE < abs(match[k, twin]) and moves[twin]:
            text = f"follows v of {joints[twin]} and not its own v: exchanged"
        elif abs(match[k, k]) >= ALIKE and not 1 - bounds.factor < slope[k] < 1 + bounds.factor:
            text = f"changes by {slope[k]:.3g} times the integral of v{_meaning(slope[k], bounds)}"
        else:
            continue
        told.setdefault(text, []).append(joints[k])
    for text, names in told.items():
        yield f"q of {', '.join(names)}: {text}"


def turns(q: Array, v: Array, spans: Sequence[slice], rate_hz: float, window_s: float) -> tuple[Array, Array]:
    """Return the changes of q and the integrals of v over all windows of the spans, (W, nu) [rad] each."""
    steps = max(1, round(window_s * rate_hz))
    change, integral = [np.zeros((0, q.shape[1]))], [np.zeros((0, q.shape[1]))]
    for span in spans:
        own, speed = q[span], v[span]
        if len(own) > steps:
            travelled = np.zeros(own.shape)
            np.cumsum((speed[1:] + speed[:-1]) / (2 * rate_hz), axis=0, out=travelled[1:])
            change.append(np.diff(own[::steps], axis=0))
            integral.append(np.diff(travelled[::steps], axis=0))
    return np.concatenate(change), np.concatenate(integral)


def _meaning(slope: float, bounds: RobotLog) -> str:
    """Return what a factor may mean, if it is a known one."""
    texts = [text for factor, text in FACTORS.items() if abs(slope / factor - 1) < bounds.factor]
    return f": {texts[0]}" if texts else ""


def _correlation(one: NDArray[np.floating], other: NDArray[np.floating]) -> Array:
    """Return the correlation without means of each column of one with each of another, (n, n)."""
    sizes = np.outer(np.linalg.norm(one, axis=0), np.linalg.norm(other, axis=0))
    return one.T @ other / np.maximum(sizes, np.finfo(float).tiny)
