"""Short windows of a log, in which the momentum of the nominal model must change by the mean torque (O1 of note 0034).

No acceleration is needed. All hints on torques look at these windows.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.core.recording import Sensed
from mobnet.robot.dynamics import momentum_and_beta
from mobnet.robot.nominal import NominalModel
from mobnet.robot.wrench import feet_torque
from mobnet.settings.robotlog import RobotLog

NODES = 11  # samples of a window at which beta is taken


@dataclass(frozen=True)
class Windows:
    """Positions and velocities at the nodes of windows (W, NODES, n), and mean torques of the motors (W, nu) [N m].

    `loads` are what the feet's sensors read, side -> (W, NODES, 6) [N], [N m].
    """

    q: Array
    v: Array
    torque: Array
    loads: Mapping[str, Array]
    period_s: float

    def needed(self, nominal: NominalModel) -> Array:
        """Return the mean torques of the motors that the motion needs (W, nu) [N m]."""
        shape = self.q.shape[:2]
        p, beta = (term.reshape(*shape, -1) for term in momentum_and_beta(nominal, self.q, self.v))
        mean = (beta.sum(axis=1) - (beta[:, 0] + beta[:, -1]) / 2) / (shape[1] - 1)
        feet = feet_torque(nominal, self.q, self.loads).mean(axis=1)
        needed = (p[:, -1] - p[:, 0]) / self.period_s - mean - feet
        return needed[:, len(nominal.robot.layout.virtual) :]

    def thinned(self, step: int) -> "Windows":
        """Return every so many of the windows."""
        loads = {side: load[::step] for side, load in self.loads.items()}
        return Windows(self.q[::step], self.v[::step], self.torque[::step], loads, self.period_s)


def windows_of(
    sensed: Sensed, spans: Sequence[slice], rate_hz: float, wrenches: Mapping[str, Array], bounds: RobotLog
) -> Windows | None:
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
    return Windows(q, v, torque, loads, steps / rate_hz)


def known_joints(
    nominal: NominalModel, windows: Windows, needed: Array, wrenches: Mapping[str, Array], bounds: RobotLog
) -> NDArray[np.bool_]:
    """Return which joints tell of themselves (nu,): with a torque, and on no leg whose contact nobody measures.

    `needed` are the torques that the motion needs (W, nu) [N m].
    """
    robot = nominal.robot
    felt = [foot.limb for side, foot in robot.feet.items() if side not in wrenches]
    blind = {joint for limb in felt for joint in robot.layout.limb(limb)}
    sees = np.array([joint not in blind for joint in robot.layout.actuated])
    sees &= np.ptp(windows.torque, axis=0) > 0.0
    return sees & (np.maximum(size_of(windows.torque), size_of(needed)) > bounds.least_torque * robot.torque_limits)


def share_of(needed: Array, torque: Array) -> Array:
    """Return the square error over the larger square of the two, joint by joint (nu,)."""
    error = np.square(needed - torque).mean(axis=0)
    return error / np.maximum(np.maximum(size_of(needed), size_of(torque)) ** 2, np.finfo(float).tiny)


def size_of(values: Array) -> Array:
    """Return the root mean square of columns (n,)."""
    return np.sqrt(np.square(values).mean(axis=0))
