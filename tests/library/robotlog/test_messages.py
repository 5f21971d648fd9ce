"""Messages of bags: topics at other rates and with other clocks, joints by name, kinds of messages of one's own."""

import json
import re
from pathlib import Path

import numpy as np
import pytest
from made_logs import IMU, JOINTS, TOPIC, Sample, bag1, bag2, humanoid, states
from mcap.writer import Writer

from mobnet.core.errors import DataError
from mobnet.formats.loading import load_section
from mobnet.formats.log_map import LogMap
from mobnet.robotlog.formats import column_names, read_log
from mobnet.robotlog.observe import converted_log, observe_log

ROWS = 2000
OWN = """std_msgs/Header header
uint32 tick
my_robot/Motor[] motors
================================================================================
MSG: my_robot/Motor
float64 q
float64 dq
float64 tau_est
"""
STATE = "my_robot/msg/State"
NAMED = "my_robot/msg/Joints"
OWN_NAMED = """my_robot/Joint[] joints
================================================================================
MSG: my_robot/Joint
string name
float64 q
float64 dq
float64 tau_est
"""
DYNAMIC = "control_msgs/msg/DynamicJointState"
DYNAMIC_DEFINITIONS = (
    ("control_msgs/msg/InterfaceValue", "string[] interface_names\nfloat64[] values\n"),
    (
        DYNAMIC,
        "std_msgs/Header header\nstring[] joint_names\ncontrol_msgs/InterfaceValue[] interface_values\n",
    ),
)
OWN_FIELDS = {"q": "q", "v": "dq", "tau_motor": "tau_est"}
OWN_MAP = {name: {"columns": [f"/low.motors.*.{field}"]} for name, field in OWN_FIELDS.items()}
APART_MAP = {
    "q": {"columns": ["/motion.position"]},
    "v": {"columns": ["/motion.velocity"]},
    "tau_motor": {"columns": ["/torque.effort"]},
}
JOINT_MAP = {name: {"columns": [f"{TOPIC}.{field}"]} for name, field in (("q", "position"), ("v", "velocity"))}
PAGE = Path("docs/logs.md")
EPOCH_NS = 1_764_000_000_000_000_000  # a day of 2025


@pytest.fixture(scope="module")
def read(arm, settings):
    """Return a function that makes a recording of a log of the arm."""

    def convert(path, mapping=None):
        meaning = None if mapping is None else LogMap.model_validate(mapping)
        return converted_log(path, arm.layout, meaning, settings.robotlog)

    return convert


def apart(samples, topic, fields):
    """Return messages with some of the fields alone, as a topic of their own."""
    return [
        one._replace(topic=topic, fields={"name": one.fields["name"], **{f: one.fields[f] for f in fields}})
        for one in samples
    ]


@pytest.mark.parametrize("write", [bag1, bag2])
def test_joints_are_found_by_name_in_any_order_that_may_change(write, clean, read, tmp_path):
    table = clean[:ROWS]
    turned = [
        one if k % 3 else other
        for k, (one, other) in enumerate(zip(states(table), states(table, JOINTS[::-1]), strict=True))
    ]
    sensed = read(write(turned, tmp_path / ("log.bag" if write is bag1 else "log"))).recording.sensed
    for k, joint in enumerate(JOINTS):
        np.testing.assert_allclose(sensed.q[:, k], table[f"q.{joint}"], atol=1e-12)
        np.testing.assert_allclose(sensed.tau_motor[:, k], table[f"tau_motor.{joint}"], atol=1e-12)


def test_joints_of_other_names_stand_in_the_map_in_the_order_of_the_table(clean, read, tmp_path):
    samples = [one._replace(fields={**one.fields, "name": ["shoulder", "elbow"]}) for one in states(clean[:100])]
    path = bag2(samples, tmp_path / "bag")
    names = {"tau_motor": {"columns": [f"{TOPIC}.effort"]}, **JOINT_MAP, "joints": ["elbow", "shoulder"]}
    np.testing.assert_allclose(read(path, names).recording.sensed.q[:, 0], clean["q.J2"][:100], atol=1e-12)
    with pytest.raises(DataError, match=r"column: '/joint_states\.position' .*: /joint_states\.position\.elbow, "):
        read(path, names | {"joints": None})


