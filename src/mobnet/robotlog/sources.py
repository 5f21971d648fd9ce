"""Open logs of messages: bags of ROS 1 and 2, and MCAP files."""

import contextlib
import json
import os
import struct
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from pathlib import Path
from typing import IO, Any, NamedTuple

from mobnet.core.errors import DataError, not_accepted

METADATA = "metadata.yaml"  # in each folder that `ros2 bag` wrote
FILES = (".mcap", ".db3")  # that hold the messages there
MAGIC = b"#ROSBAG V2.0"  # of bags of ROS 1
CHUNK_KIND, CHUNK = 6, struct.Struct("<BQQQQII")  # kind, length, times, size, checksum; bytes of the compression's name
ENCODINGS = ("cdr", "json", "ros1")  # of messages in MCAP files that are read
Decoder = Callable[[bytes], Any]


class Message(NamedTuple):
    """A message with its topic and the time at which it was recorded [ns]."""

    topic: str
    recorded_ns: int
    content: Any


class MessageLog(NamedTuple):
    """An open log of messages: its topics, and those messages of some of them, in the order of recording.

    `unread` are the encodings of topics that cannot be read; `hint` says where the log ends early.
    """

    topics: Sequence[str]
    messages: Callable[[Collection[str]], Iterator[Message]]
    unread: Mapping[str, str] = {}
    hint: str = ""


@contextlib.contextmanager
def opened(path: Path) -> Iterator[MessageLog]:
    """Open a bag of ROS 1, a folder that `ros2 bag` wrote, a file of one, or a MCAP file.

    Raises:
        DataError: a bag of ROS 1 was not closed.
    """
    if path.suffix.lower() == ".active":
        raise DataError(
            f"{path}: a bag that was not closed is not accepted; accepted: what `rosbag reindex` makes of it"
        )
    with contextlib.ExitStack() as stack:
        yield stack.enter_context(_opener(path)(path))


def _opener(path: Path) -> Callable[[Path], contextlib.AbstractContextManager[MessageLog]]:
    """Return the function that opens a log of messages."""
    return {".mcap": _mcap, ".db3": _database, ".bag": _bag}.get(path.suffix.lower(), _folder)


@contextlib.contextmanager
def _folder(path: Path) -> Iterator[MessageLog]:
    """Open what `ros2 bag` wrote; where it was stopped, its files one after the other."""
    files = sorted(file for file in path.iterdir() if file.suffix in FILES)
    with contextlib.ExitStack() as stack:
        if (path / METADATA).is_file():
            from rosbags.highlevel import AnyReaderError

            try:
                yield stack.enter_context(_bag(path))
                return
            except AnyReaderError:
                # Of a recording that was stopped the files may be whole where the metadata are not.
                if not files:
                    raise
        sources = [stack.enter_context(_opener(file)(file)) for file in files]

        def messages(topics: Collection[str]) -> Iterator[Message]:
            for source in sources:
                yield from source.messages(topics)

        topics = set[str]()
        unread = dict[str, str]()
        for source in sources:
            topics.update(source.topics)
            unread.update(source.unread)
        yield MessageLog(sorted(topics), messages, unread, next((source.hint for source in sources if source.hint), ""))


@contextlib.contextmanager
def _bag(path: Path) -> Iterator[MessageLog]:
    """Open a bag of ROS 1 or 2; definitions of messages come from the bag, or are those of ROS 2 where it has none."""
    from rosbags import highlevel
    from rosbags import typesys as stores

    if path.is_file():
        _check_magic(path)
    with highlevel.AnyReader([path], default_typestore=stores.get_typestore(stores.Stores.LATEST)) as bag:

        def messages(topics: Collection[str]) -> Iterator[Message]:
            wanted = [connection for connection in bag.connections if connection.topic in topics]
            for connection, recorded, raw in bag.messages(wanted):
                yield Message(connection.topic, recorded, bag.deserialize(raw, connection.msgtype))

        known = bag.typestore.fielddefs
        yield MessageLog(
            sorted(
                {connection_of_bag.topic for connection_of_bag in bag.connections if connection_of_bag.msgtype in known}
            ),
            messages,
        )


def _check_magic(path: Path) -> None:
    """Raise a DataError where a file does not begin as a bag of ROS 1, whose reader takes any first line."""
    with path.open("rb") as file:
        start = file.read(len(MAGIC))
    if start != MAGIC:
        raise DataError(f"{path}: begins with {start!r}; accepted: {MAGIC!r}, as a bag of ROS 1 does")


