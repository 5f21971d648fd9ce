"""Changes of a log that would undo a mistake: of torques, of joints as a whole, of feet, of what the model lacks."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.robot.nominal import NominalModel
from mobnet.robotlog.hints.bounds import HintBounds
from mobnet.robotlog.hints.fits import TINY, friction_fit, unexplained
from mobnet.robotlog.hints.mounting import mounting_of
from mobnet.robotlog.hints.payload import payloads
from mobnet.robotlog.hints.windows import MotionWindows, MotorDemand, repeated, size_of

ALIKE = 3.0  # factor that a wrong model may make of a torque
ANY = np.array(np.inf)  # offset of a torque [N m]
FACTORS = np.geomspace(1e-4, 1e4, 161)  # of torques that are tried, and how finely the best of them is sought again
BOTH_SIGNS = np.concatenate([FACTORS, -FACTORS])
FINER = np.geomspace(1 / 1.1, 1.1, 41)
CONSTANTS = np.geomspace(1 / ALIKE, ALIKE, 45)  # of a single joint, by which a wrong constant may be off,
LEAST_CONSTANT = 1.2  # factor from which it has a word among what explains the residual,
SURE_CONSTANT = 1.5  # and from which it is a hint: masses of a table make smaller ones, too
UNITS = {"mN m": 1e-3, "kN m": 1e3}
APART_RAD = np.radians(15.0)  # between zeros of a joint that are tried
LEAST_RAD = np.radians(12.0)  # shift of a zero below which friction may be the cause
WAVES = 5  # numbers that tell how the torque of a joint depends on its own angle
LEAST_TOLD = 2  # joints of a wrong sign from which all may have it
LEAST_CARRIED = 2  # joints that a mass at the end of an arm loads
LEAST_ORDER = 3  # joints that stand in another order; two are exchanged


Changed = Callable[[MotionWindows], MotionWindows]


class Change(NamedTuple):
    """A change that would undo a mistake.

    Attributes:
        text: what the mistake is.
        joints: those that it must explain.
        numbers: how many numbers were chosen for it, by which changes are held against each other.
        apply: what it makes of windows.
    """

    text: str
    joints: tuple[int, ...]
    numbers: int
    apply: Changed


Moved = tuple[Changed, tuple[Change, ...]]  # a change of motion, and those of torques that may go with it


class Seen(NamedTuple):
    """A log's windows and what their motion asks for.

    Attributes:
        left: share of the square torque of each joint that is not explained (nu,).
        known: joints that tell of themselves.
        suspects: those of them that are not explained, the worst first.
        few: those of the suspects that are tried with each other, in order.
    """

    nominal: NominalModel
    bounds: HintBounds
    windows: MotionWindows
    asked: MotorDemand
    left: Array
    known: tuple[int, ...]
    suspects: tuple[int, ...]
    few: tuple[int, ...]

    def offset(self, k: int) -> Array:
        """Return the largest offset of a motor's torque that needs no word, an array of one number [N m]."""
        return self.bounds.offset * np.asarray(self.nominal.robot.torque_limits[k])

    def with_torque(self, i: int, torque: Array) -> Array:
        """Return what joint i would leave unexplained if its torques were these (W, m), (m,)."""
        return unexplained(self.asked.terms[:, i], self.asked.needed[:, [i]], torque, self.offset(i))

    def with_factors(self, i: int, factors: Array, offset: Array | None = None) -> Array:
        """Return what joint i would leave unexplained if its motion needed so many times as much (m,).

        The offset of its torque is at most so large [N m], that which needs no word where none is given.
        """
        needed = self.asked.needed[:, [i]] * factors
        torque = self.windows.torque[:, [i]]
        return unexplained(self.asked.terms[:, i], needed, torque, self.offset(i) if offset is None else offset)


