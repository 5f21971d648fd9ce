"""A robot's table of figures, `configs/robots/*.yaml` (docs/robots.md)."""

from __future__ import annotations

import hashlib
from collections.abc import Collection, Iterator
from itertools import zip_longest
from typing import Any, Literal

from pydantic import Field, ValidationError, model_validator
from pydantic_core import InitErrorDetails

from mobnet.core.errors import not_accepted
from mobnet.core.joints import N_VIRTUAL, JointLayout, Limits, right_of, with_image
from mobnet.settings.base import BodyName, JointName, LimbName, Section, Some, Text
from mobnet.settings.names import Place, unknown, uses
from mobnet.settings.networks import Limb
from mobnet.settings.parts import (
    BodyRow,
    Colour,
    FootRow,
    ImuRow,
    JointRow,
    LegRow,
    PointRow,
    PostureRow,
    ShapeRow,
    Side,
    SoleRow,
    Totals,
)

WORLD = "world"
MASS_TOLERANCE = 1e-6  # relative, of the total
Problem = tuple[Place, str]


class Order(Section):
    """Names of the joints in the order of the generalized velocity; only a floating base has virtual joints."""

    virtual: tuple[Text, ...] = ()
    actuated: Some[Text]


class RobotTable(Section):
    """All figures of a robot; what stands on none of its bodies, joints or limbs is refused.

    `bodies` stand depth-first, parents first, and `joints` in the order of the motors; `groups` are limb -> joints.
    """

    name: Text
    base: Literal["fixed", "floating"]
    totals: Totals | None = None
    imu: ImuRow | None = None
    feet: dict[Side, FootRow] = Field(default={})
    sole: SoleRow | None = None
    leg: LegRow | None = None
    hands: dict[Side, BodyName] = Field(default={})
    order: Order
    groups: dict[Text, Some[JointName]]
    posture: dict[LimbName, PostureRow] = Field(default_factory=dict)
    networks: dict[Text, Limb] = Field(default_factory=dict)
    joints: tuple[JointRow, ...]
    bodies: Some[BodyRow]
    tones: dict[Text, Colour] = Field(default_factory=dict)
    shapes: tuple[ShapeRow, ...] = ()
    points: tuple[PointRow, ...] = ()

    def __repr_args__(self) -> Iterator[tuple[str, str]]:
        """Name the robot and a digest of all figures: the table is a parameter of every rule that takes it."""
        yield "name", self.name
        yield "digest", hashlib.sha256(self.model_dump_json().encode()).hexdigest()[:16]

    @property
    def layout(self) -> JointLayout:
        """Joints and limbs."""
        legs = {side: foot.limb for side, foot in self.feet.items()}
        limits = {row.id: Limits(*row.range, row.velocity_limit, row.torque_limit) for row in self.joints}
        return JointLayout(self.order.virtual, self.order.actuated, self.groups, legs, limits)

    @property
    def accepted_names(self) -> dict[str, Collection[str]]:
        """Kind of name -> the names that exist on the robot."""
        order = self.order
        joints = (*order.virtual, *order.actuated)
        return {
            "joint": joints, "motor": order.actuated, "limb": self.groups, "limb or joint": (*self.groups, *joints),
            "body": [body.name for body in self.bodies], "tone": self.tones,
            "network of the robot": self.networks,
            "point": [
                *(name for point in self.points for name in with_image(point.name)),
                *(f"{side}_sole" for side in self.feet),
            ],
        }  # fmt: skip

    @model_validator(mode="after")
    def _fits_itself(self) -> RobotTable:
        """Check that the rows fit each other; every problem is named at its place."""
        found = [
            *unknown(uses(self, RobotTable), self.accepted_names), *_repeated(self), *_tree_problems(self),
            *_order_problems(self), *_length_problems(self), *_base_problems(self), *_total_problems(self),
        ]  # fmt: skip
        if found:
            raise ValidationError.from_exception_data(
                self.name,
                [
                    InitErrorDetails(type="value_error", loc=place, input=None, ctx={"error": ValueError(text)})
                    for place, text in found
                ],
            )
        return self


