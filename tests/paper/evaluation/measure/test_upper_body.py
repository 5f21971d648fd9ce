"""Joint ranges and hand speeds are those of the samples looked at."""

from pathlib import Path

import numpy as np
import pytest

from experiments.evaluation.measure.data.upper_body import hand_speeds, upper_body
from mobnet.core.joints import NQ_BASE
from mobnet.core.store import read_array
from mobnet.robot.nominal import NominalModel


def test_ranges_are_those_of_all_recordings(nominal: NominalModel, data_sets: dict[str, list[Path]]) -> None:
    stems = data_sets["motion"]
    found = {(quantity, part): value for quantity, part, value, _ in upper_body(10, stems, nominal)}
    angles = np.concatenate([read_array(stem, ["q.LA2"])[0][::10, 0] for stem in stems])
    joint = next(joint for joint in nominal.robot.joints if joint.id == "LA2")
    assert found["smallest position", "LA2"] == pytest.approx(angles.min())
    assert found["largest position", "LA2"] == pytest.approx(angles.max())
    assert found["upper limit", "LA2"] == joint.range[1]
    share = np.ptp(angles) / np.ptp(joint.range)
    assert found["joint range visited", "LA2"] == pytest.approx(share)
    shares = [found["joint range visited", f"LA{i}"] for i in range(1, 9)]
    assert found["joint range visited", "limb LA"] == pytest.approx(np.mean(shares))
    assert 0 < found["mean hand speed", "left"] < found["largest hand speed", "left"]


def test_hand_speed_is_that_of_finite_differences_and_invariant_to_the_base(nominal: NominalModel) -> None:
    robot, rng, step = nominal.robot, np.random.default_rng(3), 1e-6
    q, v = np.zeros((1, robot.layout.nq)), rng.normal(size=(1, robot.layout.nv))
    q[0, 3] = 1.0
    q[0, NQ_BASE:] = rng.uniform(-0.5, 0.5, robot.layout.nu)
    speed = hand_speeds(nominal, q, v)
    moved = q.copy()
    moved[0, NQ_BASE:] += step * v[0, 6:]
    for k, side in enumerate(("left", "right")):
        places = [_hand(nominal, posture_, f"{side}_hand") for posture_ in (q, moved)]
        assert speed[0, k] == pytest.approx(np.linalg.norm(places[1] - places[0]) / step, rel=1e-4)
    v[0, :6] += 5.0
    np.testing.assert_array_equal(hand_speeds(nominal, q, v), speed)


def _hand(nominal: NominalModel, q: np.ndarray, name: str) -> np.ndarray:
    """Return a hand's place by chaining the table's own transforms, without Pinocchio."""
    robot = nominal.robot
    point = next(point for point in robot.points if point.name == name)
    bodies = {body.name: body for body in robot.bodies}
    place, body = np.asarray(point.pos), bodies[point.body]
    while body.name != robot.base:
        joint = robot.joint_of(body.name)
        if joint is not None:
            angle = q[0, NQ_BASE + robot.layout.actuated.index(joint.id)]
            place = _turn(np.array([np.cos(angle / 2), *(np.sin(angle / 2) * np.array(joint.axis))])) @ place
        place = _turn(np.array(body.quat)) @ place + body.pos
        body = bodies[body.parent]
    return place


def _turn(quat: np.ndarray) -> np.ndarray:
    """Return the rotation of a unit quaternion w x y z by Rodrigues' formula."""
    axis = np.array([[0, -quat[3], quat[2]], [quat[3], 0, -quat[1]], [-quat[2], quat[1], 0]])
    return np.eye(3) + 2 * quat[0] * axis + 2 * axis @ axis
