"""Messages of ROS 1 and 2, and of MCAP in JSON, as columns.

A column is TOPIC.FIELD, of an array TOPIC.FIELD.0 and so on. Where a message names the entries of its arrays, as a
JointState does, a column has that name: TOPIC.FIELD.JOINT. Its numbers are found by it in every message, whatever the
order there. So is an entry of a list of objects, whose names stand in the objects themselves or, as those of a
DynamicJointState, beside the list: TOPIC.FIELD.JOINT.position.
"""

import logging
import time
from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import islice
from operator import attrgetter, itemgetter
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mobnet.core.errors import DataError, not_accepted
from mobnet.robotlog.columns import MOST, LogColumn
from mobnet.robotlog.sources import ENCODINGS, Message, opened

NANO = 1e-9
NAMES = ("name", "names", "joint_names", "interface_names")  # fields that name the entries of the arrays beside them
STAMPS = (("sec", "nanosec"), ("secs", "nsecs"), ("sec", "nsec"))  # of a header's time
FIRST = 20  # messages of a topic in which its columns are looked for
OWN_NAMES = ("name", "joint_name")  # fields that name an object in a list
TOLD_S, LOOKED = 5.0, 10_000  # seconds between two lines of progress, messages between two looks at the clock
log = logging.getLogger(__name__)
Step = Callable[[Any], Any]  # from a message to one of its fields, or from an array to an entry


class AbsentError(LookupError):
    """A message lacks an entry that others have."""


@dataclass
class Entry:
    """The step from a list of objects to the one of a name, which is looked for where it was before first."""

    own_name: Step
    name: str
    place: int

    def __call__(self, items: Sequence[Any]) -> Any:
        """Return the object."""
        if self.place >= len(items) or self.own_name(items[self.place]) != self.name:
            index = next((k for k, item in enumerate(items) if self.own_name(item) == self.name), None)
            if index is None:
                raise AbsentError(self.name)
            self.place = index
        return items[self.place]


@dataclass
class EntryBeside:
    """The step from a message to the object of a name in a list beside which a list of the names stands.

    `place` is where it was last, which is looked at first.
    """

    labels: tuple[Step, ...]
    items: tuple[Step, ...]
    name: str
    place: int

    def __call__(self, message: Any) -> Any:
        """Return the object."""
        names = _at(message, self.labels)
        if self.place >= len(names) or names[self.place] != self.name:
            if self.name not in names:
                raise AbsentError(self.name)
            self.place = names.index(self.name)
        return _at(message, self.items)[self.place]


class MessageField(NamedTuple):
    """A number or an array of numbers in the messages of a topic, and where the names of its entries stand."""

    name: str
    steps: tuple[Step, ...]
    labels: tuple[Step, ...]


@dataclass
class Gathered:
    """What was read of a topic: times of recording and stamps [ns]; of each part the rows by its entries' names."""

    stamp: Callable[[Any], int] | None
    parts: dict[str, MessageField] = field(default_factory=dict)
    recorded: list[int] = field(default_factory=list)
    stamps: list[int] = field(default_factory=list)
    rows: dict[str, dict[tuple[str, ...], tuple[list[int], list[Any]]]] = field(default_factory=dict)


def message_names(path: Path) -> list[str]:
    """Return the columns in the first messages of each topic of a log."""
    names = []
    with opened(path) as source:
        for topic in source.topics:
            for _, _, content in islice(source.messages([topic]), FIRST):
                for part in _parts(content, content, topic):
                    names += _in(part, content)
        if not names and source.hint:
            raise DataError(f"{path}: {source.hint}, which is before its first message; accepted: a log with messages")
        if not names and source.unread:
            topics = ", ".join(f"{topic} ({encoding})" for topic, encoding in source.unread.items())
            raise DataError(f"{path}: cannot be decoded: {topics}; accepted: messages in {', '.join(ENCODINGS)}")
    return list(dict.fromkeys(names))


