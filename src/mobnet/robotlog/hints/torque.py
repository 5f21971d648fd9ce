"""Hints from the motion that torques should make: which single mistake explains the observer's own residual best.

Over short windows the momentum of the nominal model changes by the mean torque (O1 of note 0034), so that no
acceleration is needed. A mistake is a change of the signals that would undo it; one is told if it takes most of the
difference between needed and measured torque away and leaves little of it.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.core.recording import Sensed
from mobnet.robot.dynamics import momentum_and_beta
from mobnet.robot.nominal import NominalModel
from mobnet.robot.wrench import feet_torque
from mobnet.settings.robotlog import RobotLog

NODES = 11  # samples of a window at which beta is taken
MOST = 8  # mistakes that are looked for, one after another
ALIKE = 2.0  # factor that friction and a wrong model may make of a torque
GEAR = (10.0, 500.0)  # reductions of gears
UNITS = {"mN m": 1e-3, "kN m": 1e3}


@dataclass(frozen=True)
class Windows:
    """Positions and velocities at the nodes of windows (W, NODES, n), and mean torques of the motors (W, nu) [N m].

    `feet` is what the feet's sensors add (W, nv) [N] and [N m]; zero where there are none.
    """

    q: Array
    v: Array
    torque: Array
    feet: Array
    period_s: float

    def needed(self, nominal: NominalModel) -> Array:
        """Return the mean torques of the motors that the motion needs (W, nu) [N m]."""
        shape = self.q.shape[:2]
        p, beta = (term.reshape(*shape, -1) for term in momentum_and_beta(nominal, self.q, self.v))
        mean = (beta.sum(axis=1) - (beta[:, 0] + beta[:, -1]) / 2) / (shape[1] - 1)
        needed = (p[:, -1] - p[:, 0]) / self.period_s - mean - self.feet
        return needed[:, len(nominal.robot.layout.virtual) :]


@dataclass(frozen=True)
class Mistake:
    """A change that would undo a mistake: its text, the windows after it, and the joints that it changes."""

    text: str
    windows: Windows
    joints: tuple[int, ...]


def torque_hints(nominal: NominalModel, windows: Windows, known: NDArray[np.bool_], bounds: RobotLog) -> Iterator[str]:
    """Yield what looks wrong with torques, or with joints as a whole, of those that are known (nu,)."""
    names, told = nominal.robot.layout.actuated, dict[str, list[str]]()
    for _ in range(MOST):
        found = _best(nominal, windows, known, bounds)
        for mistake in found:
            told.setdefault(mistake.text, []).append(" and ".join(names[k] for k in mistake.joints))
            windows = _undone(windows, mistake)
        if not found:
            break
    for text, joints in told.items():
        yield f"{', '.join(joints)}: {text}"


def windows_of(
    nominal: NominalModel, sensed: Sensed, spans: Sequence[slice], rate_hz: float,
    wrenches: Mapping[str, Array], bounds: RobotLog,
) -> Windows | None:  # fmt: skip
    """Return windows spread evenly over the spans, None where no span is long enough."""
    steps = max(2, round(bounds.window_s * rate_hz))
    starts = np.concatenate([np.arange(s.start, s.stop - steps, steps) for s in spans] or [np.zeros(0)]).astype(np.intp)
    if not len(starts):
        return None
    count = min(bounds.windows, len(starts))
    starts = starts[np.linspace(0, len(starts) - 1, count).round().astype(np.intp)]
    nodes = starts[:, None] + np.linspace(0, steps, min(NODES, steps + 1)).round().astype(np.intp)
    q, v = sensed.q[nodes].astype(np.float64), sensed.v[nodes].astype(np.float64)
    inside = starts[:, None] + 1 + np.arange(steps)
    torque = sensed.tau_motor[inside].mean(axis=1, dtype=np.float64)
    loads = {side: wrench[nodes] for side, wrench in wrenches.items()}
    feet = feet_torque(nominal, q, loads).mean(axis=1)
    return Windows(q, v, torque, feet, steps / rate_hz)


def known_joints(
    nominal: NominalModel, windows: Windows, wrenches: Mapping[str, Array], bounds: RobotLog
) -> NDArray[np.bool_]:
    """Return which joints tell of themselves (nu,): with a torque, and on no leg whose contact nobody measures."""
    robot = nominal.robot
    size = np.sqrt(np.square(windows.torque).mean(axis=0))
    felt = [foot.limb for side, foot in robot.feet.items() if side not in wrenches]
    blind = {joint for limb in felt for joint in robot.layout.limb(limb)}
    sees = np.array([joint not in blind for joint in robot.layout.actuated])
    return sees & (np.maximum(size, _size(windows.needed(nominal))) > bounds.least_torque * robot.torque_limits)


def _best(nominal: NominalModel, windows: Windows, known: NDArray[np.bool_], bounds: RobotLog) -> list[Mistake]:
    """Return the mistake that explains most; where many joints are wrong, the factors of all their torques at once."""
    needed = windows.needed(nominal)
    wrong = _share(needed, windows.torque)
    worst = np.argsort(np.where(known, -wrong, np.inf))
    suspects = [k for k in worst.tolist() if known[k] and wrong[k] > bounds.suspect]
    found = [mistake for k in suspects if (mistake := _of_torque(windows, needed, k, bounds))]
    if len(found) > bounds.few:
        return found
    suspects = sorted(suspects[: bounds.few])
    pairs = [(i, j) for i in suspects for j in suspects if i < j]
    tried = [mistake for pair in pairs if (mistake := _swapped_torque(windows, needed, *pair, bounds))]
    best, least = [], float(wrong[known].clip(max=1.0).sum())
    for mistake in (*found, *tried, *_of_joints(nominal, windows, suspects)):
        after = _share(mistake.windows.needed(nominal), mistake.windows.torque)
        own, total = list(mistake.joints), float(after[known].clip(max=1.0).sum())
        clears = (after[own] < np.minimum(bounds.good, (1 - bounds.explained) * wrong[own])).all()
        if clears and total < least:
            best, least = [mistake], total
    return best


def _of_torque(windows: Windows, needed: Array, k: int, bounds: RobotLog) -> Mistake | None:
    """Return the factor on the torque of one joint that explains it, if one with a meaning does."""
    own, wanted = windows.torque[:, k], needed[:, k]
    factor = float(own @ wanted / max(float(own @ own), np.finfo(float).tiny))
    meaning = _meaning(factor, bounds)
    if not meaning or not _explains(wanted, own, factor * own, bounds):
        return None
    torque = windows.torque.copy()
    torque[:, k] *= factor
    return Mistake(meaning, replace(windows, torque=torque), (k,))


def _meaning(factor: float, bounds: RobotLog) -> str:
    """Return what a factor on a torque means; nothing of one that a model's error or friction may make."""
    size = abs(factor)
    sign = " and of the wrong sign" if factor < 0 else ""
    unit = next((unit for unit, value in UNITS.items() if abs(size / value - 1) < bounds.factor), "")
    if unit:
        return f"tau_motor is in {unit}{sign}"
    if GEAR[0] < size < GEAR[1]:
        return f"tau_motor is 1/{size:.3g} of what the motion needs{sign}: before the gear?"
    return "tau_motor is of the wrong sign" if sign and 1 / ALIKE < size < ALIKE else ""