def sign_changes(seen: Seen) -> Iterator[Change]:
    """Yield the change of the signs of all torques that fit better with the other one."""
    torque = -seen.windows.torque
    nu = torque.shape[1]
    other = [seen.with_torque(k, torque[:, [k]])[0] for k in range(nu)]
    wrong = [k for k in seen.suspects if _improves(other[k], seen.left[k], seen.bounds)]
    if not wrong:
        return
    right = [k for k in range(nu) if _improves(seen.left[k], other[k], seen.bounds)]
    if len(wrong) >= LEAST_TOLD and len(wrong) < nu and not right:
        text = "tau_motor is of the wrong sign, and so may be that of all joints: none speaks against it"
        yield Change(text, tuple(sorted(wrong)), 1, _times(-np.ones(nu)))
        return
    sign = np.ones(nu)
    sign[wrong] = -1.0
    numbers = 1 if len(wrong) == len(seen.known) else len(wrong)
    yield Change("tau_motor is of the wrong sign", tuple(sorted(wrong)), numbers, _times(sign))


def factor_changes(seen: Seen) -> Iterator[Change]:
    """Yield factors of torques: of a single joint, or of all that are not explained, one or for each its own."""
    # A joint whose motion needs next to nothing has no factor to tell.
    large = size_of(seen.asked.needed) > seen.bounds.least_torque * seen.nominal.robot.torque_limits
    factors = {k: _best_factor(seen, [k], BOTH_SIGNS) for k in sorted(seen.suspects) if large[k]}
    factors = {
        k: factor
        for k, factor in factors.items()
        if _improves(*seen.with_factors(k, np.array([factor, 1.0]), ANY), seen.bounds)
    }
    for k, factor in factors.items():
        yield from _factor_change(seen, {k: factor}, 1)
    if len(factors) > 1:
        common = _best_factor(seen, list(factors), BOTH_SIGNS)
        same = dict.fromkeys(factors, common)
        # A joint that its own factor does not explain either has none to tell.
        is_sure = {k: float(seen.with_factors(k, np.array([factors[k]]))[0]) < seen.bounds.suspect for k in factors}
        each = {k: factor if is_sure[k] else common for k, factor in factors.items()}
        better = _sum_of_logs(seen, each) + seen.bounds.number * (len(factors) - 1) < _sum_of_logs(seen, same)
        yield from _factor_change(seen, each if better else same, len(factors) if better else 1)


def _best_factor(seen: Seen, joints: Sequence[int], tried: Array) -> float:
    """Return the factor on what the motion needs of some joints that explains their torques best, near those tried."""
    coarse = float(tried[int(np.argmin(_log_left(seen, joints, tried)))])
    return coarse * float(FINER[int(np.argmin(_log_left(seen, joints, coarse * FINER)))])


def _log_left(seen: Seen, joints: Sequence[int], factors: Array) -> Array:
    """Return the sum of logarithms of what joints leave with factors on what their motion needs (m,)."""
    return np.sum([np.log(seen.with_factors(k, factors) + TINY) for k in joints], axis=0)


def _sum_of_logs(seen: Seen, factors: Mapping[int, float]) -> float:
    """Return the sum of logarithms of what joints leave with factors on what their motion needs."""
    return float(sum(_logs(seen.with_factors(k, np.array([size])), seen.bounds)[0] for k, size in factors.items()))


def _factor_change(seen: Seen, factors: Mapping[int, float], numbers: int) -> Iterator[Change]:
    """Yield the change that undoes factors of joints on what the motion needs, if they have a meaning."""
    if meaning := _meaning(list(factors.values()), seen.bounds):
        size = np.ones(len(seen.left))
        size[list(factors)] = [1 / factor for factor in factors.values()]
        yield Change(meaning, tuple(factors), numbers, _times(size))


def order_changes(seen: Seen) -> Iterator[Change]:
    """Yield orders of torques: two exchanged, or many in another order."""
    nu = len(seen.left)
    suspects = sorted(seen.suspects)
    torque = seen.windows.torque
    for i in seen.few:
        for j in (j for j in seen.few if j > i):
            yield Change("tau_motor of the two is exchanged", (i, j), 1, _in_order(_exchanged(nu, i, j)))
    if len(suspects) < LEAST_ORDER:
        return
    yield Change("tau_motor stands in the reverse order", tuple(suspects), 1, _in_order(np.arange(nu)[::-1]))
    from scipy.optimize import linear_sum_assignment  # here, as it takes a second to import

    left = np.array([seen.with_torque(i, torque[:, suspects]) for i in suspects])
    place, assigned = linear_sum_assignment(_logs(left, seen.bounds))
    order = np.arange(nu)
    order[[suspects[k] for k in place]] = [suspects[k] for k in assigned]
    moved = tuple(np.flatnonzero(order != np.arange(nu)).tolist())
    if len(moved) >= LEAST_ORDER:
        names = seen.nominal.robot.layout.actuated
        given = ", ".join(f"{names[k]} has that of {names[int(np.flatnonzero(order == k)[0])]}" for k in moved)
        yield Change(f"tau_motor stands in another order: {given}", moved, len(moved), _in_order(order))


