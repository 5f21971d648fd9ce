"""What was read of source files, kept between processes in a project's folder: reading their syntax takes a second.

It holds for exactly these sources and this Python: with any other byte of them all is read again. Standard library
only.
"""

from __future__ import annotations

import atexit
import functools
import hashlib
import json
import sys
from contextlib import suppress
from pathlib import Path

from mobnet.core import source
from mobnet.core.errors import DataError
from mobnet.core.files import write_json
from mobnet.core.source import PACKAGES, CodePart, Source

Kept = dict[CodePart, Source]


def read(part: CodePart) -> Source:
    """Read one part, or take what this process or an earlier one has read of it.

    Parts of the packages are kept in the folder `.cache` of a project; elsewhere nothing is kept.
    """
    folder = source.SOURCE
    if not (folder.parent / ".cache").is_dir() or not part.path.is_relative_to(folder):
        return source.read(part)
    return keeper(folder).read(part)


@functools.cache
def keeper(folder: Path) -> Keeper:
    """Return what is kept of the packages below a folder."""
    return Keeper(folder)


class Keeper:
    """Parts of the packages below a folder that were read, by this process or an earlier one."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._file = folder.parent / ".cache" / "source.json"
        self._state = state_of(folder)
        self._kept = self._load()
        self._is_new = False
        atexit.register(self._store)

    def read(self, part: CodePart) -> Source:
        """Return what a part contributes, read at most once."""
        if part not in self._kept:
            self._kept[part] = source.read(part)
            self._is_new = True
        return self._kept[part]

    def _load(self) -> Kept:
        """Return what an earlier process kept of the same sources; nothing of others, or of a damaged file."""
        kept = Kept()
        with suppress(OSError, ValueError, KeyError, TypeError):
            note = json.loads(self._file.read_text(encoding="utf-8"))
            if note["state"] == self._state:
                for key, (digest, parts, packages) in note["parts"].items():
                    used = tuple(map(self._part, parts))
                    kept[self._part(key)] = Source(bytes.fromhex(digest), used, frozenset(packages))
                return kept
        return Kept()

    def _store(self) -> None:
        """Keep what this process has read, if the disk has room for it."""
        if self._is_new:
            parts: dict[str, object] = {}
            for part, contributed in self._kept.items():
                used = [self._key(each) for each in contributed.parts]
                parts[self._key(part)] = [contributed.digest.hex(), used, sorted(contributed.packages)]
            with suppress(DataError, OSError):
                write_json(self._file, {"state": self._state, "parts": parts})

    def _key(self, part: CodePart) -> str:
        return f"{part.path.relative_to(self._folder)}:{part.name}:{'type' if part.is_type else ''}"

    def _part(self, key: str) -> CodePart:
        path, name, kind = key.rsplit(":", 2)
        return CodePart(self._folder / path, name, bool(kind))


def state_of(folder: Path) -> str:
    """Return a hash of all source files of the packages below a folder, and of this Python."""
    state = hashlib.sha256(sys.version.encode())
    for package in PACKAGES:
        for path in sorted((folder / package).rglob("*.py")):
            content = path.read_bytes()
            state.update(f"{path.relative_to(folder)} {len(content)} ".encode())
            state.update(content)
    return state.hexdigest()