@contextlib.contextmanager
def _database(path: Path) -> Iterator[MessageLog]:
    """Open a file of a bag of ROS 2 without its metadata, sqlite3."""
    from rosbags import typesys as stores
    from rosbags.rosbag2.storage_sqlite3 import Sqlite3Reader

    reader = Sqlite3Reader(path)
    reader.open()
    with contextlib.closing(reader):
        types = stores.get_typestore(stores.Stores.LATEST)
        # The bag has the definitions of messages of one's own; bags of before Iron have none.
        for connection in reader.connections:
            if connection.msgdef.format.name == "MSG":
                wanted = stores.get_types_from_msg(connection.msgdef.data, connection.msgtype)
                types.register({name: kind for name, kind in wanted.items() if name not in types.fielddefs})

        def messages(topics: Collection[str]) -> Iterator[Message]:
            wanted = [connection for connection in reader.connections if connection.topic in topics]
            for connection, recorded, raw in reader.messages(wanted):
                yield Message(connection.topic, recorded, types.deserialize_cdr(raw, connection.msgtype))

        known = {
            connection_of_bag.topic
            for connection_of_bag in reader.connections
            if connection_of_bag.msgtype in types.fielddefs
        }
        yield MessageLog(
            sorted(known),
            messages,
            {
                connection_of_bag.topic: connection_of_bag.msgtype
                for connection_of_bag in reader.connections
                if connection_of_bag.topic not in known
            },
        )


@contextlib.contextmanager
def _mcap(path: Path) -> Iterator[MessageLog]:
    """Open a MCAP file with messages of ROS 1, of ROS 2 or in JSON; one that ends early, as far as it is whole."""
    from mcap import reader as reading

    with path.open("rb") as file:
        reader = reading.make_reader(file)
        try:
            summary = reader.get_summary()
            is_cut = False
        except Exception:  # noqa: BLE001  the file has no end, in whose place may stand anything
            summary = None
            is_cut = True

        def every(topics: Collection[str] | None) -> Iterator[tuple[Any, Any, Any]]:
            if not is_cut:
                yield from reader.iter_messages(topics=topics)
                return
            yield from (one for one in _whole(file, path) if topics is None or one[1].topic in topics)

        def messages(topics: Collection[str]) -> Iterator[Message]:
            decoders = dict[int, Decoder]()
            for schema, channel, message in every(list(topics)):
                if channel.id not in decoders:
                    decoders[channel.id] = _decoder(channel, schema, path)
                yield Message(channel.topic, message.log_time, decoders[channel.id](message.data))

        channels = summary.channels if summary and summary.channels else {one.id: one for _, one, _ in every(None)}
        read = {one.topic for one in channels.values() if one.message_encoding in ENCODINGS}
        unread = {one.topic: one.message_encoding or "none" for one in channels.values() if one.topic not in read}
        yield MessageLog(sorted(read), messages, unread, f"{path.name} ends early: read as far as it is whole" * is_cut)


def _whole(file: IO[bytes], path: Path) -> Iterator[tuple[Any, Any, Any]]:
    """Yield schema, channel and message of each message of a MCAP file that ends early, up to there."""
    from mcap import records

    schemas = dict[int, Any]()
    channels = dict[int, Any]()
    for record in _records(file, path):
        if isinstance(record, records.Schema):
            schemas[record.id] = record
        elif isinstance(record, records.Channel):
            channels[record.id] = record
        elif isinstance(record, records.Message) and record.channel_id in channels:
            channel = channels[record.channel_id]
            yield schemas.get(channel.schema_id), channel, record


def _records(file: IO[bytes], path: Path) -> Iterator[Any]:
    """Yield the whole records of a MCAP file that ends early, those of a last chunk too if it is not compressed."""
    from mcap import stream_reader as streams

    most = path.stat().st_size
    start = 0
    # First the records of the file, then those within the chunk at which it is cut: the first ones there are whole.
    for is_inside in (False, True):
        file.seek(start)
        if is_inside and not _enter_chunk(file):
            return
        stream = iter(streams.StreamReader(file, skip_magic=is_inside, record_size_limit=most).records)
        while True:
            start = file.tell()
            try:
                record = next(stream)
            except Exception:  # noqa: BLE001  whatever stands where the file was cut
                break
            yield record


def _enter_chunk(file: IO[bytes]) -> bool:
    """Go to the first record of a chunk; return whether one begins here, and is not compressed."""
    head = file.read(CHUNK.size)
    if len(head) < CHUNK.size:
        return False
    kind, *_, name_bytes = CHUNK.unpack(head)
    file.seek(8, os.SEEK_CUR)  # the length of the records
    return kind == CHUNK_KIND and name_bytes == 0


def _decoder(channel: Any, schema: Any, path: Path) -> Decoder:
    """Return the function that decodes the messages of a channel."""
    if channel.message_encoding == "json":
        return json.loads
    encoding = f"{channel.message_encoding} with {schema.encoding if schema else 'no schema'}"
    if encoding == "ros1 with ros1msg":
        return _ros1(schema)
    from mcap_ros2.decoder import DecoderFactory

    ros = DecoderFactory()
    decoder = ros.decoder_for(channel.message_encoding, schema)
    if decoder is None:
        accepted = ["cdr with ros2msg", "ros1 with ros1msg", "json"]
        raise DataError(not_accepted(f"{path}: {channel.topic}: encoding", encoding, accepted))
    return decoder


def _ros1(schema: Any) -> Decoder:
    """Return the function that decodes messages of ROS 1."""
    from rosbags import typesys as stores

    types = stores.get_typestore(stores.Stores.EMPTY)
    name = schema.name
    package, _, kind = name.rpartition("/")
    full = f"{package.removesuffix('/msg') or 'own'}/msg/{kind}"
    types.register(stores.get_types_from_msg(schema.data.decode(), full))
    return lambda raw: types.deserialize_ros1(raw, full)