def offset_changes(seen: Seen) -> Iterator[Change]:
    """Yield offsets of single torques."""
    for k in seen.suspects:
        rest = seen.windows.torque[:, [k]] - seen.asked.needed[:, [k]]
        size = float(friction_fit(seen.asked.terms[:, k], rest, np.array(np.inf))[1].item())
        if abs(size) > seen.offset(k):
            shift = np.zeros(len(seen.left))
            shift[k] = -size
            text = f"tau_motor reads {size:+.3g} N m too much all the time: an offset"
            yield Change(text, (k,), 1, _plus(shift))


def gravity_changes(seen: Seen) -> Iterator[Change]:
    """Yield gravity that the drives of an arm add by themselves, or that is in its torques twice."""
    if not seen.suspects or seen.nominal.robot.floating:  # whose feet carry it
        return
    gravity = replace(seen.windows, v=0 * seen.windows.v, loads={}).needed(seen.nominal)
    joints = tuple(sorted(seen.suspects))
    yield Change("tau_motor lacks the torque of gravity, which the drive adds by itself", joints, 1, _beside(gravity))
    yield Change("tau_motor has the torque of gravity twice", joints, 1, _beside(-gravity))


def mounting_changes(seen: Seen) -> Iterator[Change]:
    """Yield another direction of gravity, which explains all joints of an arm at once."""
    if not seen.suspects:
        return
    mounting = mounting_of(seen.nominal, seen.windows, seen.asked, seen.left, seen.known)
    if mounting:
        text = mounting.text(seen.nominal)
        yield Change(text, tuple(sorted(seen.suspects)), 2, _beside(-mounting.torque))


def constant_changes(seen: Seen, least: float) -> Iterator[Change]:
    """Yield a factor of the torques of a single joint that is no unit and no sign: a wrong torque constant.

    A factor nearer to one than the least has no word.
    """
    for k in sorted(seen.suspects):
        factor = _best_factor(seen, [k], CONSTANTS)
        is_far = not 1 / least < factor < least
        # Any offset is allowed, so that the torque of a joint that only holds its load has no factor to tell.
        left, before = seen.with_factors(k, np.array([factor, 1.0]), ANY).tolist()
        if is_far and _improves(left, before, seen.bounds):
            size = np.ones(len(seen.left))
            size[k] = 1 / factor
            remedy = f"a scale of {1 / factor:.3g} undoes it, and identify --scale finds it"
            text = f"tau_motor is {factor:.3g} times what the motion needs: a wrong torque constant? {remedy}"
            yield Change(text, (k,), 1, _times(size))


def payload_changes(seen: Seen) -> Iterator[Change]:
    """Yield a mass at the end of a limb, which several joints carry."""
    if len(seen.suspects) < LEAST_CARRIED:
        return
    for mass in payloads(seen.nominal, seen.windows, seen.asked, seen.left, seen.known):
        yield Change(mass.text(), tuple(sorted(seen.suspects)), 4, _beside(-mass.torque))


def motion_changes(seen: Seen) -> Iterator[Moved]:
    """Yield changes of motion, for which the model has to be asked again, and those of torques that may go with it."""
    nu = len(seen.left)
    few = seen.few
    every = tuple(sorted(seen.suspects))
    order = np.arange(nu)
    same = np.ones(nu)
    # A joint that is explained is exchanged with none; one that tells nothing may be.
    others = [k for k in range(nu) if k in few or k not in seen.known]
    for i in few:
        sign = same.copy()
        sign[i] = -1.0
        alone = Change("q and v have the wrong sign", (i,), 1, _unchanged)
        whole = Change("q, v and tau_motor have the wrong sign", (i,), 1, _times(sign))
        yield _with_motion(order, sign), (alone, whole)
        for j in (j for j in others if j > i or j not in few):
            pair = _exchanged(nu, i, j)
            alone = Change("q and v of the two are exchanged", (i, j), 1, _unchanged)
            both = Change("the two joints are exchanged", (i, j), 1, _in_order(pair))
            yield _with_motion(pair, same), (alone, both)
    if len(every) >= LEAST_ORDER:
        back = order[::-1].copy()
        alone = Change("q and v stand in the reverse order", every, 1, _unchanged)
        whole = Change("q, v and tau_motor stand in the reverse order", every, 1, _in_order(back))
        yield _with_motion(back, same), (alone, whole)
    if every:
        degrees = Change("q and v are too small by 57.3: in rad, and taken for degrees", every, 1, _unchanged)
        yield _with_motion(order, np.degrees(same)), (degrees,)


