"""Uncertainty levels (section 5.1), and surrogate robots: hidden drives, masses and errors of sensors (5.2 to 7)."""

from collections.abc import Mapping
from typing import Annotated, Any, Literal, cast

from pydantic import AfterValidator, Field

from mobnet.formats.base import (
    BodyName,
    Change,
    Distinct,
    Flag,
    Index,
    LimbName,
    LowerName,
    MethodNames,
    NotNegative,
    Range,
    Real,
    ScenarioName,
    Section,
    Share,
    Some,
    SurrogateLevelName,
    TrainingSetName,
    Whole,
    distinct,
)
from mobnet.settings.data import CommandRanges

Part = Literal["drives", "body", "sensors"]
Ratio = Annotated[Real, Field(ge=0.5, le=5)]
Time = Annotated[Real, Field(ge=0, le=0.05)]  # of a drive or a sensor [s]
Payload = Annotated[NotNegative, Field(le=50)]
RunningTime = Range[Annotated[NotNegative, Field(le=360_000)]]
FrictionTerm = Literal["stribeck", "load", "loss"]
Reading = Literal["none", "std", "swapped", "variance"]  # of Table 3


class Drive(Section):
    """Ranges from which every joint draws; `spread` is that of the numbers in `LimbDrives`.

    The dry friction of all joints is that of `LimbDrives` times `dry_scale`.
    """

    dry_scale: Real = Field(ge=0.05, le=10)
    torque_constant: Range[Ratio]
    lag_s: Range[Annotated[Real, Field(ge=0.0001, le=0.05)]]
    delay_s: Range[Time]
    stribeck_rad_s: Range[Annotated[Real, Field(ge=0.001, le=1)]]
    static_share: Range[Share]
    direction_share: Range[Share]
    back_ratio: Range[Ratio]
    presliding_rad: Range[Annotated[Real, Field(ge=0.0001, le=0.1)]]
    ripple_share: Range[Share]
    ripple_waves: Whole = Field(ge=1, le=10_000)
    cogging_waves: Whole = Field(ge=1, le=10_000)
    warm_share: Range[Share]
    warm_s: Range[Annotated[Real, Field(ge=1, le=36_000)]]
    damping_ratio: Share
    rotor_min_kg_m2: Real = Field(ge=0.0001, le=1)
    spread: Real = Field(ge=0, lt=1)


class LimbDrives(Section):
    """Typical numbers of the joints of a limb, one for each."""

    coulomb_nm: Some[Annotated[NotNegative, Field(le=100)]]
    viscous_nms: Some[Annotated[NotNegative, Field(le=100)]]
    load_share: Some[Share]
    cogging_nm: Some[Annotated[NotNegative, Field(le=20)]]
    stiffness_nm_rad: Some[Annotated[Real, Field(ge=100, le=1e6)]]
    cable_nm: Some[Annotated[NotNegative, Field(le=50)]]


class Body(Section):
    """What the robot's links and soles have that its table has not."""

    mass_share: Real = Field(ge=0, le=0.5)
    com_m: NotNegative = Field(le=0.1)
    payload_body: BodyName
    payload_kg: Range[Payload]
    sole_stiffness_n_m: Range[Annotated[Real, Field(ge=1e3, le=1e7)]]


class SensorErrors(Section):
    """Errors of sensors that last; standard deviations, where they are no ranges.

    The noise of the inertial sensor, white at each sample, takes the place of that of Table 3.
    """

    encoder_zero_rad: NotNegative = Field(le=0.1)
    imu_late_s: Range[Time]
    acceleration_m_s2: NotNegative = Field(le=5)
    angular_velocity_rad_s: NotNegative = Field(le=0.5)
    acceleration_noise_m_s2: NotNegative = Field(le=5)
    angular_velocity_noise_rad_s: NotNegative = Field(le=0.5)
    mounting_rad: NotNegative = Field(le=0.1)
    foot_gain_share: NotNegative = Field(le=0.2)
    foot_force_n: NotNegative = Field(le=200)
    foot_moment_nm: NotNegative = Field(le=50)
    plate_share: Real = Field(ge=0, le=0.5)


