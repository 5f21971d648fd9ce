"""Feed-forward of the learned uncertainty torque (section 9.1): motors make up for what the model gets wrong.

Only the leg that swings is fed: a leg that carries the robot is held by the ground's force, and the upper body follows
its references no better with it (docs/notes/reaction.md).
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.control.parameters import State
from mobnet.core.arrays import Array
from mobnet.core.joints import NQ_BASE
from mobnet.simulation.simulator import Simulator


@dataclass(frozen=True)
class FeedForward:
    """Torque that is added to what the controller asks of the leg that swings.

    Attributes:
        share: of the uncertainty torque that the motors make up for [-].
        held: where the joints of the legs stand in an estimate (n,).
        motors: their motors (n,).
        torque: what is added (nu,) [N m].
    """

    share: float
    held: NDArray[np.intp]
    motors: NDArray[np.intp]
    torque: Array

    @classmethod
    def of(cls, simulator: Simulator, joints: tuple[str, ...], share: float) -> "FeedForward":
        """Feed the legs of a simulator, of whose joints an estimate holds some; the random torque ends.

        Random torque acts on the leg that swings, as this does, so that its place is taken.
        """
        layout = simulator.robot.layout
        law = simulator.torque
        legs = layout.limbs(layout.legs.values())
        law.left[:] = np.inf
        law.value[:] = 0.0
        columns = [joints.index(joint) for joint in legs]
        motors = [layout.actuated.index(joint) for joint in legs]
        return cls(share, np.array(columns), np.array(motors), law.value)

    def feed(self, uncertainty: NDArray[Any]) -> None:
        """Make up for an uncertainty torque of the estimate's joints (n,) [N, N m], which acts as motors do."""
        self.torque[self.motors] = -self.share * uncertainty[self.held]


def swing_error(s: State, first: NDArray[np.int64], q: Array, error: NDArray[np.float32]) -> None:
    """Write how far the joints of the leg that swings are from their references (6,) [rad]; nothing while none swings.

    `first` are the first actuators of both legs, q (nq,) is the true position.
    """
    # Fields by their names, in NumPy: it takes longer for an attribute of a record, and numba for so large a record.
    if s["swinging"] == 1:
        leg = 1 if s["side"] > 0.0 else 0
        at = NQ_BASE + first[leg]
        error[:] = s["q_reference"][leg] - q[at : at + len(error)]
