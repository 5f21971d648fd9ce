"""What the hash of code takes of a source file: its syntax, without what cannot change a result, and what it uses.

Files are followed in two ways. A file that computes counts whole, with every file that it imports. The packages of
`DECLARING` say what there is: sections of files and of the configuration, and what each job gets. A job receives their
values as parameters, and an edit of a table's section must not simulate a walk again. So of these packages only those
names count that the code uses, each with the names that it uses in turn:

* of a function or a constant, its code;
* of a class, its methods, wherever an annotation names it: an object of it may come from anywhere. Where the code uses
  the class itself, also its fields with their defaults.

Annotations and bounds of fields do not count, nor do checks: functions whose names end with `problems`, and validators
of a whole section. They only refuse, and a value that was accepted does not depend on them.

Standard library only: the hash exists before anything is installed.
"""

from __future__ import annotations

import ast
import functools
import hashlib
import re
import sys
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

from mobnet.core.errors import misfit, not_accepted

SOURCE = Path(__file__).parents[2]
PACKAGES = ("mobnet", "experiments")
# Imports of these modules are not followed: provenance and logs write notes, and checks refuse, but make no results.
NOT_FOLLOWED = (
    "mobnet.core.code",
    "mobnet.core.source",
    "mobnet.core.source_cache",
    "experiments.running.logs",
    "mobnet.formats.checks",
    "experiments.settings.checks",
)
DECLARING = ("mobnet.formats", "mobnet.settings", "experiments.settings", "experiments.plan")
DISTRIBUTIONS = {  # import name -> name in the lock, where they differ; asking importlib.metadata for all takes 0.4 s
    "OpenGL": "pyopengl",
    "PIL": "pillow",
    "markdown_it": "markdown-it-py",
    "mcap_ros2": "mcap-ros2-support",
    "pinocchio": "pin",
    "yaml": "pyyaml",
}
LOGGERS = frozenset({"log", "logging", "warnings"})
LEVELS = frozenset({"debug", "info", "warning", "warn", "error", "exception", "critical", "log"})
ERROR_TEXTS = frozenset({not_accepted.__name__, misfit.__name__})  # functions that return the text of an error
ANNOTATIONS = frozenset({"annotation", "returns"})  # fields of syntax trees
DEFAULTS = ("default", "default_factory")  # of what a field is declared with
NO_DEFAULT = ast.Constant(...)
CHECK = "problems"  # end of the name of a function that checks


class CodePart(NamedTuple):
    """What counts by itself: a whole file, or a name that a declaring file defines; `is_type`: only as a type."""

    path: Path
    name: str = ""
    is_type: bool = False


class Source(NamedTuple):
    """What one part contributes: the hash of its syntax, and what it uses of these packages and of others."""

    digest: bytes
    parts: tuple[CodePart, ...]
    packages: frozenset[str]


class Declared(NamedTuple):
    """What a declaring file has: the statement that defines each of its names, and the full names of its imports."""

    statements: dict[str, ast.stmt]
    imports: dict[str, str]


@functools.cache
def read(part: CodePart) -> Source:
    """Read one part."""
    return read_name(part) if part.name else read_file(part.path)


def read_file(path: Path) -> Source:
    """Read a whole file."""
    reader = Reader()
    reader.read(ast.parse(path.read_bytes(), str(path)))
    parts = set[CodePart]()
    for name, full_name in reader.imports:
        if is_declaring(full_name):
            parts.update(used_parts(name, full_name, reader))
        else:
            parts.update(map(CodePart, module_files(full_name)))
    return Source(reader.digest, tuple(parts), distributions(full_name for _, full_name in reader.imports))


def used_parts(name: str, full_name: str, reader: Reader) -> Iterator[CodePart]:
    """Yield what a file uses of an import from a declaring package; what it only hands on, it uses."""
    used = reader.values | reader.types
    for used_name in [name, *(each for each in used if each.startswith(f"{name}."))]:
        is_type = used_name in reader.types and used_name not in reader.values
        yield from declared_parts(full_name + used_name.removeprefix(name), is_type=is_type)


