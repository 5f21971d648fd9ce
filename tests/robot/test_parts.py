"""Rows of the table: unit quaternions, mirror images."""

from __future__ import annotations

import numpy as np

from mobnet.robot.description import RobotDescription
from mobnet.robot.parts import MIRROR_Y, read_body, read_shape, with_mirrored

ROW = {"name": "left_hand", "body": "L_Wrist2_Link", "pos": [0.1, 0.2, 0.3]}
TONES = {"light": [1.0, 1.0, 1.0, 1.0]}


def test_right_side_is_the_mirror_image_of_the_left() -> None:
    """Left and right are symmetric in y."""
    left, right = with_mirrored([ROW])
    assert left is ROW
    assert (right["name"], right["body"]) == ("right_hand", "R_Wrist2_Link")
    np.testing.assert_allclose(right["pos"], [0.1, -0.2, 0.3])


def test_mirroring_a_segment_twice_is_the_identity() -> None:
    segment = [0.1, 0.2, 0.3, -0.4, 0.5, 0.6]
    _, right = with_mirrored([{**ROW, "segment": segment}])
    _, again = with_mirrored([{**right, "name": "left_hand"}])
    np.testing.assert_allclose(again["segment"], segment)


def test_middle_parts_have_no_image() -> None:
    middle = {"name": "head", "body": "Head_Link"}
    assert with_mirrored([middle]) == [middle]


def test_quaternions_are_brought_to_unit_length() -> None:
    row = {"name": "a", "parent": "world", "pos": [0, 0, 0], "quat": [0, 0, 3, 4], "mass": 1, "com": [0, 0, 0]}
    body = read_body({**row, "inertia": [1, 1, 1, 0, 0, 0]})
    np.testing.assert_allclose(body.quat, [0, 0, 0.6, 0.8])


def test_shape_stands_at_a_point_or_along_a_segment() -> None:
    row = {"name": "head", "body": "Head_Link", "type": "capsule", "size": [0.1], "tone": "light"}
    assert read_shape(row, TONES).segment is None
    np.testing.assert_array_equal(read_shape(row, TONES).pos, 0)
    along = read_shape({**row, "segment": [0, 0, 0, 0, 0, 1]}, TONES)
    assert along.segment is not None
    assert along.segment.dtype == np.float64


def test_the_robot_s_shapes_are_symmetric(robot: RobotDescription) -> None:
    shapes = {shape.name: shape for shape in robot.shapes}
    for name, left in shapes.items():
        if name.startswith("left_"):
            right = shapes[name.replace("left_", "right_", 1)]
            np.testing.assert_array_equal(right.size, left.size)
            np.testing.assert_allclose(right.pos, left.pos * MIRROR_Y)
