"""Logs of robots in every format that `./reproduce observe` reads, written by other packages than those that read them
where there are such."""

import json
from pathlib import Path
from typing import NamedTuple

import numpy as np

JOINTS = ("J1", "J2")
SIGNALS = {"q": "position", "v": "velocity", "tau_motor": "effort"}  # and the fields of a JointState
TOPIC = "/joint_states"
CHUNK_BYTES = 10_000  # of messages that are compressed together
LATE_NS = 37  # of the recording after the stamp
STATE, IMU, WRENCH = "sensor_msgs/msg/JointState", "sensor_msgs/msg/Imu", "geometry_msgs/msg/WrenchStamped"
JOINT_STATE = """std_msgs/Header header
string[] name
float64[] position
float64[] velocity
float64[] effort
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"""


class Sample(NamedTuple):
    """A message: the time of its recording and the stamp of its header [ns], and its fields by name."""

    topic: str
    kind: str
    recorded_ns: int
    stamp_ns: int
    fields: dict


def states(table, order=JOINTS, late_ns=LATE_NS, stamp=lambda ns: ns):
    """Return a JointState for each row of a table, with the joints in some order."""
    found = []
    for row in table.to_dict("records"):
        ns = round(row["time"] * 1e9)
        fields = {field: [row[f"{signal}.{joint}"] for joint in order] for signal, field in SIGNALS.items()}
        found.append(Sample(TOPIC, STATE, ns + late_ns, stamp(ns), {"name": list(order), **fields}))
    return found


def humanoid(layout):
    """Return 0.4 s of a humanoid's topics, joints in the reverse order of its table, with an IMU at 200 Hz.

    Joint k stands at k rad and 1 mrad more in each sample; the base is yawed by 90 degrees and goes ahead.
    """
    half, names, samples = np.sqrt(0.5), list(reversed(layout.actuated)), []
    wrench = {"force": {"x": 1.0, "y": 2.0, "z": 3.0}, "torque": {"x": 4.0, "y": 5.0, "z": 6.0}}
    imu = {
        "orientation": {"w": half, "x": 0.0, "y": 0.0, "z": half},
        "angular_velocity": {"z": 0.5},
        "linear_acceleration": {"z": 9.80665},
    }
    odometry = {"twist": {"twist": {"linear": {"x": 1.0}}}}
    for k in range(400):
        ns = k * 1_000_000
        numbers = [layout.actuated.index(name) + 1e-3 * k for name in names]
        fields = {"name": names, "position": numbers, "velocity": [1.0] * len(names), "effort": numbers}
        samples.append(Sample(TOPIC, STATE, ns, ns, fields))
        samples += [Sample(topic, WRENCH, ns, ns, {"wrench": wrench}) for topic in ("/left_foot", "/right_foot")]
        if k % 5 == 0:
            samples.append(Sample("/imu/data", IMU, ns, ns, imu))
            samples.append(Sample("/odom", "nav_msgs/msg/Odometry", ns, ns, odometry))
    return samples


def as_csv(table, folder):
    table.to_csv(folder / "log.csv", index=False)
    return folder / "log.csv"


def as_parquet(table, folder):
    table.to_parquet(folder / "log.parquet")
    return folder / "log.parquet"


def as_hdf5(table, folder):
    import h5py

    with h5py.File(folder / "log.h5", "w") as file:
        file["clock/t"] = table["time"]
        for name in SIGNALS:
            file[f"arm/{name}"] = table[[f"{name}.{joint}" for joint in JOINTS]].to_numpy()
        file["note"] = "a text is left out"
    return folder / "log.h5"


