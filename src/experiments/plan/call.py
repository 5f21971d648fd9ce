"""A job as a value: a function of this package by its dotted name, and the arguments that it gets."""

import ast
import functools
import hashlib
import importlib
from collections.abc import Mapping
from dataclasses import dataclass, field

from experiments.running.stamp import Stamps
from mobnet.core.code import SHORT, code_hash, start_of
from mobnet.core.errors import ConfigError, not_accepted

STAGE = "stage"  # argument that says where a job keeps its parts


@dataclass(frozen=True)
class Call:
    """A call of a function of this package, `module:name`, with arguments by name: sections, names, paths."""

    function: str
    arguments: Mapping[str, object]

    @property
    def module(self) -> str:
        """Dotted name of the function's module."""
        return self.function.split(":")[0]

    @property
    def fingerprint(self) -> str:
        """Short hash of the function's name and of every argument."""
        return hashlib.sha256(repr(self).encode()).hexdigest()[:SHORT]

    def run(self) -> None:
        """Import the function and call it."""
        getattr(importlib.import_module(self.module), self.function.split(":")[1])(**self.arguments)


@dataclass(frozen=True)
class Job:
    """A call, and what it reads and makes.

    Attributes:
        call: the call.
        inputs: files that it reads.
        modules: those that it imports by name only.
        own: note, or file of rows, that it makes -> what of the arguments and of the modules is for this file alone.
        parts: names of the arguments that list what it makes one after another.
    """

    call: Call
    inputs: tuple[str, ...]
    modules: tuple[str, ...] = ()
    own: Mapping[str, object] = field(default_factory=dict[str, object])
    parts: tuple[str, ...] = ()

    @property
    def given(self) -> str:
        """What the job reruns on besides its files: its arguments and the code behind it."""
        return self.call.fingerprint + code_hash(self.call.module, *self.modules)

    @functools.cached_property
    def stamps(self) -> Stamps:
        """What is stamped on each file, the same however the parts are divided among jobs."""
        shared = {name: value for name, value in self.call.arguments.items() if name not in (*self.parts, STAGE)}
        common = Call(self.call.function, shared).fingerprint + code_hash(self.call.module)
        return Stamps({name: Call(common, {"own": own}).fingerprint for name, own in self.own.items()})


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
