"""A hash of the code behind a result, so that an edit reruns exactly what depends on it.

Snakemake sees a script but not what it imports; each rule therefore carries the hash of its code as a parameter. The
machine code of compiled functions and the checkpoints of trainings belong to the same hash. It covers

* the syntax of the files named and of all that they use of these packages, directly or not (`mobnet.core.source`),
  without what cannot change a result: comments, docstrings, and the texts of errors and log messages;
* the lines in environment.lock of the packages that this code imports, and of those that these require.

Standard library only: the hash exists before anything is installed. As long as a package is not installed, nobody
knows what it requires; it then counts with its own line alone, and the hash may differ from the one afterwards.
"""

from __future__ import annotations

import functools
import hashlib
import importlib.metadata
import re
import subprocess
from collections.abc import Iterable
from itertools import chain
from pathlib import Path

from mobnet.core.errors import ConfigError
from mobnet.core.root import ROOT
from mobnet.core.source import PACKAGES, SOURCE, CodePart, Source, is_declaring, lock_name
from mobnet.core.source_cache import read

LOCK = ROOT / "environment.lock"
SHORT = 16  # characters of a hash that are kept
UNKNOWN = "unknown"
CHANGED = "-changed"


@functools.cache
def code_hash(*starts: Path | str) -> str:
    """Return a short hash of the code behind files, or behind dotted names of modules or of functions, `module:name`.

    Of a function in a package that declares, such as the plan, that function counts and what it uses, not its module.

    Raises:
        ConfigError: there is no such file or module.
    """
    sources = reached(map(part_of, starts))
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
    sources = reached(map(part_of, starts))
    digests = sorted(source.digest for source in sources)
    return hashlib.sha256(b"".join(digests)).hexdigest()[:SHORT]


def start_of(start: Path | str) -> Path:
    """Return the file of a path or of a dotted name such as `mobnet.learning.train:train`."""
    is_dotted = isinstance(start, str) and start.split(".")[0] in PACKAGES
    place = SOURCE.joinpath(*start.partition(":")[0].split(".")) if is_dotted else Path(start)
    accepted = (place / "__init__.py", place.with_suffix(".py")) if is_dotted else (place,)
    file_of_code = next((file.resolve() for file in accepted if file.is_file()), None)
    if file_of_code is None:
        accepted_names = " or ".join(PACKAGES)
        raise ConfigError(f"{start}: no such code; accepted: a file, or a module of {accepted_names} below {SOURCE}")
    return file_of_code


def part_of(start: Path | str) -> CodePart:
    """Return where the code behind a path or a dotted name begins: a file, or a function of one that declares."""
    module, _, name = str(start).partition(":")
    return CodePart(start_of(start), name if isinstance(start, str) and is_declaring(module) else "")


def reached(starts: Iterable[CodePart]) -> tuple[Source, ...]:
    """Return some parts and all that they use of these packages, directly or not."""
    sources: dict[CodePart, Source] = {}
    waiting = [*starts]
    while waiting:
        part = waiting.pop()
        if part not in sources:
            sources[part] = read(part)
            waiting += sources[part].parts
    return tuple(sources.values())


def with_required(packages: Iterable[str]) -> set[str]:
    """Return packages and those that they require, directly or not, as far as environment.lock has them."""
    names: set[str] = set()
    waiting = list(packages)
    while waiting:
        name = waiting.pop()
        if name not in names and name in lock_lines():
            names.add(name)
            waiting += required(name)
    return names


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


def commit_of(file: Path) -> str:
    """Return the last commit that changed a file of this checkout; `unknown` without git."""
    return _git("log", "-1", "--format=%H", "--", str(file)) or UNKNOWN


def changed_between(first: str, second: str) -> list[str] | None:
    """Return the files of this checkout in which two commits differ; None where git does not know both."""
    names = _git("diff", "--name-only", "--no-renames", first, second)
    return None if names is None else names.splitlines()


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