def _repeated(table: RobotTable) -> Iterator[Problem]:
    """Yield names that occur twice where each may occur once."""
    lists: dict[Place, list[str]] = {
        ("bodies",): [body.name for body in table.bodies],
        ("joints",): [joint.body for joint in table.joints],
        ("order",): [*table.order.virtual, *table.order.actuated],
        ("groups",): [joint for limb in table.groups.values() for joint in limb],
        ("shapes",): [name for shape in table.shapes for name in with_image(shape.name)],
        ("points",): [name for point in table.points for name in with_image(point.name)],
    }
    for place, names in lists.items():
        for name in sorted({name for name in names if names.count(name) > 1}):
            yield place, f"{name!r} occurs {names.count(name)} times; accepted: once"


def _tree_problems(table: RobotTable) -> Iterator[Problem]:
    """Yield bodies that do not stand right below the branch that they hang on, and mirror images without a body."""
    branch = [WORLD]
    for index, body in enumerate(table.bodies):
        if body.parent not in branch:
            yield ("bodies", str(index), "parent"), not_accepted(f"parent of {body.name}", body.parent, branch)
        else:
            branch = branch[: branch.index(body.parent) + 1]
        branch = [name for name in branch if name != WORLD] + [body.name]
    names = {body.name for body in table.bodies}
    for kind, rows in (("shapes", table.shapes), ("points", table.points)):
        for index, row in enumerate(rows):
            if len(with_image(row.name)) > 1 and row.body in names and right_of(row.body) not in names:
                yield (kind, str(index), "body"), not_accepted("body of the mirror image", right_of(row.body), names)


def _order_problems(table: RobotTable) -> Iterator[Problem]:
    """Yield where joints, or the bodies that they move, first depart from the order of the motors."""
    moved = {joint.body: joint.id for joint in table.joints}
    lists = {
        "joints": [joint.id for joint in table.joints],
        "bodies": [moved[body.name] for body in table.bodies if body.name in moved],
    }
    for kind, found in lists.items():
        for index, (name, accepted) in enumerate(zip_longest(found, table.order.actuated)):
            if name != accepted:
                yield (kind,), f"joint {index} in order is {name!r}; accepted: {accepted!r}, by `order.actuated`"
                break


def _length_problems(table: RobotTable) -> Iterator[Problem]:
    """Yield lists of a limb's posture that are not as long as the limb."""
    for limb, posture in table.posture.items():
        for name, values in posture:
            if limb in table.groups and len(values) != len(table.groups[limb]):
                yield ("posture", limb, name), f"{len(values)} numbers; accepted: {len(table.groups[limb])}"


def _base_problems(table: RobotTable) -> Iterator[Problem]:
    """Yield virtual joints, a sensor or a hinge that do not fit the base, and feet without soles."""
    base, wanted = table.bodies[0].name, N_VIRTUAL if table.base == "floating" else 0
    if len(table.order.virtual) != wanted:
        yield ("order", "virtual"), f"{len(table.order.virtual)} joints; accepted: {wanted} of a {table.base} base"
    if table.imu is not None and table.imu.body != base:
        yield ("imu", "body"), not_accepted("body", table.imu.body, [base])
    if bool(table.feet) != (table.sole is not None):
        yield ("feet",), "`feet` and `sole` are accepted together only"
    for index, joint in enumerate(table.joints):
        if joint.body == base:
            yield ("joints", str(index), "body"), f"{joint.id} moves the base {base!r}; accepted: a body below it"


def _total_problems(table: RobotTable) -> Iterator[Problem]:
    """Yield totals that the rows do not add up to."""
    if table.totals is None:
        return
    nv, nu = len(table.order.virtual), len(table.order.actuated)
    counts: dict[str, Any] = {
        "bodies": len(table.bodies), "actuated_joints": nu, "virtual_joints": nv, "dof": nv + nu
    }  # fmt: skip
    for name, count in counts.items():
        if getattr(table.totals, name) != count:
            yield ("totals", name), f"{getattr(table.totals, name)} is not accepted; accepted: {count}, by the rows"
    mass = sum(body.mass for body in table.bodies)
    if abs(table.totals.mass - mass) > MASS_TOLERANCE * mass:
        yield ("totals", "mass"), f"{table.totals.mass} is not accepted; accepted: {mass:.6f}, by the rows"
