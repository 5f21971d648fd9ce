"""Hints from single columns and clocks: constant, the same twice, held, clipped; jitter and gaps."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import combinations, repeat

import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.core.contract import Rule, rule_of
from mobnet.core.joints import JointLayout
from mobnet.core.recording import Sensed
from mobnet.robotlog.hints.bounds import HintBounds
from mobnet.robotlog.pieces import pieces, ranges

TURN = 2 * np.pi  # beyond which an angle of a joint may be in degrees
FEW = 5  # of a list of joints that are named
SAME = 1e-9  # difference of two columns that are the same, as a share of their size
SLOWEST_S = 10.0  # between two samples of a log
CLOCKS, RATES = {"ms": 1e-3, "us": 1e-6, "ns": 1e-9}, (20.0, 20_000.0)  # units of clocks, and usual rates [Hz]
LOOKED = 1000  # samples of two columns that are compared first
LEAST_CLIPPED = 20  # samples at a torque's largest value, below which nothing is said


def column_hints(sensed: Sensed, joints: Sequence[str], bounds: HintBounds) -> Iterator[str]:
    """Yield hints on the columns of motors, (T, nu) each."""
    first = sensed.q.shape[1] - len(joints), sensed.v.shape[1] - len(joints)
    signals = {"q": sensed.q[:, first[0] :], "v": sensed.v[:, first[1] :], "tau_motor": sensed.tau_motor}
    ends = {name: ranges(values) for name, values in signals.items()}
    changes = {name: low < high for name, (low, high) in ends.items()}
    for name, values in signals.items():
        others = np.any([changes[other] for other in ("q", "v") if other != name], axis=0)
        still = ~changes[name] & others  # a joint that rests has nothing to change
        if still.any():
            yield f"{name} of {listed(joints, still)}: never changes, {values[0, still][0]:g} in all samples"
        few = values[:: max(1, len(values) // LOOKED)]  # most pairs differ in any sample
        for i, j in combinations(np.flatnonzero(changes[name]).tolist(), 2):
            if _same(few, i, j) and _same(values, i, j):
                yield f"{name} of {joints[i]} and {joints[j]}: the same numbers in both columns"
    for name in ("v", "tau_motor"):
        repeated = held_share(signals[name])
        late = (repeated > bounds.held) & changes[name]
        if late.any():
            yield f"{name} of {listed(joints, late)}: {_repeats(repeated[late].max())}"
    clipped = _clipped(signals["tau_motor"], *ends["tau_motor"])
    cut = clipped > bounds.clipped
    if cut.any():
        sizes = np.maximum(*map(np.abs, ends["tau_motor"]))
        largest = ", ".join(f"{value:.4g}" for value in sizes[cut][:FEW])
        yield (
            f"tau_motor of {listed(joints, cut)}: {clipped[cut].max():.1%} of the samples stand at the largest value "
            f"({largest} N m): clipped by the log or the drive"
        )


def base_column_hints(sensed: Sensed, bounds: HintBounds) -> Iterator[str]:
    """Yield hints on the columns of a floating base that repeat the sample before."""
    for name, values in (("omega", sensed.v[:, 3:6]), ("acc", sensed.acc_base_in_base), ("velocity", sensed.v[:, :3])):
        if (share := float(held_share(values).max())) > bounds.held:
            yield f"{name}: {_repeats(share)}"


def limit_hints(sensed: Sensed, layout: JointLayout) -> Iterator[str]:
    """Yield hints on joints whose position, speed or torque is beyond the wide bounds of `mobnet.core.contract`."""
    joints = layout.actuated
    for signal, values in (("q", sensed.q), ("v", sensed.v), ("tau_motor", sensed.tau_motor)):
        low, high = ranges(values[:, -len(joints) :])
        largest = np.maximum(np.abs(low), np.abs(high))
        rules = [rule_of(f"{signal}.{joint}", layout) for joint in joints]
        most = np.array([max(abs(rule.low), abs(rule.high)) for rule in rules])
        far = largest > most
        for k in np.flatnonzero(far).tolist() if signal == "q" else []:
            if turns := _turns_beyond(float(low[k]), float(high[k]), rules[k]):
                far[k] = False
                text = f"it reaches {largest[k]:.4g} rad, accepted are {most[k]:.4g}"
                remedy = f"give offset: {turns * TURN:.7g}"
                yield f"q of {joints[k]}: beyond the robot's table by {_counted(turns)}: {text}; {remedy}"
        if not far.any():
            continue
        k = int(np.argmax(np.where(far, largest / most, 0.0)))
        degrees = ": in degrees?" if signal == "q" and TURN < largest[k] <= np.degrees(most[k]) else ""
        text = f"{joints[k]} reaches {largest[k]:.4g} {rules[k].places[0][0]}, accepted are {most[k]:.4g}"
        yield f"{signal} of {listed(joints, far)}: beyond the robot's table: {text}{degrees}"


def _turns_beyond(low: float, high: float, rule: Rule) -> int:
    """Return by how many full turns positions between two [rad] are above a range; 0 where turns do not help."""
    turns = round(((low + high) / 2 - (rule.low + rule.high) / 2) / TURN)
    fits = rule.low <= low - turns * TURN and high - turns * TURN <= rule.high
    return turns if fits else 0


def _counted(turns: int) -> str:
    """Return a number of turns in words."""
    way = "too much" if turns > 0 else "too little"
    return f"a full turn {way}" if abs(turns) == 1 else f"{abs(turns)} full turns {way}"


def unit_hints(clocks: Mapping[str, Array]) -> Iterator[str]:
    """Yield a hint if the clocks (T,) [s] of signals are of another unit; then no other hint means anything."""
    for names, clock in _together(clocks):
        median = float(np.median(np.diff(clock)))
        if median > SLOWEST_S:
            units = [unit for unit, size in CLOCKS.items() if RATES[0] <= 1 / (median * size) <= RATES[1]]
            yield f"clock of {names}: {median:.3g} s between samples" + f": in {' or '.join(units)}?" * bool(units)


def clock_hints(clocks: Mapping[str, Array], bounds: HintBounds) -> Iterator[str]:
    """Yield hints on the clocks (T,) [s] of signals."""
    for names, clock in _together(clocks):
        steps = np.diff(clock)
        median = float(np.median(steps))
        pauses = steps > bounds.gap_intervals * median
        spread = float(np.std(steps[~pauses]) / median)
        if spread > bounds.jitter:
            yield f"clock of {names}: intervals of {median * 1e3:.3g} ms spread by {spread:.0%} (standard deviation)"
        if pauses.any():
            lost = f"{pauses.sum()} gap{'s' * bool(pauses.sum() > 1)}, the longest {steps.max():.3g} s"
            yield f"clock of {names}: {lost}; each ends a segment, and the observer starts anew"


def listed(joints: Sequence[str], which: Iterable[bool] = repeat(True)) -> str:
    """Return the names of some joints, the first few of many."""
    names = [joint for joint, has in zip(joints, which, strict=False) if has]
    return ", ".join(names[:FEW]) + (f" and {len(names) - FEW} more" if len(names) > FEW else "")


def _same(values: NDArray[np.floating], i: int, j: int) -> bool:
    """Return whether two columns hold the same numbers."""
    apart = 0.0
    largest = 0.0
    for rows in pieces(0, len(values)):
        apart = max(apart, float(np.abs(values[rows, i] - values[rows, j]).max()))
        largest = max(largest, float(np.abs(values[rows, i]).max()))
    return apart <= SAME * largest


def _repeats(share: float) -> str:
    """Return what it means that a share of samples repeat the one before."""
    return f"{share:.0%} of the samples repeat the one before: updated more slowly than the log is written, or coarse"


def held_share(speed: NDArray[np.floating]) -> NDArray[np.float64]:
    """Return the share of samples that repeat the one before, where the joint moves (n,)."""
    repeated, moved = np.zeros((2, speed.shape[1]), dtype=np.intp)
    for rows in pieces(1, len(speed)):
        now = speed[rows]
        before = speed[rows.start - 1 : rows.stop - 1]
        moves = now != 0.0
        moved += np.count_nonzero(moves, axis=0)
        repeated += np.count_nonzero((now == before) & moves, axis=0)
    return repeated / np.maximum(moved, 1)


def _clipped(
    torque: NDArray[np.floating], low: NDArray[np.floating], high: NDArray[np.floating]
) -> NDArray[np.float64]:
    """Return the share of samples at the largest or at the smallest value of torques (T, n), whichever is more, (n,).

    The smallest and the largest values are (n,) each.
    """
    at_low, at_high = np.zeros((2, torque.shape[1]), dtype=np.intp)
    for rows in pieces(0, len(torque)):
        at_low += np.count_nonzero(torque[rows] == low, axis=0)
        at_high += np.count_nonzero(torque[rows] == high, axis=0)
    count = np.maximum(at_low, at_high)
    return np.where((low < high) & (count >= LEAST_CLIPPED), count / len(torque), 0.0)


def _together(clocks: Mapping[str, Array]) -> Iterator[tuple[str, Array]]:
    """Yield the names of signals with one clock, and the clock."""
    groups: list[tuple[list[str], Array]] = []
    for name, clock in clocks.items():
        names_so_far = next((names for names, other in groups if np.array_equal(other, clock)), None)
        if names_so_far is None:
            groups.append(([name], clock))
        else:
            names_so_far.append(name)
    yield from ((", ".join(names), clock) for names, clock in groups)
