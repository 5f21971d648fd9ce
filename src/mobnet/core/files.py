"""Writing files so that a reader finds either the old or the complete new one, reading text and JSON, and locks.

Standard library only. The system frees a lock when its process ends, however it ends.
"""

import contextlib
import errno
import fcntl
import functools
import json
import logging
import math
import os
import shutil
import tempfile
from collections.abc import Iterator, Mapping
from difflib import get_close_matches
from pathlib import Path
from typing import Any

from mobnet.core.errors import LOOKED, NEAREST, DataError, not_accepted, refuse

log = logging.getLogger(__name__)
WEIGHTS, METRICS, RUN = "weights.safetensors", "metrics.csv", "run.json"  # files of a trained network
CHECKPOINT = "checkpoint.safetensors"  # of a training that is under way, in a folder of its own with METRICS
MEMBERS = "members.json"  # beside the checkpoint of networks that learn side by side: the folders of their METRICS
TIME = "time.json"  # beside the checkpoint of a network: what its training took [s]
PARTIAL = ".partial."  # first characters of the name of a file that is being written
LOCKLESS = {errno.ENOLCK, errno.ENOSYS, errno.EOPNOTSUPP}  # what a file system says that has no locks
FULL = frozenset({errno.ENOSPC, errno.EDQUOT})
REFUSALS = FULL | {
    errno.EACCES,
    errno.EPERM,
    errno.EROFS,
    errno.EEXIST,
    errno.ENOTDIR,
    errno.EISDIR,
    errno.ENAMETOOLONG,
}
MIB = 2**20
STDIN = Path("/dev/stdin")
OPEN_FILES = ("/dev/fd", "/proc/self/fd")  # folders in which a process sees its open files by their numbers
ROOM_BYTES = 2**17  # below this a disk counts as full


def files_like(path: Path) -> str:
    """Return what to add to a line about a file or folder that is not there: names like it in its place, if any."""
    try:
        beside = sorted(os.listdir(path.parent))
    except OSError:
        beside = []
    alike = get_close_matches(path.name, beside[:LOOKED], NEAREST)
    return f"; did you mean {', '.join(alike)}?" if alike else ""


@contextlib.contextmanager
def atomic_path(path: Path, size: int = 0) -> Iterator[Path]:
    """Yield a temporary path beside `path`; on success it is synced to disk and replaces `path`, else it is deleted.

    The size [bytes] of the whole file, if it is known, is told where the disk is full.

    Raises:
        DataError: the disk is full, or the place cannot be written to.
    """
    temporary = None
    handle = None
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(prefix=PARTIAL, suffix=f".{path.name}", dir=path.parent)
        temporary = Path(name)
        with contextlib.suppress(OSError):  # not every file system has locks
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        yield temporary
        with temporary.open("rb+") as file:
            os.fsync(file.fileno())
        temporary.chmod(0o644)
        os.replace(temporary, path)
    except OSError as error:
        if error.errno not in REFUSALS:
            raise
        raise DataError(refusal(error, path, temporary, size)) from None
    finally:
        if temporary:
            temporary.unlink(missing_ok=True)
        if handle is not None:
            os.close(handle)


def sweep(folder: Path) -> None:
    """Delete what commands that were killed left half written in a folder; what is being written is locked."""
    for path in folder.glob(f"{PARTIAL}*"):
        discard(path)


def discard(path: Path) -> None:
    """Delete a file that was left half written, unless somebody is writing it."""
    with contextlib.suppress(OSError), path.open("rb+") as file:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        path.unlink()


def refusal(error: OSError, path: Path, temporary: Path | None = None, size: int = 0) -> str:
    """Return one line for a file that could not be written; on a full disk with the space [MiB] needed and free.

    Where the size [bytes] of the whole file is not known, more is needed than is free, its unfinished part included.
    """
    if error.errno not in FULL:
        beside = str(error.filename).startswith((str(path), str(path.parent / PARTIAL)))
        why = error.strerror if error.filename is None or beside else f"{error.strerror} ({error.filename})"
        return f"{path}: cannot be written: {why}; accepted: a folder that you may write to"
    place = next(folder for folder in (path, *path.absolute().parents) if folder.is_dir())
    free = shutil.disk_usage(place).free + (temporary.stat().st_size if temporary else 0)
    needed = f"{size / MIB:.3f}" if size > free else f"more than {free / MIB:.3f}"
    return f"{path}: cannot be written: {error.strerror}; needed: {needed} MiB, free: {free / MIB:.3f} MiB"


