"""What every section of the configuration is made of: frozen classes, bounded numbers, names that must exist elsewhere.

A unit stands at the end of a field's name. Bounds are wide: what a humanoid or an arm of any size may need lies inside,
a wrong unit (mm, ms, kHz, deg for rad) outside. Values of sections are parameters of every rule that takes them. So
bounds and checks are in no hash of code; methods are in that of the code that gets the section (`mobnet.core.source`).
"""

from dataclasses import dataclass
from itertools import pairwise
from typing import Annotated, TypeVar

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, JsonValue

from mobnet.core.rates import GAIN_HZ, RATE_HZ
from mobnet.kernel.drive import TorqueKind as TorqueKind

Number = TypeVar("Number", int, float)
Item = TypeVar("Item")


class Section(BaseModel):
    """A part of the configuration: its fields are the accepted keys, and nothing changes after loading."""

    # A class is built when it first checks a value: a job imports hundreds and needs few.
    model_config = ConfigDict(frozen=True, extra="forbid", defer_build=True)


@dataclass(frozen=True)
class Named:
    """Marks a field whose value must be the name of something configured elsewhere, of a kind such as `level`."""

    kind: str


def _ordered(bounds: tuple[Number, Number]) -> tuple[Number, Number]:
    """Check that a range has its lower end first."""
    if bounds[0] > bounds[1]:
        raise ValueError("accepted: two numbers, the lower one first")
    return bounds


def _spread(bounds: tuple[Number, Number]) -> tuple[Number, Number]:
    """Check that a range has its lower end first and is not a single value."""
    if bounds[0] >= bounds[1]:
        raise ValueError("accepted: two numbers, the lower one first")
    return bounds


def _ascending(values: tuple[Number, ...]) -> tuple[Number, ...]:
    """Check that each value is above the one before it."""
    if any(low >= high for low, high in pairwise(values)):
        raise ValueError("accepted: numbers that rise, each once")
    return values


def distinct(values: tuple[Item, ...]) -> tuple[Item, ...]:
    """Check that no value occurs twice."""
    if len(set(values)) < len(values):
        raise ValueError("accepted: each value once")
    return values


Real = Annotated[float, Field(strict=True, allow_inf_nan=False)]
Positive = Annotated[float, Field(strict=True, gt=0, allow_inf_nan=False)]
NotNegative = Annotated[float, Field(strict=True, ge=0, allow_inf_nan=False)]
Share = Annotated[float, Field(strict=True, ge=0, le=1)]
InnerShare = Annotated[float, Field(strict=True, gt=0, lt=1)]
PositiveShare = Annotated[float, Field(strict=True, gt=0, le=1)]
Whole = Annotated[int, Field(strict=True)]
Count = Annotated[int, Field(strict=True, ge=1, le=1_000_000_000)]
Index = Annotated[int, Field(strict=True, ge=0, le=2**32 - 1)]
Flag = Annotated[bool, Field(strict=True)]
Text = Annotated[str, Field(min_length=1, max_length=2000, pattern=r"\S")]
Some = Annotated[tuple[Item, ...], Field(min_length=1)]
Distinct = Annotated[Some[Item], AfterValidator(distinct)]

# What becomes part of file names and wildcards: short, and without anything that a path or a pattern could mean.
LowerName = Annotated[str, Field(pattern="^[a-z][a-z0-9_]*$", max_length=50)]
RowName = Annotated[str, Field(pattern="^[A-Za-z0-9][A-Za-z0-9-]*$", max_length=50)]
PartName = Annotated[str, Field(pattern="^[A-Za-z][A-Za-z0-9_]*$", max_length=50)]

LOW_PASS_HZ = (0.01, 100_000.0)
THRESHOLD = 1e-9, 1e6  # [N m], of a ratio [-]
RateHz = Annotated[Real, Field(ge=RATE_HZ[0], le=RATE_HZ[1])]
GainHz = Annotated[Real, Field(ge=GAIN_HZ[0], le=GAIN_HZ[1])]
LowPassHz = Annotated[Real, Field(ge=LOW_PASS_HZ[0], le=LOW_PASS_HZ[1])]
Threshold = Annotated[Real, Field(ge=THRESHOLD[0], le=THRESHOLD[1])]

