"""Hints from positions and velocities: a factor, a sign, an order or a delay between them."""

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.core.contract import BEYOND_SPEED
from mobnet.core.joints import JointLayout
from mobnet.robotlog.hints.bounds import HintBounds
from mobnet.robotlog.hints.columns import listed
from mobnet.robotlog.hints.fits import quotient
from mobnet.robotlog.long_arrays import give_back
from mobnet.robotlog.pieces import PIECE_ROWS, pieces

MOVES_RAD = 0.005  # mean turn in a window below which a joint tells nothing
ALIKE = 0.95  # correlation above which a column is what another one should be
LOOKED = 100_000  # samples of which the usual step is taken
JUMP = 20.0  # times the usual step of a position that is a jump
WRAPPED = 0.1  # share of a full turn within which a jump is one
FACTORS = {  # of the change of q over the integral of v -> what it means
    180 / np.pi: "q in degrees, or v in 57.3 rad/s",
    np.pi / 180: "v in deg/s",
    np.pi / 30: "v in rpm",
    -1.0: "one of them has the wrong sign",
    1e3: "q in mrad",
    1e-3: "the clock in ms, or v in mrad/s",
    1e-6: "the clock in us",
}


def motion_hints(
    q: Array, v: Array, spans: Sequence[slice], rate_hz: float, joints: Sequence[str], bounds: HintBounds
) -> Iterator[str]:
    """Yield hints on positions and velocities of joints (T, nu) [rad], [rad/s] within contiguous spans."""
    change, integral = turns(q, v, spans, rate_hz, bounds.window_s)
    if not len(change):  # the log is shorter than a window
        return
    size = np.sqrt(np.maximum(np.square(change).mean(axis=0), np.square(integral).mean(axis=0)))
    moves = size > MOVES_RAD
    match = _correlation(change, integral)
    slope = quotient((change * integral).sum(axis=0), np.square(integral).sum(axis=0))
    if moves.any() and _are_exchanged(change, integral, turns(v, q, spans, rate_hz, bounds.window_s), moves, bounds):
        yield f"q and v of {listed(joints, moves)}: v changes by the integral of q, and not q by that of v: exchanged"
        return
    names_by_text: dict[str, list[str]] = {}
    for k in np.flatnonzero(moves).tolist():
        twin = int(np.argmax(np.abs(match[k])))
        if abs(match[k, k]) < ALIKE < abs(match[k, twin]) and moves[twin]:
            text = f"follows v of {joints[twin]} and not its own v: exchanged"
        elif abs(match[k, k]) >= ALIKE and not 1 - bounds.factor < slope[k] < 1 + bounds.factor:
            text = f"changes by {slope[k]:.3g} times the integral of v{_meaning(slope[k], rate_hz, bounds)}"
        else:
            continue
        names_by_text.setdefault(text, []).append(joints[k])
    for text, names in names_by_text.items():
        yield f"q of {', '.join(names)}: {text}"


def turns(q: Array, v: Array, spans: Sequence[slice], rate_hz: float, window_s: float) -> tuple[Array, Array]:
    """Return the changes of q and the integrals of v over all windows of the spans, (W, nu) [rad] each."""
    steps = max(1, round(window_s * rate_hz))
    change = [np.zeros((0, q.shape[1]))]
    integral = [np.zeros((0, q.shape[1]))]
    for span in spans:
        q_of_span = q[span]
        speed = v[span]
        if len(q_of_span) > steps:
            change.append(np.diff(q_of_span[::steps], axis=0))
            integral.append(np.diff(_travelled(speed, steps, rate_hz), axis=0))
    return np.concatenate(change), np.concatenate(integral)


def _travelled(speed: Array, steps: int, rate_hz: float) -> Array:
    """Return the integral of speeds (T, nu) [rad/s] from the first row to multiples of `steps`, (W + 1, nu) [rad]."""
    last = (len(speed) - 1) // steps * steps
    travelled = np.zeros(speed.shape[1])
    parts = [np.zeros((1, speed.shape[1]))]
    for rows in pieces(0, last, steps * max(1, PIECE_ROWS // steps)):
        sums = speed[rows.start + 1 : rows.stop + 1] + speed[rows]
        sums /= 2 * rate_hz
        sums[0] += travelled
        np.cumsum(sums, axis=0, out=sums)
        travelled = sums[-1]
        parts.append(sums[steps - 1 :: steps])
    return np.concatenate(parts)


def jump_hints(q: Array, spans: Sequence[slice], rate_hz: float, layout: JointLayout) -> Iterator[str]:
    """Yield hints on positions of joints (T, nu) [rad] that jump from one sample to the next within a span."""
    before = np.concatenate([np.arange(span.start, span.stop - 1) for span in spans])
    looked = before[:: max(1, len(before) // LOOKED)]
    usual = np.quantile(np.abs(q[looked + 1] - q[looked]), 0.99, axis=0)
    give_back()
    speeds = np.array([layout.limits[joint].speed for joint in layout.actuated])
    most = np.maximum(JUMP * usual, BEYOND_SPEED * speeds / rate_hz)
    counts = np.zeros(len(most), dtype=np.intp)
    sizes = np.zeros(len(most))
    for span in spans:
        for rows in pieces(span.start + 1, span.stop):
            steps = np.abs(q[rows] - q[rows.start - 1 : rows.stop - 1])
            counts += np.count_nonzero(steps > most, axis=0)
            sizes = np.maximum(sizes, steps.max(axis=0))
    for k in np.flatnonzero(counts).tolist():
        largest = float(sizes[k])
        count = int(counts[k])
        turn = ": wrapped at a full turn" if abs(largest / (2 * np.pi) - 1) < WRAPPED else ": samples are lost or wrong"
        times = f"{count} time{'s' * (count > 1)}"
        yield f"q of {layout.actuated[k]}: jumps {times}, by up to {largest:.3g} rad from one sample to the next{turn}"


def _are_exchanged(
    change: Array, integral: Array, other: tuple[Array, Array], moves: NDArray[np.bool_], bounds: HintBounds
) -> bool:
    """Return whether all joints that move follow the other signal, whose changes and integrals (W, nu) are `other`."""

    def fits(change: Array, integral: Array) -> NDArray[np.bool_]:
        slope = quotient((change * integral).sum(axis=0), np.square(integral).sum(axis=0))
        return (np.diag(_correlation(change, integral)) >= ALIKE) & (np.abs(slope - 1) < bounds.factor)

    return bool((fits(*other)[moves] & ~fits(change, integral)[moves]).all())


def _meaning(slope: float, rate_hz: float, bounds: HintBounds) -> str:
    """Return what a factor may mean, if it is a known one."""
    known = [*FACTORS.items(), (rate_hz, "v in rad from one sample to the next")]
    texts = [text for factor, text in known if abs(slope / factor - 1) < bounds.factor]
    return f": {', or '.join(texts)}" if texts else ""


def _correlation(first: NDArray[np.floating], other: NDArray[np.floating]) -> Array:
    """Return the correlation without means of each column of one with each of another, (n, n)."""
    sizes = np.outer(np.linalg.norm(first, axis=0), np.linalg.norm(other, axis=0))
    return quotient(first.T @ other, sizes)
