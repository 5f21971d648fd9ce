"""Detection in a log by a file of thresholds: their filters, and swings that a log does not tell."""

import json

import numpy as np
import pytest
from made_logs import bag2, humanoid
from mcap.reader import make_reader
from scipy.signal import lfilter

from mobnet.core.errors import DataError
from mobnet.core.options import detect_parser
from mobnet.core.word_checks import check_detect
from mobnet.formats.limb_thresholds import LimbThresholds
from mobnet.formats.log_map import LogMap
from mobnet.robotlog.detected import detect_log
from mobnet.robotlog.flags_mcap import write_mcap

JOINTS = {name: {"columns": [f"/joint_states.{field}"]} for name, field in (("q", "position"), ("v", "velocity"))}
MAP = {
    **JOINTS,
    "tau_motor": {"columns": ["/joint_states.effort"]},
    "quaternion": {"columns": ["/imu/data.orientation"]},
    "velocity": {"columns": ["/odom.twist.twist.linear"]},
    "omega": {"columns": ["/imu/data.angular_velocity"]},
    "acc": {"columns": ["/imu/data.linear_acceleration"]},
}


def thresholds(robot, limb, **changes):
    joints = robot.layout.limb(limb)
    row = {
        "robot": robot.name, "limb": limb, "joints": joints, "method": "MOB", "signal": "mean",
        "thresholds": [5.0] * len(joints), "watched": "always", "low_pass_hz": 15.0, "hold_s": 0.005,
        "rate_hz": 1000.0, "gain_hz": 100.0, "torque": "sample", "rate_per_h": 1.0, "expected_per_h": 1.0,
        "low_per_h": 0.5, "high_per_h": 2.0, "confidence": 0.95,
    }  # fmt: skip
    return LimbThresholds.model_validate(row | changes)


def test_filters_are_those_of_the_thresholds_and_not_of_configs(clean, stored, arm, settings):
    low_pass_hz = 0.2 * settings.detection.low_pass_hz
    found = thresholds(arm, "A", low_pass_hz=low_pass_hz)
    made = detect_log(stored(clean[:2000]), arm, None, None, found, settings)
    pole = np.exp(-2.0 * np.pi * low_pass_hz / 1000.0)
    expected = lfilter([1.0 - pole], [1.0, -pole], made.estimate.tau_ext.astype(np.float64), axis=0)
    np.testing.assert_allclose(made.watched, expected, atol=1e-9)


@pytest.mark.parametrize(("limb", "message"), [
    ("LL", "swing, landing: missing in the log or its map; accepted: a log with them, as LL is watched in its swings"),
    ("LA", "thresholds of LA: watched: 'swing' is not accepted; accepted: always"),
])  # fmt: skip
def test_swings_that_a_log_does_not_tell_are_one_line_and_not_a_log_without_flags(
    limb, message, robot, layout, settings, tmp_path
):
    found = thresholds(robot, limb, watched="swing")
    path = bag2(humanoid(layout), tmp_path / "bag")
    with pytest.raises(DataError, match=message):
        detect_log(path, robot, LogMap.model_validate(MAP), None, found, settings)


def test_an_mcap_file_holds_torques_and_flags_at_the_times_of_the_log(clean, stored, arm, settings, tmp_path):
    found = thresholds(arm, "A", thresholds=[0.5] * len(arm.layout.limb("A")))
    made = detect_log(stored(clean[:2000]), arm, None, None, found, settings)
    assert made.flags
    write_mcap(made, found, arm.layout.columns(found.joints), tmp_path / "new.mcap")
    read = {"/torques": [], "/flags": [], "/log": []}
    with (tmp_path / "new.mcap").open("rb") as file:
        for schema, channel, message in make_reader(file).iter_messages():
            content = json.loads(message.data)
            assert (schema.encoding, channel.message_encoding) == ("jsonschema", "json")
            assert content.keys() <= json.loads(schema.data)["properties"].keys()
            read[channel.topic].append((schema.name, message.log_time / 1e9, content))
    times = [stamp for _, stamp, _ in read["/torques"]]
    np.testing.assert_allclose(times, made.observed.converted.time_s, atol=1e-8)
    for name, signal in (("tau_ext", made.estimate.tau_ext), ("residual", made.observed.residual)):
        told = [list(content[name].values()) for _, _, content in read["/torques"]]
        np.testing.assert_allclose(told, signal, atol=1e-5)
    ratios = np.array([max(content["ratio"].values()) for _, _, content in read["/torques"]])
    np.testing.assert_allclose(ratios, np.abs(made.watched).max(axis=1) / 0.5, atol=1e-5)
    for flag, (_, stamp, content), (schema, logged, line) in zip(made.flags, read["/flags"], read["/log"], strict=True):
        assert stamp == logged == pytest.approx(flag.start_s, abs=1e-8)
        assert (content["joint"], content["ratio"]) == (flag.joint, flag.ratio)
        within = (times >= np.float64(flag.start_s)) & (times <= np.float64(flag.end_s))
        assert ratios[within].max() >= flag.ratio - 1e-5  # which a signal has to hold for some samples
        assert (schema, line["timestamp"]["sec"]) == ("foxglove.Log", int(flag.start_s))
        assert line["message"].startswith(f"{flag.joint} at ")


def test_a_wrench_is_not_written_to_an_mcap_file():
    words = ["new.csv", "--thresholds", "limb.yaml", "--out", "new.mcap", "--wrench", "hand"]
    with pytest.raises(DataError, match=r"^--wrench: is not written to new\.mcap; accepted: a folder as --out$"):
        check_detect(detect_parser().parse_args(words))
