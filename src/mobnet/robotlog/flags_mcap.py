"""What `detect` finds as one MCAP file, which Foxglove opens: `./reproduce detect ... --out NAME.mcap`.

Messages are JSON, each topic with its schema, so that no reader needs definitions of ours. Their times are those of the
log's clock.
"""

import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.core.errors import DataError, not_accepted
from mobnet.core.files import atomic_path
from mobnet.core.place import version
from mobnet.formats.limb_thresholds import LimbThresholds
from mobnet.robotlog.detected import LogDetection
from mobnet.robotlog.flags import COLUMNS, Flag

TORQUES, FLAGS, LOG = "/torques", "/flags", "/log"  # topics
NANO = 1_000_000_000  # ns in a second
DIGITS = 6  # behind the point, of torques [N m] and ratios
WARNING = 3  # level of `foxglove.Log`, whose messages the log panel lists
TEXT, NUMBER = {"type": "string"}, {"type": "number"}
STAMP = {"type": "object", "properties": {"sec": {"type": "integer"}, "nsec": {"type": "integer"}}}
TEXTS = ("joint", "link", "point", "direction")  # columns of a flag
LOG_FIELDS: dict[str, Any] = {
    "timestamp": STAMP,
    "level": {"type": "integer"},
    "message": TEXT,
    "name": TEXT,
    "file": TEXT,
    "line": {"type": "integer"},
}
Message = tuple[str, float, dict[str, Any]]  # topic, time [s], content


def write_mcap(made: LogDetection, thresholds: LimbThresholds, columns: NDArray[np.intp], path: Path) -> None:
    """Write estimate, residual and flags of a log.

    Args:
        made: what was detected.
        thresholds: the thresholds.
        columns: numbers of the limb's joints among those of the residual, (n,).
        path: the file.

    Raises:
        DataError: a time is below zero, or the file cannot be written.
    """
    from mcap import writer as writing

    time_s = made.observed.converted.time_s
    if time_s[0] < 0.0:
        raise DataError(f"{path}: {not_accepted('first time of the log', float(time_s[0]), ['0 s or later'])}")
    signals = signals_of(made, thresholds, columns)
    schemas = {
        TORQUES: ("mobnet.Torques", mapping({name: of_joints(thresholds.joints) for name in signals})),
        FLAGS: ("mobnet.Flag", mapping({name: TEXT if name in TEXTS else NUMBER for name in COLUMNS})),
        LOG: ("foxglove.Log", mapping(LOG_FIELDS)),
    }
    with atomic_path(path) as temporary, temporary.open("wb") as file:
        writer = writing.Writer(file)
        writer.start(library=f"mobnet {version()}")
        channels: dict[str, int] = {}
        for topic, (name, schema) in schemas.items():
            number = writer.register_schema(name, "jsonschema", json.dumps(schema).encode())
            channels[topic] = writer.register_channel(topic, "json", number)
        for topic, stamp_s, content in in_order(made, thresholds, signals):
            stamp = round(stamp_s * NANO)
            writer.add_message(channels[topic], stamp, json.dumps(content).encode(), stamp)
        writer.finish()


def signals_of(made: LogDetection, thresholds: LimbThresholds, columns: NDArray[np.intp]) -> dict[str, Array]:
    """Return name -> signal of each joint of the limb in every sample, (T, n) [N m].

    `ratio`, what is watched over its threshold, has no unit; above 1 for long enough it is a flag.
    """
    estimate = made.estimate
    signals = {"tau_ext": estimate.tau_ext, "residual": made.observed.residual[:, columns]}
    if estimate.std is not None:
        signals["std"] = estimate.std
    signals["ratio"] = np.abs(made.watched) / np.array(thresholds.thresholds)
    return {name: np.round(np.asarray(signal, dtype=np.float64), DIGITS) for name, signal in signals.items()}


def in_order(made: LogDetection, thresholds: LimbThresholds, signals: Mapping[str, Array]) -> Iterator[Message]:
    """Yield the messages by their times: torques of every sample, and each flag where it begins."""
    waiting = list(made.flags)
    for row, stamp_s in enumerate(made.observed.converted.time_s.tolist()):
        content: dict[str, Any] = {}
        for name, signal in signals.items():
            content[name] = dict(zip(thresholds.joints, signal[row].tolist(), strict=True))
        yield TORQUES, stamp_s, content
        while waiting and waiting[0].start_s <= stamp_s:
            yield from messages_of(waiting.pop(0), thresholds.limb)


def messages_of(flag: Flag, limb: str) -> Iterator[Message]:
    """Yield a flag as numbers, without what it does not tell, and as a line for the log panel."""
    numbers = dict(zip(COLUMNS, flag.row(), strict=True))
    yield FLAGS, flag.start_s, {name: value for name, value in numbers.items() if value != ""}
    stamp = {"sec": int(flag.start_s), "nsec": round(flag.start_s % 1.0 * NANO)}
    text = f"{flag.joint} at {flag.ratio:.2f} times its threshold until {flag.end_s:.3f} s"
    content = {"timestamp": stamp, "level": WARNING, "message": text, "name": limb, "file": "", "line": 0}
    yield LOG, flag.start_s, content


def mapping(fields: Mapping[str, Any]) -> dict[str, Any]:
    """Return the JSON schema of an object with some fields."""
    return {"type": "object", "properties": dict(fields)}


def of_joints(joints: tuple[str, ...]) -> dict[str, Any]:
    """Return the JSON schema of a number for each joint."""
    return mapping(dict.fromkeys(joints, NUMBER))
