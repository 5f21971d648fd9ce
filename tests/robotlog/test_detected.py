"""Thresholds of a leg that is watched in its swings, on logs that do not say when it swings and on other limbs."""

import pytest
from made_logs import bag2, humanoid

from mobnet.core.errors import DataError
from mobnet.robotlog.detected import detect_log
from mobnet.settings.limb_thresholds import LimbThresholds
from mobnet.settings.robotlog import LogMap

JOINTS = {name: {"columns": [f"/joint_states.{field}"]} for name, field in (("q", "position"), ("v", "velocity"))}
MAP = {
    **JOINTS,
    "tau_motor": {"columns": ["/joint_states.effort"]},
    "quaternion": {"columns": ["/imu/data.orientation"]},
    "velocity": {"columns": ["/odom.twist.twist.linear"]},
    "omega": {"columns": ["/imu/data.angular_velocity"]},
    "acc": {"columns": ["/imu/data.linear_acceleration"]},
}


@pytest.mark.parametrize(("limb", "message"), [
    ("LL", "swing, landing: missing in the log or its map; accepted: a log with them, as LL is watched in its swings"),
    ("LA", "thresholds of LA: watched: 'swing' is not accepted; accepted: always"),
])  # fmt: skip
def test_swings_that_a_log_does_not_tell_are_one_line_and_not_a_log_without_flags(
    limb, message, robot, layout, settings, tmp_path
):
    joints = layout.limb(limb)
    found = LimbThresholds(
        robot=robot.name, limb=limb, joints=joints, method="MOB", signal="mean", thresholds=(5.0,) * len(joints),
        watched="swing", low_pass_hz=15.0, hold_s=0.005, rate_hz=1000.0, gain_hz=100.0, torque="sample",
        rate_per_h=1.0, expected_per_h=1.0, low_per_h=0.5, high_per_h=2.0, confidence=0.95,
    )  # fmt: skip
    path = bag2(humanoid(layout), tmp_path / "bag")
    with pytest.raises(DataError, match=message):
        detect_log(path, robot, LogMap.model_validate(MAP), None, found, settings)
