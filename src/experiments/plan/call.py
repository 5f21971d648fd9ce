"""A call as a value: a function of this package by its dotted name, and the arguments that it gets."""

import ast
import functools
import importlib
from collections.abc import Mapping
from dataclasses import dataclass

from mobnet.core.code import start_of
from mobnet.core.errors import ConfigError, not_accepted


@dataclass(frozen=True)
class Call:
    """A call of a function of this package, `module:name`, with arguments by name: sections, names, paths."""

    function: str
    arguments: Mapping[str, object]

    @property
    def module(self) -> str:
        """Dotted name of the function's module."""
        return self.function.split(":")[0]

    def run(self) -> None:
        """Import the function and call it."""
        getattr(importlib.import_module(self.module), self.function.split(":")[1])(**self.arguments)


def call_of(function: str, available: Mapping[str, object]) -> Call:
    """Return a call whose arguments are those of the available values that the function's signature names.

    Raises:
        ConfigError: the function asks for something else.
    """
    required, optional = parameters(function)
    missing = [name for name in required if name not in available]
    if missing:
        raise ConfigError(not_accepted(f"{function}: parameter", missing[0], available))
    return Call(function, {name: available[name] for name in (*required, *optional) if name in available})


@functools.cache
def parameters(function: str) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return the names of a function's parameters, those without a default and those with one; nothing is imported."""
    module, name = function.split(":")
    tree = ast.parse(start_of(module).read_text(encoding="utf-8"))
    for node in tree.body:
        if isinstance(node, ast.FunctionDef) and node.name == name:
            names = [argument.arg for argument in node.args.args]
            plain = len(names) - len(node.args.defaults)
            return tuple(names[:plain]), tuple(names[plain:])
    raise ConfigError(
        not_accepted(f"function of {module}", name, [n.name for n in tree.body if isinstance(n, ast.FunctionDef)])
    )
