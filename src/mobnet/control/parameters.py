"""Parameters, commands and state of the walking controller as compiled code sees them.

A command is a row (5,): step x, step y [m], turn [rad], duration [s], foot height [m].
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mobnet.core.errors import ConfigError, not_accepted

Array = NDArray[np.float64]

STEP_X, STEP_Y, TURN, DURATION, FOOT_HEIGHT = range(5)  # columns of a command
SIDES = (1.0, -1.0)  # of the left, right leg: +y is left
State = np.record  # one record of STATE; its fields are attributes


class WalkingParameters(NamedTuple):
    """Numbers of the walking controller; units stand in configs/config.yaml, `walking`."""

    foot_spacing_m: float
    zmp_offset_x_m: float
    toe_in_max_rad: float
    double_support_share: float
    velocity_filter: float
    com_height_min_m: float
    dcm_gain: float
    vertical_damping_hz: float
    sole_x_m: Array
    sole_y_m: float
    double_support_shift_m: Array
    pelvis_height_m: float
    pelvis_height_rate_hz: float
    pelvis_height_speed_m_s: float
    foothold_band_m: Array
    foothold_change_max_m: Array
    foothold_x_max_m: float
    foothold_y_m: Array
    foothold_gain: float
    foothold_speed_m_s: float
    foothold_freeze_s: float
    timing_band_m: float
    timing_ankle_m: float
    timing_rate: float
    timing_freeze_s: float
    timing_soonest_s: float
    timing_dcm_min_m: float
    timing_dcm_lost_m: float
    step_min_s: float
    step_shorter_max_s: float
    step_longer_max_s: float
    swing_speed_max_m_s: float
    touch_force_n: float
    late_max_s: float
    early_max_s: float
    swing_apex: float
    swing_xy_share: float
    swing_level_share: float
    descent_speed_m_s: float
    descent_acceleration_m_s2: float
    descent_depth_m: float
    joint_speed_max_rad_s: float
    ankle_damping_nms: float
    ankle_integral_hz: float
    ankle_leak_hz: float
    ankle_tilt_leak_hz: float
    ankle_tilt: float
    ankle_integral_max_nm: float
    guard_stiffness_nm: float
    guard_edge_nm: float
    guard_damping_nms: float
    guard_band: Array
    stand_load_min: float
    stand_shift_m: Array
    base_time_constant_s: float
    load_gain: float
    load_filter: float
    stumble_m: float
    stumble_sunk_m: float
    slope_rate_hz: float
    slope_max: float
    leg_stiffness_nm_rad: Array
    leg_damping_nms_rad: Array
    unloaded_stiffness: float
    posture_rad: Array
    posture_stiffness_nm_rad: Array
    posture_damping_nms_rad: Array


STATE = np.dtype(
    [
        ("clock", "f8"),  # time since the episode began [s]
        # The step: side is +1 while the left foot is the stance foot, else -1; t counts from touch-down [s]; commanded
        # and total are the duration as commanded and as adapted [s]; old_ankle, old_yaw: of the last stance foot.
        ("side", "f8"), ("t", "f8"), ("total", "f8"), ("commanded", "f8"), ("standing", "i8"), ("swinging", "i8"),
        ("steps", "i8"), ("command", "f8", 5), ("old_ankle", "f8", 3), ("old_yaw", "f8"), ("stance_yaw", "f8"),
        # The pelvis: wanted yaw, its value at touch-down [rad], wanted height [m] and its rate [m/s].
        ("yaw", "f8"), ("yaw_start", "f8"), ("height", "f8"), ("height_rate", "f8"),
        # The feet: shares of the load, forces that they lack [N], height of the soles [m], the ground's slope along
        # world x and y, integrals of the ankles' pitch and roll [N m].
        ("load", "f8", 2), ("load_error", "f8", 2), ("sole_height", "f8"), ("slope", "f8", 2),
        ("integral", "f8", (2, 2)),
        # The pendulum: omega [1/s]; velocity of (W2) [m/s]; positions x, y in the world [m], of which plan has the ZMPs
        # of five footholds, next_ankle and next_yaw belong to the first of them; force of the ground [N].
        ("omega", "f8"), ("velocity", "f8", 2), ("dcm", "f8", 2), ("dcm_reference", "f8", 2), ("dcm_end", "f8", 2),
        ("error", "f8", 2), ("plan", "f8", (5, 2)), ("next_ankle", "f8", 2), ("next_yaw", "f8"), ("zmp_old", "f8", 2),
        ("zmp_nominal", "f8", 2), ("zmp", "f8", 2), ("force", "f8", 3),
        # The swing foot: pose at lift-off, target of the ankle, and where the foot should be now; all in the world.
        ("lift", "f8", 3), ("lift_yaw", "f8"), ("lift_roll", "f8"), ("lift_pitch", "f8"), ("target", "f8", 2),
        ("target_velocity", "f8", 2), ("foot", "f8", 3), ("foot_velocity", "f8", 3), ("foot_rotation", "f8", (3, 3)),
        ("foot_yaw_rate", "f8"),
        # References of the legs' joints, left and right [rad, rad/s]; jacobian is scratch.
        ("q_reference", "f8", (2, 6)), ("v_reference", "f8", (2, 6)), ("jacobian", "f8", (6, 6)),
    ]
)  # fmt: skip


def walking_parameters(settings: Mapping[str, Any]) -> WalkingParameters:
    """Build the parameters from the `walking` section of the configuration.

    Raises:
        ConfigError: a key is unknown or missing.
    """
    names = WalkingParameters._fields
    for key in set(settings) ^ set(names):
        raise ConfigError(not_accepted("walking: key", key, names))
    values: dict[str, Any] = {
        name: np.array(value, dtype=float) if isinstance(value, list) else float(value)
        for name, value in settings.items()
    }
    return WalkingParameters(**values)


def empty_state() -> State:
    """Return a zeroed controller state, one record."""
    return np.zeros(1, dtype=STATE).view(np.recarray)[0]