def read_name(part: CodePart) -> Source:
    """Read a name of a declaring file: its definition, or where it comes from."""
    declared = read_declared(part.path)
    reader = Reader(is_declaring=True)
    if part.name in declared.statements:
        read_statement(declared.statements[part.name], reader, is_type=part.is_type)
    else:
        (reader.types if part.is_type else reader.values).add(part.name)
    inner = dict(reader.imports)  # of a function: they hide the names of its module
    imports = {**declared.imports, **inner}
    parts = set[CodePart]()
    outside = set[str]()
    for used in reader.types | reader.values:
        first, dot, rest = used.partition(".")
        is_type = used not in reader.values
        full_name = imports.get(first, "") + dot + rest
        if first in declared.statements and first not in inner:
            parts.add(CodePart(part.path, first, is_type))
        elif is_declaring(full_name):
            parts.update(declared_parts(full_name, is_type=is_type))
        elif first in imports and not is_type:
            parts.update(map(CodePart, module_files(full_name)))
            outside.add(full_name)
    return Source(reader.digest, tuple(parts), distributions(outside))


def read_statement(statement: ast.stmt, reader: Reader, *, is_type: bool) -> None:
    """Read what counts of the definition of a name."""
    if isinstance(statement, ast.ClassDef):
        read_class(statement, reader, is_type=is_type)
    elif isinstance(statement, ast.Assign | ast.AnnAssign):
        if is_type and statement.value is not None:
            reader.note(statement.value)
        else:
            reader.read(statement)
    elif not is_type and not is_check(statement):
        reader.read(statement)


def read_class(node: ast.ClassDef, reader: Reader, *, is_type: bool) -> None:
    """Read the methods of a class, and its fields too where it is not only a type."""
    for decorator in node.decorator_list:
        reader.read(decorator)
    for base in node.bases:
        if is_type:
            reader.note(base)
        else:
            reader.read(base)
    for statement in node.body:
        if isinstance(statement, ast.AnnAssign):
            reader.note(statement.annotation)
            if not is_type:
                reader.read(statement.target)
                reader.read(statement.value or NO_DEFAULT)
        elif not is_idle(statement) and not is_check(statement):
            reader.read(statement)


@functools.cache
def read_declared(path: Path) -> Declared:
    """Read what a declaring file defines and imports."""
    tree = ast.parse(path.read_bytes(), str(path))
    statements: dict[str, ast.stmt] = {}
    imports: dict[str, str] = {}
    for statement in tree.body:
        statements |= dict.fromkeys(names_of(statement), statement)
        imports.update(imported(statement))
    return Declared(statements, imports)


def names_of(statement: ast.stmt) -> list[str]:
    """Return the names that a statement defines."""
    if isinstance(statement, ast.ClassDef | ast.FunctionDef):
        return [statement.name]
    targets: list[ast.expr] = []
    if isinstance(statement, ast.Assign):
        targets = statement.targets
    elif isinstance(statement, ast.AnnAssign):
        targets = [statement.target]
    names: list[str] = []
    for target in targets:
        names += [node.id for node in ast.walk(target) if isinstance(node, ast.Name)]
    return names


def imported(node: ast.AST) -> list[tuple[str, str]]:
    """Return the names that a node imports, each with the full name of what it stands for."""
    if isinstance(node, ast.Import):
        return [(alias.asname or alias.name, alias.name) for alias in node.names]
    if isinstance(node, ast.ImportFrom):
        return [(alias.asname or alias.name, f"{node.module}.{alias.name}") for alias in node.names]
    return []


