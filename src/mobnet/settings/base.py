"""What every section of the configuration is made of: frozen classes, bounded numbers, names that must exist elsewhere.

A unit stands at the end of a field's name. Sections hold values and their checks, no computation: their code is not
part of a rule's code hash, their values are parameters of every rule that takes them.
"""

from dataclasses import dataclass
from typing import Annotated, TypeVar

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, JsonValue

Number = TypeVar("Number", int, float)
Item = TypeVar("Item")


class Section(BaseModel):
    """A part of the configuration: its fields are the accepted keys, and nothing changes after loading."""

    model_config = ConfigDict(frozen=True, extra="forbid")


@dataclass(frozen=True)
class Named:
    """Marks a field whose value must be the name of something configured elsewhere, of a kind such as `level`."""

    kind: str


def _ordered(bounds: tuple[Number, Number]) -> tuple[Number, Number]:
    """Check that a range has its lower end first."""
    if bounds[0] > bounds[1]:
        raise ValueError("the lower end must come first")
    return bounds


def distinct(values: tuple[Item, ...]) -> tuple[Item, ...]:
    """Check that no value occurs twice."""
    if len(set(values)) < len(values):
        raise ValueError("each value may occur once")
    return values


Real = Annotated[float, Field(strict=True, allow_inf_nan=False)]
Positive = Annotated[float, Field(strict=True, gt=0, allow_inf_nan=False)]
NotNegative = Annotated[float, Field(strict=True, ge=0, allow_inf_nan=False)]
Share = Annotated[float, Field(strict=True, ge=0, le=1)]
InnerShare = Annotated[float, Field(strict=True, gt=0, lt=1)]
Count = Annotated[int, Field(strict=True, ge=1)]
Index = Annotated[int, Field(strict=True, ge=0)]
Flag = Annotated[bool, Field(strict=True)]
Text = Annotated[str, Field(min_length=1)]
Some = Annotated[tuple[Item, ...], Field(min_length=1)]

Range = Annotated[tuple[Real, Real], AfterValidator(_ordered)]
PositiveRange = Annotated[tuple[Positive, Positive], AfterValidator(_ordered)]
NotNegativeRange = Annotated[tuple[NotNegative, NotNegative], AfterValidator(_ordered)]
ShareRange = Annotated[tuple[Share, Share], AfterValidator(_ordered)]
CountRange = Annotated[tuple[Count, Count], AfterValidator(_ordered)]
PositivePair = tuple[Positive, Positive]
Vector3 = tuple[Real, Real, Real]
Choices = Some[Positive]
InnerShares = Annotated[Some[InnerShare], AfterValidator(distinct)]
Seeds = Annotated[Some[Index], AfterValidator(distinct)]

LevelName = Annotated[str, Named("level")]
TerrainName = Annotated[str, Named("terrain")]
PushName = Annotated[str, Named("push")]
MotionName = Annotated[str, Named("motion")]
ScenarioName = Annotated[str, Named("scenario")]
TestName = Annotated[str, Named("test")]
PushedTestName = Annotated[str, Named("test with a window around pushes")]
TrainingSetName = Annotated[str, Named("training set")]
ExperimentName = Annotated[str, Named("experiment")]
NetworkName = Annotated[str, Named("network")]
MethodName = Annotated[str, Named("method")]
SourceName = Annotated[str, Named("method that runs on its own")]
SweepName = Annotated[str, Named("sweep")]
ScaleName = Annotated[str, Named("scale")]
JointName = Annotated[str, Named("joint")]
MotorName = Annotated[str, Named("motor")]
LimbName = Annotated[str, Named("limb")]
LimbOrJointName = Annotated[str, Named("limb or joint")]
BodyName = Annotated[str, Named("body")]
ToneName = Annotated[str, Named("tone")]
PointName = Annotated[str, Named("point")]
RobotNetworkName = Annotated[str, Named("network of the robot")]

MethodNames = Some[MethodName]
LimbNames = tuple[LimbName, ...]
Change = dict[str, JsonValue]  # keys of another section that are replaced, checked once they are
