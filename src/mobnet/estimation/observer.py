"""The momentum observer of section 3.2 for a robot of a table: `mobnet.kernel.recursion` over its samples."""

import logging
from collections.abc import Mapping, Sequence
from functools import partial

import numpy as np

from mobnet.core.arrays import Array
from mobnet.core.errors import DataError
from mobnet.core.recording import Sensed
from mobnet.formats.parts import FrictionRow
from mobnet.kernel.drive import DriveParameters, TorqueKind
from mobnet.kernel.recursion import ObserverState, Recursion
from mobnet.robot.dynamics import momentum_and_beta
from mobnet.robot.nominal import NominalModel

LOGGED_ROWS = 100_000  # samples between two messages of progress
log = logging.getLogger(__name__)


class RobotObserver:
    """Momentum observer (4) to (11) of a robot's nominal model.

    Attributes:
        nominal: the model it knows.
        gain_hz: K_0 of (7) [1/s].
        pole: gamma = exp(-K_0 T) [-].
        rate_hz: samples per second [Hz].
        torque: whether `Sensed.tau_motor` holds means over the intervals that end at the ticks, as the simulator writes
            them, or samples at the ticks.
        drives: friction and errors of the drives that the robot's table has; None where it has none.
    """

    def __init__(self, nominal: NominalModel, gain_hz: float, rate_hz: float, torque: TorqueKind = "mean") -> None:
        """Set up the observer.

        Raises:
            ConfigError: a gain or a rate is not positive, or the kind of torque is unknown.
        """
        layout = nominal.robot.layout
        self.nominal = nominal
        self.torque = torque
        self.drives = drives_of(nominal.robot.friction, layout.actuated)
        motors = slice(len(layout.virtual), None)  # of a generalized velocity
        terms = partial(momentum_and_beta, nominal)
        self._recursion = Recursion(terms, motors, gain_hz, rate_hz, torque, self.drives)
        self.gain_hz = gain_hz
        self.pole = self._recursion.pole
        self.rate_hz = rate_hz

    def init(self) -> ObserverState:
        """Return the state before the first sample."""
        return ObserverState()

    def step(self, state: ObserverState, sample: Sensed) -> tuple[ObserverState, Array]:
        """Take one sample (1-D arrays); return the new state and r of (9), (nv,) [N] and [N m]. The first r is zero."""
        return self._recursion.step(state, sample.q, sample.v, sample.tau_motor)

    def residual(self, sensed: Sensed, out: Array | None = None) -> Array:
        """Return r of (9) over one contiguous stretch, (T, nv) [N] and [N m]; equal to stepping through it.

        It is written into `out`, contiguous rows, where that is given.

        Raises:
            DataError: positions, velocities or torques do not fit the model.
        """
        layout = self.nominal.robot.layout
        shapes = [sensed.q.shape, sensed.v.shape, sensed.tau_motor.shape]
        accepted = [(len(sensed), width) for width in (layout.nq, layout.nv, layout.nu)]
        if shapes != accepted:
            raise DataError(f"samples q, v, tau_motor of shapes {shapes}; accepted: {accepted}")
        residual = np.empty(sensed.v.shape) if out is None else out
        state = self.init()
        for start in range(0, len(sensed), LOGGED_ROWS):
            rows = slice(start, start + LOGGED_ROWS)
            state = self.follow(state, sensed[rows], residual[rows])
            log.info("%d of %d samples observed", min(rows.stop, len(sensed)), len(sensed))
        return residual

    def follow(self, state: ObserverState, sensed: Sensed, out: Array) -> ObserverState:
        """Write r of (9) of contiguous samples into `out` (n, nv) [N] and [N m]; return the state after them.

        The state is that after the sample before the first one, or of `init`: a stretch may come in pieces. Its arrays
        may be overwritten afterwards.
        """
        return self._recursion.follow(state, sensed.q, sensed.v, sensed.tau_motor, out)


def drives_of(friction: Mapping[str, FrictionRow], joints: Sequence[str]) -> DriveParameters | None:
    """Return the drives of actuated joints (nu,) by the rows of a table; None where it has none."""
    if not friction:
        return None
    rows = [friction.get(joint) for joint in joints]
    return DriveParameters(
        coulomb=np.array([row.coulomb_nm if row else 0.0 for row in rows]),
        viscous=np.array([row.viscous_nms if row else 0.0 for row in rows]),
        load=np.array([row.load if row else 0.0 for row in rows]),
        offset=np.array([row.offset_nm if row else 0.0 for row in rows]),
        scale=np.array([row.scale if row else 1.0 for row in rows]),
        smoothing=np.array([row.smoothing_rad_s if row else 1.0 for row in rows]),
        breakaway=np.array([(row.breakaway_rad if row else None) or 0.0 for row in rows]),
    )
