"""One recording in every format gives one residual."""

import builtins
import json
from pathlib import Path

import numpy as np
import pytest

from mobnet.core.errors import DataError
from mobnet.robotlog.formats import read_log
from mobnet.robotlog.observe import observe_log
from mobnet.settings.robotlog import LogMap

JOINTS = ("J1", "J2")
ROWS = 1500
TOPIC = "/joint_states"
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


def ticks(table):
    """Yield time [ns] and positions, velocities and torques (2,) of each row."""
    for row in table.to_dict("records"):
        signals = ([row[f"{name}.{joint}"] for joint in JOINTS] for name in ("q", "v", "tau_motor"))
        yield round(row["time"] * 1e9), *signals


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
        for name in ("q", "v", "tau_motor"):
            file[f"arm/{name}"] = table[[f"{name}.{joint}" for joint in JOINTS]].to_numpy()
        file["note"] = "a text is left out"
    return folder / "log.h5"


def as_mcap(table, folder):
    from mcap_ros2.writer import Writer

    with (folder / "log.mcap").open("wb") as file, Writer(file) as writer:
        schema = writer.register_msgdef("sensor_msgs/msg/JointState", JOINT_STATE)
        for k, (ns, q, v, tau) in enumerate(ticks(table)):
            stamp = {"sec": ns // 10**9, "nanosec": ns % 10**9}
            content = {"header": {"stamp": stamp, "frame_id": ""}, "name": list(JOINTS)}
            content |= {"position": q, "velocity": v, "effort": tau}
            writer.write_message(TOPIC, schema, content, log_time=ns + 37, publish_time=ns + 37, sequence=k)
    return folder / "log.mcap"


def as_json_mcap(table, folder):
    from mcap.writer import Writer

    with (folder / "json.mcap").open("wb") as file:
        writer = Writer(file)
        writer.start()
        schema = writer.register_schema("state", "jsonschema", b"{}")
        channel = writer.register_channel(TOPIC, "json", schema)
        for ns, q, v, tau in ticks(table):
            content = json.dumps({"name": list(JOINTS), "position": q, "velocity": v, "effort": tau}).encode()
            writer.add_message(channel, ns, content, ns)
        writer.finish()
    return folder / "json.mcap"


def as_rosbag(table, path, writer, store):
    """Write a bag of ROS 1 or 2 with joint states, and a topic of another kind, which nobody asks for."""
    from rosbags.typesys import get_typestore

    types = get_typestore(store)
    kinds = types.types
    serialize = types.serialize_ros1 if "ROS1" in store.name else types.serialize_cdr
    with writer as bag:
        states = bag.add_connection(TOPIC, "sensor_msgs/msg/JointState", typestore=types)
        texts = bag.add_connection("/note", "std_msgs/msg/String", typestore=types)
        for k, (ns, q, v, tau) in enumerate(ticks(table)):
            stamp = kinds["builtin_interfaces/msg/Time"](sec=ns // 10**9, nanosec=ns % 10**9)
            number = {"seq": k} if "ROS1" in store.name else {}
            header = kinds["std_msgs/msg/Header"](stamp=stamp, frame_id="", **number)
            arrays = (np.array(x) for x in (q, v, tau))
            state = kinds["sensor_msgs/msg/JointState"](header, list(JOINTS), *arrays)
            bag.write(states, ns + 37, serialize(state, "sensor_msgs/msg/JointState"))
        text = kinds["std_msgs/msg/String"](data="hello")
        bag.write(texts, 0, serialize(text, "std_msgs/msg/String"))
    return path


def as_bag1(table, folder):
    from rosbags.rosbag1 import Writer
    from rosbags.typesys import Stores

    return as_rosbag(table, folder / "log.bag", Writer(folder / "log.bag"), Stores.ROS1_NOETIC)


def as_bag2(table, folder):
    from rosbags.rosbag2 import Writer
    from rosbags.typesys import Stores

    return as_rosbag(table, folder / "bag2", Writer(folder / "bag2", version=9), Stores.ROS2_HUMBLE)


PLAIN = {name: [f"{name}.{joint}" for joint in JOINTS] for name in ("q", "v", "tau_motor")}
ROS = {
    name: [f"{TOPIC}.{field}.{joint}" for joint in JOINTS]
    for name, field in (("q", "position"), ("v", "velocity"), ("tau_motor", "effort"))
}
FORMATS = {
    as_csv: PLAIN,
    as_parquet: PLAIN,
    as_hdf5: {name: [f"arm/{name}.{k}" for k in (0, 1)] for name in PLAIN},
    as_mcap: ROS,
    as_json_mcap: ROS,
    as_bag1: ROS,
    as_bag2: ROS,
}


def mapping(columns, **more):
    """Return the map of a log with such columns."""
    return LogMap.model_validate({name: {"columns": tuple(own)} for name, own in columns.items()} | more)


@pytest.fixture(scope="module")
def reference(clean, arm, settings, tmp_path_factory):
    path = as_csv(clean[:ROWS], tmp_path_factory.mktemp("csv"))
    return observe_log(path, arm, mapping(PLAIN), None, 100.0, 9.81, settings.robotlog).residual


@pytest.mark.parametrize("write", FORMATS, ids=lambda write: write.__name__)
def test_every_format_gives_the_residual_of_the_csv(write, clean, arm, settings, reference, tmp_path):
    more = {"clock": {"column": "clock/t"}} if write is as_hdf5 else {}
    path = write(clean[:ROWS], tmp_path)
    found = observe_log(path, arm, mapping(FORMATS[write], **more), None, 100.0, 9.81, settings.robotlog)
    assert not found.converted.interpolated
    np.testing.assert_allclose(found.residual, reference, atol=1e-6)


def test_a_missing_reader_is_one_line_that_names_its_package(tmp_path, monkeypatch):
    (tmp_path / "log.h5").write_bytes(b"")
    original = builtins.__import__

    def refuse(name, *arguments, **keywords):
        if name.startswith("h5py"):
            raise ImportError(name)
        return original(name, *arguments, **keywords)

    monkeypatch.setattr("importlib.import_module", lambda name: refuse(name))
    with pytest.raises(DataError, match=r"log\.h5: needs the package h5py; install it: \.venv/bin/python -m pip"):
        read_log(tmp_path / "log.h5")


@pytest.mark.parametrize("name", ["log.csv", "log.parquet", "log.h5", "log.mcap", "log.bag"])
def test_a_damaged_file_is_one_line(name, tmp_path):
    (tmp_path / name).write_bytes(b"\x00garbage\xff" * 20)
    with pytest.raises(DataError, match=rf"^{tmp_path}/{name}: [^\n]+; accepted: [^\n]+$"):
        read_log(tmp_path / name)


def test_an_unknown_format_and_a_missing_file_name_what_is_accepted(tmp_path):
    (tmp_path / "log.mat").write_text("")
    with pytest.raises(DataError, match=r"format: '\.mat' is not accepted; accepted: .*\.csv.*a folder of `ros2 bag`"):
        read_log(tmp_path / "log.mat")
    with pytest.raises(DataError, match=r"none\.csv: file is missing; accepted: a log, \.csv"):
        read_log(Path(tmp_path / "none.csv"))


def test_messages_of_a_topic_must_hold_the_same_numbers(tmp_path):
    from mobnet.robotlog.messages import Message, columns_of

    one, other = {"name": ["J1"], "position": [0.1]}, {"name": ["J2"], "position": [0.2]}
    with pytest.raises(DataError, match=r"/s\.position: joints: \['J2'\] is not accepted; accepted: J1"):
        columns_of([Message("/s", 0, one), Message("/s", 1, other)])
    with pytest.raises(DataError, match=r"/s\.a: stands in: .1 of 2 messages, with \[1\] numbers. is not accepted"):
        columns_of([Message("/s", 0, {"a": 1.0, "b": 1.0}), Message("/s", 1, {"b": 2.0})])