def zero_changes(seen: Seen, thin: MotionWindows) -> Iterator[Moved]:
    """Yield shifts of positions, of each joint that which explains its own torque best in a few windows.

    It must explain how the torque changes, too: gravity at another angle can look like the friction of a joint that
    rests.
    """
    nu = len(seen.left)
    asked = thin.asked(seen.nominal)
    for i in seen.few:
        by_angle = _needed_by_angle(seen, thin, i)
        left = partial(_left_by_shifts, seen, asked, thin.torque, by_angle, i)
        best = 0.0
        apart = APART_RAD
        tried = np.arange(-np.pi, np.pi, apart)
        while apart > LEAST_RAD / 20:
            best = float(tried[int(np.argmin(left(tried, seen.offset(i))))])
            tried = best + apart * np.linspace(-1, 1, 7)
            apart = apart / 3
        both = left(np.array([best, 0.0]), ANY)
        if abs(best) > LEAST_RAD and _improves(float(both[0]), float(both[1]), seen.bounds):
            much = f"{-best:+.2f} rad ({np.degrees(-best):+.0f} degrees)"
            text = f"q reads {much} too much: another zero; give it as offset"
            yield _shifted(nu, i, best), (Change(text, (i,), 2, _unchanged),)


def _needed_by_angle(seen: Seen, windows: MotionWindows, i: int) -> Array:
    """Return what joint i needs in windows as a sum of waves of a shift of its positions, (WAVES, W) [N m].

    Behind a joint nothing sees its angle but by the turn of what comes from before it: momentum has that turn once, and
    C^T v - g at most twice. Five angles tell all.
    """
    count = len(windows.q)
    angles = 2 * np.pi * np.arange(WAVES) / WAVES
    many = repeated(windows, WAVES)
    many.q[..., i - len(seen.left)] += np.repeat(angles, count)[:, None]
    needed = many.needed(seen.nominal)[:, i] - many.beside[:, i]
    return np.linalg.solve(_waves(angles), needed.reshape(WAVES, count)).astype(np.float64, copy=False)


def _waves(angles: Array) -> Array:
    """Return a constant, and cosine and sine of angles (n,) [rad] and of twice the angles, (n, WAVES)."""
    constant = np.ones(len(angles))
    return np.stack([constant, np.cos(angles), np.sin(angles), np.cos(2 * angles), np.sin(2 * angles)], axis=-1)


def _left_by_shifts(
    seen: Seen, asked: MotorDemand, torque: Array, by_angle: Array, i: int, shifts: Array, offset: Array
) -> Array:
    """Return what joint i would leave unexplained if its positions were shifted by numbers (n,) [rad], (n,).

    `asked` is what windows with torques (W, nu) ask for as they are, `by_angle` what the joint needs by the shift. The
    offset of its torque is at most so large [N m].
    """
    count = len(shifts)
    needed = (_waves(shifts) @ by_angle)[..., None]
    terms = np.broadcast_to(asked.terms[:, i], (count, *asked.terms[:, i].shape))
    return unexplained(terms, needed, torque[:, [i]], np.full(count, offset))[:, 0]


def feet_changes(seen: Seen) -> Iterator[Moved]:
    """Yield the exchange of the sensors of both feet, for the joints of the legs."""
    robot = seen.nominal.robot
    legs = set(robot.layout.limbs(foot.limb for foot in robot.feet.values()))
    joints_of_legs = tuple(k for k in sorted(seen.suspects) if robot.layout.actuated[k] in legs)
    if joints_of_legs and len(seen.windows.loads) > 1:
        text = "the sensors of the left and the right foot are exchanged"
        yield _with_feet_exchanged, (Change(text, joints_of_legs, 1, _unchanged),)