def message_columns(path: Path, wanted: Collection[str]) -> dict[str, LogColumn]:
    """Return wanted columns of a log; only messages of their topics are decoded.

    Raises:
        DataError: a message lacks a field that one before it has.
    """
    with opened(path) as source:
        topics = list[str]()
        for topic in source.topics:
            if any(name.startswith(f"{topic}.") for name in wanted):
                topics.append(topic)
        gathered = _gathered(source.messages(topics), set(wanted)) if topics else {}
        hint = source.hint
    began = min((min(of_topic.recorded) for of_topic in gathered.values()), default=0)
    columns = dict[str, LogColumn]()
    for topic, of_topic in gathered.items():
        columns |= {
            name: column for name, column in _columns_of(topic, of_topic, began, hint).items() if name in wanted
        }
    return columns


def _parts(
    message: Any, content: Any, name: str, steps: tuple[Step, ...] = (), labels: tuple[Step, ...] = ()
) -> Iterator[MessageField]:
    """Yield the numbers and arrays of numbers below a field of a message, with the ways to names of their entries.

    Ways begin at the message. Headers and texts are left out.
    """
    if isinstance(content, (bool, int, float, np.number)):
        yield MessageField(name, steps, ())
    elif _holds(content, (bool, int, float, np.number)):
        yield MessageField(name, steps, labels)
    elif isinstance(content, (list, tuple)):
        for end, way, item in _objects(message, content[:MOST], steps, labels):
            yield from _parts(message, item, f"{name}.{end}", way)
    elif not isinstance(content, (str, bytes, type(None), np.ndarray)):
        fields = {key: step for key, step in _fields(content) if key != "header"}
        named = next((key for key in NAMES if key in fields and _holds(fields[key](content), str)), None)
        labels = (*steps, fields[named]) if named else labels
        for key, step in fields.items():
            yield from _parts(message, step(content), f"{name}.{key}", (*steps, step), labels)


def _objects(
    message: Any, items: Sequence[Any], steps: tuple[Step, ...], labels: tuple[Step, ...]
) -> Iterator[tuple[str, tuple[Step, ...], Any]]:
    """Yield name, way from the message, and content of each object in a list.

    Names are those of the objects themselves, else those that stand beside the list, else numbers.
    """
    own_names = _own_names(items)
    names = _at(message, labels) if labels else ()
    for k, item in enumerate(items):
        if own_names:
            name, step = own_names[k]
            yield name, (*steps, Entry(step, name, k)), item
        elif len(names) == len(items) == len(set(names)):
            yield names[k], (EntryBeside(labels, steps, names[k], k),), item
        else:
            yield str(k), (*steps, itemgetter(k)), item


def _own_names(items: Sequence[Any]) -> list[tuple[str, Step]]:
    """Return the names that objects in a list have themselves, with the steps to them; none unless all differ."""
    for key in OWN_NAMES:
        steps = list[Step]()
        for item in items:
            steps += [step for name, step in _fields(item) if name == key]
        names = [step(item) for step, item in zip(steps, items, strict=False)]
        if names and len(set(names)) == len(items) and all(isinstance(name, str) and name for name in names):
            return list(zip(names, steps, strict=True))
    return []


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


def _entries(part: MessageField, content: Any, values: Any) -> tuple[str, ...]:
    """Return the names of the columns that a part has in a message."""
    if not isinstance(values, (list, tuple, np.ndarray)):
        return (part.name,)
    labels = _at(content, part.labels) if part.labels else ()
    ends = labels if len(labels) == len(values) else range(len(values))
    return tuple(f"{part.name}.{end}" for end in ends)


def _stamp_of(content: Any) -> Callable[[Any], int] | None:
    """Return the function that takes the stamp of a message's header [ns], None where it has none."""
    steps: list[Step] = []
    for name in ("header", "stamp"):
        step = dict(_fields(_at(content, steps))).get(name)
        if step is None:
            return None
        steps.append(step)
    fields = dict(_fields(_at(content, steps)))
    pair = next(((fields[whole], fields[rest]) for whole, rest in STAMPS if {whole, rest} <= fields.keys()), None)
    if pair is None:
        return None
    (header, stamp) = steps
    (whole, rest) = pair

    def stamp_ns(message: Any) -> int:
        stamped = stamp(header(message))
        return whole(stamped) * 1_000_000_000 + rest(stamped)

    return stamp_ns


