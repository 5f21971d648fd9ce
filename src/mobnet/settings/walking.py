"""Numbers of the walking controller (docs/notes/0019-walking-controller.md)."""

from mobnet.settings.base import NotNegative, Positive, PositivePair, PositiveRange, Range, Real, Section, Share


class Walking(Section):
    """Feet are in the yaw frame of the stance foot; pairs are (x, y)."""

    foot_spacing_m: Positive
    zmp_offset_x_m: Real
    toe_in_max_rad: Positive
    double_support_share: Share
    velocity_filter: Share
    com_height_min_m: Positive
    dcm_gain: Positive
    vertical_damping_hz: Positive
    sole_x_m: Range
    sole_y_m: Positive
    double_support_shift_m: PositivePair
    pelvis_height_m: Positive
    pelvis_height_rate_hz: Positive
    pelvis_height_speed_m_s: Positive
    foothold_band_m: PositivePair
    foothold_change_max_m: PositivePair
    foothold_x_max_m: Positive
    foothold_y_m: PositiveRange
    foothold_gain: Share
    foothold_speed_m_s: Positive
    foothold_freeze_s: Positive
    timing_band_m: Positive
    timing_ankle_m: Positive
    timing_rate: Share
    timing_freeze_s: Positive
    timing_soonest_s: Positive
    timing_dcm_min_m: Positive
    timing_dcm_lost_m: Real
    step_min_s: Positive
    step_shorter_max_s: Positive
    step_longer_max_s: Positive
    swing_speed_max_m_s: Positive
    touch_force_n: Positive
    late_max_s: Positive
    early_max_s: Positive
    swing_apex: Share
    swing_xy_share: Share
    swing_level_share: Share
    descent_speed_m_s: Positive
    descent_acceleration_m_s2: Positive
    descent_depth_m: Positive
    joint_speed_max_rad_s: Positive
    ankle_damping_nms: Positive
    ankle_integral_hz: Positive
    ankle_leak_hz: Positive
    ankle_tilt_leak_hz: Positive
    ankle_tilt: Share
    ankle_integral_max_nm: Positive
    guard_stiffness_nm: Positive
    guard_edge_nm: Positive
    guard_damping_nms: Positive
    guard_band: PositivePair
    stand_load_min: Share
    stand_shift_m: PositivePair
    base_time_constant_s: Positive
    load_gain: NotNegative
    load_filter: Share
    stumble_m: Positive
    stumble_sunk_m: Positive
    slope_rate_hz: NotNegative
    slope_max: NotNegative
    leg_stiffness_nm_rad: tuple[Positive, ...]
    leg_damping_nms_rad: tuple[Positive, ...]
    unloaded_stiffness: Share