MOST_M = 5.0  # between neighbouring parts of a robot; the arm of an excavator or of the largest robots has 3 m
Metres = Annotated[Real, Field(ge=-MOST_M, le=MOST_M)]
Length = Annotated[Positive, Field(ge=0.001, le=10)]
MOST_RAD = 12.6  # two turns
Radians = Annotated[Real, Field(ge=-MOST_RAD, le=MOST_RAD)]
Degrees = Annotated[Real, Field(ge=-180, le=180)]
Seconds = Annotated[Positive, Field(ge=0.001, le=600)]
Pause = Annotated[NotNegative, Field(le=600)]
Newton = Annotated[NotNegative, Field(le=2000)]
NewtonMetre = Annotated[Real, Field(ge=-1000, le=1000)]

Range = Annotated[tuple[Item, Item], AfterValidator(_ordered)]  # both ends may be the same
Span = Annotated[tuple[Item, Item], AfterValidator(_spread)]
Rising = Annotated[Some[Item], AfterValidator(_ascending)]
LengthPair = tuple[Length, Length]
Vector3 = tuple[Metres, Metres, Metres]
Seeds = Annotated[Distinct[Annotated[Index, Field(le=1_000_000)]], Field(max_length=100)]

LevelName = Annotated[str, Named("level")]
SingleLevelName = Annotated[str, Named("level of one plant")]
SurrogateLevelName = Annotated[str, Named("level of a surrogate robot")]
TerrainName = Annotated[str, Named("terrain")]
ObstacleName = Annotated[str, Named("obstacle")]
PushName = Annotated[str, Named("push")]
MotionName = Annotated[str, Named("motion")]
ScenarioName = Annotated[str, Named("scenario")]
CaseName = Annotated[str, Named("case of reactions")]
PushedName = Annotated[str, Named("scenario with pushes")]
QuietName = Annotated[str, Named("scenario without pushes")]
PushedTestName = Annotated[str, Named("test with a window around pushes")]
TrainingSetName = Annotated[str, Named("training set")]
ExperimentName = Annotated[str, Named("experiment")]
TaskName = Annotated[str, Named("task of development")]
RecipeName = Annotated[str, Named("recipe")]
NetworkName = Annotated[str, Named("network")]
MethodName = Annotated[str, Named("method")]
LearnedName = Annotated[str, Named("method with networks")]
SourceName = Annotated[str, Named("method that runs on its own")]
SweepName = Annotated[str, Named("sweep")]
WatchName = Annotated[str, Named("detector that reacts")]
DetectorName = Annotated[str, Named("detector")]
WatchedLevelName = Annotated[str, Named("level with detectors")]
WatchedLegName = Annotated[str, Named("leg with detectors")]
ThresholdsName = Annotated[str, Named("rule of thresholds")]
StruckName = Annotated[str, Named("cell of collisions")]
ScaleName = Annotated[str, Named("scale")]
JointName = Annotated[str, Named("joint")]
MotorName = Annotated[str, Named("motor")]
LimbName = Annotated[str, Named("limb")]
LegName = Annotated[str, Named("leg")]
LegJointName = Annotated[str, Named("joint of a leg")]
LimbOrJointName = Annotated[str, Named("limb or joint")]
BodyName = Annotated[str, Named("body")]
ToneName = Annotated[str, Named("tone")]
PointName = Annotated[str, Named("point")]
RobotNetworkName = Annotated[str, Named("network of the robot")]

MethodNames = Distinct[MethodName]
LimbNames = Annotated[tuple[LimbName, ...], AfterValidator(distinct)]
Change = dict[str, JsonValue]  # keys of another section that are replaced, checked once they are