def _improves(left: float, before: float, bounds: HintBounds) -> bool:
    """Return whether a share that is left is little, and much less than before."""
    return left < min(bounds.good, (1 - bounds.explained) * before)


def _logs(left: Array, bounds: HintBounds) -> Array:
    """Return the logarithms of shares that are left, of which the smallest count alike."""
    return np.log(np.maximum(left, bounds.floor))


def _with_feet_exchanged(windows: MotionWindows) -> MotionWindows:
    return replace(windows, loads=dict(zip(windows.loads, reversed(list(windows.loads.values())), strict=True)))


def _unchanged(windows: MotionWindows) -> MotionWindows:
    return windows


def _exchanged(nu: int, i: int, j: int) -> NDArray[np.intp]:
    """Return the order of joints in which two are exchanged."""
    order = np.arange(nu)
    order[[i, j]] = j, i
    return order


def _times(size: Array) -> Changed:
    """Return the change that multiplies torques by factors (nu,)."""
    return lambda w: replace(w, torque=size * w.torque)


def _plus(shift: Array) -> Changed:
    """Return the change that adds numbers (nu,) [N m] to torques."""
    return lambda w: replace(w, torque=w.torque + shift)


def _beside(torque: Array) -> Changed:
    """Return the change that lets a torque (W, nu) [N m] act beside the motors."""
    return lambda w: replace(w, beside=w.beside + torque)


def _in_order(order: NDArray[np.intp]) -> Changed:
    """Return the change that puts torques into an order."""
    return lambda w: replace(w, torque=w.torque[:, order])


def _with_motion(order: NDArray[np.intp], size: Array) -> Changed:
    """Return the change that puts positions and velocities of joints into an order, with factors (nu,)."""

    def apply(w: MotionWindows) -> MotionWindows:
        q = w.q.copy()
        v = w.v.copy()
        q[..., -len(order) :], v[..., -len(order) :] = (size * x[..., -len(order) :][..., order] for x in (w.q, w.v))
        return replace(w, q=q, v=v)

    return apply


def _shifted(nu: int, i: int, shift: float) -> Changed:
    """Return the change that adds a number [rad] to the positions of a joint."""

    def apply(w: MotionWindows) -> MotionWindows:
        q = w.q.copy()
        q[..., i - nu] += shift
        return replace(w, q=q)

    return apply


def _meaning(needed: Sequence[float], bounds: HintBounds) -> str:
    """Return what it means that torques are so many times what the motion needs, nothing where friction may be it."""
    sizes = sorted(map(abs, needed))
    turned = {factor < 0 for factor in needed}
    # A wrong model makes such factors, too, and joints of both signs have no factor in common.
    if len(turned) > 1 or (sizes[0] < ALIKE and sizes[-1] > 1 / ALIKE):
        return ""
    sign = " and of the wrong sign" if turned == {True} else ""
    exact = [unit for unit, value in UNITS.items() if _far(sizes, value) < 1 + bounds.factor]
    if exact:
        return f"tau_motor is in {exact[0]}{sign}"
    near = [f"in {unit}, " for unit, value in UNITS.items() if _far(sizes, value) < ALIKE]
    if sizes[0] > ALIKE:
        return f"tau_motor is {_span(sizes)} times what the motion needs{sign}: {''.join(near)}or a current in mA?"
    inverse = [1 / size for size in reversed(sizes)]
    likely = "".join(near) or "before the gear, "
    return f"tau_motor is 1/{_span(inverse)} of what the motion needs{sign}: {likely}or a current in A?"


def _far(sizes: Sequence[float], unit: float) -> float:
    """Return the largest factor between what torques would be in a unit [N m] and what the motion needs."""
    return max(max(size * unit, 1 / (size * unit)) for size in sizes)


def _span(sizes: Sequence[float]) -> str:
    """Return the smallest and the largest of some numbers in order."""
    few = f"{sizes[0]:.3g}"
    many = f"{sizes[-1]:.3g}"
    return few if few == many else f"{few} to {many}"
