"""Messages of ROS 1 and 2, and of MCAP in JSON, as columns.

A column is TOPIC.FIELD, of an array TOPIC.FIELD.0 and so on. Where a message names the entries of its arrays, as a
JointState does, a column has that name: TOPIC.FIELD.JOINT. Its numbers are found by it in every message, whatever the
order there.
"""

import contextlib
import json
import logging
import time
from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass, field
from operator import attrgetter, itemgetter
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mobnet.core.errors import DataError, not_accepted
from mobnet.robotlog.columns import Column, module_of

NANO = 1e-9
NAMES = ("name", "names", "joint_names", "interface_names")  # fields that name the entries of the arrays beside them
STAMPS = (("sec", "nanosec"), ("secs", "nsecs"), ("sec", "nsec"))  # of a header's time
MOST = 1000  # entries of an array above which it is a picture or a map, and no signal
TOLD_S, LOOKED = 5.0, 10_000  # seconds between two lines of progress, messages between two looks at the clock
log = logging.getLogger(__name__)
Step = Callable[[Any], Any]  # from a message to one of its fields, or from an array to an entry


class Message(NamedTuple):
    """A message with its topic and the time at which it was recorded [ns]."""

    topic: str
    recorded_ns: int
    content: Any


class Source(NamedTuple):
    """An open log of messages: its topics, and those messages of some of them, in the order of recording."""

    topics: Sequence[str]
    messages: Callable[[Collection[str]], Iterator[Message]]


class Part(NamedTuple):
    """A number or an array of numbers in the messages of a topic, and where the names of its entries stand."""

    name: str
    steps: tuple[Step, ...]
    labels: tuple[Step, ...]


@dataclass
class Gathered:
    """What was read of a topic: recorded times and stamps [ns], and of each part the rows by the names of its entries."""

    parts: Sequence[Part]
    stamp: Callable[[Any], int] | None
    recorded: list[int] = field(default_factory=list)
    stamps: list[int] = field(default_factory=list)
    rows: dict[str, dict[tuple[str, ...], tuple[list[int], list[Any]]]] = field(default_factory=dict)


def message_names(path: Path) -> list[str]:
    """Return the columns in the first message of each topic of a log."""
    found = []
    with _opened(path) as source:
        for topic in source.topics:
            first = next(source.messages([topic]), None)
            if first is not None:
                found += [name for part in _parts(first.content, topic) for name in _in(part, first.content)]
    return found


def message_columns(path: Path, wanted: Collection[str]) -> dict[str, Column]:
    """Return wanted columns of a log; only messages of their topics are decoded.

    Raises:
        DataError: a message lacks a field that the first one of its topic has.
    """
    with _opened(path) as source:
        topics = [topic for topic in source.topics if any(name.startswith(f"{topic}.") for name in wanted)]
        gathered = _gathered(source.messages(topics), set(wanted)) if topics else {}
    began = min((min(own.recorded) for own in gathered.values()), default=0)
    found = dict[str, Column]()
    for topic, own in gathered.items():
        found |= {name: column for name, column in _columns_of(topic, own, began).items() if name in wanted}
    return found


@contextlib.contextmanager
def _opened(path: Path) -> Iterator[Source]:
    """Open a bag of ROS 1, a folder that `ros2 bag` wrote, or a MCAP file."""
    with (_mcap(path) if path.suffix.lower() == ".mcap" else _bag(path)) as source:
        yield source


@contextlib.contextmanager
def _bag(path: Path) -> Iterator[Source]:
    """Open a bag of ROS 1 or 2; definitions of messages come from the bag, or are those of ROS 2 where it has none."""
    reader = module_of("rosbags.highlevel", path).AnyReader
    stores = module_of("rosbags.typesys", path)
    with reader([path], default_typestore=stores.get_typestore(stores.Stores.LATEST)) as bag:

        def messages(topics: Collection[str]) -> Iterator[Message]:
            own = [connection for connection in bag.connections if connection.topic in topics]
            for connection, recorded, raw in bag.messages(own):
                yield Message(connection.topic, recorded, bag.deserialize(raw, connection.msgtype))

        known = bag.typestore.fielddefs
        yield Source(sorted({one.topic for one in bag.connections if one.msgtype in known}), messages)