def test_two_publishers_of_one_topic_are_joined_by_the_names_of_joints(clean, read, tmp_path):
    """Each arm, say, publishes its own joints in turn."""
    both = [
        one._replace(
            recorded_ns=one.recorded_ns + 250_000 * k, stamp_ns=one.stamp_ns,
            fields={key: [values[k]] for key, values in one.fields.items()},
        )
        for one in states(clean[:ROWS])
        for k in (0, 1)
    ]  # fmt: skip
    found = read(bag2(both, tmp_path / "bag")).recording
    np.testing.assert_allclose(found.sensed.v[:, 1], clean["v.J2"][:ROWS], atol=1e-9)


@pytest.mark.parametrize("storage", ["SQLITE3", "MCAP"])
def test_topics_at_other_rates_come_to_one_clock(storage, clean, read, tmp_path):
    """Torques are published at a fifth of the rate, beginning later; in between they are interpolated."""
    samples = states(clean[:ROWS])
    motion, effort = apart(samples, "/motion", ("position", "velocity")), apart(samples[3::5], "/torque", ("effort",))
    path = bag2([*motion, *effort], tmp_path / "bag", storage)
    found = read(path, APART_MAP)
    assert found.interpolated
    assert found.recording.rate_hz == 1000.0
    assert {len(clock) for clock in found.clocks.values()} == {ROWS, ROWS // 5}
    sensed, first = found.recording.sensed, 3
    np.testing.assert_allclose(sensed.q[:, 0], clean["q.J1"][first : first + len(sensed)], atol=1e-6)
    np.testing.assert_allclose(
        sensed.tau_motor[::5, 1], clean["tau_motor.J2"][first : first + len(sensed) : 5], atol=1e-6
    )


def test_stamps_and_times_of_recording_are_told_apart(clean, read, tmp_path):
    """What is recorded comes late and with jitter, and the map says which clock counts."""
    jitter = np.random.default_rng(0).integers(0, 700_000, ROWS).tolist()
    late = [
        one._replace(recorded_ns=one.recorded_ns + add) for one, add in zip(states(clean[:ROWS]), jitter, strict=True)
    ]
    path = bag2(late, tmp_path / "bag")
    stamped = read(path)
    assert (stamped.interpolated, stamped.hints) == (False, ())
    columns = {"tau_motor": {"columns": [f"{TOPIC}.effort"]}, **JOINT_MAP}
    assert read(path, {**columns, "clock": {"stamp": "recorded"}}).interpolated


def test_zero_stamps_are_named_and_not_used(clean, read, tmp_path):
    found = read(bag2(states(clean[:ROWS], stamp=lambda ns: 0), tmp_path / "bag"))
    assert found.hints == (f"stamps of {TOPIC}: zero; the times of recording are taken instead",)
    assert found.recording.rate_hz == 1000.0


def test_clocks_that_are_apart_or_drift_are_named(clean, read, tmp_path):
    """The torques' computer is 0.35 s behind; that of the motion runs away by a hundredth."""
    samples = states(clean[:ROWS])
    motion = apart(samples, "/motion", ("position", "velocity"))
    effort = [
        one._replace(stamp_ns=max(one.stamp_ns - 350_000_000, 1)) for one in apart(samples, "/torque", ("effort",))
    ]
    path = bag2([*motion, *effort[400:]], tmp_path / "bag")
    (hint,) = read(path, APART_MAP).hints
    assert hint.startswith("stamps of /torque: 0.35 s before the recording, those of /motion 3.7e-08 s: another clock")
    found = read(path, APART_MAP | {"clock": {"stamp": "recorded"}})
    assert found.hints == ()
    np.testing.assert_allclose(found.recording.sensed.tau_motor[:, 0], clean["tau_motor.J1"][400:ROWS], atol=1e-4)
    fast = [one._replace(stamp_ns=one.stamp_ns + (one.stamp_ns // 50)) for one in samples]
    (hint,) = read(bag2(fast, tmp_path / "fast")).hints
    assert "against the recording they drift by -0.03" in hint


def test_stamps_that_begin_anew_end_a_segment_as_times_of_a_table_do(clean, read, tmp_path):
    """A simulation that was reset, to a time at which no sample was taken before."""
    table = clean[:ROWS]
    samples = states(table, stamp=lambda ns: ns if ns < 10**9 else ns - 700_300_000)
    found = read(bag2(samples, tmp_path / "bag"))
    assert found.recording.segments == ((0, 1000), (1000, ROWS))
    np.testing.assert_allclose(found.recording.sensed.q[:, 1], table["q.J2"], atol=1e-12)
    (hint,) = found.hints
    assert hint.startswith(
        f"stamps of {TOPIC}: begin anew in message 1000, as in a simulation that was reset: they count"
    )
    columns = {"tau_motor": {"columns": [f"{TOPIC}.effort"]}, **JOINT_MAP}
    recorded = read(tmp_path / "bag", {**columns, "clock": {"stamp": "recorded"}})
    assert recorded.hints == ()
    assert recorded.recording.segments == ((0, ROWS),)


@pytest.mark.parametrize("restarted", [("/motion", "/torque"), ("/torque",)])
def test_topics_stay_together_where_the_stamps_of_some_begin_anew(restarted, clean, read, tmp_path):
    """A simulation that was reset twice, or a driver of the torques alone, whose messages are late by 2 to 6 ms."""
    table = clean[:ROWS]
    samples = states(table)
    motion, effort = apart(samples, "/motion", ("position", "velocity")), apart(samples[::5], "/torque", ("effort",))
    late = np.random.default_rng(0).integers(2_000_000, 6_000_000, len(effort)).tolist()
    messages = [*motion, *(one._replace(recorded_ns=one.stamp_ns + add) for one, add in zip(effort, late, strict=True))]
    for k, one in enumerate(messages):
        back = sum(one.stamp_ns >= start for start in (700_000_000, 1_300_000_000)) if one.topic in restarted else 0
        messages[k] = one._replace(stamp_ns=one.stamp_ns - 600_000_000 * back)
    found = read(bag2(messages, tmp_path / "bag"), APART_MAP)
    first = {"/motion": 700, "/torque": 140}
    hints = [f"stamps of {topic}: begin anew in message {first[topic]} and 1 more" for topic in restarted]
    assert [hint.partition(",")[0] for hint in found.hints] == hints
    assert len(found.recording.segments) == 3
    sensed = found.recording.sensed
    for k, (start, end) in enumerate(found.recording.segments):
        pauses = 0.05 * k  # ten intervals of the slower topic
        rows = np.round(1e3 * (found.time_s[start:end] - pauses)).astype(int)
        assert 560 <= len(rows) <= 705
        np.testing.assert_allclose(sensed.q[start:end, 0], table["q.J1"][rows], atol=1e-3)
        np.testing.assert_allclose(sensed.tau_motor[start:end, 0], table["tau_motor.J1"][rows], atol=0.3)


def test_clocks_that_never_meet_are_one_line(clean, read, tmp_path):
    """Headers of one topic count from the start of a computer, those of the other since 1970."""
    samples = states(clean[:100])
    motion = [
        one._replace(stamp_ns=one.stamp_ns + EPOCH_NS) for one in apart(samples, "/motion", ("position", "velocity"))
    ]
    path = bag2([*motion, *apart(samples, "/torque", ("effort",))], tmp_path / "bag")
    with pytest.raises(
        DataError, match=r"clock: q begins at .* s and tau_motor ends at .*`clock: \{stamp: recorded\}`$"
    ):
        read(path, APART_MAP)


def test_a_topic_with_a_single_message_is_one_line(clean, read, tmp_path):
    samples = states(clean[:100])
    motion, effort = apart(samples, "/motion", ("position", "velocity")), apart(samples[5:6], "/torque", ("effort",))
    path = bag2([*motion, *effort], tmp_path / "bag")
    with pytest.raises(DataError, match=r"/torque: 1 message with /torque\.effort\.J1; accepted: two or more"):
        read(path, APART_MAP)


def test_messages_out_of_order_and_twice_are_put_in_order(clean, read, tmp_path):
    samples = states(clean[:ROWS])
    samples[10], samples[11] = (
        samples[k]._replace(recorded_ns=samples[j].recorded_ns) for k, j in ((11, 10), (10, 11))
    )
    found = read(bag2([*samples, samples[50]._replace(recorded_ns=samples[50].recorded_ns + 1)], tmp_path / "bag"))
    assert found.hints == (f"stamps of {TOPIC}: 2 of {ROWS + 1} are not after the one before",)
    np.testing.assert_allclose(found.recording.sensed.q[:, 0], clean["q.J1"][:ROWS], atol=1e-12)


@pytest.mark.parametrize("storage", ["SQLITE3", "MCAP"])
def test_kinds_of_messages_of_ones_own_are_read_by_their_definition_in_the_bag(storage, clean, arm, settings, tmp_path):
    samples = [
        one._replace(
            topic="/low", kind=STATE,
            fields={"tick": k, "motors": [
                dict(zip(("q", "dq", "tau_est"), values, strict=True))
                for values in zip(*(one.fields[field] for field in ("position", "velocity", "effort")), strict=True)
            ]},
        )
        for k, one in enumerate(states(clean[:ROWS]))
    ]  # fmt: skip
    path = bag2(samples, tmp_path / "bag", storage, [(STATE, OWN)])
    assert "/low.motors.1.tau_est" in column_names(path)
    found = observe_log(path, arm, LogMap.model_validate(OWN_MAP), "sample", 100.0, 9.81, settings.robotlog)
    np.testing.assert_allclose(found.converted.recording.sensed.v[:, 1], clean["v.J2"][:ROWS], atol=1e-12)


@pytest.mark.parametrize("storage", ["JSON", "SQLITE3"])
def test_objects_in_a_list_are_found_by_their_own_names_in_any_order_that_may_change(storage, clean, read, tmp_path):
    """As Foxglove's JointStates has them; one message lacks a joint."""
    states_of = []
    for k, row in enumerate(clean[:200].to_dict("records")):
        joints = [
            {"name": j, "q": row[f"q.{j}"], "dq": row[f"v.{j}"], "tau_est": row[f"tau_motor.{j}"]} for j in JOINTS
        ]
        states_of.append({"joints": joints[::-1] if k % 3 else joints[: 1 if k == 50 else 2]})
    if storage == "JSON":
        path = as_json(states_of, tmp_path / "log.mcap")
    else:
        path = bag2([Sample("/low", NAMED, k * 10**6, k * 10**6, one) for k, one in enumerate(states_of)],
                    tmp_path / "bag", storage, [(NAMED, OWN_NAMED)])  # fmt: skip
    mapping = {name: {"columns": [f"/low.joints.*.{field}"]} for name, field in OWN_FIELDS.items()}
    sensed = read(path, mapping).recording.sensed
    assert len(sensed) == 200
    for k, joint in enumerate(JOINTS):
        np.testing.assert_allclose(sensed.q[51:, k], clean[f"q.{joint}"][51:200], atol=1e-6)
        np.testing.assert_allclose(sensed.tau_motor[:50, k], clean[f"tau_motor.{joint}"][:50], atol=1e-6)
    names = {"columns": [f"/low.joints.{joint}.q" for joint in JOINTS]}
    assert len(read(path, {**mapping, "q": names}).recording.sensed) == 200


def dynamic_states(table):
    """Return the DynamicJointStates of ros2_control, with joints and interfaces in an order that changes."""
    interfaces = {"position": "q", "velocity": "v", "effort": "tau_motor"}
    samples = []
    for k, row in enumerate(table.to_dict("records")):
        joints = JOINTS[::-1] if k % 3 else JOINTS
        kinds = [*interfaces][:: -1 if k % 4 else 1]
        values = [
            {"interface_names": kinds, "values": [row[f"{interfaces[kind]}.{j}"] for kind in kinds]} for j in joints
        ]
        fields = {"joint_names": list(joints), "interface_values": values}
        samples.append(Sample("/dynamic_joint_states", DYNAMIC, k * 10**6, k * 10**6, fields))
    return samples


@pytest.mark.parametrize("joints", [JOINTS, ("shoulder", "elbow")])
def test_objects_in_a_list_are_found_by_the_names_beside_it(joints, clean, read, tmp_path):
    samples = dynamic_states(clean[:200])
    for sample in samples:
        sample.fields["joint_names"] = [joints[JOINTS.index(name)] for name in sample.fields["joint_names"]]
    path = bag2(samples, tmp_path / "bag", "MCAP", DYNAMIC_DEFINITIONS)
    mapping = {
        signal: {"columns": [f"/dynamic_joint_states.interface_values.*.values.{field}"]}
        for signal, field in (("q", "position"), ("v", "velocity"), ("tau_motor", "effort"))
    }
    if joints != JOINTS:
        # By number, which is how the list would be read without its names, joints would be exchanged.
        with pytest.raises(DataError, match=r"column: .* is not accepted; accepted: .*interface_values\.elbow\.values"):
            read(path, mapping)
        mapping["joints"] = list(joints)
    sensed = read(path, mapping).recording.sensed
    for k, joint in enumerate(JOINTS):
        np.testing.assert_allclose(sensed.q[:, k], clean[f"q.{joint}"][:200], atol=1e-12)
        np.testing.assert_allclose(sensed.tau_motor[:, k], clean[f"tau_motor.{joint}"][:200], atol=1e-12)


def as_json(contents, path):
    """Write objects as messages of a topic /low, one each millisecond."""
    with path.open("wb") as file:
        writer = Writer(file)
        writer.start()
        channel = writer.register_channel("/low", "json", writer.register_schema("state", "jsonschema", b"{}"))
        for k, content in enumerate(contents):
            writer.add_message(channel, k * 10**6, json.dumps(content).encode(), k * 10**6)
        writer.finish()
    return path


def test_messages_that_cannot_be_decoded_are_named(tmp_path):
    with (tmp_path / "log.mcap").open("wb") as file:
        writer = Writer(file)
        writer.start()
        channel = writer.register_channel("/low", "protobuf", writer.register_schema("state", "protobuf", b"x"))
        writer.add_message(channel, 0, b"\x08\x01", 0)
        writer.finish()
    with pytest.raises(
        DataError, match=r"cannot be decoded: /low \(protobuf\); accepted: messages in cdr, json, ros1$"
    ):
        column_names(tmp_path / "log.mcap")


@pytest.mark.parametrize("storage", ["SQLITE3", "MCAP"])
def test_a_bag_without_its_metadata_and_a_file_of_it_alone_are_read(storage, clean, read, tmp_path):
    path = bag2(states(clean[:200]), tmp_path / "bag", storage)
    (path / "metadata.yaml").unlink()
    (file,) = path.iterdir()
    for log in (path, file):
        np.testing.assert_allclose(read(log).recording.sensed.q[:, 1], clean["q.J2"][:200], atol=1e-12)


def test_numbers_that_are_nan_in_messages_are_named_and_left_out(clean, read, tmp_path):
    nothing = [float("nan")] * 2
    samples = [one._replace(fields={**one.fields, "effort": nothing}) if k == 7 else one for k, one in
               enumerate(states(clean[:200]))]  # fmt: skip
    found = read(bag2(samples, tmp_path / "bag"))
    assert found.hints == (
        f"no number in 1 of 200 rows of {TOPIC}.effort.J1, {TOPIC}.effort.J2: each signal is taken on the rows that "
        "it has",
    )
    assert len(found.recording.sensed) == 200


def without(samples, field):
    return [one._replace(fields={**one.fields, field: []}) for one in samples]


def renamed(samples, names):
    return [one._replace(fields={**one.fields, "name": names}) for one in samples]


def only_first(samples):
    return [one._replace(fields={key: values[:1] for key, values in one.fields.items()}) for one in samples]


@pytest.mark.parametrize(
    ("spoil", "message"),
    [
        (lambda s: without(s, "effort"), "/joint_states: effort is empty; accepted: position, velocity and effort of"),
        (only_first, "/joint_states: position has J1, and not J2; accepted: all joints of the robot, or `joints` of a"),
        (lambda s: renamed(s, ["a", "b"]), "/joint_states: position has a, b, and not J1, J2; accepted: all joints"),
        (
            lambda s: [*s, *(one._replace(topic="/arm/states") for one in s)],
            "/arm/states and /joint_states have all joints of the robot; accepted: a --map that names one, such",
        ),
        (lambda s: [one._replace(topic="/low", kind=IMU) for one in s], "has no column q.J1 or the like; accepted: a"),
    ],
    ids=["no effort", "a joint is missing", "other names", "two topics", "no joint states"],
)  # fmt: skip
def test_a_bag_that_needs_a_map_is_one_line_that_says_why(spoil, message, clean, read, tmp_path):
    path = bag2(spoil(states(clean[:20])), tmp_path / "bag")
    with pytest.raises(DataError, match=rf"^{path}: {message}.*$") as error:
        read(path)
    assert "\n" not in str(error.value)


def test_a_message_that_lacks_a_field_is_one_line(tmp_path):
    samples = [Sample("/low", STATE, k, k, {"motors": [{"q": 1.0}] * (2 - k // 5)}) for k in range(1, 8)]
    path = bag2(samples, tmp_path / "bag", definitions=[(STATE, OWN)])
    with pytest.raises(DataError, match=r"/low\.motors\.1\.q: message 5: .* one with /low\.motors\.1\.q, as one"):
        read_log(path, ["/low.motors.1.q"])


def test_a_humanoids_topics_become_the_signals_of_its_base_and_feet(layout, settings, tmp_path):
    """A base yawed by 90 degrees, with an IMU at 200 Hz; axes are taken by their names, whatever the map's order."""
    (text,) = re.findall(r"^```yaml\n(clock: {stamp.*?)^```$", PAGE.read_text(), re.DOTALL | re.MULTILINE)
    (tmp_path / "map.yaml").write_text(text.replace("orientation]", "orientation], order: xyzw"))
    path, half = bag2(humanoid(layout), tmp_path / "bag"), np.sqrt(0.5)
    found = converted_log(path, layout, load_section(tmp_path / "map.yaml", LogMap), settings.robotlog)
    sensed = found.recording.sensed
    np.testing.assert_allclose(sensed.q[7, 7:], np.arange(layout.nu) + 7e-3, atol=1e-9)
    np.testing.assert_allclose(sensed.q[:, 3:7], np.tile([half, 0, 0, half], (len(sensed), 1)), atol=1e-12)
    np.testing.assert_allclose(sensed.v[3, :6], [0.0, 1.0, 0.0, 0.0, 0.0, 0.5], atol=1e-12)
    np.testing.assert_allclose(sensed.acc_base_in_base[0], [0.0, 0.0, 9.80665])
    np.testing.assert_allclose(found.wrenches["left"][0], [1, 2, 3, 4, 5, 6])


def test_a_wrong_name_is_one_line_with_the_names_that_are_like_it(clean, read, tmp_path):
    path = bag2(states(clean[:10]), tmp_path / "bag")
    wrong = {**JOINT_MAP, "tau_motor": {"columns": ["/joint_state.effort.J1", "/joint_states.effort.J2"]}}
    with pytest.raises(
        DataError, match=r"bag: column: '/joint_state\.effort\.J1' is not accepted; accepted: /joint_states\.effort\.J1"
    ):
        read(path, wrong)
    with pytest.raises(DataError, match=r"tau_motor\.sign: number: 3 is not accepted; accepted: 1, 2"):
        read(path, {**JOINT_MAP, "tau_motor": {"columns": [f"{TOPIC}.effort"], "sign": [1, 1, 1]}})
