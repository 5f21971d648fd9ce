"""What is walked and recorded: terrains, commands, motions, pushes, scenarios, training sets (section 4.3, Table 2)."""

from __future__ import annotations

from typing import Literal

from pydantic import model_validator

from mobnet.settings import base
from mobnet.settings.base import Section

Phase = Literal["always", "left_swing", "right_swing", "left_support", "right_support"]
Direction = Literal["any", "horizontal", "down", "backward"]
CommandSource = Literal["random", "stand"]


class Checks(Section):
    """Raised squares, Figure 3 (a)."""

    height_m: base.Positive
    cell_m: base.Positive
    bevel_m: base.Positive


class Flat(Section):
    """Even ground."""


class Plates(Section):
    """Loose wooden plates, Figure 3 (b)."""

    height_m: base.Positive
    sizes_m: base.Some[base.PositivePair]
    bevel_m: base.Positive
    gap_m: base.NotNegative
    period_m: base.Positive


class Slope(Section):
    """Even ground, up, even ground, down, Figure 3 (c)."""

    angle_deg: base.Positive
    slope_m: base.Positive
    even_m: base.Positive


class Terrain(Section):
    """Terrains by name; a recording gets those that its scenario walks on."""

    checks: Checks | None = None
    flat: Flat | None = None
    plates: Plates | None = None
    slope: Slope | None = None


class RandomCommands(Section):
    """How commands are drawn and held, in place of a joystick."""

    hold_steps: base.CountRange
    kinds: dict[Literal["omnidirectional", "forward", "turn", "sideways", "backward"], base.Share]
    edge_probability: base.Share
    slew_step_x_m: base.Positive
    slew_step_y_m: base.Positive
    slew_turn_deg: base.Positive
    in_place_steps: base.Index


class Commands(Section):
    """Ranges of Table 2."""

    step_x_m: base.Range
    step_y_m: base.Range
    turn_deg: base.Range
    duration_s: base.Choices
    foot_height_m: base.Choices
    random: RandomCommands


class Narrowed(Section):
    """Ranges of Table 2 that a scenario replaces by narrower ones."""

    step_x_m: base.Range | None = None
    step_y_m: base.Range | None = None
    turn_deg: base.Range | None = None
    duration_s: base.Choices | None = None
    foot_height_m: base.Choices | None = None


class FixedCommand(Section):
    """One walking command that is held."""

    step_x_m: base.Real
    step_y_m: base.Real
    turn_deg: base.Real
    duration_s: base.Positive
    foot_height_m: base.Positive


class RandomTorque(Section):
    """Random torque exploration, section 4.3."""

    period_s: base.PositiveRange
    legs_waist_nm: base.NotNegative
    arms_nm: tuple[base.NotNegative, ...]
    neck_nm: base.NotNegative


class MotionVariant(Section):
    """Another speed and another place of the hands for the same drawn motion, section 4.3."""

    speed: base.Positive
    hand_offset_m: base.Vector3


class Motion(Section):
    """Random motion of the joints above the legs, section 4.3."""

    knot_hz: base.Positive
    band_hz: base.PositiveRange
    waves: base.Count
    hand_azimuth_rad: base.Range
    hand_elevation_rad: base.Range
    hand_distance_m: base.PositiveRange
    waist_rad: tuple[base.Range, ...]
    neck_rad: tuple[base.Range, ...]
    arm_rad: tuple[base.Range, ...]
    hand_cost: base.Positive
    arm_cost: base.Positive
    trunk_cost: base.Positive
    inertia_cost: base.Positive
    gain: base.Share
    hand_speed_max_m_s: base.Positive
    speed_share: base.Share
    clearance_m: base.Positive
    clearance_least_m: base.NotNegative
    guard_m: base.Positive
    leg_poses_rad: tuple[tuple[base.Real, base.Real, base.Real, base.Real], ...]
    still_s: base.NotNegative
    ease_s: base.Positive
    smoothing_s: base.Positive
    variants: base.Some[MotionVariant]


class Push(Section):
    """A force at a point, or a torque on a joint, with the times at which it comes."""

    point: base.PointName | None = None
    joint: base.MotorName | None = None
    during: Phase = "always"
    share: base.NotNegativeRange = (0.0, 0.0)
    pause_s: base.NotNegativeRange | None = None
    at_s: base.Some[base.NotNegative] | None = None
    force_n: base.Range | None = None
    torque_nm: base.Range | None = None
    duration_s: base.PositiveRange
    direction: Direction = "any"
    shape: Literal["step", "half_sine"]

    @model_validator(mode="after")
    def _is_one_of_two(self) -> Push:
        """Check that it is a force at a point or a torque on a joint, and that its times are given."""
        force, torque = (self.point, self.force_n), (self.joint, self.torque_nm)
        whole, empty = (force, torque) if self.joint is None else (torque, force)
        if None in whole or any(value is not None for value in empty):
            raise ValueError("accepted: `point`, `force_n` and `direction`, or `joint` and `torque_nm`")
        if self.joint is None and "direction" not in self.model_fields_set:
            raise ValueError("accepted: `point`, `force_n` and `direction`, or `joint` and `torque_nm`")
        if self.pause_s is None and self.at_s is None:
            raise ValueError("accepted: `pause_s` or `at_s`")
        return self


class Scenario(Section):
    """What is walked; a level and a seed make it a recording."""

    terrain: base.Some[base.TerrainName]
    commands: CommandSource | base.Some[CommandSource] | FixedCommand
    narrowed: Narrowed = Narrowed()
    random_torque: base.Flag
    pushes: tuple[base.PushName, ...] = ()
    motion: base.MotionName | None = None
    draws: base.ScenarioName | None = None


class Recordings(Section):
    """Number of recordings and duration of each."""

    shards: base.Count
    shard_s: base.Positive


class TrainingSet(Section):
    """Recordings of a scenario that networks learn from, section 4.3; sizes by scale."""

    scenario: base.ScenarioName
    level: base.LevelName
    sizes: dict[base.ScaleName, Recordings]


class RecordingSettings(Section):
    """How a walk is cut into episodes and when it counts as a fall."""

    fall_height_m: base.Positive
    dropped_before_fall_s: base.NotNegative
    chunk_s: base.Positive
    settle_s: base.NotNegative
    clearance_hz: base.Positive
    episode_s: base.Positive
    episode_steps: base.Count
