"""What a file says compared with what its place and the configuration say."""

from collections.abc import Iterator, Mapping
from typing import Any

from mobnet.core.errors import not_accepted

NOTHING = "nothing"  # in place of a value that is not there


def differences(note: Mapping[str, Any], said: Mapping[str, object], prefix: str = "") -> Iterator[str]:
    """Yield the keys whose value is another one than is said by place and configuration."""
    for key, value in said.items():
        found = note.get(key, NOTHING)
        if found != value:
            yield not_accepted(f"{prefix}{key}", found, [f"{value!r}, as its place and the configuration say"])
