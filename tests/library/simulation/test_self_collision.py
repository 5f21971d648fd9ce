"""Self-collision: hits are seen with the solids that hit, nothing where nothing is near, and distances are right."""

import numpy as np
import pytest

from mobnet.core.errors import DataError
from mobnet.core.joints import NQ_BASE
from mobnet.simulation.self_collision import REACH_M, Clearance, held_together

HANDS = ("left_hand", "right_hand")
STANDING = {"LL3": -0.4, "LL4": 0.8, "LL5": -0.4, "RL3": -0.4, "RL4": 0.8, "RL5": -0.4}
FOLDED = {"LA1": 0.0, "LA2": 0.1, "LA3": 1.6, "LA4": -0.5, "LA5": -2.1, "LA6": 0.2, "LA7": -1.1}
LOWERED = {"LA1": 0.1, "LA2": 0.2, "LA3": 1.6, "LA4": -1.0, "LA5": -0.5, "LA6": 0.1, "LA7": -0.4}
HANDS_MEET = {1: 0.1, 2: 0.0, 3: 2.0, 4: -1.0, 5: -1.4, 6: 0.1, 7: -1.1, 8: -0.1}  # left arm; the right one mirrors it
HITS = {  # joint angles [rad] besides the standing posture -> the solids that overlap
    ("chest_front", "left_hand"): FOLDED,
    ("left_thigh", "left_hand"): LOWERED,
    ("left_shank", "right_shank"): {"LL2": -0.3},
    ("left_ankle", "right_ankle"): {"LL2": -0.2},
    HANDS: {f"{side}A{k}": sign * angle for side, sign in (("L", 1), ("R", -1)) for k, angle in HANDS_MEET.items()},
}


@pytest.fixture(scope="module")
def clearance(robot):
    return Clearance(robot)


@pytest.fixture(scope="module")
def standing(robot):
    """Standing with bent knees in the walking posture (nq,)."""
    q = np.zeros(robot.layout.nq)
    q[3] = 1.0
    q[-len(robot.posture.angle) :] = robot.posture.angle
    return with_angles(robot, q, STANDING)


def with_angles(robot, q, angles):
    """Return q (nq,) with some joints at other angles [rad]."""
    q = q.copy()
    for name, angle in angles.items():
        q[NQ_BASE + robot.layout.actuated.index(name)] = angle
    return q


@pytest.mark.parametrize("pair", HITS)
def test_a_hit_is_seen(clearance, robot, standing, pair):
    q = with_angles(robot, standing, HITS[pair])
    assert clearance.nearest(q[None])[0] < -0.02
    assert set(clearance.pair(q) or ()) == set(pair)


def test_nothing_is_near_in_the_posture_however_a_leg_walks(clearance, robot, standing, settings):
    assert clearance.pair(standing) is None
    assert clearance.nearest(np.stack([standing, standing])).tolist() == [REACH_M, REACH_M]
    for yaw, roll, pitch, knee in settings.motions["random_motion"].leg_poses_rad:
        lifted = {"LL1": yaw, "LL2": roll, "LL3": pitch, "LL4": knee, "LL5": -pitch - knee}
        assert clearance.nearest(with_angles(robot, standing, lifted)[None])[0] > 0.02


def test_where_the_robot_is_does_not_matter(clearance, robot, standing):
    hit = with_angles(robot, standing, {"LL2": -0.15})
    moved = hit.copy()
    moved[:7] = 3.0, -2.0, 1.0, 0.5, -0.5, 0.5, 0.5
    np.testing.assert_allclose(clearance.nearest(moved[None]), clearance.nearest(hit[None]), atol=1e-6)


def test_distance_of_capsules_is_that_of_their_axes_less_their_radii(robot, standing):
    """Both thighs are parallel, hips 0.205 m apart, and nothing else is as near."""
    clearance = Clearance(robot, 0.1)
    radius = next(shape.size[0] for shape in robot.shapes if shape.name == "left_thigh")
    assert clearance.nearest(standing[None])[0] == pytest.approx(2 * robot.leg.hip_pos[1] - 2 * radius, abs=1e-6)
    assert clearance.pair(standing) == ("left_thigh", "right_thigh")


def test_distance_never_jumps_while_hands_meet(clearance, robot, standing):
    """MuJoCo's own test of two boxes misses some that are near: the distance then falls from out of reach at once."""
    rng = np.random.default_rng(0)
    meeting, share = with_angles(robot, standing, HITS[HANDS]), np.linspace(0, 1, 300)[:, None]
    for _ in range(10):
        wrists = dict(zip(("LA6", "LA7", "LA8", "RA6", "RA7", "RA8"), rng.uniform(-1, 1, 6), strict=True))
        turned = with_angles(robot, meeting, wrists)
        apart = with_angles(robot, turned, {"LA3": 1.0, "RA3": -1.0})
        distance = clearance.nearest(apart + share * (turned - apart))
        assert distance[0] == REACH_M
        assert distance[-1] < 0
        assert np.abs(np.diff(np.maximum(distance, 0))).max() < 0.004


def test_neighbours_are_left_out_and_legs_are_not(robot):
    bodies = {body.name: body for body in robot.bodies}
    for one, other, held in [
        ("L_Elbow_Link", "L_Forearm_Link", True),
        ("base_link", "L_Thigh_Link", True),
        ("base_link", "Upperbody_Link", True),
        ("Upperbody_Link", "L_Shoulder3_Link", False),
        ("L_Thigh_Link", "R_Thigh_Link", False),
        ("L_HipRoll_Link", "R_HipCenter_Link", False),
        ("Upperbody_Link", "L_Wrist2_Link", False),
    ]:
        assert held_together(robot, bodies[one], bodies[other]) == held
        assert held_together(robot, bodies[other], bodies[one]) == held


def test_another_shape_is_refused(clearance):
    with pytest.raises(DataError, match=r"shape \(3, 39\) is not accepted; accepted: \(T, 40\)"):
        clearance.nearest(np.zeros((3, 39)))
