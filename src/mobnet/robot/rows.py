"""From the rows of a robot's table to its parts as numpy values."""

from collections.abc import Iterable, Mapping
from typing import TypeVar

import numpy as np
from numpy.typing import ArrayLike

from mobnet.core.joints import right_of, with_image
from mobnet.robot.parts import Body, Foot, Joint, Point, Posture, Shape, Sole, Vector
from mobnet.settings.parts import BodyRow, Colour, JointRow, PointRow, ShapeRow
from mobnet.settings.robot import RobotTable

Row = TypeVar("Row", bound=PointRow)
MIRROR_Y = np.array([1.0, -1.0, 1.0])


def vector(values: ArrayLike) -> Vector:
    """Return numbers of the table as a float64 vector (n,), in the table's SI units."""
    return np.asarray(values, dtype=np.float64)


def read_body(row: BodyRow) -> Body:
    """Return a body; its quaternion is brought to unit length."""
    quat = vector(row.quat)
    return Body(
        row.name,
        row.parent,
        vector(row.pos),
        quat / np.linalg.norm(quat),
        row.mass,
        vector(row.com),
        vector(row.inertia),
    )


def read_joint(row: JointRow) -> Joint:
    """Return an actuated joint."""
    return Joint(
        row.id, row.body, vector(row.axis), vector(row.range), row.torque_limit, row.armature, row.velocity_limit
    )


def read_feet(table: RobotTable) -> dict[str, Foot]:
    """Return side -> foot, all on soles of one shape."""
    row = table.sole
    if row is None:
        return {}
    sole = Sole(vector(row.sensor_pos), vector(row.box_centre), vector(row.box_half), row.height)
    return {side: Foot(foot.body, foot.limb, sole) for side, foot in table.feet.items()}


def read_posture(table: RobotTable) -> Posture:
    """Return the posture of all limbs that have one, in motor order."""
    rows = {
        joint: numbers
        for limb, row in table.posture.items()
        for joint, *numbers in zip(
            table.groups[limb], row.angle_rad, row.stiffness_nm_rad, row.damping_nms_rad, strict=True
        )
    }
    joints = tuple(joint for joint in table.order.actuated if joint in rows)
    numbers = np.array([rows[joint] for joint in joints], dtype=np.float64).reshape(-1, 3)
    return Posture(joints, *np.ascontiguousarray(numbers.T))


def read_shape(row: ShapeRow, tones: Mapping[str, Colour]) -> Shape:
    """Return a solid with its colour."""
    segment = None if row.segment is None else vector(row.segment)
    return Shape(row.name, row.body, row.type, vector(row.size), vector(row.pos), segment, vector(tones[row.tone]))


def read_point(row: PointRow) -> Point:
    """Return a point."""
    return Point(row.name, row.body, vector(row.pos))


def with_mirrored(rows: Iterable[Row]) -> list[Row]:
    """Return rows of the left side, each with its mirror image in y, and other rows as they are."""
    return [image for row in rows for image in (row, *(_mirrored(row, name) for name in with_image(row.name)[1:]))]


def _mirrored(row: Row, name: str) -> Row:
    """Return a row of the left side as the right side has it, under its name."""
    update = {"name": name, "body": right_of(row.body), "pos": _in_y(row.pos)}
    if isinstance(row, ShapeRow) and row.segment is not None:
        update["segment"] = _in_y(row.segment)
    return row.model_copy(update=update)


def _in_y(points: tuple[float, ...]) -> tuple[float, ...]:
    """Return points, three coordinates each, mirrored in y."""
    return tuple((np.reshape(points, (-1, len(MIRROR_Y))) * MIRROR_Y).ravel().tolist())
