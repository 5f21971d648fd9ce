"""What forces at points of an arm do to its joints, the least of them that are found, and the one that is named."""

import numpy as np
import pytest

from mobnet.detection.always import setup_of
from mobnet.detection.points import axis_forces, axis_torques, felt_push, points_of, some_rows
from mobnet.formats.parts import PointRow
from mobnet.robot.description import describe
from mobnet.robot.nominal import NominalModel

POINTS = (
    PointRow(name="elbow", body="upper", pos=(0.45, 0.0, 0.0)),
    PointRow(name="tip", body="lower", pos=(0.3, 0.0, 0.0)),
    PointRow(name="mount", body="wall"),
)
JOINTS = ("J1", "J2")
POSE = np.array([0.4, -0.9])


@pytest.fixture
def pointed(arm_table):
    return describe(arm_table.model_copy(update={"points": POINTS}))


@pytest.fixture
def model(pointed):
    return NominalModel(pointed)


def test_points_are_those_that_the_joints_move(pointed):
    assert [row.name for row in points_of(pointed, JOINTS)] == ["elbow", "tip"]
    assert [row.name for row in points_of(pointed, ("J1",))] == ["elbow"]


def test_torques_of_a_straight_arm_are_force_times_lever(pointed, model):
    elbow, tip = axis_torques(model, JOINTS, points_of(pointed, JOINTS), np.zeros((1, 2)))[0].reshape(2, 3, 2)
    # The hinges turn about y: a force along z at a lever along x turns by minus their product, one along x or y not.
    np.testing.assert_allclose(elbow, [[0, 0], [0, 0], [-0.45, 0]], atol=1e-12)
    np.testing.assert_allclose(tip, [[0, 0], [0, 0], [-0.75, -0.3]], atol=1e-12)


def test_the_smallest_force_is_that_at_which_a_joint_crosses_and_none_where_no_joint_feels_it(settings, pointed, model):
    setup = setup_of(settings.detection, pointed, "A", 1000.0)
    forces = axis_forces(setup, model, np.zeros((3, 2)), np.full((3, 2), 3.0))
    assert forces["tip"][2] == pytest.approx(3.0 / 0.75 / 0.919, rel=0.01)
    assert forces["elbow"][2] == pytest.approx(3.0 / 0.45 / 0.919, rel=0.01)
    assert np.isinf(forces["tip"][:2]).all()


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_the_push_that_acts_is_named_with_its_force(sign, pointed, model):
    rows = points_of(pointed, JOINTS)
    across = axis_torques(model, JOINTS, rows, POSE[None])[0].reshape(2, 3, 2)[1, 2]  # at the tip, along z of its link
    found = felt_push(model, JOINTS, POSE, sign * 20.0 * across, np.ones(2))
    assert found is not None
    assert (found.point, found.body, found.direction) == ("tip", "lower", "+z" if sign > 0 else "-z")
    assert found.force_n == pytest.approx(20.0)


def test_a_limb_without_points_names_nothing(arm):
    assert felt_push(NominalModel(arm), JOINTS, POSE, np.ones(2), np.ones(2)) is None


def test_rows_of_poses_are_evenly_apart_and_none_is_taken_twice():
    assert some_rows(10, 4).tolist() == [0, 3, 6, 9]
    assert some_rows(3, 10).tolist() == [0, 1, 2]