def as_mcap(table, folder):
    from mcap_ros2.writer import Writer

    with (folder / "log.mcap").open("wb") as file, Writer(file, chunk_size=CHUNK_BYTES) as writer:
        schema = writer.register_msgdef(STATE, JOINT_STATE)
        for k, one in enumerate(states(table)):
            stamp = {"sec": one.stamp_ns // 10**9, "nanosec": one.stamp_ns % 10**9}
            content = {"header": {"stamp": stamp, "frame_id": ""}, **one.fields}
            ns = one.recorded_ns
            writer.write_message(TOPIC, schema, content, log_time=ns, publish_time=ns, sequence=k)
    return folder / "log.mcap"


def as_json_mcap(table, folder):
    from mcap.writer import Writer

    with (folder / "json.mcap").open("wb") as file:
        writer = Writer(file, chunk_size=CHUNK_BYTES)
        writer.start()
        schema = writer.register_schema("state", "jsonschema", b"{}")
        channel = writer.register_channel(TOPIC, "json", schema)
        for one in states(table):
            writer.add_message(channel, one.stamp_ns, json.dumps(one.fields).encode(), one.stamp_ns)
        writer.finish()
    return folder / "json.mcap"


def as_ros1_mcap(table, folder):
    from mcap.writer import Writer
    from rosbags.typesys import Stores, get_typestore

    types = get_typestore(Stores.ROS1_NOETIC)
    with (folder / "ros1.mcap").open("wb") as file:
        writer = Writer(file)
        writer.start(profile="ros1")
        text = types.generate_msgdef(STATE)[0]
        channel = writer.register_channel(
            TOPIC, "ros1", writer.register_schema("sensor_msgs/JointState", "ros1msg", text.encode())
        )
        for one in states(table):
            message = _message(types, STATE, one.fields, one.stamp_ns)
            writer.add_message(channel, one.recorded_ns, bytes(types.serialize_ros1(message, STATE)), one.recorded_ns)
        writer.finish()
    return folder / "ros1.mcap"


def as_bag1(table, folder):
    return bag1(states(table), folder / "log.bag")


def as_bag2(table, folder):
    return bag2(states(table), folder / "bag2")


def as_bag2_mcap(table, folder):
    return bag2(states(table), folder / "bag2_mcap", "MCAP")


def bag1(samples, path):
    """Write a bag of ROS 1."""
    from rosbags.rosbag1 import Writer
    from rosbags.typesys import Stores, get_typestore

    types = get_typestore(Stores.ROS1_NOETIC)
    return _write(samples, path, Writer(path), types, types.serialize_ros1)


def bag2(samples, path, storage="SQLITE3", definitions=()):
    """Write a folder as `ros2 bag` does, with definitions (name, text) of messages of one's own."""
    from rosbags.rosbag2 import StoragePlugin, Writer
    from rosbags.typesys import Stores, get_types_from_msg, get_typestore

    types = get_typestore(Stores.ROS2_HUMBLE)
    for name, text in definitions:
        types.register(get_types_from_msg(text, name))
    writer = Writer(path, version=9, storage_plugin=StoragePlugin[storage])
    return _write(samples, path, writer, types, types.serialize_cdr)


def _write(samples, path, writer, types, serialize):
    """Write messages, and a topic with a text, which nobody asks for."""
    with writer as bag:
        kinds = {"/note": "std_msgs/msg/String"} | {one.topic: one.kind for one in samples}
        topics = {topic: bag.add_connection(topic, kind, typestore=types) for topic, kind in kinds.items()}
        for one in sorted(samples, key=lambda one: one.recorded_ns):
            message = _message(types, one.kind, one.fields, one.stamp_ns)
            bag.write(topics[one.topic], one.recorded_ns, serialize(message, one.kind))
        text = types.types["std_msgs/msg/String"](data="hello")
        bag.write(topics["/note"], samples[0].recorded_ns, serialize(text, "std_msgs/msg/String"))
    return Path(path)


def _message(types, kind, fields, stamp_ns):
    """Return a message of a kind; numbers that are not given are zero, and its header has the stamp."""
    if kind.endswith("/Time"):
        return types.types[kind](sec=stamp_ns // 10**9, nanosec=stamp_ns % 10**9)
    values = {}
    for name, (node, about) in types.fielddefs[kind][1]:
        given = fields.get(name)
        if node.name == "NAME":
            values[name] = _message(types, about, given or {}, stamp_ns)
        elif node.name == "BASE":
            values[name] = given if given is not None else ("" if about[0] == "string" else 0)
        elif about[0][0].name == "NAME":
            values[name] = [_message(types, about[0][1], item, stamp_ns) for item in given or ()]
        elif about[0][1][0] == "string":
            values[name] = list(given or ())
        else:
            values[name] = np.array(given if given is not None else [0.0] * about[1], dtype=about[0][1][0])
    return types.types[kind](**values)
