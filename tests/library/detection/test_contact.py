"""A force on a limb is found again where it presses, also beside the ground's, and as far as torques can tell."""

from dataclasses import replace

import numpy as np
import pytest
from made_contacts import pushed

from mobnet.core.errors import ConfigError, DataError
from mobnet.detection.contact import LEAST, ContactLocator, explain
from mobnet.detection.surface import carried_by, surface_of
from mobnet.formats.parts import ShapeRow
from mobnet.formats.plain import as_plain
from mobnet.kernel.detecting import ContactNumbers
from mobnet.robot.wrench import feet_torque

FORCE_N = 150.0
POINTS = ("left_knee_front", "left_knee_side", "left_ankle_front", "left_ankle_side", "left_foot_side")


@pytest.fixture(scope="module")
def q(robot):
    """A position with one leg in its swing, the base turned."""
    q, layout = np.zeros(robot.layout.nq), robot.layout
    q[2], q[3:7] = 0.9, np.array([0.95, 0.05, -0.1, 0.3]) / np.linalg.norm([0.95, 0.05, -0.1, 0.3])
    angles = {"LL2": 0.05, "LL3": -0.6, "LL4": 1.1, "LL5": -0.5, "RL3": -0.3, "RL4": 0.6, "RL5": -0.3}
    q[7 + np.array([layout.actuated.index(joint) for joint in angles])] = list(angles.values())
    return q


@pytest.fixture(scope="module")
def finder(settings, robot):
    return ContactLocator.of(
        as_plain(settings.contact_point, ContactNumbers), robot, "LL", robot.layout.limbs(["LL", "RL", "V"])
    )


def hit(robot, q, name, size=FORCE_N):
    """Return the torque (nv,) of a hit at a point of the table, and where in the world it meets the robot."""
    row = next(row for row in robot.points if row.name == name)
    force = np.array([-size, 0.0, 0.0] if name.endswith("front") else [0.0, -size, 0.0])
    return pushed(robot, q, row.body, row.pos, force), row


def located(finder, q, torque, std=0.1, **others):
    columns = finder.robot.layout.columns(finder.joints)
    return finder.locate(q, torque[columns], np.broadcast_to(std, columns.shape), **others)


def error_m(finder, q, contact, row):
    axes, origin = finder.place(q, row.body)
    return float(np.linalg.norm(contact.place - origin - axes @ np.asarray(row.pos)))


@pytest.mark.parametrize("name", POINTS)
def test_a_hit_is_found_where_and_how_hard_it_is(robot, finder, q, name):
    torque, row = hit(robot, q, name)
    contact = located(finder, q, torque)
    assert error_m(finder, q, contact, row) < 0.04
    axes, _ = finder.place(q, row.body)
    true = axes @ ([-1.0, 0.0, 0.0] if name.endswith("front") else [0.0, -1.0, 0.0])
    assert contact.force @ true == pytest.approx(FORCE_N, rel=0.1)
    axes, origin = finder.place(q, contact.body)
    np.testing.assert_allclose(contact.place, origin + axes @ contact.point, atol=1e-9)


def test_a_point_is_weighed_by_what_is_known_of_a_force_and_by_the_torques(settings):
    """A closed form, as the three directions do not mix: the cone is two standard deviations wide."""
    numbers, told = (
        as_plain(settings.contact_point, ContactNumbers),
        0.01,
    )  # what torques tell of each direction [1/N^2]
    forces = np.array([[50.0, 10.0, -5.0], [-50.0, 0.0, 0.0]])
    seen = told * np.concatenate([forces, np.zeros((2, 3))], axis=1)
    wrenches, weight = np.broadcast_to(np.eye(3, 6), (2, 3, 6)), np.broadcast_to(told * np.eye(6), (2, 6, 6))
    cost, found = explain(wrenches, weight, seen, numbers)
    pressing = told * forces[:, 0] / (told + numbers.force_n**-2)
    width = numbers.friction / 2.0 * np.array([pressing[0], LEAST])  # a force that pulls has a cone, too
    known = np.stack([np.full(2, numbers.force_n), width, width], axis=1) ** -2
    expected = told * forces / (told + known)
    np.testing.assert_allclose(found, expected, rtol=1e-9)
    weighed = np.log((told + known) / known).sum(axis=1) - told * (forces * expected).sum(axis=1)
    np.testing.assert_allclose(cost, [weighed[0], np.inf], rtol=1e-9)


def test_the_wrench_of_the_ground_on_the_other_foot_changes_nothing(robot, finder, q, nominal):
    torque, row = hit(robot, q, "left_knee_front")
    ground = feet_torque(nominal, q, {"right": np.array([40.0, -30.0, 900.0, 20.0, -50.0, 10.0])})
    contact = located(finder, q, torque + ground, standing=["R_Foot_Link"])
    assert error_m(finder, q, contact, row) < 0.04
    unaware = located(finder, q, torque + ground)
    assert unaware is None or error_m(finder, q, unaware, row) > 0.1


