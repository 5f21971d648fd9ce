"""Parameters and state of the walking controller as compiled code sees them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mobnet.settings.walking import Walking

State = np.record  # one record of STATE; its fields are attributes
if TYPE_CHECKING:
    WalkingParameters = Walking  # a type checker sees the fields and their units
else:
    WalkingParameters = np.record


STATE = np.dtype(
    [
        ("clock", "f8"),  # time since the episode began [s]
        # The step: side is +1 while the left foot is the stance foot, else -1; t counts from touch-down [s]; commanded
        # and total are the duration as commanded and as adapted [s]; old_ankle, old_yaw: of the last stance foot.
        ("side", "f8"),
        ("t", "f8"),
        ("total", "f8"),
        ("commanded", "f8"),
        ("standing", "i8"),
        ("swinging", "i8"),
        ("steps", "i8"),
        ("command", "f8", 5),
        ("old_ankle", "f8", 3),
        ("old_yaw", "f8"),
        ("stance_yaw", "f8"),
        # The pelvis: wanted yaw, its value at touch-down [rad], wanted height [m] and its rate [m/s].
        ("yaw", "f8"),
        ("yaw_start", "f8"),
        ("height", "f8"),
        ("height_rate", "f8"),
        # The feet: shares of the load, forces that they lack [N], height of the soles [m], the ground's slope along
        # world x and y, integrals of the ankles' pitch and roll [N m].
        ("load", "f8", 2),
        ("load_error", "f8", 2),
        ("sole_height", "f8"),
        ("slope", "f8", 2),
        ("integral", "f8", (2, 2)),
        # The pendulum: omega [1/s]; velocity of (W2) [m/s]; positions x, y in the world [m], of which plan has the ZMPs
        # of five footholds, next_ankle and next_yaw belong to the first of them; force of the ground [N].
        ("omega", "f8"),
        ("velocity", "f8", 2),
        ("dcm", "f8", 2),
        ("dcm_reference", "f8", 2),
        ("dcm_end", "f8", 2),
        ("error", "f8", 2),
        ("plan", "f8", (5, 2)),
        ("next_ankle", "f8", 2),
        ("next_yaw", "f8"),
        ("zmp_old", "f8", 2),
        ("zmp_nominal", "f8", 2),
        ("zmp", "f8", 2),
        ("force", "f8", 3),
        # The swing foot: pose at lift-off, target of the ankle, and where the foot should be now; all in the world.
        ("lift", "f8", 3),
        ("lift_yaw", "f8"),
        ("lift_roll", "f8"),
        ("lift_pitch", "f8"),
        ("target", "f8", 2),
        ("target_velocity", "f8", 2),
        ("foot", "f8", 3),
        ("foot_velocity", "f8", 3),
        ("foot_rotation", "f8", (3, 3)),
        ("foot_yaw_rate", "f8"),
        # A reaction: whether the robot reacts, the direction of the force on it (unit vector, world), and whether the
        # swing foot turns back in the next tick.
        ("reacting", "i8"),
        ("away", "f8", 2),
        ("turns_back", "i8"),
        # References of the legs' joints, left and right [rad, rad/s]; jacobian is scratch.
        ("q_reference", "f8", (2, 6)),
        ("v_reference", "f8", (2, 6)),
        ("jacobian", "f8", (6, 6)),
    ]
)


def walking_parameters(walking: Walking) -> WalkingParameters:
    """Return the numbers of the walking controller as one record, in which pairs and lists are arrays.

    The type of a record says where each of its fields lies. Machine code that was compiled and cached for other fields
    is therefore never used, although the sections of the configuration are no part of the code's hash.
    """
    numbers = walking.model_dump()
    layout = np.dtype([(name, "f8", np.shape(value)) for name, value in numbers.items()])
    return np.array([tuple(numbers.values())], dtype=layout).view(np.recarray)[0]


def empty_state() -> State:
    """Return a zeroed controller state, one record."""
    return np.zeros(1, dtype=STATE).view(np.recarray)[0]
