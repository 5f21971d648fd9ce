"""What is walked and recorded: terrains, commands, motions, pushes, scenarios, training sets (section 4.3, Table 2)."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import AfterValidator, Field

from mobnet.formats import base
from mobnet.formats.base import Section

Phase = Literal["always", "left_swing", "right_swing", "left_support", "right_support"]
Direction = Literal["any", "horizontal", "down", "backward", "leftward", "rightward"]
Wrench = Literal["sensed", "estimated"]  # of the feet, as the controller gets it
CommandSource = Literal["random", "joystick", "uniform", "stand"]


Height = Annotated[base.Real, Field(ge=0.0005, le=0.2)]
Step = Annotated[base.Real, Field(ge=-1, le=1)]  # [m]
Turn = Annotated[base.Real, Field(ge=-90, le=90)]  # [deg]
StepTime = Annotated[base.Real, Field(ge=0.2, le=3)]  # [s]
Duration = Annotated[base.Real, Field(ge=0.002, le=120)]  # of a push [s]
FootHeight = Annotated[base.Real, Field(ge=0.005, le=0.5)]  # [m]
Offset = Annotated[base.Real, Field(ge=-0.5, le=0.5)]  # [m]
Offset3 = Annotated[base.Real, Field(ge=-5, le=5)]  # [m]
Cost = Annotated[base.Real, Field(ge=0.001, le=50)]
RecordingSeconds = Annotated[base.Real, Field(ge=1, le=7200)]


class Checks(Section):
    """Raised squares, Figure 3 (a); the height of a field is drawn, and which squares are raised."""

    height_m: base.Range[Height]
    cell_m: base.Real = Field(ge=0.1, le=10)
    cells: base.Whole = Field(ge=1, le=20)
    raised_share: base.PositiveShare
    bevel_m: base.Length


class Flat(Section):
    """Even ground."""


class Plates(Section):
    """Loose wooden plates, Figure 3 (b)."""

    height_m: Height
    sizes_m: Annotated[base.Some[base.LengthPair], Field(max_length=20)]
    bevel_m: base.Length
    gap_m: base.NotNegative = Field(le=10)
    period_m: base.Real = Field(ge=0.2, le=20)


class Slope(Section):
    """Even ground, up, even ground, down, Figure 3 (c)."""

    angle_deg: base.Real = Field(ge=0.1, le=30)
    slope_m: base.Real = Field(ge=0.1, le=10)
    even_m: base.Real = Field(ge=0.1, le=10)


class Terrain(Section):
    """Terrains by name; a recording gets those that its scenario walks on."""

    checks: Checks | None = None
    flat: Flat | None = None
    plates: Plates | None = None
    slope: Slope | None = None


class ObstaclePart(Section):
    """A solid of an obstacle: half lengths of a box, radius and half length of a capsule or cylinder along its axis.

    With `bevel_m` the sides of a box slope: its top is so much smaller all around, and it lies flat.
    """

    type: Literal["box", "capsule", "cylinder"]
    size: base.Some[base.Length]
    pos: tuple[Offset3, Offset3, Offset3]
    axis: Literal["x", "y", "z"] = "z"
    bevel_m: base.Length | None = None


class Obstacle(Section):
    """A padded obstacle that stands fixed in the robot's way, sections 5.4 and 7; its distance is drawn."""

    parts: base.Some[ObstaclePart]
    ahead_m: base.Range[Annotated[base.Real, Field(ge=0.2, le=20)]]
    stiffness_n_m: base.Real = Field(ge=100, le=1e7)
    damping_ns_m: base.Real = Field(ge=0, le=1e5)
    friction: base.Real = Field(ge=0, le=2)


class RandomCommands(Section):
    """How commands are drawn and held, in place of a joystick."""

    hold_steps: base.Range[Annotated[base.Count, Field(le=1000)]]
    kinds: dict[Literal["omnidirectional", "forward", "turn", "sideways", "backward"], base.Share]
    edge_probability: base.Share
    slew_step_x_m: base.Real = Field(ge=0.001, le=1)
    slew_step_y_m: base.Real = Field(ge=0.001, le=1)
    slew_turn_deg: base.Real = Field(ge=0.1, le=90)
    in_place_steps: base.Whole = Field(ge=0, le=100)


class Commands(Section):
    """Ranges of Table 2."""

    step_x_m: base.Span[Step]
    step_y_m: base.Span[Step]
    turn_deg: base.Span[Turn]
    duration_s: Annotated[base.Rising[StepTime], Field(min_length=2)]
    foot_height_m: Annotated[base.Rising[FootHeight], Field(min_length=2)]
    random: RandomCommands
    joystick: RandomCommands


class CommandRanges(Section):
    """Ranges of walking commands in place of those of Table 2."""

    step_x_m: base.Range[Step] | None = None
    step_y_m: base.Range[Step] | None = None
    turn_deg: base.Range[Turn] | None = None
    duration_s: base.Rising[StepTime] | None = None
    foot_height_m: base.Rising[FootHeight] | None = None


class FixedCommand(Section):
    """One walking command that is held."""

    step_x_m: Step
    step_y_m: Step
    turn_deg: Turn
    duration_s: StepTime
    foot_height_m: FootHeight


class RandomTorque(Section):
    """Random torque exploration, section 4.3."""

    period_s: base.Range[Annotated[base.Real, Field(ge=0.005, le=20)]]
    legs_waist_nm: base.NotNegative = Field(le=1000)
    arms_nm: tuple[Annotated[base.NotNegative, Field(le=1000)], ...]
    neck_nm: base.NotNegative = Field(le=1000)


class MotionVariant(Section):
    """Another speed and another place of the hands for the same drawn motion, section 4.3."""

    speed: base.Real = Field(ge=0.1, le=10)
    hand_offset_m: tuple[Offset, Offset, Offset]