class Surrogate(Section):
    """All that a surrogate robot is drawn from."""

    drive: Drive
    limbs: dict[LimbName, LimbDrives]
    body: Body
    sensors: SensorErrors

    def with_numbers(self, numbers: Change) -> "Surrogate":
        """Return the same with other numbers, nested as the sections are; what is not named stays.

        Raises:
            ValidationError: a section or a number is unknown, or is not accepted.
        """
        return Surrogate.model_validate(_laid_over(self.model_dump(), numbers))


def _laid_over(numbers: Mapping[str, Any], changes: Mapping[str, Any]) -> dict[str, Any]:
    """Return numbers, nested at any depth, with changes in their places."""
    changed: dict[str, Any] = dict(numbers)
    for name, value in changes.items():
        inside: Any = changed.get(name)
        nested = isinstance(inside, dict) and isinstance(value, dict)
        changed[name] = _laid_over(cast("dict[str, Any]", inside), cast("dict[str, Any]", value)) if nested else value
    return changed


class SurrogateRobot(Section):
    """One surrogate robot: the seed it is drawn from, its hidden parts, and how long it has been running [s].

    Without `drives`, the friction of its joints is (23), and without `body` or `sensors` these are as on the plant of
    section 5.1. `running_s` is the range of the time since its gears were cold, at the start of a recording. Friction
    and torque constants of its drives are those drawn, times a ratio, and so are the gains of its legs' joints. Its
    `gait` replaces ranges of the commands, and `payload_kg` comes on top of the payload drawn. On another `day` than 0
    its sensors have other errors, as they were mounted and zeroed anew. `numbers` replaces numbers of `Surrogate`.
    """

    seed: Index
    parts: Annotated[tuple[Part, ...], AfterValidator(distinct)]
    running_s: RunningTime
    friction_ratio: Ratio = 1.0
    constant_ratio: Ratio = 1.0
    gain_ratio: Ratio = 1.0
    gait: CommandRanges = CommandRanges()
    payload_kg: Payload = 0.0
    day: Index = 0
    numbers: Change = {}


class Level(Section):
    """An uncertainty level of section 5.1: which errors the plant has and what the observer's model gets wrong.

    With a `surrogate`, the plant is a surrogate robot; `labels` says what networks learn the external torque from.
    """

    friction: Annotated[tuple[FrictionTerm, ...], AfterValidator(distinct)]
    noise: Reading
    nominal_mass_ratio: Real = Field(ge=0.3, le=3)
    base_state: Literal["true_state", "sensed"]
    surrogate: SurrogateRobot | None = None
    labels: Literal["truth", "foot_sensors"] = "truth"


class Variant(Section):
    """How every robot of the fleet is changed for a test, while its networks stay as they are.

    What is given replaces that of the robot's own level; `other` puts the next robot of the fleet in its place.
    """

    other: Flag = False
    parts: Annotated[tuple[Part, ...], AfterValidator(distinct)] | None = None
    friction: Annotated[tuple[FrictionTerm, ...], AfterValidator(distinct)] = ()
    running_s: RunningTime | None = None
    friction_ratio: Ratio = 1.0
    constant_ratio: Ratio = 1.0
    gain_ratio: Ratio = 1.0
    gait: CommandRanges = CommandRanges()
    payload_kg: Payload = 0.0
    day: Index = 0
    numbers: Change = {}


class Fleet(Section):
    """Surrogate robots that stand together for the robot of the paper, each a level of its own.

    A test at the level `name` is walked by each of the `robots`, with methods that are fitted and trained on that
    robot's recordings; at the level of a variant, by each of them changed. There, `sets` take the place of the training
    sets that networks name. Robots of which a scale wants but a leg walk the `leg_tests` alone, as they are, with
    the `leg_methods`, which estimate the limb `leg`.
    """

    name: LowerName
    robots: Distinct[SurrogateLevelName]
    leg: LimbName
    leg_tests: Distinct[ScenarioName]
    leg_methods: MethodNames
    sets: dict[TrainingSetName, TrainingSetName]
    variants: dict[LowerName, Variant]

    @property
    def levels(self) -> tuple[str, ...]:
        """The levels at which each robot walks: as it is, and changed."""
        return (self.name, *self.variants)

    def level_of(self, robot: str, level: str) -> str:
        """Return the level of one robot at a level of the fleet, or at its own."""
        return robot if level in (self.name, robot) else f"{robot}_{level}"
