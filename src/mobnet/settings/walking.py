"""Numbers of the walking controller (docs/notes/walking.md)."""

from typing import Annotated

from pydantic import Field

from mobnet.formats.base import Length, LengthPair, Metres, Positive, Real, Section, Share, Some, Span
from mobnet.formats.robot import RobotTable
from mobnet.settings.data import Commands, Obstacle, Push, RandomTorque, RecordingSettings, Scenario, Terrain
from mobnet.settings.plant import Plant, Rates
from mobnet.settings.surrogate import Level, Surrogate

Stiffness = Annotated[Positive, Field(ge=10, le=100_000)]
Damping = Annotated[Positive, Field(ge=0.1, le=5_000)]


class Walking(Section):
    """Feet are in the yaw frame of the stance foot; pairs are (x, y).

    Bounds lie about a factor of ten around what a humanoid walks with, from the size of a child to twice a person's.
    """

    foot_spacing_m: Real = Field(ge=0.05, le=1)
    zmp_offset_x_m: Real = Field(ge=-0.1, le=0.1)
    toe_in_max_rad: Real = Field(ge=0.01, le=1)
    double_support_share: Real = Field(ge=0.01, le=0.8)
    velocity_filter: Real = Field(ge=0.001, le=1)
    com_height_min_m: Real = Field(ge=0.1, le=2)
    dcm_gain: Real = Field(gt=1, le=20)
    vertical_damping_hz: Real = Field(ge=0.1, le=50)
    sole_x_m: Span[Metres]
    sole_y_m: Real = Field(ge=0.005, le=0.3)
    double_support_shift_m: LengthPair
    pelvis_height_m: Real = Field(ge=0.2, le=2)
    leg_reach_m: Real = Field(ge=0.2, le=2)
    pelvis_sink_max_m: Real = Field(ge=0, le=0.3)
    pelvis_height_rate_hz: Real = Field(ge=0.5, le=100)
    pelvis_height_speed_m_s: Real = Field(ge=0.01, le=5)
    foothold_band_m: LengthPair
    foothold_change_max_m: LengthPair
    foothold_x_max_m: Real = Field(ge=0.05, le=2)
    foothold_y_m: Span[Length]
    foothold_gain: Real = Field(ge=0.001, le=1)
    foothold_speed_m_s: Real = Field(ge=0.1, le=20)
    foothold_freeze_s: Real = Field(ge=0.001, le=0.5)
    timing_band_m: Real = Field(ge=0.0005, le=0.2)
    timing_ankle_m: Real = Field(ge=0.001, le=0.3)
    timing_rate: Real = Field(ge=0.01, le=10)
    timing_freeze_s: Real = Field(ge=0.005, le=1)
    timing_soonest_s: Real = Field(ge=0.005, le=1)
    timing_dcm_min_m: Real = Field(ge=0.0005, le=0.2)
    timing_dcm_lost_m: Real = Field(ge=-0.5, le=0)
    step_min_s: Real = Field(ge=0.1, le=3)
    step_shorter_max_s: Real = Field(ge=0.01, le=3)
    step_longer_max_s: Real = Field(ge=0.01, le=3)
    swing_speed_max_m_s: Real = Field(ge=0.1, le=20)
    touch_force_n: Real = Field(ge=5, le=1000)
    touch_friction: Real = Field(ge=0.1, le=10)
    late_max_s: Real = Field(ge=0.005, le=1)
    early_max_s: Real = Field(ge=0.005, le=1)
    swing_apex: Real = Field(ge=0.05, le=0.95)
    swing_xy_share: Real = Field(ge=0.05, le=1)
    swing_turn_share: Real = Field(ge=0, le=0.99)
    swing_level_share: Real = Field(ge=0.05, le=1)
    descent_speed_m_s: Real = Field(ge=0.01, le=3)
    descent_acceleration_m_s2: Real = Field(ge=0.2, le=100)
    descent_depth_m: Real = Field(ge=0.001, le=0.3)
    joint_speed_max_rad_s: Real = Field(ge=0.5, le=100)
    ankle_damping_nms: Real = Field(ge=0.1, le=200)
    ankle_integral_hz: Real = Field(ge=0.5, le=500)
    ankle_leak_hz: Real = Field(ge=0.05, le=100)
    ankle_tilt_leak_hz: Real = Field(ge=0.5, le=500)
    ankle_tilt: Real = Field(ge=0.01, le=1)
    ankle_integral_max_nm: Real = Field(ge=0.5, le=500)
    guard_stiffness_nm: Real = Field(ge=1, le=5000)
    guard_edge_nm: Real = Field(ge=10, le=50000)
    guard_damping_nms: Real = Field(ge=0.05, le=500)
    guard_band: tuple[Share, Share]
    stand_load_min: Real = Field(ge=0.001, le=0.5)
    stand_shift_m: LengthPair
    base_time_constant_s: Real = Field(ge=0.01, le=20)
    base_still_speed_m_s: Real = Field(ge=0.001, le=1)
    load_gain: Real = Field(ge=0, le=20)
    load_filter: Real = Field(ge=0.001, le=1)
    stumble_m: Real = Field(ge=0.005, le=0.5)
    stumble_sunk_m: Real = Field(ge=0.002, le=0.5)
    slope_rate_hz: Real = Field(ge=0, le=50)
    slope_max: Real = Field(ge=0, le=1)
    leg_stiffness_nm_rad: Some[Stiffness]
    leg_damping_nms_rad: Some[Damping]
    unloaded_stiffness: Real = Field(ge=0, le=1)
    knee_torque_max_nm: Real = Field(ge=10, le=2000)


class WalkSettings(Section):
    """A scenario at a level, with the terrains and pushes that it names and no others; recordings draw by its name."""

    seed: int
    robot: RobotTable
    rates: Rates
    plant: Plant
    walking: Walking
    commands: Commands
    random_torque: RandomTorque
    recording: RecordingSettings
    scenario_name: str
    scenario: Scenario
    level_name: str
    level: Level
    surrogate: Surrogate | None
    terrain: Terrain
    pushes: dict[str, Push]
    obstacles: dict[str, Obstacle]
