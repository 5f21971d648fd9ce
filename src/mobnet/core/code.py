"""A hash of the code behind a result, so that an edit reruns exactly what depends on it.

Snakemake sees a script but not what it imports; each rule therefore carries `code_hash(its script)` as a parameter.
Docstrings and comments do not count.
"""

from __future__ import annotations

import ast
import functools
import hashlib
from collections.abc import Iterable, Iterator
from pathlib import Path

SOURCE = Path(__file__).parents[2]
PACKAGE = "mobnet"
NOTED_ONLY = frozenset({"mobnet.core.provenance", "mobnet.core.logs"})  # they write notes, never results
SHORT = 16  # characters of a hash that are kept


def code_hash(*scripts: Path | str) -> str:
    """Return a short hash of scripts and of every module of this package that they import, directly or not."""
    files: set[Path] = set()
    waiting = [Path(script).resolve() for script in scripts]
    while waiting:
        path = waiting.pop()
        if path not in files:
            files.add(path)
            waiting += reading(path)[1]
    return hashlib.sha256("".join(reading(path)[0] for path in sorted(files)).encode()).hexdigest()[:SHORT]


@functools.cache
def reading(path: Path) -> tuple[str, tuple[Path, ...]]:
    """Return a file's code without docstrings, as text, and the files of this package that it imports."""
    tree = ast.parse(path.read_text(encoding="utf-8"), str(path))
    imported = {file for name in imported_names(tree) for file in module_files(name)}
    return ast.dump(without_docstrings(tree)), tuple(sorted(imported))


def imported_names(tree: ast.Module) -> Iterator[str]:
    """Yield the dotted names of this package that a module imports, anywhere in it."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names if alias.name.split(".")[0] == PACKAGE)
        elif isinstance(node, ast.ImportFrom) and node.module and node.module.split(".")[0] == PACKAGE:
            yield from (f"{node.module}.{alias.name}" for alias in node.names)


def module_files(name: str) -> Iterable[Path]:
    """Return the files that importing a dotted name runs: its packages and itself, where it is a module."""
    parts = name.split(".")
    for count in range(1, len(parts) + 1):
        if ".".join(parts[:count]) in NOTED_ONLY:
            return
        place = SOURCE.joinpath(*parts[:count])
        for file in (place / "__init__.py", place.with_suffix(".py")):
            if file.is_file():
                yield file


def without_docstrings(tree: ast.Module) -> ast.Module:
    """Return the tree with every docstring taken out, in place."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef) and _is_text(node.body):
            node.body = node.body[1:]
    return tree


def _is_text(body: list[ast.stmt]) -> bool:
    """Return whether a body begins with a docstring."""
    first = body[0] if body else None
    return isinstance(first, ast.Expr) and isinstance(first.value, ast.Constant) and isinstance(first.value.value, str)
