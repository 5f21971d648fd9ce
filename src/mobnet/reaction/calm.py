"""Thresholds by the paper's rule from a walk that nothing pushes: of limbs with hands, and of the feet's sensors.

[5.3] Thresholds are larger than the largest signal in normal walking by a margin. Here that is random walking: arms
swing with every step, and what their networks do not know of it is larger than in place.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from mobnet.core.arrays import Array
from mobnet.core.estimator import Estimator
from mobnet.core.recording import Recording
from mobnet.detection.watch import LegSetup


def limb_thresholds(setup: LegSetup, walk: Recording, estimator: Estimator, joints: Sequence[str]) -> Array:
    """Return thresholds of the estimated torque of joints (1, n) [N m], all of which the estimator estimates."""
    held, largest = [estimator.joints.index(joint) for joint in joints], np.zeros(len(joints))
    for span in walk.spans():
        tau = np.ascontiguousarray(estimator.estimate(walk.sensed[span]).tau_ext[:, held], dtype=np.float64)
        largest = np.maximum(largest, np.abs(setup.low_passed(tau, ((0, len(tau)),))).max(axis=0))
    return setup.detection.thresholds.margin * largest[None]


def foot_threshold(setup: LegSetup, walk: Recording) -> Array:
    """Return the threshold of the force on a foot in its swing (1, 1) [N], by its sensor."""
    # Without a torque the gate knows no early contact, so that the truth says where the foot is on the ground.
    nothing = np.zeros((len(walk.sensed), len(setup.joints)))
    watched = setup.gate.watch(walk, nothing).watched & (walk.truth.contact[:, setup.gate.foot] == 0)
    wrench = (walk.truth.wrench_left_foot, walk.truth.wrench_right_foot)[setup.gate.foot]
    force = setup.low_passed(np.ascontiguousarray(wrench[:, :3], dtype=np.float64), walk.segments)
    return np.array([[setup.detection.thresholds.margin * np.linalg.norm(force, axis=1)[watched].max()]])


def first_part(walk: Recording, samples: int) -> Recording:
    """Return the first samples of a recording."""
    segments = tuple((start, min(end, samples)) for start, end in walk.segments if start < samples)
    return replace(walk, sensed=walk.sensed[:samples], truth=walk.truth[:samples], segments=segments)
