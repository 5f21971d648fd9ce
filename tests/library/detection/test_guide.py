"""The code of docs/detection.md for legs runs, finds and names a hit, and says where it is."""

import re
from pathlib import Path

import numpy as np
from made_contacts import pushed
from made_swings import GROUND

from mobnet.core.estimator import Estimate
from mobnet.detection.leg import unit_torques

GUIDE = Path(__file__).parents[3] / "docs" / "detection.md"
LATE, FORCE_N = 150, 50.0  # samples after lift-off


def codes():
    """Return the blocks of Python code of the guide."""
    return re.findall(r"^```python\n(.*?)^```$", GUIDE.read_text(), flags=re.DOTALL | re.MULTILINE)


def test_the_code_of_the_guide_finds_and_names_a_hit(walk, robot, gate):
    code, _, _ = codes()
    sensed, start = walk(1), GROUND + LATE
    torque = np.zeros((len(sensed), 6))
    torque[start : start + 30] = FORCE_N * unit_torques(robot, gate.leg, sensed.q[0], ["left_knee_side"], -1.0)
    found = {"walk": [(sensed[k], Estimate(torque[k])) for k in range(start + 30)]}
    exec(code, found)
    assert len(found["alarms"]) > 10
    assert all(point == "left_knee_side" for point, _ in found["alarms"])
    np.testing.assert_allclose([force for _, force in found["alarms"]], FORCE_N)


def test_the_code_of_the_guide_says_where_a_hit_is(walk, robot, settings):
    q, point = walk(1).q[GROUND + LATE], next(row for row in robot.points if row.name == "left_knee_side")
    columns = robot.layout.columns(robot.layout.limbs(["LL", "RL", "V"]))
    torque = pushed(robot, q, point.body, point.pos, [0.0, -FORCE_N, 0.0])[columns]
    found = {"robot": robot, "settings": settings, "q": q, "tau": torque, "std": np.full(len(columns), 0.1)}
    exec(codes()[2], found)
    axes, origin = found["finder"].place(q, point.body)
    assert np.linalg.norm(found["contact"].place - origin - axes @ point.pos) < 0.05
    np.testing.assert_allclose(axes.T @ found["contact"].force, [0.0, -FORCE_N, 0.0], atol=0.2 * FORCE_N)
