"""Messages of ROS 1 and 2 as columns: TOPIC.FIELD, of an array TOPIC.FIELD.0, of joints by name TOPIC.FIELD.NAME."""

import json
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from mobnet.core.errors import DataError, not_accepted
from mobnet.robotlog.formats import Column, module_of

NANO = 1e-9
NAMED_FIELDS = ("position", "velocity", "effort")  # of a JointState, whose field `name` names their entries


class Message(NamedTuple):
    """A message with its topic and the time at which it was recorded [ns]."""

    topic: str
    recorded_ns: int
    content: Any


def ros_messages(path: Path) -> Iterator[Message]:
    """Yield the messages of a bag of ROS 1, or of a folder that `ros2 bag` wrote, in the order of time."""
    reader = module_of("rosbags.highlevel", path).AnyReader
    stores = module_of("rosbags.typesys", path)
    with reader([path], default_typestore=stores.get_typestore(stores.Stores.LATEST)) as bag:
        for connection, recorded, raw in bag.messages():
            yield Message(connection.topic, recorded, bag.deserialize(raw, connection.msgtype))


def mcap_messages(path: Path) -> Iterator[Message]:
    """Yield the messages of a MCAP file, those of ROS 2 and those in JSON."""
    decoding = module_of("mcap_ros2.decoder", path)
    reading = module_of("mcap.reader", path)
    with path.open("rb") as file:
        decoders = {}
        ros = decoding.DecoderFactory()
        for schema, channel, message in reading.make_reader(file).iter_messages():
            if channel.id not in decoders:
                decoders[channel.id] = _decoder(ros, channel, schema, path)
            yield Message(channel.topic, message.log_time, decoders[channel.id](message.data))


def _decoder(ros: Any, channel: Any, schema: Any, path: Path) -> Any:
    """Return the function that decodes the messages of a channel."""
    if channel.message_encoding == "json":
        return json.loads
    decoder = ros.decoder_for(channel.message_encoding, schema)
    if decoder is None:
        encoding = channel.message_encoding
        raise DataError(not_accepted(f"{path}: {channel.topic}: encoding", encoding, ["cdr of ROS 2", "json"]))
    return decoder


def columns_of(messages: Iterable[Message]) -> dict[str, Column]:
    """Return a column for each number in the messages, with the header's stamp where there is one, else the record's.

    Raises:
        DataError: messages of a topic do not hold the same numbers.
    """
    times: dict[str, list[float]] = {}
    rows: dict[str, dict[str, list[Any]]] = {}
    labels: dict[str, list[str]] = {}
    for topic, recorded_ns, content in messages:
        times.setdefault(topic, []).append(_time_ns(content, recorded_ns) * NANO)
        for name, values, joints in _blocks(content, topic):
            rows.setdefault(topic, {}).setdefault(name, []).append(values)
            if labels.setdefault(name, joints) != joints:
                raise DataError(not_accepted(f"{name}: joints", joints, [", ".join(labels[name])]))
    found = dict[str, Column]()
    for topic, blocks in rows.items():
        stamps = np.array(times[topic])
        for name, block in blocks.items():
            sizes = {np.size(values) for values in block}
            if len(block) != len(stamps) or len(sizes) > 1:
                text = f"{len(block)} of {len(stamps)} messages, with {sorted(sizes)} numbers"
                raise DataError(not_accepted(f"{name}: stands in", text, ["all messages of its topic, equally long"]))
            columns = np.asarray(block, dtype=np.float64).reshape(len(stamps), -1).T
            ends = labels[name] or ([""] if np.ndim(block[0]) == 0 else map(str, range(len(columns))))
            for end, values in zip(ends, columns, strict=True):
                found[f"{name}.{end}".removesuffix(".")] = Column(np.ascontiguousarray(values), stamps)
    return found


def _time_ns(content: Any, recorded_ns: int) -> float:
    """Return the time of a message's header [ns], or, without one, that at which it was recorded."""
    stamp = _field(_field(content, "header"), "stamp")
    seconds, rest = _field(stamp, "sec"), _field(stamp, "nanosec")
    return (seconds or 0) / NANO + (rest or 0) or recorded_ns


def _field(content: Any, name: str) -> Any:
    """Return a field of a message or of a JSON object, None where it has none."""
    return content.get(name) if isinstance(content, dict) else getattr(content, name, None)


def _fields(content: Any) -> Iterator[tuple[str, Any]]:
    """Yield the fields of a message or of a JSON object."""
    if isinstance(content, dict):
        yield from content.items()
        return
    names = getattr(content, "__dataclass_fields__", None) or getattr(content, "__slots__", ())
    yield from ((name, getattr(content, name)) for name in names if not name.startswith("__"))


def _blocks(content: Any, name: str) -> Iterator[tuple[str, Any, list[str]]]:
    """Yield numbers and arrays of numbers below a field: full name, itself, and the joints that name its entries.

    Headers and texts are left out.
    """
    if isinstance(content, (bool, int, float, np.number, np.ndarray)) or _is_numeric(content):
        yield name, content, []
    elif isinstance(content, (list, tuple)):
        for k, item in enumerate(content):
            yield from _blocks(item, f"{name}.{k}")
    elif not isinstance(content, (str, bytes, type(None))):
        joints = _field(content, "name")
        for key, inner in _fields(content):
            if key in NAMED_FIELDS and isinstance(joints, list) and len(joints) == len(inner):
                yield f"{name}.{key}", inner, joints
            elif key != "header":
                yield from _blocks(inner, f"{name}.{key}")


def _is_numeric(content: Any) -> bool:
    """Return whether something is a list of numbers; an empty one holds nothing at all."""
    is_list = isinstance(content, (list, tuple)) and bool(content)
    return is_list and isinstance(content[0], (bool, int, float, np.number))
