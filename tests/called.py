"""Calls of the functions that make tables and figures."""

import inspect
from collections.abc import Callable, Mapping
from typing import Any


def call(function: Callable[..., None], known: Mapping[str, Any]) -> None:
    """Call a function with those of the known values that its parameters name."""
    names = inspect.signature(function).parameters
    function(**{name: known[name] for name in names if name in known})
