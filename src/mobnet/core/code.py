"""A hash of the code behind a result, so that an edit reruns exactly what depends on it.

Snakemake sees a script but not what it imports; each rule therefore carries the hash of its code as a parameter. The
machine code of compiled functions and the checkpoints of trainings belong to the same hash. It covers

* the syntax trees of the files named and of all modules of these packages that they import, directly or not, without
  what cannot change a result: comments, docstrings, and the texts of errors and log messages;
* the lines in environment.lock of the packages that these files import, and of those that these require.

Standard library only: the hash exists before anything is installed. As long as a package is not installed, nobody
knows what it requires; it then counts with its own line alone, and the hash may differ from the one afterwards.
"""

from __future__ import annotations

import ast
import functools
import hashlib
import importlib.metadata
import re
import subprocess
import sys
from collections.abc import Iterable
from dataclasses import dataclass, field
from itertools import chain
from pathlib import Path
from typing import NamedTuple

from mobnet.core.errors import ConfigError, not_accepted

SOURCE = Path(__file__).parents[2]
ROOT = SOURCE.parent
LOCK = ROOT / "environment.lock"
PACKAGES = ("mobnet", "experiments")
# Imports of these modules are not followed. Provenance and logs write notes, never results. Settings and plan read and
# check the configuration and compute nothing: what a job takes of their values is a parameter of its rule, so that a
# changed value reruns the job, and a changed check of it reruns nothing.
NOT_FOLLOWED = (
    "mobnet.core.code",
    "experiments.running.logs",
    "mobnet.settings",
    "experiments.settings",
    "experiments.plan",
)
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
SHORT = 16  # characters of a hash that are kept
UNKNOWN = "unknown"
CHANGED = "-changed"


class SourceFile(NamedTuple):
    """What one file contributes: the hash of its syntax tree, and what it imports of these packages and of others."""

    digest: bytes
    files: tuple[Path, ...]
    packages: frozenset[str]


@functools.cache
def code_hash(*starts: Path | str) -> str:
    """Return a short hash of the code behind files, or behind dotted names of modules or of functions, `module:name`.

    Raises:
        ConfigError: there is no such file or module.
    """
    sources = reached(start_of(start) for start in starts)
    digests = sorted(source.digest for source in sources)
    packages = with_required(chain.from_iterable(source.packages for source in sources))
    pinned = sorted(lock_lines()[name] for name in packages)
    return hashlib.sha256(b"".join(digests) + "\n".join(pinned).encode()).hexdigest()[:SHORT]


@functools.cache
def source_hash(*starts: Path | str) -> str:
    """Return a short hash of the code behind files or names as `code_hash` does, without the versions of packages.

    Raises:
        ConfigError: there is no such file or module.
    """
    sources = reached(start_of(start) for start in starts)
    digests = sorted(source.digest for source in sources)
    return hashlib.sha256(b"".join(digests)).hexdigest()[:SHORT]


def start_of(start: Path | str) -> Path:
    """Return the file of a path or of a dotted name such as `mobnet.learning.train:train`."""
    is_dotted = isinstance(start, str) and start.split(".")[0] in PACKAGES
    place = SOURCE.joinpath(*start.partition(":")[0].split(".")) if is_dotted else Path(start)
    accepted = (place / "__init__.py", place.with_suffix(".py")) if is_dotted else (place,)
    found = next((file.resolve() for file in accepted if file.is_file()), None)
    if found is None:
        accepted_names = " or ".join(PACKAGES)
        raise ConfigError(f"{start}: no such code; accepted: a file, or a module of {accepted_names} below {SOURCE}")
    return found


def reached(starts: Iterable[Path]) -> tuple[SourceFile, ...]:
    """Return some files and all that they import of these packages, directly or not."""
    found: dict[Path, SourceFile] = {}
    waiting = list(starts)
    while waiting:
        path = waiting.pop()
        if path not in found:
            found[path] = read(path)
            waiting += found[path].files
    return tuple(found.values())


