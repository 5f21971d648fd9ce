"""The pipeline of section 7, sample by sample: detection, isolation, identification, classification, reaction.

It reads what a robot senses and an estimate of its external torque, and returns the steps with which the robot should
react. A limb is watched by a detector of its own, so that detection isolates the limb too.
"""

from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Protocol

import numpy as np

from mobnet.control.steps import DURATION, SIDES
from mobnet.core.arrays import Array
from mobnet.core.estimator import Estimate
from mobnet.core.recording import Sensed
from mobnet.detection.detector import ALARM_RATIO
from mobnet.kernel.detecting import Strategy
from mobnet.reaction.contacts import IN_THE_AIR, Ends, end_effectors, identify, make_ends, unexpected_wrench
from mobnet.reaction.footsteps import Stance, compliant_steps, in_place, rewound_steps
from mobnet.reaction.numbers import ReactionNumbers
from mobnet.robot.description import RobotDescription


class Watcher(Protocol):
    """A detector of the collisions of one limb."""

    def init(self) -> Any:
        """Return the state before the first sample."""
        ...

    def ratio(self, state: Any, sample: Sensed, estimate: Estimate) -> float:
        """Take one sample and the estimate of all joints; return how far it lies above the threshold, 1 at it."""
        ...


@dataclass(frozen=True)
class Reacted:
    """A collision and what to do about it.

    Attributes:
        limb: the limb that was hit.
        direction: in which to step, horizontal, in the world (2,): that of the force on the limb's hand or foot, or of
            the wrench on the base where it has none.
        wrench: unexpected wrench on the base (6,) [N, N m], (24).
        steps: reacting steps (n, 5), commands as those of Table 2, the first for the step that is being made.
    """

    limb: str
    direction: Array
    wrench: Array
    steps: Array


@dataclass
class HandlerState:
    """What the pipeline carries from one sample to the next.

    Attributes:
        watchers: limb -> state of its detector.
        settling: samples in which nothing is an alarm yet.
        kept: poses in which feet stood (3,) [m, m, rad], the last one last.
        in_air: which feet swung at the last sample (2,).
        swing: the foot that swings, or will do so next: 0 for the left, 1 for the right one.
        waiting: samples until a reaction to what was detected; None where nothing was.
        limb: the limb that was hit.
        has_reacted: whether the robot reacts already.
    """

    watchers: dict[str, Any]
    settling: int
    kept: deque[Array]
    in_air: list[bool] = field(default_factory=lambda: [False, False])
    swing: int = 1
    waiting: int | None = None
    limb: str = ""
    has_reacted: bool = False