class Motion(Section):
    """Random motion of the joints above the legs, section 4.3."""

    knot_hz: base.Real = Field(ge=5, le=1000)
    band_hz: base.Span[Annotated[base.Real, Field(ge=0.001, le=20)]]
    waves: base.Whole = Field(ge=1, le=1000)
    hand_azimuth_rad: base.Span[Annotated[base.Real, Field(ge=-3.15, le=3.15)]]
    hand_elevation_rad: base.Span[Annotated[base.Real, Field(ge=-1.58, le=1.58)]]
    hand_distance_m: base.Span[Annotated[base.Real, Field(ge=0.02, le=2)]]
    waist_rad: tuple[base.Span[base.Radians], ...]
    neck_rad: tuple[base.Span[base.Radians], ...]
    arm_rad: tuple[base.Span[base.Radians], ...]
    hand_cost: Cost
    arm_cost: Cost
    trunk_cost: Cost
    inertia_cost: Cost
    gain: base.PositiveShare
    hand_speed_max_m_s: base.Real = Field(ge=0.05, le=10)
    speed_share: base.PositiveShare
    clearance_m: base.Real = Field(ge=0.001, le=0.5)
    clearance_least_m: base.NotNegative = Field(le=0.5)
    guard_m: base.Real = Field(ge=0.001, le=0.5)
    leg_poses_rad: base.Some[tuple[base.Radians, base.Radians, base.Radians, base.Radians]]
    still_s: base.NotNegative = Field(le=60)
    ease_s: base.Real = Field(ge=0.05, le=60)
    smoothing_s: base.Real = Field(ge=0.001, le=2)
    variants: Annotated[base.Some[MotionVariant], Field(max_length=100)]


class Sines(Section):
    """Lines of a multisine: frequency, phase at the push's start, and amplitude as a share of the push's size."""

    frequency_hz: Annotated[base.Rising[Annotated[base.Positive, Field(le=500)]], Field(max_length=50)]
    phase_deg: base.Some[base.Degrees]
    share: base.Some[base.PositiveShare]


class Push(Section):
    """A force at a point, or a torque on a joint, with the times at which it comes.

    A push of shape `sines` is a sum of sines, whose amplitudes are shares of its size. An `impactor` is a mass on a
    spring that meets the point and leaves it again; force and duration are those of its hit on a wall. Sizes are drawn
    evenly from their range, or with `sizes: log` evenly on a log scale. A moment about an axis of its own, drawn from
    all directions, comes and goes with a force.
    """

    point: base.PointName | None = None
    joint: base.MotorName | None = None
    during: Phase = "always"
    share: base.Range[base.Share] = (0.0, 0.0)
    pause_s: base.Range[base.Pause] | None = None
    at_s: base.Rising[Annotated[base.NotNegative, Field(le=3600)]] | None = None
    force_n: base.Range[base.Newton] | None = None
    torque_nm: base.Range[base.NewtonMetre] | None = None
    moment_nm: base.Range[Annotated[base.NotNegative, Field(le=1000)]] | None = None
    sizes: Literal["even", "log"] = "even"
    duration_s: base.Range[Duration]
    direction: Direction = "any"
    shape: Literal["step", "half_sine", "sines", "impactor"]
    sines: Sines | None = None
    impactor_kg: Annotated[base.Real, Field(ge=0.1, le=500)] | None = None


class Scenario(Section):
    """What is walked; a level and a seed make it a recording.

    Where there are obstacles, the robot starts at the origin and faces them. The controller gets the wrenches of the
    feet as their sensors read them, or as a closed loop estimates them.
    """

    terrain: base.Distinct[base.TerrainName]
    commands: CommandSource | base.Some[CommandSource] | FixedCommand
    narrowed: CommandRanges = CommandRanges()
    random_torque: base.Flag
    pushes: Annotated[tuple[base.PushName, ...], AfterValidator(base.distinct)] = ()
    obstacles: Annotated[tuple[base.ObstacleName, ...], AfterValidator(base.distinct)] = ()
    wrench: Wrench = "sensed"
    motion: base.MotionName | None = None
    draws: base.ScenarioName | None = None


class Recordings(Section):
    """Number of recordings and duration of each."""

    shards: base.Whole = Field(ge=1, le=500)
    shard_s: RecordingSeconds


class TestRecordings(Recordings):
    """Recordings of a test, with the seeds from `first_seed` on, below those of development."""

    first_seed: base.Whole = Field(ge=101, le=400)
    shards: base.Whole = Field(ge=1, le=100)


class TrainingRecordings(Recordings):
    """Recordings that networks learn from; the last `held_out` ones validate, or else a share of every stretch."""

    held_out: base.Whole = Field(default=0, ge=0, le=500)


class TrainingSet(Section):
    """Recordings of a scenario that networks learn from, section 4.3; sizes by scale."""

    scenario: base.ScenarioName
    level: base.LevelName
    sizes: dict[base.ScaleName, TrainingRecordings]


class Development(Section):
    """Networks of a limb of one plant, and the walks on which they are chosen, apart from all tests."""

    scenario: base.ScenarioName
    level: base.SingleLevelName
    limb: base.NetworkName


class RecordingSettings(Section):
    """How a walk is cut into episodes and when it counts as a fall."""

    fall_height_m: base.Real = Field(ge=0.1, le=2)
    dropped_before_fall_s: base.NotNegative = Field(le=60)
    chunk_s: base.Real = Field(ge=0.001, le=10)
    settle_s: base.NotNegative = Field(le=60)
    clearance_hz: base.Real = Field(ge=1, le=10_000)
    episode_s: base.Real = Field(ge=0.1, le=7200)
    episode_steps: base.Whole = Field(ge=1, le=100_000)
