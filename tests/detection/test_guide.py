"""The first code of docs/detection.md runs, and finds and names a hit; tests/robotlog runs the other one."""

import re
from pathlib import Path

import numpy as np
from made_swings import GROUND

from mobnet.core.estimator import Estimate
from mobnet.detection.leg import unit_torques

GUIDE = Path(__file__).parents[2] / "docs" / "detection.md"
LATE, FORCE_N = 150, 50.0  # samples after lift-off


def test_the_code_of_the_guide_finds_and_names_a_hit(walk, robot, gate):
    code, _ = re.findall(r"^```python\n(.*?)^```$", GUIDE.read_text(), flags=re.DOTALL | re.MULTILINE)
    sensed, start = walk(1), GROUND + LATE
    torque = np.zeros((len(sensed), 6))
    torque[start : start + 30] = FORCE_N * unit_torques(robot, gate.leg, sensed.q[0], ["left_knee_side"], -1.0)
    found = {"walk": [(sensed[k], Estimate(torque[k])) for k in range(start + 30)]}
    exec(code, found)
    assert len(found["alarms"]) > 10
    assert all(point == "left_knee_side" for point, _ in found["alarms"])
    np.testing.assert_allclose([force for _, force in found["alarms"]], FORCE_N)