def check_room(folder: Path) -> None:
    """Check that a folder can be made and written to, by a small file that is gone at once.

    Raises:
        DataError: the disk is full, or the folder cannot be written to.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder) as file:
            file.write(bytes(ROOM_BYTES))
    except OSError as error:
        raise DataError(refusal(error, folder, size=ROOM_BYTES)) from None


def check_place(folder: Path) -> None:
    """Check that a folder, which may not be there yet, can be written to, and make nothing.

    Raises:
        DataError: the disk is full, or what is there of the folder's path cannot be written to.
    """
    check_room(next(place for place in (folder, *folder.absolute().parents) if place.exists()))


def write_text(path: Path, text: str) -> None:
    """Write a text file atomically."""
    content = text.encode()
    with atomic_path(path, len(content)) as temporary:
        temporary.write_bytes(content)


def write_json(path: Path, value: Mapping[str, object]) -> None:
    """Write a JSON file atomically, keys in the order given."""
    write_text(path, json.dumps(value, indent=1) + "\n")


def descriptor_of(path: Path) -> int | None:
    """Return the open file that a path stands for: that of `-`, of /dev/stdin, and of a shell's `<(...)`; else None."""
    if path in (Path("-"), STDIN):
        return 0
    is_number = path.name.isascii() and path.name.isdecimal()
    return int(path.name) if str(path.parent) in OPEN_FILES and is_number else None


def stem_of(path: Path) -> str:
    """Return the name of a robot's file without its endings; that of a pipe says nothing."""
    return "robot" if descriptor_of(path) is not None else Path(path.name.removesuffix(".gz")).stem


def check_regular(path: Path) -> None:
    """Check that what stands at a path, if anything does, is a file: reading a pipe or a device may never end.

    Raises:
        DataError: it is something else.
    """
    if path.exists() and not path.is_file():
        what = "a folder" if path.is_dir() else "a pipe or a device"
        raise DataError(f"{path}: {what} is not accepted; accepted: a file")


def read_text(path: Path) -> str:
    """Read a text file, UTF-8.

    Raises:
        DataError: it is missing, cannot be read or is no text.
    """
    try:
        check_regular(path)
        return path.read_text(encoding="utf-8")
    except FileNotFoundError:
        raise DataError(f"{path}: file is missing; accepted: a text file") from None
    except UnicodeDecodeError as error:
        raise DataError(f"{path}: not text in UTF-8, byte {error.start}; accepted: text in UTF-8") from None
    except OSError as error:
        raise DataError(f"{path}: cannot be read: {error.strerror}") from None


def read_json(path: Path) -> dict[str, Any]:
    """Read a JSON object.

    Raises:
        DataError: the file is missing or is not JSON, a key occurs twice or a number is not finite.
    """
    return parse_json(read_text(path), str(path))


def parse_json(text: str, place: str) -> dict[str, Any]:
    """Return the JSON object that a text is; a DataError names its place, as `read_json` does."""
    try:
        value = json.loads(text, object_pairs_hook=_object)
        refuse(place, _not_finite(value))
    except (ValueError, RecursionError) as error:
        raise DataError(f"{place}: not JSON, {error}; accepted: a JSON object") from None
    if not isinstance(value, dict):
        raise DataError(not_accepted(place, value, ["a JSON object"]))
    return value


def _object(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """Return a JSON object whose keys each occur once."""
    entries = dict(pairs)
    if len(entries) < len(pairs):
        names = [name for name, _ in pairs]
        raise ValueError(f"key {next(name for name in names if names.count(name) > 1)!r} occurs twice; accepted: once")
    return entries


def _not_finite(value: object, *place: str) -> Iterator[str]:
    """Yield the numbers below a JSON value that are not finite: Python's reader takes NaN, and 1e999 for infinity."""
    if isinstance(value, float) and not math.isfinite(value):
        yield not_accepted(".".join(place), value, ["finite numbers"])
    elif isinstance(value, dict | list):
        for key, inner in value.items() if isinstance(value, dict) else enumerate(value):
            yield from _not_finite(inner, *place, str(key))


def opened(path: Path) -> int:
    """Return the descriptor of a lock's file, which nothing closes before this process ends.

    Raises:
        DataError: it cannot be written.
    """
    try:
        path.parent.mkdir(exist_ok=True)
        return os.open(path, os.O_RDWR | os.O_CREAT, 0o644)
    except OSError as error:
        raise DataError(refusal(error, path)) from None


def taken(handle: int) -> bool:
    """Take a lock if nobody else holds it, and return whether it was free; a file system without locks says yes."""
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError as error:
        if error.errno not in LOCKLESS:
            raise
        warn_of_missing_locks()
    return True


@functools.cache
def warn_of_missing_locks() -> None:
    """Say, once, that two runs may meet."""
    log.warning("this file system has no locks: nothing keeps two processes in this folder apart")