class Handler:
    """Detects collisions and decides how to step; `identified` has the last sample's wrenches on hands and feet."""

    def __init__(
        self,
        robot: RobotDescription,
        numbers: ReactionNumbers,
        spacing_m: float,
        watchers: Mapping[str, Watcher],
        strategy: Strategy,
        delay: int = 0,
        settle: int = 0,
    ) -> None:
        """Watch limbs; react `delay` samples after an alarm, with feet that the controller sets spacing_m [m] apart.

        In the first `settle` samples, while filters and networks begin from rest, nothing is an alarm.
        """
        self.numbers = numbers
        self.spacing = spacing_m
        self.watchers = watchers
        self.strategy = strategy
        self.delay = delay
        self.settle = settle
        bodies = end_effectors(robot)
        self.limbs = list(bodies)
        self.identified = make_ends(robot, bodies, numbers.identification)

    def init(self) -> HandlerState:
        """Return the state before the first sample."""
        watchers = {limb: watcher.init() for limb, watcher in self.watchers.items()}
        return HandlerState(watchers, self.settle, deque(maxlen=self.numbers.rewind.kept))

    def step(self, state: HandlerState, sample: Sensed, estimate: Estimate) -> Reacted | None:
        """Take one sample (1-D arrays) and the estimate of all joints (nv,); return a reaction when it begins."""
        tau = np.asarray(estimate.tau_ext, dtype=np.float64)
        identify(self.identified, np.asarray(sample.q, dtype=np.float64), tau)
        self._keep_footsteps(state, sample)
        ratios = {
            limb: watcher.ratio(state.watchers[limb], sample, estimate) for limb, watcher in self.watchers.items()
        }
        state.settling = max(0, state.settling - 1)
        if state.has_reacted or state.settling:
            return None
        limb = max(ratios, key=ratios.__getitem__, default="")
        if state.waiting is None and limb and ratios[limb] > ALARM_RATIO:
            state.waiting = self.delay
            state.limb = limb
        if state.waiting is None:
            return None
        state.waiting -= 1
        if state.waiting >= 0:
            return None
        state.has_reacted = True
        return self._react(state, sample, tau)

    def _react(self, state: HandlerState, sample: Sensed, tau: Array) -> Reacted:
        """Return the reaction to a collision of a limb."""
        standing = [k for k in range(2) if sample.swing[k] < IN_THE_AIR]
        wrench = unexpected_wrench(self.identified, tau, standing)
        # A limb that was hit knows the force by its own joints. (24) has the same force, and the errors of the base's
        # network and of the stance leg on top of it, which are as large in the first hundredth of a second. It is used
        # where a limb without hand or foot was hit, such as the waist.
        known = state.limb in self.limbs
        force = self.identified.wrench[self.limbs.index(state.limb), :2] if known else wrench[:2]
        size = float(np.hypot(*force))
        direction = force / size if size > 0.0 else np.zeros(2)
        stance = self._stance(state, sample)
        command = np.asarray(sample.command, dtype=np.float64)
        numbers = self.numbers
        first = self.numbers.first_step
        if self.strategy == "compliant":
            steps = compliant_steps(numbers.compliant, first, stance, direction, command, self.spacing)
        else:
            kept = self._behind(state)
            count = numbers.rewind.steps
            steps = rewound_steps(kept, count, numbers.compliant.step_m, first, stance, command, self.spacing)
        steps = np.vstack([steps, in_place(command, numbers.stop_steps)])
        # The step that is being made keeps its duration, from which the foot's way and the balance were planned.
        steps[1:, DURATION] = np.minimum(steps[1:, DURATION], numbers.step_s)
        return Reacted(state.limb, direction, wrench, steps)

    def _stance(self, state: HandlerState, sample: Sensed) -> Stance:
        """Return how the robot stands, by its joints; on both feet it is about to swing the one that stood longer."""
        swing = state.swing
        pose = self.identified.pose
        foot = self.identified.body[1 - swing]
        other = self.identified.body[swing]
        in_air = sample.swing[swing] >= IN_THE_AIR
        landing = float(sample.landing[swing]) if in_air else np.inf
        place = pose.position[other, :2].copy()
        height = float(pose.position[other, 2] - pose.position[foot, 2])
        return Stance(pose_of(self.identified, foot), SIDES[1 - swing], place, height, landing)

    def _keep_footsteps(self, state: HandlerState, sample: Sensed) -> None:
        """Keep where a foot stood when it leaves."""
        for k in range(2):
            in_air = sample.swing[k] >= IN_THE_AIR
            if in_air and not state.in_air[k]:
                state.swing = k
                state.kept.append(pose_of(self.identified, self.identified.body[k]))
            if state.in_air[k] and not in_air:
                state.swing = 1 - k
            state.in_air[k] = in_air

    def _behind(self, state: HandlerState) -> list[Array]:
        """Return footsteps to walk back on, of which the last is where the swing foot stood, or still stands."""
        here = [] if any(state.in_air) else [pose_of(self.identified, self.identified.body[state.swing])]
        return [*state.kept, *here]


def pose_of(ends: Ends, body: Any) -> Array:
    """Return place and yaw of a body (3,) [m, m, rad]."""
    rotation = ends.pose.rotation[body]
    place = ends.pose.position[body]
    return np.array([place[0], place[1], np.arctan2(rotation[1, 0], rotation[0, 0])])
