"""What files hold, and what a file says compared with what its place and the configuration say."""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.errors import not_accepted
from mobnet.core.notes import read_array_note
from mobnet.core.store import NOTE, file_of, read_array

NOTHING = "nothing"  # in place of a value that is not there
SAME = 1e-3  # relative to the largest number of a column
Signals = Mapping[str, NDArray[Any]]  # columns of an array by name, each (T,)


def signals_of(stem: Path, names: Sequence[str]) -> dict[str, NDArray[Any]]:
    """Return columns of an array that it has, by name, each (T,)."""
    held = {column["name"] for column in read_array_note(file_of(stem, NOTE))["columns"]}
    wanted = [name for name in names if name in held]
    array = read_array(stem, wanted)[0].astype(np.float64)
    return dict(zip(wanted, array.T, strict=True))


def difference(found: NDArray[Any], wanted: NDArray[Any]) -> float:
    """Return the largest difference of a column (T,) from another one; 0 where it is one of rounding."""
    apart, size = float(np.abs(found - wanted).max()), float(np.abs(wanted).max())
    return apart if apart > SAME * max(size, 1.0) else 0.0


def differences(note: Mapping[str, Any], said: Mapping[str, object], prefix: str = "") -> Iterator[str]:
    """Yield the keys whose value is another one than is said by place and configuration; of lists, the entries."""
    for key, value in said.items():
        found = note.get(key, NOTHING)
        if isinstance(value, Mapping) and isinstance(found, Mapping):
            yield from differences(found, {**dict.fromkeys(found, NOTHING), **value}, f"{prefix}{key}.")
        elif isinstance(value, list | tuple) and isinstance(found, list | tuple) and len(value) == len(found):
            yield from differences(dict(_numbered(found)), dict(_numbered(value)), f"{prefix}{key}.")
        elif found != value:
            yield not_accepted(f"{prefix}{key}", found, [f"{value!r}, as its place and the configuration say"])


def _numbered(entries: Sequence[Any]) -> Iterator[tuple[str, Any]]:
    """Yield the entries of a list, each with its number from 0."""
    yield from ((str(k), entry) for k, entry in enumerate(entries))