def _gathered(messages: Iterator[Message], wanted: Collection[str]) -> dict[str, Gathered]:
    """Return what messages hold of wanted columns, by topic."""
    topics = dict[str, Gathered]()
    last_told = time.monotonic()
    for count, (topic, recorded_ns, content) in enumerate(messages, 1):
        of_topic = topics.get(topic)
        if of_topic is None:
            of_topic = topics[topic] = Gathered(_stamp_of(content))
        if len(of_topic.recorded) < FIRST:  # several nodes may publish one topic, each its own joints
            parts = (part for part in _parts(content, content, topic) if _is_wanted(part.name, wanted))
            of_topic.parts = {**{part.name: part for part in parts}, **of_topic.parts}
        of_topic.recorded.append(recorded_ns)
        of_topic.stamps.append(of_topic.stamp(content) if of_topic.stamp else 0)
        for part in of_topic.parts.values():
            _gather(of_topic, part, content)
        if count % LOOKED == 0 and time.monotonic() - last_told > TOLD_S:
            last_told = time.monotonic()
            log.info("%d messages read", count)
    return topics


def _is_wanted(part: str, wanted: Collection[str]) -> bool:
    """Return whether a wanted column is a part or one of its entries."""
    return any(name == part or name.startswith(f"{part}.") for name in wanted)


def _in(part: MessageField, content: Any) -> tuple[str, ...]:
    """Return the names of the columns that a part has in a message."""
    return _entries(part, content, _at(content, part.steps))


def _gather(of_topic: Gathered, part: MessageField, content: Any) -> None:
    """Add the numbers of a message."""
    try:
        values = _at(content, part.steps)
        names = _entries(part, content, values)
    except AbsentError:
        # What stands in some of the messages alone gets the times of those.
        return
    except (AttributeError, IndexError, KeyError, TypeError):
        text = not_accepted(f"message {len(of_topic.recorded)}", "it", [f"one with {part.name}, as one before it has"])
        raise DataError(f"{part.name}: {text}") from None
    rows, numbers = of_topic.rows.setdefault(part.name, {}).setdefault(names, ([], []))
    rows.append(len(of_topic.recorded) - 1)
    numbers.append(values)


def _columns_of(topic: str, of_topic: Gathered, began_ns: int, hint: str) -> dict[str, LogColumn]:
    """Return the columns of a topic; what stands in some of its messages alone has their times."""
    recorded = NANO * (np.array(of_topic.recorded) - began_ns)
    is_stamped = (
        2 * of_topic.stamps.count(0) <= len(of_topic.stamps) if of_topic.stamp else None
    )  # a simulation begins at zero
    times = NANO * (np.array(of_topic.stamps) - began_ns) if is_stamped else recorded
    pieces: dict[str, list[tuple[list[int], NDArray[Any]]]] = {}
    for layouts in of_topic.rows.values():
        for names, (rows, numbers) in layouts.items():
            block = np.asarray(numbers, dtype=np.float64).reshape(len(rows), -1)
            for k, name in enumerate(names):
                pieces.setdefault(name, []).append((rows, block[:, k]))
    columns = dict[str, LogColumn]()
    for name, parts in pieces.items():
        # Several nodes may publish one topic, and a node may list its entries in another order: a column has pieces.
        rows = np.concatenate([rows for rows, _ in parts])
        values = np.concatenate([values for _, values in parts])
        order = np.argsort(rows, kind="stable")
        clocks = (times, recorded) if len(rows) == len(times) else (times[rows[order]], recorded[rows[order]])
        columns[name] = LogColumn(values[order], *clocks, topic, is_stamped, hint)
    return columns