def test_the_torques_of_the_leg_alone_tell_less(settings, robot, finder, q):
    alone = ContactLocator.of(as_plain(settings.contact_point, ContactNumbers), robot, "LL", robot.layout.limb("LL"))
    for name in ("left_knee_side", "left_ankle_side"):
        torque, _ = hit(robot, q, name)
        assert located(alone, q, torque).spread_m > 1.2 * located(finder, q, torque).spread_m


def test_a_torque_of_large_standard_deviation_says_little(robot, finder, q):
    torque, row = hit(robot, q, "left_ankle_front")
    std, wrong = np.full(len(finder.joints), 0.1), torque.copy()
    std[finder.joints.index("LL4")] = 1000.0
    wrong[robot.layout.columns(["LL4"])] += 80.0
    assert error_m(finder, q, located(finder, q, wrong, std), row) < 0.04
    believed = located(finder, q, wrong)
    assert believed is None or error_m(finder, q, believed, row) > 0.05


def test_what_is_expected_grows_with_the_errors_of_the_torques(robot, finder, q):
    torque, _ = hit(robot, q, "left_knee_front")
    expected = [located(finder, q, torque, std).spread_m for std in (0.1, 10.0, 40.0)]
    assert expected[0] < expected[1] < expected[2]


def test_a_torque_that_is_no_number_has_no_contact(robot, finder, q):
    torque, _ = hit(robot, q, "left_knee_front")
    torque[robot.layout.columns(["LL3"])] = np.nan
    assert located(finder, q, torque) is None


def test_a_base_moved_through_the_world_changes_nothing_in_the_body(robot, finder, q):
    torque, _ = hit(robot, q, "left_knee_front")
    moved = q.copy()
    moved[:3] += [3.0, -2.0, 0.5]
    here, there = located(finder, q, torque), located(finder, moved, torque)
    assert here.body == there.body
    np.testing.assert_allclose(here.point, there.point, atol=1e-9)
    np.testing.assert_allclose(there.place - here.place, [3.0, -2.0, 0.5], atol=1e-9)


def test_an_arm_on_a_wall_feels_where_it_is_pressed(settings, arm):
    common = {"type": "capsule", "size": [0.03], "tone": "grey"}
    ends = {"upper": [0.0, 0.0, 0.0, 0.45, 0.0, 0.0], "lower": [0.0, 0.0, 0.0, 0.4, 0.0, 0.0]}
    rows = [{"name": name, "body": name, "segment": segment, **common} for name, segment in ends.items()]
    robot = replace(arm, shapes=tuple(map(ShapeRow.model_validate, rows)))
    finder = ContactLocator.of(as_plain(settings.contact_point, ContactNumbers), robot, "A", robot.layout.limb("A"))
    q = np.array([0.3, 0.8])
    torque = pushed(robot, q, "lower", [0.3, 0.0, 0.03], np.array([0.0, 0.0, -60.0]))
    contact = finder.locate(q, torque, np.full(2, 0.1))
    assert contact.body == "lower"
    # two hinges about y cannot tell the sides from each other, but the place along the link and the force
    assert contact.point[0] == pytest.approx(0.3, abs=0.06)
    assert np.linalg.norm(contact.force) == pytest.approx(60.0, rel=0.25)


def test_points_within_another_solid_of_the_body_are_left_out(robot):
    surface = surface_of(robot, "LL", 0.01)
    names = [shape.name for shape in surface.shapes]
    own = surface.patch.points[surface.shape == names.index("left_foot")]
    instep = robot.shapes[[shape.name for shape in robot.shapes].index("left_instep")]
    start, end = np.reshape(instep.segment, (2, 3))
    along = np.clip((own - start) @ (end - start) / ((end - start) @ (end - start)), 0.0, 1.0)[:, None]
    assert (np.linalg.norm(own - start - along * (end - start), axis=1) > instep.size[0] - 1e-6).all()
    assert all(shape.name.startswith("left_") for shape in surface.shapes)


def test_a_body_without_a_joint_is_carried_by_the_one_above(robot):
    assert carried_by(robot, "L_Foot_Link").joint == "LL6"
    assert carried_by(robot, robot.base).joint is None
    with pytest.raises(ConfigError, match="body: 'L_Toe'"):
        carried_by(robot, "L_Toe")


def test_what_is_not_there_is_refused(settings, robot, finder, arm, q):
    with pytest.raises(ConfigError, match="no `shapes` of limb A"):
        ContactLocator.of(as_plain(settings.contact_point, ContactNumbers), arm, "A", arm.layout.limb("A"))
    with pytest.raises(ConfigError, match="joint: 'LL7'"):
        ContactLocator.of(as_plain(settings.contact_point, ContactNumbers), robot, "LL", ["LL7"])
    with pytest.raises(DataError, match=r"shapes \(18,\)"):
        finder.locate(q, np.zeros(6), np.ones(6))
    with pytest.raises(ConfigError, match="the base is not accepted"):
        located(finder, q, np.zeros(robot.layout.nv), standing=[robot.base])
