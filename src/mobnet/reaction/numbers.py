"""Numbers of the pipeline of section 7; section `reaction` of a configuration gives them."""

from dataclasses import dataclass


@dataclass(frozen=True)
class WrenchDamping:
    """Damping of the contact Jacobian's inverse: the error of torques [N m], and a force and a moment that are large.

    Attributes:
        torque_error_nm: error of torques [N m].
        force_n: force that is large [N].
        moment_nm: moment that is large [N m].
    """

    torque_error_nm: float
    force_n: float
    moment_nm: float


@dataclass(frozen=True)
class FirstStepNumbers:
    """How far a foot that is in the air may be sent elsewhere: it need not be fast, and lands where it can carry.

    Attributes:
        height_ratio: way for each height of the foot [-].
        foot_speed_m_s: speed of the foot [m/s].
        behind_m: how far behind the stance foot it lands at most [m].
        clear_m: how far from where it is it lands at least [m].
    """

    height_ratio: float
    foot_speed_m_s: float
    behind_m: float
    clear_m: float


@dataclass(frozen=True)
class CompliantNumbers:
    """Compliant Stepping Planning, (24) and Figure 21: number of steps, and their length [m]."""

    steps: int
    step_m: float


@dataclass(frozen=True)
class RewindNumbers:
    """Rewind Stepping Planning: footsteps that are kept, and how many are walked back."""

    kept: int
    steps: int


@dataclass(frozen=True)
class ReactionNumbers:
    """What a handler of collisions is made with.

    Attributes:
        identification: of the wrenches.
        first_step: of the foot that is in the air.
        compliant: of steps along the force.
        rewind: of steps back.
        step_s: longest duration of a reacting step [s].
        stop_steps: steps in place after them.
    """

    identification: WrenchDamping
    first_step: FirstStepNumbers
    compliant: CompliantNumbers
    rewind: RewindNumbers
    step_s: float
    stop_steps: int
