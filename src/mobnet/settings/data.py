"""What is walked and recorded: terrains, commands, motions, pushes, scenarios, training sets (section 4.3, Table 2)."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, model_validator

from mobnet.settings.base import (
    Choices,
    Count,
    CountRange,
    Flag,
    Index,
    LevelName,
    MotionName,
    MotorName,
    NotNegative,
    NotNegativeRange,
    PointName,
    Positive,
    PositivePair,
    PositiveRange,
    PushName,
    Range,
    Real,
    ScaleName,
    ScenarioName,
    Section,
    Share,
    TerrainName,
    Vector3,
)  # fmt: skip

Phase = Literal["always", "left_swing", "right_swing", "left_support", "right_support"]
Direction = Literal["any", "horizontal", "down", "backward"]
CommandSource = Literal["random", "stand"]


class Checks(Section):
    """Raised squares, Figure 3 (a)."""

    height_m: Positive
    cell_m: Positive
    bevel_m: Positive


class Flat(Section):
    """Even ground."""


class Plates(Section):
    """Loose wooden plates, Figure 3 (b)."""

    height_m: Positive
    sizes_m: Annotated[tuple[PositivePair, ...], Field(min_length=1)]
    bevel_m: Positive
    gap_m: NotNegative
    period_m: Positive


class Slope(Section):
    """Even ground, up, even ground, down, Figure 3 (c)."""

    angle_deg: Positive
    slope_m: Positive
    even_m: Positive


class Terrain(Section):
    """Terrains by name; a recording gets those that its scenario walks on."""

    checks: Checks | None = None
    flat: Flat | None = None
    plates: Plates | None = None
    slope: Slope | None = None


class RandomCommands(Section):
    """How commands are drawn and held, in place of a joystick."""

    hold_steps: CountRange
    kinds: dict[Literal["omnidirectional", "forward", "turn", "sideways", "backward"], Share]
    edge_probability: Share
    slew_step_x_m: Positive
    slew_step_y_m: Positive
    slew_turn_deg: Positive
    in_place_steps: Index


class Commands(Section):
    """Ranges of Table 2."""

    step_x_m: Range
    step_y_m: Range
    turn_deg: Range
    duration_s: Choices
    foot_height_m: Choices
    random: RandomCommands


class Narrowed(Section):
    """Ranges of Table 2 that a scenario replaces by narrower ones."""

    step_x_m: Range | None = None
    step_y_m: Range | None = None
    turn_deg: Range | None = None
    duration_s: Choices | None = None
    foot_height_m: Choices | None = None


class FixedCommand(Section):
    """One walking command that is held."""

    step_x_m: Real
    step_y_m: Real
    turn_deg: Real
    duration_s: Positive
    foot_height_m: Positive


class RandomTorque(Section):
    """Random torque exploration, section 4.3."""

    period_s: PositiveRange
    legs_waist_nm: NotNegative
    arms_nm: tuple[NotNegative, ...]
    neck_nm: NotNegative


class MotionVariant(Section):
    """Another speed and another place of the hands for the same drawn motion, section 4.3."""

    speed: Positive
    hand_offset_m: Vector3


class Motion(Section):
    """Random motion of the joints above the legs, section 4.3."""

    knot_hz: Positive
    band_hz: PositiveRange
    waves: Count
    hand_azimuth_rad: Range
    hand_elevation_rad: Range
    hand_distance_m: PositiveRange
    waist_rad: tuple[Range, ...]
    neck_rad: tuple[Range, ...]
    arm_rad: tuple[Range, ...]
    hand_cost: Positive
    arm_cost: Positive
    trunk_cost: Positive
    inertia_cost: Positive
    gain: Share
    hand_speed_max_m_s: Positive
    speed_share: Share
    clearance_m: Positive
    clearance_least_m: NotNegative
    guard_m: Positive
    leg_poses_rad: tuple[tuple[Real, Real, Real, Real], ...]
    still_s: NotNegative
    ease_s: Positive
    smoothing_s: Positive
    variants: Annotated[tuple[MotionVariant, ...], Field(min_length=1)]


class Push(Section):
    """A force at a point, or a torque on a joint, with the times at which it comes."""

    point: PointName | None = None
    joint: MotorName | None = None
    during: Phase = "always"
    share: NotNegativeRange = (0.0, 0.0)
    pause_s: NotNegativeRange | None = None
    at_s: Annotated[tuple[NotNegative, ...], Field(min_length=1)] | None = None
    force_n: Range | None = None
    torque_nm: Range | None = None
    duration_s: PositiveRange
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

    terrain: Annotated[tuple[TerrainName, ...], Field(min_length=1)]
    commands: CommandSource | Annotated[tuple[CommandSource, ...], Field(min_length=1)] | FixedCommand
    narrowed: Narrowed = Narrowed()
    random_torque: Flag
    pushes: tuple[PushName, ...] = ()
    motion: MotionName | None = None
    draws: ScenarioName | None = None


class Recordings(Section):
    """Number of recordings and duration of each."""

    shards: Count
    shard_s: Positive


class TrainingSet(Section):
    """Recordings of a scenario that networks learn from, section 4.3; sizes by scale."""

    scenario: ScenarioName
    level: LevelName
    sizes: dict[ScaleName, Recordings]


class RecordingSettings(Section):
    """How a walk is cut into episodes and when it counts as a fall."""

    fall_height_m: Positive
    dropped_before_fall_s: NotNegative
    chunk_s: Positive
    settle_s: NotNegative
    clearance_hz: Positive
    episode_s: Positive
    episode_steps: Count
