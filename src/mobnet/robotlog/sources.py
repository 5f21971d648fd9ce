"""Open logs of messages: bags of ROS 1 and 2, and MCAP files."""

import contextlib
import json
from collections.abc import Callable, Collection, Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from mobnet.core.errors import DataError, not_accepted
from mobnet.robotlog.columns import module_of

Decoder = Callable[[bytes], Any]


class Message(NamedTuple):
    """A message with its topic and the time at which it was recorded [ns]."""

    topic: str
    recorded_ns: int
    content: Any


class Source(NamedTuple):
    """An open log of messages: its topics, and those messages of some of them, in the order of recording."""

    topics: Sequence[str]
    messages: Callable[[Collection[str]], Iterator[Message]]


@contextlib.contextmanager
def opened(path: Path) -> Iterator[Source]:
    """Open a bag of ROS 1, a folder that `ros2 bag` wrote, or a MCAP file."""
    with _mcap(path) if path.suffix.lower() == ".mcap" else _bag(path) as source:
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
        reader, ros, decoders = (
            reading.make_reader(file),
            decoding.DecoderFactory(),
            dict[int, Decoder](),
        )

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


def _decoder(ros: Any, channel: Any, schema: Any, path: Path) -> Decoder:
    """Return the function that decodes the messages of a channel."""
    if channel.message_encoding == "json":
        return json.loads
    decoder = ros.decoder_for(channel.message_encoding, schema)
    if decoder is None:
        encoding = f"{channel.message_encoding} with {schema.encoding if schema else 'no schema'}"
        raise DataError(not_accepted(f"{path}: {channel.topic}: encoding", encoding, ["cdr with ros2msg", "json"]))
    return decoder