@functools.cache
def read(path: Path) -> SourceFile:
    """Read one file."""
    reader = Reader()
    reader.read(ast.parse(path.read_bytes(), str(path)))
    files = set(chain.from_iterable(map(module_files, reader.imports)))
    tops = {name.partition(".")[0] for name in reader.imports} - {*PACKAGES} - sys.stdlib_module_names
    packages = {DISTRIBUTIONS.get(top, lock_name(top)) for top in tops}
    return SourceFile(hashlib.sha256(" ".join(reader.words).encode()).digest(), tuple(files), frozenset(packages))


@dataclass
class Reader:
    """Reads a syntax tree, without what cannot change a result, into words, and the dotted names that it imports.

    The words are the kinds of its nodes, its constants, and brackets around lists.
    """

    words: list[str] = field(default_factory=list)
    imports: set[str] = field(default_factory=set)

    def read(self, node: ast.AST) -> None:
        """Add a node with all below it."""
        self._prepare(node)
        self.words.append(type(node).__name__)
        for name in node._fields:
            value = getattr(node, name, None)
            if isinstance(value, ast.AST):
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

    def _prepare(self, node: ast.AST) -> None:
        """Take the texts out of an error, and note what an import statement imports."""
        if isinstance(node, ast.Raise) and isinstance(node.exc, ast.Call):
            node.exc = node.exc.func
        elif isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == not_accepted.__name__:
            node.args = []
            node.keywords = []
        elif isinstance(node, ast.Import):
            self.imports.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            self.imports.update(f"{node.module}.{alias.name}" for alias in node.names)


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


@functools.cache
def module_files(name: str) -> tuple[Path, ...]:
    """Return the files that importing a dotted name runs: its packages and itself, where it is a module."""
    parts = name.split(".")
    names = [parts[: count + 1] for count in range(len(parts))]
    if parts[0] not in PACKAGES or any(".".join(some) in NOT_FOLLOWED for some in names):
        return ()
    places = [SOURCE.joinpath(*some) for some in names]
    files = list[Path]()
    for place in places:
        files += [place / "__init__.py", place.with_suffix(".py")]
    return tuple(file for file in files if file.is_file())


def with_required(packages: Iterable[str]) -> set[str]:
    """Return packages and those that they require, directly or not, as far as environment.lock has them."""
    found: set[str] = set()
    waiting = list(packages)
    while waiting:
        name = waiting.pop()
        if name not in found and name in lock_lines():
            found.add(name)
            waiting += required(name)
    return found


@functools.cache
def lock_lines() -> dict[str, str]:
    """Return package -> `name==version` of environment.lock; nothing without that file."""
    text = LOCK.read_text(encoding="utf-8") if LOCK.is_file() else ""
    return {match[1]: match[0] for match in re.finditer(r"^([a-z0-9-]+)==[^\s;\\]+", text, re.MULTILINE)}


@functools.cache
def required(package: str) -> tuple[str, ...]:
    """Return what an installed package requires, its extras apart; nothing where it is not installed."""
    try:
        lines = importlib.metadata.requires(package) or []
    except importlib.metadata.PackageNotFoundError:
        return ()
    return tuple(lock_name(re.split(r"[^\w.-]", line)[0]) for line in lines if "extra ==" not in line)


def lock_name(name: str) -> str:
    """Return a package's name as the lock writes it."""
    return re.sub(r"[-_.]+", "-", name).lower()


def provenance() -> dict[str, str]:
    """Return `commit` and `lock` of a result; `unknown` where git or environment.lock is not there."""
    return {"commit": commit(), "lock": lock_hash()}


@functools.cache
def commit() -> str:
    """Return the commit of this checkout, `-changed` added where tracked files differ from it.

    A copy that lies in a repository of something else has none.
    """
    name = _git("rev-parse", "HEAD")
    if name is None or not _git("ls-files", LOCK.name):
        return UNKNOWN
    return f"{name}{CHANGED}" if _git("status", "--porcelain", "--untracked-files=no") else name


def _git(*words: str) -> str | None:
    """Return what git says about this checkout, or None without git."""
    try:
        done = subprocess.run(["git", "-C", str(ROOT), *words], capture_output=True, text=True, check=True)
    except (OSError, subprocess.CalledProcessError):
        return None
    return done.stdout.strip()


def lock_hash() -> str:
    """Return a short hash of environment.lock, or `unknown` without it."""
    return hashlib.sha256(LOCK.read_bytes()).hexdigest()[:SHORT] if LOCK.exists() else UNKNOWN