@dataclass
class Reader:
    """Reads a syntax tree, without what cannot change a result, into words, and notes the names that it uses.

    Attributes:
        is_declaring: whether annotations have no part in the words.
        words: kinds of nodes, constants, and brackets around lists.
        imports: names that the tree imports, each with the full name of what it stands for.
        values: names that it uses, and names with an attribute, such as `base.Section`.
        types: those that it uses in annotations.
    """

    is_declaring: bool = False
    words: list[str] = field(default_factory=list)
    imports: set[tuple[str, str]] = field(default_factory=set)
    values: set[str] = field(default_factory=set)
    types: set[str] = field(default_factory=set)

    @property
    def digest(self) -> bytes:
        """Hash of the words; empty without any, so that it is the same whether a bound has a name or not."""
        return hashlib.sha256(" ".join(self.words).encode()).digest() if self.words else b""

    def read(self, node: ast.AST) -> None:
        """Add a node with all below it."""
        self._prepare(node)
        self.words.append(type(node).__name__)
        for name in node._fields:
            if name == "ctx":  # follows from the place of the node
                continue
            value = getattr(node, name, None)
            if isinstance(value, ast.AST):
                if name in ANNOTATIONS:
                    self.note(value)
                else:
                    self.read(value)
            elif isinstance(value, list):
                self.words.append("[")
                for item in value:
                    if not isinstance(item, ast.AST):
                        self.words.append(repr(item))
                    elif not is_idle(item):
                        self.read(item)
                self.words.append("]")
            else:
                self.words.append(repr(value))

    def note(self, annotation: ast.AST) -> None:
        """Note the names that an annotation uses; where it has a part in what is computed, it counts, too."""
        inner = Reader(words=[] if self.is_declaring else self.words)
        inner.read(annotation)
        self.types |= inner.values

    def _prepare(self, node: ast.AST) -> None:
        """Take the texts out of an error and the bounds out of a field, and note what a node uses and imports."""
        if isinstance(node, ast.Name):
            self.values.add(node.id)
        elif isinstance(node, ast.Attribute):
            if isinstance(node.value, ast.Name):
                self.values.add(f"{node.value.id}.{node.attr}")
        elif isinstance(node, ast.Raise) and isinstance(node.exc, ast.Call):
            node.exc = node.exc.func
        elif isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
            if node.func.id in ERROR_TEXTS:
                node.args = []
                node.keywords = []
            elif node.func.id == "Field" and self.is_declaring:
                node.keywords = [keyword for keyword in node.keywords if keyword.arg in DEFAULTS]
        elif isinstance(node, ast.Import | ast.ImportFrom):
            self.imports.update(imported(node))


def is_idle(node: object) -> bool:
    """Return whether a statement cannot change a result: a docstring, a log call, or imports for type checkers."""
    if isinstance(node, ast.If):
        return isinstance(node.test, ast.Name) and node.test.id == "TYPE_CHECKING"
    if not isinstance(node, ast.Expr):
        return False
    value = node.value
    if isinstance(value, ast.Constant):
        return True
    called = value.func if isinstance(value, ast.Call) else None
    if not isinstance(called, ast.Attribute) or not isinstance(called.value, ast.Name):
        return False
    return called.value.id in LOGGERS and called.attr in LEVELS


def is_check(statement: ast.stmt) -> bool:
    """Return whether a function of a declaring package only refuses what is not accepted."""
    if not isinstance(statement, ast.FunctionDef):
        return False
    validators = {"model_validator(mode='after')"}
    return statement.name.endswith(CHECK) or bool(validators.intersection(map(ast.unparse, statement.decorator_list)))


def is_below(name: str, packages: Iterable[str]) -> bool:
    """Return whether a dotted name is one of some packages, or stands in one of them."""
    return any(f"{name}.".startswith(f"{package}.") for package in packages)


@functools.cache
def is_declaring(name: str) -> bool:
    """Return whether a dotted name stands in a declaring package, and not among the checks there."""
    return is_below(name, DECLARING) and not is_below(name, NOT_FOLLOWED)


@functools.cache
def declared_parts(full_name: str, *, is_type: bool) -> tuple[CodePart, ...]:
    """Return the part behind a dotted name in a declaring package; none behind that of a module or a package."""
    names = full_name.split(".")
    for count in range(1, len(names)):
        path = SOURCE.joinpath(*names[:count]).with_suffix(".py")
        if path.is_file():
            return (CodePart(path, names[count], is_type),)
    return ()


@functools.cache
def module_files(name: str) -> tuple[Path, ...]:
    """Return the files that importing a dotted name runs and that count whole: its packages, and a module itself."""
    package, _, _ = name.rpartition(".")
    if name.partition(".")[0] not in PACKAGES or is_below(name, (*NOT_FOLLOWED, *DECLARING)):
        return ()
    place = SOURCE.joinpath(*name.split("."))
    candidates = (place / "__init__.py", place.with_suffix(".py"))
    return (*module_files(package), *(file for file in candidates if file.is_file()))


def distributions(full_names: Iterable[str]) -> frozenset[str]:
    """Return the packages of others behind imports, named as the lock names them."""
    tops = {name.partition(".")[0] for name in full_names} - {*PACKAGES} - sys.stdlib_module_names
    return frozenset(DISTRIBUTIONS.get(top, lock_name(top)) for top in tops)


def lock_name(name: str) -> str:
    """Return a package's name as the lock writes it."""
    return re.sub(r"[-_.]+", "-", name).lower()
