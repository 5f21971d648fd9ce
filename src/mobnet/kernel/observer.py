"""The momentum observer of section 3.2 for any model of Pinocchio, over arrays."""

from collections.abc import Mapping, Sequence

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike

from mobnet.core.arrays import Array, check_finite
from mobnet.core.errors import DataError, not_accepted
from mobnet.kernel.compiled_step import CompiledStep, StepNumbers
from mobnet.kernel.drive import DriveParameters, TorqueKind
from mobnet.kernel.mechanism import Mechanism
from mobnet.kernel.recursion import ObserverState, Recursion

State = ObserverState | Array  # what the observer carries: an array where one compiled call takes a sample
GAIN_HZ = 100.0  # K_0 of the paper, section 5.1, as in configs/config.yaml


class MomentumObserver:
    """Momentum observer (4) to (11): the residual r follows the external torque through a first-order low-pass.

    Positions (nq,) and velocities (nv,) are those of the model, in Pinocchio's order, axes and units: of a free-flyer
    place [m], quaternion x y z w, and velocities in its own axes. The residual (nv,) [N], [N m] is in the same axes. A
    free-flyer's force is filtered in the axes of its parent, which do not turn. An endless hinge, which a URDF calls
    continuous, has cosine and sine in Pinocchio; its angle [rad] is taken as well, where all of them have it.

    Attributes:
        model: the model.
        joints: names of the joints with a motor.
        nu: number of torques of motors.
        rate_hz: samples per second [Hz].
        gain_hz: K_0 [1/s], the inverse of the low-pass's time constant.
    """

    def __init__(
        self,
        model: pin.Model,
        rate_hz: float,
        gain_hz: float = GAIN_HZ,
        torque: TorqueKind = "sample",
        joints: Sequence[str] | None = None,
        friction: Mapping[str, ArrayLike] | None = None,
    ) -> None:
        """Make the observer of a model, as `pin.buildModelFromUrdf` and others return it.

        Args:
            model: whatever Pinocchio builds; compiled code computes where all joints are hinges.
            rate_hz: samples per second [Hz].
            gain_hz: gain K_0 [1/s].
            torque: whether motors' torques are a `sample` at the tick, or the `mean` over the interval before it.
            joints: names of the joints with a motor, in the order of the torques; all but a free-flyer if None.
            friction: of the drives of these joints and errors of their torques, by names of `DriveParameters`: a number
                for all, or one for each torque.

        Raises:
            ConfigError: a number or a name is not accepted, or a joint cannot be taken.
        """
        self.model = model
        self._mechanism = Mechanism(model)
        self.joints = _driven(model) if joints is None else tuple(joints)
        motors: list[int] = []
        for joint in self.joints:
            motors += self._mechanism.columns_of(joint)
        self.nu = len(motors)
        drives = None if friction is None else DriveParameters.of(self.nu, **friction)
        self.rate_hz = rate_hz
        self.gain_hz = gain_hz
        terms = self._mechanism.terms
        columns = np.array(motors, dtype=np.intp)
        self._recursion = Recursion(terms, columns, gain_hz, rate_hz, torque, drives)
        linkage = self._mechanism.linkage
        self._compiled: CompiledStep | None = None
        if linkage is not None and self._mechanism.is_same and drives is None:
            numbers = StepNumbers(linkage, columns, self._recursion.pole, float(rate_hz), torque == "mean")
            self._compiled = CompiledStep(numbers)

    def init(self) -> State:
        """Return the state before the first sample."""
        return ObserverState() if self._compiled is None else self._compiled.init()

    def step(self, state: State, q: ArrayLike, v: ArrayLike, tau: ArrayLike) -> tuple[State, Array]:
        """Return the state after a sample, and the residual (nv,) [N], [N m]; the first one is zero.

        Args:
            state: that after the sample before, or of `init`.
            q: position (nq,).
            v: velocity (nv,).
            tau: torques of the motors (nu,) [N m], [N].

        Raises:
            DataError: an array has another shape, or a number is not finite.
        """
        if self._compiled is not None and isinstance(state, np.ndarray):
            done = self._compiled.step(state, q, v, tau)
            if done is not None:
                return done
        # What compiled code does not take is refused here, with what is wrong with it.
        position = self._mechanism.with_circles(_taken("q", q, (), self._mechanism.widths)[None])
        velocity = _taken("v", v, (), (self.model.nv,))
        torque = _taken("tau", tau, (), (self.nu,))
        simple_q, simple_v = self._mechanism.to_simple(position, velocity[None])
        carried = state if isinstance(state, ObserverState) else ObserverState()
        carried, residual = self._recursion.step(carried, simple_q[0], simple_v[0], torque)
        return carried, self._mechanism.from_simple(position, residual[None])[0]

    def run(self, q: ArrayLike, v: ArrayLike, tau: ArrayLike) -> Array:
        """Return the residual of samples without a gap (T, nv) [N], [N m], as stepping through them gives it.

        Args:
            q: positions (T, nq).
            v: velocities (T, nv).
            tau: torques of the motors (T, nu) [N m], [N].

        Raises:
            DataError: an array has another shape, or a number is not finite.
        """
        samples = np.shape(q)[:1]
        positions = self._mechanism.with_circles(_taken("q", q, samples, self._mechanism.widths))
        velocities = _taken("v", v, samples, (self.model.nv,))
        torques = _taken("tau", tau, samples, (self.nu,))
        simple_q, simple_v = self._mechanism.to_simple(positions, velocities)
        residual = np.empty(simple_v.shape)
        self._recursion.follow(ObserverState(), simple_q, simple_v, torques, residual)
        return self._mechanism.from_simple(positions, residual)

    def __repr__(self) -> str:
        """Return what a notebook shows."""
        way = "compiled" if self._mechanism.is_compiled else "by Pinocchio"
        moves = f"{self.model.nv} velocities, {self.nu} motors"
        return f"MomentumObserver {self.model.name}: {moves}, {self.rate_hz:g} Hz, gain {self.gain_hz:g} 1/s, {way}"


def _taken(name: str, array: ArrayLike, samples: tuple[int, ...], widths: Sequence[int]) -> Array:
    """Return an array of finite numbers that is as long as there are samples, of one of some widths."""
    taken = np.asarray(array, dtype=np.float64)
    accepted = [(*samples, width) for width in widths]
    if taken.shape not in accepted:
        raise DataError(not_accepted(f"shape of {name}", taken.shape, accepted))
    check_finite(name, taken)
    return taken


def _driven(model: pin.Model) -> tuple[str, ...]:
    """Return the names of the joints that move by themselves, but for free-flyers."""
    names: list[str] = []
    for number in range(1, model.njoints):
        joint = model.joints[number]
        if joint.nv and joint.shortname() != "JointModelFreeFlyer":
            names.append(model.names[number])
    return tuple(names)
