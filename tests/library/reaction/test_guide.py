"""The code of docs/reaction.md runs, and answers a hit with steps."""

import re
from pathlib import Path

import numpy as np

from mobnet.core.estimator import Estimate
from mobnet.core.recording import Sensed
from mobnet.detection.chain import make_chain

GUIDE = Path(__file__).parents[3] / "docs" / "reaction.md"
HIT, FORCE_N, THRESHOLD_NM = 150, 80.0, 5.0


def test_the_code_of_the_guide_answers_a_hit_with_steps(layout, leg_watchers):
    (code,) = re.findall(r"^```python\n(.*?)^```$", GUIDE.read_text(), flags=re.DOTALL | re.MULTILINE)
    q, zeros = np.zeros(layout.nq), np.zeros(layout.nu)
    q[3] = 1.0
    command, swing = np.array([0.15, 0.0, 0.0, 0.7, 0.05]), np.array([1.0, 0.0])
    sample = Sensed(q, np.zeros(layout.nv), np.zeros(3), zeros, zeros, swing, command, 0.3 * swing)
    torque = np.zeros((200, layout.nv))
    torque[HIT:, 0] = -FORCE_N
    torque[HIT:, layout.columns(["LL3"])] = 10.0 * THRESHOLD_NM
    planned = []
    exec(code, {
        "walk": [(sample, Estimate(row)) for row in torque],
        "left_leg_detector": leg_watchers["LL"].detector,
        "right_arm_chain": make_chain(15.0, 0.005, 1000.0, np.full((1, 8), THRESHOLD_NM)),
        "plan": planned.append,
    })  # fmt: skip
    (steps,) = planned
    assert steps[1, 0] < 0.0
