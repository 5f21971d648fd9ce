"""From rows of a table to values: unit quaternions, mirror images, a posture in motor order."""

import numpy as np
import pytest

from mobnet.robot.description import RobotDescription
from mobnet.robot.rows import MIRROR_Y, read_body, read_point, read_shape, with_mirrored
from mobnet.settings.parts import BodyRow, PointRow, ShapeRow

HAND = PointRow(name="left_hand", body="L_Wrist2_Link", pos=(0.1, 0.2, 0.3))
HEAD = PointRow(name="head", body="Head_Link")
ARM = ShapeRow(
    name="left_arm",
    body="L_Arm_Link",
    type="capsule",
    size=(0.1,),
    segment=(0.1, 0.2, 0.3, -0.4, 0.5, 0.6),
    tone="light",
)


def test_right_side_is_the_mirror_image_of_the_left_and_the_middle_has_none() -> None:
    """Left and right are symmetric in y."""
    left, right, middle = with_mirrored([HAND, HEAD])
    assert (left, middle) == (HAND, HEAD)
    assert (right.name, right.body) == ("right_hand", "R_Wrist2_Link")
    np.testing.assert_allclose(read_point(right).pos, [0.1, -0.2, 0.3])


def test_mirroring_a_segment_twice_is_the_identity() -> None:
    _, right = with_mirrored([ARM])
    assert right.segment == (0.1, -0.2, 0.3, -0.4, -0.5, 0.6)
    _, again = with_mirrored([right.model_copy(update={"name": "left_arm"})])
    assert again.segment == ARM.segment
    read = read_shape(ARM, {"light": (1.0, 1.0, 1.0, 1.0)})
    assert read.segment is not None
    assert read.segment.dtype == np.float64


def test_quaternions_are_brought_to_unit_length() -> None:
    row = {"name": "a", "parent": "world", "pos": (0, 0, 0), "quat": (0, 0, 0.600001, 0.8), "mass": 1, "com": (0, 0, 0)}
    body = read_body(BodyRow.model_validate({**row, "inertia": (1, 1, 1, 0, 0, 0)}))
    assert np.linalg.norm(body.quat) == pytest.approx(1, abs=1e-15)


def test_the_robot_s_shapes_are_symmetric(robot: RobotDescription) -> None:
    shapes = {shape.name: shape for shape in robot.shapes}
    for name, left in shapes.items():
        if name.startswith("left_"):
            right = shapes[name.replace("left_", "right_", 1)]
            np.testing.assert_array_equal(right.size, left.size)
            np.testing.assert_allclose(right.pos, left.pos * MIRROR_Y)


def test_posture_stands_in_motor_order_whatever_the_order_of_the_limbs(robot: RobotDescription) -> None:
    posture = robot.posture
    assert posture.joints == robot.layout.actuated[12:]
    here = [posture.joints.index(name) for name in robot.layout.limb("LA")]
    np.testing.assert_array_equal(posture.angle[here], [0.3, 0.3, 1.5, -1.27, -1.0, 0.0, -1.0, 0.0])
    np.testing.assert_array_equal(posture.damping[here][:2], [10.0, 20.0])