@contextlib.contextmanager
def _mcap(path: Path) -> Iterator[Source]:
    """Open a MCAP file with messages of ROS 2 or in JSON."""
    reading, decoding = module_of("mcap.reader", path), module_of("mcap_ros2.decoder", path)
    with path.open("rb") as file:
        reader, ros, decoders = reading.make_reader(file), decoding.DecoderFactory(), dict[int, Step]()

        def messages(topics: Collection[str]) -> Iterator[Message]:
            for schema, channel, message in reader.iter_messages(topics=list(topics)):
                if channel.id not in decoders:
                    decoders[channel.id] = _decoder(ros, channel, schema, path)
                yield Message(channel.topic, message.log_time, decoders[channel.id](message.data))

        summary = reader.get_summary()
        channels = summary.channels.values() if summary and summary.channels else _channels(reader)
        read = {channel.topic for channel in channels if channel.message_encoding in ("cdr", "json")}
        yield Source(sorted(read), messages)


def _channels(reader: Any) -> list[Any]:
    """Return the channels of a MCAP file without a summary."""
    return list({channel.id: channel for _, channel, _ in reader.iter_messages()}.values())


def _decoder(ros: Any, channel: Any, schema: Any, path: Path) -> Step:
    """Return the function that decodes the messages of a channel."""
    if channel.message_encoding == "json":
        return json.loads
    decoder = ros.decoder_for(channel.message_encoding, schema)
    if decoder is None:
        encoding = f"{channel.message_encoding} with {schema.encoding if schema else 'no schema'}"
        raise DataError(not_accepted(f"{path}: {channel.topic}: encoding", encoding, ["cdr with ros2msg", "json"]))
    return decoder


def _parts(content: Any, name: str, steps: tuple[Step, ...] = (), labels: tuple[Step, ...] = ()) -> Iterator[Part]:
    """Yield the numbers and arrays of numbers below a field, with the way to the names of their entries, if any.

    Headers and texts are left out.
    """
    if isinstance(content, (bool, int, float, np.number)):
        yield Part(name, steps, ())
    elif _holds(content, (bool, int, float, np.number)):
        yield Part(name, steps, labels)
    elif isinstance(content, (list, tuple)):
        for k, item in enumerate(content[:MOST]):
            yield from _parts(item, f"{name}.{k}", (*steps, itemgetter(k)))
    elif not isinstance(content, (str, bytes, type(None), np.ndarray)):
        fields = {key: step for key, step in _fields(content) if key != "header"}
        named = next((key for key in NAMES if key in fields and _holds(fields[key](content), str)), None)
        labels = (*steps, fields[named]) if named else labels
        for key, step in fields.items():
            yield from _parts(step(content), f"{name}.{key}", (*steps, step), labels)


def _fields(content: Any) -> Iterator[tuple[str, Step]]:
    """Yield the fields of a message or of a JSON object, with what takes them out of it."""
    if isinstance(content, dict):
        yield from ((name, itemgetter(name)) for name in content)
    else:
        names = getattr(content, "__dataclass_fields__", None) or getattr(content, "__slots__", ())
        yield from ((name, attrgetter(name)) for name in names if not name.startswith("__"))


def _holds(content: Any, kinds: Any) -> bool:
    """Return whether something is a list of such things, short enough for signals and not empty."""
    if isinstance(content, np.ndarray):
        return content.dtype.kind in "fiub" and 0 < content.size <= MOST and kinds is not str
    return isinstance(content, (list, tuple)) and 0 < len(content) <= MOST and isinstance(content[0], kinds)