def _swapped_torque(windows: Windows, needed: Array, i: int, j: int, bounds: RobotLog) -> Mistake | None:
    """Return the exchange of the torques of two joints, if it explains both."""
    torque = windows.torque.copy()
    torque[:, [i, j]] = windows.torque[:, [j, i]]
    pair = all(_explains(needed[:, k], windows.torque[:, k], torque[:, k], bounds) for k in (i, j))
    return Mistake("tau_motor of the two is exchanged", replace(windows, torque=torque), (i, j)) if pair else None


def _of_joints(nominal: NominalModel, windows: Windows, suspects: Sequence[int]) -> Iterator[Mistake]:
    """Yield changes of joints as a whole, for which the model has to be asked again."""
    q0, v0 = (x.shape[2] - nominal.robot.layout.nu for x in (windows.q, windows.v))
    for i in suspects:
        sign = np.ones(nominal.robot.layout.nu)
        sign[i] = -1.0
        q, v = windows.q.copy(), windows.v.copy()
        q[..., q0:] *= sign
        v[..., v0:] *= sign
        yield Mistake("q and v have the wrong sign", replace(windows, q=q, v=v), (i,))
        whole = replace(windows, q=q, v=v, torque=windows.torque * sign)
        yield Mistake("q, v and tau_motor have the wrong sign", whole, (i,))
    for i in suspects:
        for j in range(nominal.robot.layout.nu):
            if j == i or (j in suspects and j < i):
                continue
            order = np.arange(nominal.robot.layout.nu)
            order[[i, j]] = j, i
            q, v = windows.q.copy(), windows.v.copy()
            q[..., q0:], v[..., v0:] = windows.q[..., q0 + order], windows.v[..., v0 + order]
            yield Mistake("q and v of the two are exchanged", replace(windows, q=q, v=v), (i, j))
            whole = replace(windows, q=q, v=v, torque=windows.torque[:, order])
            yield Mistake("the two joints are exchanged", whole, (i, j))


def _undone(windows: Windows, mistake: Mistake) -> Windows:
    """Return windows with a mistake undone; several that change torques alone may be undone one after another."""
    if mistake.windows.q is not windows.q:
        return mistake.windows
    torque, own = windows.torque.copy(), list(mistake.joints)
    torque[:, own] = mistake.windows.torque[:, own]
    return replace(windows, torque=torque)


def _explains(needed: Array, before: Array, after: Array, bounds: RobotLog) -> bool:
    """Return whether a change of a torque (W,) takes most of the square error away and leaves little of it."""
    was, left = float(np.square(needed - before).sum()), float(np.square(needed - after).sum())
    return left < (1 - bounds.explained) * was and left < bounds.good * float(np.square(needed).sum())


def _share(needed: Array, torque: Array) -> Array:
    """Return the square error over the larger square of the two, joint by joint (nu,)."""
    error = np.square(needed - torque).mean(axis=0)
    return error / np.maximum(np.maximum(_size(needed), _size(torque)) ** 2, np.finfo(float).tiny)


def _size(values: Array) -> Array:
    """Return the root mean square of columns (n,)."""
    return np.sqrt(np.square(values).mean(axis=0))
