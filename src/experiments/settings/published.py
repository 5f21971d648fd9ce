"""The paper's own results, as printed (Lim, Kim, Cha, Park: MOB-Net)."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from mobnet.formats.base import (
    Count,
    Distinct,
    Flag,
    LevelName,
    LimbName,
    LowerName,
    MethodName,
    NotNegative,
    Positive,
    RowName,
    Section,
    Text,
    TrainingSetName,
    Whole,
)

# one for each column; None where nothing is printed or readable
Numbers = tuple[Annotated[NotNegative, Field(le=1000)] | None, ...]
QUANTITIES = "recordings|duration|samples|falls|episodes|time standing|steps"  # of the table of training sets
Quantity = Annotated[str, Field(pattern=f"^({QUANTITIES})$")]


ColumnName = Annotated[str, Field(pattern="^[A-Za-z0-9+ ]+$", max_length=50)]
PlaceName = Annotated[str, Field(pattern="^[a-z0-9_.]+$", max_length=100)]


class Floor(Section):
    """The row over which a table prints its averages as increases."""

    level: LevelName
    method: MethodName


class PublishedTable(Section):
    """A table, or the numbers of a figure: place in it, such as a level -> method -> one number for each column.

    `labels` says how the table calls a level; `robot`, whether it was measured on the paper's robot.
    """

    printed: Text
    metric: Literal["rmse"] | None = None
    unit: Literal["N m"] | None = None
    columns: Distinct[ColumnName]
    robot: Flag = False
    floor: Floor | None = None
    labels: dict[LevelName, Text] = {}
    numbers: dict[PlaceName, dict[RowName, Numbers]]


ARCHITECTURE = r"^GRU\[(\d+), (\d+)\]-Linear\[(\d+), (\d+)\]$"  # inputs, state; state, outputs


class PublishedNetwork(Section):
    """A row of Table 1."""

    architecture: Annotated[str, Field(pattern=ARCHITECTURE)]
    parameters: Count
    horizon_steps: Whole = Field(ge=1, le=10_000)


class PublishedNetworks(Section):
    """Table 1."""

    printed: Text
    rows: dict[LimbName, PublishedNetwork]


class PublishedData(Section):
    """What the paper says of its training sets: set -> quantity -> number, durations in minutes."""

    printed: Text
    sets: dict[TrainingSetName, dict[Quantity, Annotated[Positive, Field(le=1e9)]]]


class PublishedUncertainty(Section):
    """Standard deviations of the robot's uncertainty torque [N m], V1 to V3 [N], by limb."""

    printed: Text
    unit: Literal["N m"]
    std: dict[LimbName, tuple[Annotated[Positive, Field(le=1000)], ...]]
    note: Text


class PublishedKinds(Section):
    """Networks of section 6.1: parameters, and the order of their losses, lowest first."""

    printed: Text
    parameters: dict[MethodName, Count]
    order: dict[MethodName, Count]


class PublishedContact(Section):
    """Peak force and impulse of a contact."""

    force_n: Positive = Field(le=10_000)
    momentum_ns: Positive = Field(le=1000)


class PublishedCollisions(Section):
    """Section 5.3: means of the collisions of a leg. It gives none of the force."""

    printed: Text
    impulse_ns: Positive
    contact_ms: Positive


class PublishedContacts(Section):
    """Section 5.4: means of five collisions with a fixed obstacle."""

    printed: Text
    foot: PublishedContact
    knee: PublishedContact


class Published(Section):
    """All numbers of the paper that ours stand beside, and the methods that it has.

    `original_methods` are its methods, with those that a sweep of its own stands for, and its detectors, each by where
    it describes them. All others are ours.
    """

    original_methods: dict[RowName, Text]
    table_01: PublishedNetworks
    tables: Annotated[dict[LowerName, PublishedTable], Field(min_length=1)]
    data: PublishedData
    uncertainty: PublishedUncertainty
    kinds: PublishedKinds
    section_5_3: PublishedCollisions
    section_5_4: PublishedContacts
