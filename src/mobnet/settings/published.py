"""The paper's own results, as printed (Lim, Kim, Cha, Park: MOB-Net)."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field, model_validator

from mobnet.settings.base import Count, LevelName, LimbName, MethodName, Positive, Real, Section, Text

Numbers = tuple[Real | None, ...]  # one for each column; None where nothing is printed or readable


class Floor(Section):
    """The row over which a table prints its averages as increases."""

    level: LevelName
    method: MethodName


class PublishedTable(Section):
    """A table, or the numbers of a figure: place in it, such as a level -> method -> one number for each column.

    `labels` says how the table calls a level; `robot`, whether it was measured on the paper's robot.
    """

    printed: Text
    metric: Text | None = None
    unit: Text | None = None
    columns: tuple[Text, ...]
    robot: bool = False
    floor: Floor | None = None
    labels: dict[LevelName, str] = {}
    numbers: dict[str, dict[str, Numbers]]

    @model_validator(mode="after")
    def _rows_fit(self) -> PublishedTable:
        """Check that every row has a number for each column."""
        for place, rows in self.numbers.items():
            for method, row in rows.items():
                if len(row) != len(self.columns):
                    raise ValueError(f"{place}, {method}: {len(row)} numbers for {len(self.columns)} columns")
        return self


class PublishedNetwork(Section):
    """A row of Table 1."""

    architecture: Text
    parameters: Count
    horizon_steps: Count


class PublishedNetworks(Section):
    """Table 1."""

    printed: Text
    rows: dict[LimbName, PublishedNetwork]


class PublishedData(Section):
    """What the paper says of its training sets: set -> quantity -> number, durations in minutes."""

    printed: Text
    sets: dict[str, dict[str, Real]]


class PublishedUncertainty(Section):
    """Standard deviations of the robot's uncertainty torque [N m], V1 to V3 [N], by limb."""

    printed: Text
    unit: Text
    std: dict[LimbName, tuple[Positive, ...]]
    note: Text


class PublishedKinds(Section):
    """Networks of section 6.1: parameters, and the order of their losses, lowest first."""

    printed: Text
    parameters: dict[MethodName, Count]
    order: dict[MethodName, Count]


class Contact(Section):
    """Peak force and impulse of a contact."""

    force_n: Positive
    momentum_ns: Positive


class PublishedContacts(Section):
    """Section 5.4: means of five collisions with a fixed obstacle."""

    printed: Text
    foot: Contact
    knee: Contact


class Published(Section):
    """All numbers of the paper that ours stand beside."""

    table_01: PublishedNetworks
    tables: Annotated[dict[str, PublishedTable], Field(min_length=1)]
    data: PublishedData
    uncertainty: PublishedUncertainty
    kinds: PublishedKinds
    section_5_4: PublishedContacts
