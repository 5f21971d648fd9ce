"""Changes of a log that would undo a mistake: of torques, of joints as a whole, of feet."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from mobnet.core.arrays import Array
from mobnet.robot.nominal import NominalModel
from mobnet.robotlog.hints.windows import Windows, share_of
from mobnet.settings.robotlog import RobotLog

ALIKE = 2.0  # factor that friction and a wrong model may make of a torque
GEAR = (10.0, 500.0)  # reductions of gears
UNITS = {"mN m": 1e-3, "kN m": 1e3}
APART_RAD = np.radians(15.0)  # between zeros of a joint that are tried
LEAST_RAD = np.radians(12.0)  # shift of a zero below which friction may be the cause
LEAST_ORDER = 3  # joints that stand in another order; two are exchanged


Changed = Callable[[Windows], Windows]


class Change(NamedTuple):
    """A change that would undo a mistake: its text, the joints that it must explain, and what it makes of windows."""

    text: str
    joints: tuple[int, ...]
    apply: Changed


Moved = tuple[Changed, tuple[Change, ...]]  # a change of motion, and those of torques that may go with it


def factor_of(needed: Array, windows: Windows, k: int, bounds: RobotLog) -> Change | None:
    """Return the factor on the torque of one joint that explains it, if one with a meaning does."""
    own, wanted = windows.torque[:, k], needed[:, k]
    factor = float(own @ wanted / max(float(own @ own), np.finfo(float).tiny))
    meaning = _meaning(factor, bounds)
    if not meaning or not _explains(wanted, own, factor * own, bounds):
        return None
    size = np.ones(windows.torque.shape[1])
    size[k] = factor
    return Change(meaning, (k,), lambda w: replace(w, torque=size * w.torque))


def torque_changes(
    nominal: NominalModel,
    needed: Array,
    windows: Windows,
    suspects: Sequence[int],
    few: Sequence[int],
    bounds: RobotLog,
) -> Iterator[Change]:
    """Yield changes of torques alone: two exchanged, many in another order, gravity that the drive adds by itself."""
    for i in few:
        for j in (j for j in few if j > i):
            order = _exchanged(windows.torque.shape[1], i, j)
            if all(_explains(needed[:, k], windows.torque[:, k], windows.torque[:, order[k]], bounds) for k in (i, j)):
                yield Change("tau_motor of the two is exchanged", (i, j), _with_torques(order))
    share = np.array([share_of(needed[:, suspects], windows.torque[:, [j]]) for j in suspects]).clip(max=1.0)
    place, own = linear_sum_assignment(share.T) if len(suspects) >= LEAST_ORDER else (np.zeros(0, int),) * 2
    order = np.arange(windows.torque.shape[1])
    order[[suspects[k] for k in place]] = [suspects[k] for k in own]
    moved = tuple(np.flatnonzero(order != np.arange(len(order))).tolist())
    if len(moved) >= LEAST_ORDER:
        names = nominal.robot.layout.actuated
        given = ", ".join(f"{names[k]} has that of {names[int(np.flatnonzero(order == k)[0])]}" for k in moved)
        yield Change(f"tau_motor stands in another order: {given}", moved, _with_torques(order))
    if suspects and not nominal.robot.floating:  # whose feet carry it
        gravity = replace(windows, v=0 * windows.v, loads={}).needed(nominal)
        yield Change(
            "tau_motor lacks the torque of gravity, which the drive adds by itself", tuple(suspects),
            lambda w: replace(w, torque=w.torque + gravity),
        )  # fmt: skip


def motion_changes(nominal: NominalModel, few: Sequence[int]) -> Iterator[Moved]:
    """Yield changes of motion, for which the model has to be asked again, and those of torques that may go with it."""
    nu = nominal.robot.layout.nu
    order, same = np.arange(nu), np.ones(nu)
    for i in few:
        sign = same.copy()
        sign[i] = -1.0
        alone = Change("q and v have the wrong sign", (i,), _unchanged)
        whole = Change("q, v and tau_motor have the wrong sign", (i,), _with_torques(order, sign))
        yield _with_motion(order, sign), (alone, whole)
        for j in (j for j in range(nu) if j > i or (j not in few and j != i)):
            pair = _exchanged(nu, i, j)
            alone = Change("q and v of the two are exchanged", (i, j), _unchanged)
            yield _with_motion(pair, same), (alone, Change("the two joints are exchanged", (i, j), _with_torques(pair)))


def zero_changes(nominal: NominalModel, thin: Windows, few: Sequence[int], bounds: RobotLog) -> Iterator[Moved]:
    """Yield shifts of positions, of each joint that which leaves the least error in a few windows.

    It must explain how the joint's torque changes, too: gravity at another angle can look like the friction of a joint
    that rests.
    """
    nu, before = nominal.robot.layout.nu, _share_of_changes(thin.needed(nominal), thin.torque)
    for i in few:

        def left(shift: float, i: int = i) -> float:
            moved = _shifted(nu, i, shift)(thin)
            return float(share_of(moved.needed(nominal), moved.torque).clip(max=1.0).sum())

        best, apart = 0.0, APART_RAD
        tried = np.arange(-np.pi, np.pi, apart)
        while apart > LEAST_RAD / 20:
            best = float(min(tried, key=left))
            tried, apart = best + apart * np.linspace(-1, 1, 7), apart / 3
        after = _share_of_changes(_shifted(nu, i, best)(thin).needed(nominal), thin.torque)
        if abs(best) > LEAST_RAD and after[i] < (1 - bounds.explained) * before[i]:
            much = f"{-best:+.2f} rad ({np.degrees(-best):+.0f} degrees)"
            text = f"q reads {much} too much: another zero; give it as offset"
            yield _shifted(nu, i, best), (Change(text, (i,), _unchanged),)


def feet_changes(nominal: NominalModel, windows: Windows, suspects: Sequence[int]) -> Iterator[Moved]:
    """Yield the exchange of the sensors of both feet, for the joints of the legs."""
    robot = nominal.robot
    legs = {joint for foot in robot.feet.values() for joint in robot.layout.limb(foot.limb)}
    own = tuple(k for k in sorted(suspects) if robot.layout.actuated[k] in legs)
    if own and len(windows.loads) > 1:
        text = "the sensors of the left and the right foot are exchanged"
        yield _with_feet_exchanged, (Change(text, own, _unchanged),)


def _share_of_changes(needed: Array, torque: Array) -> Array:
    """Return the square error over the larger square of what is left of both without their means (nu,)."""
    return share_of(needed - needed.mean(axis=0), torque - torque.mean(axis=0))


def _with_feet_exchanged(windows: Windows) -> Windows:
    return replace(windows, loads=dict(zip(windows.loads, reversed(list(windows.loads.values())), strict=True)))


def _unchanged(windows: Windows) -> Windows:
    return windows


def _exchanged(nu: int, i: int, j: int) -> NDArray[np.intp]:
    """Return the order of joints in which two are exchanged."""
    order = np.arange(nu)
    order[[i, j]] = j, i
    return order


def _with_torques(order: NDArray[np.intp], sign: Array | float = 1.0) -> Changed:
    """Return the change that puts torques into an order, with signs (nu,)."""
    return lambda w: replace(w, torque=sign * w.torque[:, order])


def _with_motion(order: NDArray[np.intp], sign: Array) -> Changed:
    """Return the change that puts positions and velocities of joints into an order, with signs (nu,)."""

    def apply(w: Windows) -> Windows:
        q, v = w.q.copy(), w.v.copy()
        q[..., -len(order) :], v[..., -len(order) :] = (sign * x[..., -len(order) :][..., order] for x in (w.q, w.v))
        return replace(w, q=q, v=v)

    return apply


def _shifted(nu: int, i: int, shift: float) -> Changed:
    """Return the change that adds a number [rad] to the positions of a joint."""

    def apply(w: Windows) -> Windows:
        q = w.q.copy()
        q[..., i - nu] += shift
        return replace(w, q=q)

    return apply


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


def _explains(needed: Array, before: Array, after: Array, bounds: RobotLog) -> bool:
    """Return whether a change of a torque (W,) takes most of the square error away and leaves little of it."""
    was, left = float(np.square(needed - before).sum()), float(np.square(needed - after).sum())
    return left < (1 - bounds.explained) * was and left < bounds.good * float(np.square(needed).sum())
