"""Values as YAML on one line, so that rows of a file stand below each other."""

from collections.abc import Callable, Mapping
from typing import Any


def flow(value: Any, other: Callable[[Any], str] = str) -> str:
    """Return a value as YAML on one line; numbers keep all their digits, and `other` writes what is no number."""
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{key}: {flow(own, other)}" for key, own in value.items()) + "}"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(flow(one, other) for one in value) + "]"
    if isinstance(value, float):
        digits, e, power = repr(value).partition("e")
        return f"{digits}{'' if '.' in digits else '.0'}{e}{power}"  # YAML takes 1e-05 for a text
    return other(value)
