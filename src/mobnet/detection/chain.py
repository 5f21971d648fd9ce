"""From signals to how far they lie above their thresholds: low-pass, threshold, and a time without a gap."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.core.compilation import compiled


class Chain(NamedTuple):
    """Numbers of the chain of a detector."""

    pole: float  # of the low-pass
    hold: int  # samples for which a signal must lie above its threshold
    norm: bool  # whether the length of all signals together is compared, and not each by itself
    thresholds: Array  # of each signal, or of their length, in each phase of a swing (phases, c)


class ChainState(NamedTuple):
    """State of the chain."""

    low: Array  # signals behind the low-pass (m,)
    held: Array  # over thresholds, of the last samples (hold, c)
    place: NDArray[np.int64]  # samples so far, and the signal that lies highest (2,)


def make_chain(low_pass_hz: float, hold_s: float, rate_hz: float, thresholds: Array, *, norm: bool = False) -> Chain:
    """Return the chain of a detector at a rate of samples [Hz]."""
    # (D7) [5.3]: exact for a signal that is constant between samples, at any rate.
    pole = float(np.exp(-2.0 * np.pi * low_pass_hz / rate_hz))
    return Chain(pole, max(1, round(hold_s * rate_hz)), norm, np.ascontiguousarray(thresholds, dtype=np.float64))


def chain_state(chain: Chain, signals: int) -> ChainState:
    """Return the state of a chain of so many signals before its first sample."""
    shape = chain.hold, chain.thresholds.shape[1]
    return ChainState(np.zeros(signals), np.zeros(shape), np.zeros(2, dtype=np.int64))


@compiled
def advance_chain(chain: Chain, state: ChainState, signals: Array, is_watched: bool, phase: float) -> float:
    """Take one sample of the signals (m,); return how often the highest lies above its threshold, held without a gap.

    Above 1 there is a collision. What is not watched counts as zero. The phase of the swing [-] picks thresholds.
    """
    # The filter runs on the ground too: a state that began at the gate would hide the first 10 ms of a swing.
    parts, count = chain.thresholds.shape
    part = min(int(phase * parts), parts - 1)
    row = state.place[0] % chain.hold
    total = 0.0
    state.place[0] += 1
    for k in range(len(signals)):
        state.low[k] = chain.pole * state.low[k] + (1.0 - chain.pole) * signals[k]
        total += state.low[k] * state.low[k]
    highest = 0.0
    for k in range(count):
        size = np.sqrt(total) if chain.norm else abs(state.low[k])
        # (D8): one sample that is not watched breaks what is held, so that no alarm reaches back to before the gate.
        state.held[row, k] = size / chain.thresholds[part, k] if is_watched else 0.0
        # [5.3] "continuous filtering of 5 ms": the least of the last samples is above 1 if and only if all are.
        least = state.held[row, k]
        for i in range(chain.hold):
            least = min(least, state.held[i, k])
        # The OR of [5.3]: one signal over its threshold is enough, and the highest one names the alarm.
        if least > highest:
            highest = least
            state.place[1] = k
    return highest


@compiled
def run_chain(
    chain: Chain,
    state: ChainState,
    signals: Array,
    watched: NDArray[np.bool_],
    phase: Array,
    ratio: Array,
    which: NDArray[np.int64],
) -> None:
    """Run the chain over samples (T, m) as `advance_chain` does; write its numbers and the highest signals (T,)."""
    for row in range(len(signals)):
        ratio[row] = advance_chain(chain, state, signals[row], watched[row], phase[row])
        which[row] = state.place[1]


@compiled
def low_passed(pole: float, signals: Array, out: Array) -> None:
    """Write the signals (T, m) behind the chain's low-pass from rest into out (T, m)."""
    for k in range(signals.shape[1]):
        low = 0.0
        for row in range(len(signals)):
            low = pole * low + (1.0 - pole) * signals[row, k]
            out[row, k] = low
