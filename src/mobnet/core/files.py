"""Writing files so that a reader finds either the old or the complete new one, and reading text and JSON."""

import contextlib
import errno
import json
import os
import shutil
import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from mobnet.core.errors import DataError, not_accepted

WEIGHTS, METRICS, RUN = "weights.safetensors", "metrics.csv", "run.json"  # files of a trained network
PARTIAL = ".partial."  # first characters of the name of a file that is being written
FULL = frozenset({errno.ENOSPC, errno.EDQUOT})
REFUSALS = FULL | {
    errno.EACCES, errno.EPERM, errno.EROFS, errno.EEXIST, errno.ENOTDIR, errno.EISDIR, errno.ENAMETOOLONG,
}  # fmt: skip
MIB = 2**20
ROOM_BYTES = 2**16


@contextlib.contextmanager
def atomic_path(path: Path) -> Iterator[Path]:
    """Yield a temporary path beside `path`; on success it is synced to disk and replaces `path`, else it is deleted.

    Raises:
        DataError: the disk is full, or the place cannot be written to.
    """
    temporary = None
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(prefix=PARTIAL, suffix=f".{path.name}", dir=path.parent)
        os.close(handle)
        temporary = Path(name)
        yield temporary
        with temporary.open("rb+") as file:
            os.fsync(file.fileno())
        temporary.chmod(0o644)
        os.replace(temporary, path)
    except OSError as error:
        if error.errno not in REFUSALS:
            raise
        raise DataError(refusal(error, path, temporary)) from None
    finally:
        if temporary:
            temporary.unlink(missing_ok=True)


def refusal(error: OSError, path: Path, temporary: Path | None = None) -> str:
    """Return one line for a file that could not be written; on a full disk with the space [MiB] needed and free.

    What is needed is unknown before a file is whole: more than what is free and what the unfinished file takes.
    """
    if error.errno not in FULL:
        other = error.filename if error.filename != str(path) and PARTIAL not in str(error.filename) else None
        why = f"{error.strerror} ({other})" if other else error.strerror
        return f"{path}: cannot be written: {why}; accepted: a folder that you may write to"
    place = next(folder for folder in (path, *path.absolute().parents) if folder.is_dir())
    taken = temporary.stat().st_size if temporary else 0
    free = (shutil.disk_usage(place).free + taken) / MIB
    return f"{path}: cannot be written: {error.strerror}; needed: more than {free:.3f} MiB, free: {free:.3f} MiB"


def check_room(path: Path) -> None:
    """Check that the disk of a path is not full: programs that write there do not always say so.

    Raises:
        DataError: it is full.
    """
    if shutil.disk_usage(path.parent).free < ROOM_BYTES:
        raise DataError(refusal(OSError(errno.ENOSPC, os.strerror(errno.ENOSPC)), path))


def write_text(path: Path, text: str) -> None:
    """Write a text file atomically."""
    with atomic_path(path) as temporary:
        temporary.write_text(text, encoding="utf-8")


def write_json(path: Path, value: Mapping[str, object]) -> None:
    """Write a JSON file atomically, keys in the order given."""
    write_text(path, json.dumps(value, indent=1) + "\n")


def read_text(path: Path) -> str:
    """Read a text file, UTF-8.

    Raises:
        DataError: it is missing, cannot be read or is no text.
    """
    try:
        return path.read_text(encoding="utf-8")
    except FileNotFoundError:
        raise DataError(f"{path}: file is missing") from None
    except UnicodeDecodeError as error:
        raise DataError(f"{path}: not text in UTF-8, byte {error.start}") from None
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
        value = json.loads(text, object_pairs_hook=_object, parse_constant=_no_number)
    except (ValueError, RecursionError) as error:
        raise DataError(f"{place}: not JSON, {error}") from None
    if not isinstance(value, dict):
        raise DataError(not_accepted(place, value, ["a JSON object"]))
    return value


def _object(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """Return a JSON object whose keys each occur once."""
    found = dict(pairs)
    if len(found) < len(pairs):
        names = [name for name, _ in pairs]
        raise ValueError(f"key {next(name for name in names if names.count(name) > 1)!r} occurs twice; accepted: once")
    return found


def _no_number(text: str) -> None:
    """Refuse NaN and infinity, which Python's reader takes."""
    raise ValueError(f"{text} is not accepted; accepted: finite numbers")