def _at(content: Any, steps: Sequence[Step]) -> Any:
    """Return what the steps lead to."""
    for step in steps:
        content = step(content)
    return content


def _entries(part: Part, content: Any, values: Any) -> tuple[str, ...]:
    """Return the names of the columns that a part has in a message."""
    if not isinstance(values, (list, tuple, np.ndarray)):
        return (part.name,)
    labels = _at(content, part.labels) if part.labels else ()
    ends = labels if len(labels) == len(values) else range(len(values))
    return tuple(f"{part.name}.{end}" for end in ends)


def _stamp_of(content: Any) -> Step | None:
    """Return the function that takes the stamp of a message's header [ns], None where it has none."""
    for header in (step for name, step in _fields(content) if name == "header"):
        for stamp in (step for name, step in _fields(header(content)) if name == "stamp"):
            fields = dict(_fields(stamp(header(content))))
            for whole, rest in STAMPS:
                if whole in fields and rest in fields:
                    first, second = fields[whole], fields[rest]

                    def stamp_ns(message: Any) -> int:
                        own = stamp(header(message))
                        return first(own) * 1_000_000_000 + second(own)

                    return stamp_ns
    return None


def _gathered(messages: Iterator[Message], wanted: Collection[str]) -> dict[str, Gathered]:
    """Return what messages hold of wanted columns, by topic."""
    topics = dict[str, Gathered]()
    told = time.monotonic()
    for count, (topic, recorded_ns, content) in enumerate(messages, 1):
        own = topics.get(topic)
        if own is None:
            parts = [part for part in _parts(content, topic) if not wanted.isdisjoint(_in(part, content))]
            own = topics[topic] = Gathered(parts, _stamp_of(content))
        own.recorded.append(recorded_ns)
        own.stamps.append(own.stamp(content) if own.stamp else 0)
        for part in own.parts:
            _gather(own, part, content)
        if count % LOOKED == 0 and time.monotonic() - told > TOLD_S:
            told = time.monotonic()
            log.info("%d messages read", count)
    return topics


def _in(part: Part, content: Any) -> tuple[str, ...]:
    """Return the names of the columns that a part has in a message."""
    return _entries(part, content, _at(content, part.steps))


def _gather(own: Gathered, part: Part, content: Any) -> None:
    """Add the numbers of a message."""
    try:
        values = _at(content, part.steps)
        names = _entries(part, content, values)
    except (AttributeError, IndexError, KeyError, TypeError):
        text = not_accepted(f"message {len(own.recorded)}", "it", [f"one with {part.name}, as the first one has"])
        raise DataError(f"{part.name}: {text}") from None
    rows, numbers = own.rows.setdefault(part.name, {}).setdefault(names, ([], []))
    rows.append(len(own.recorded) - 1)
    numbers.append(values)


def _columns_of(topic: str, own: Gathered, began_ns: int) -> dict[str, Column]:
    """Return the columns of a topic; what stands in some of its messages alone has their times."""
    recorded = NANO * (np.array(own.recorded) - began_ns)
    is_stamped = own.stamps.count(0) <= 1 if own.stamp else None  # the time of a simulation begins with zero
    times = NANO * (np.array(own.stamps) - began_ns) if is_stamped else recorded
    pieces: dict[str, list[tuple[list[int], NDArray[Any]]]] = {}
    for layouts in own.rows.values():
        for names, (rows, numbers) in layouts.items():
            block = np.asarray(numbers, dtype=np.float64).reshape(len(rows), -1)
            for k, name in enumerate(names):
                pieces.setdefault(name, []).append((rows, block[:, k]))
    found = dict[str, Column]()
    for name, parts in pieces.items():
        rows = np.concatenate([rows for rows, _ in parts])
        values, order = np.concatenate([values for _, values in parts]), np.argsort(rows, kind="stable")
        clocks = (times, recorded) if len(rows) == len(times) else (times[rows[order]], recorded[rows[order]])
        found[name] = Column(values[order], *clocks, topic, is_stamped)
    return found
