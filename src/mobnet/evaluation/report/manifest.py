"""The list of every result file with its hash, in the format of sha256sum.

It shows whether files are still as their run wrote them. Some differ from one run to the next: `run.json` and
`runs.html` hold times, and so do the table of compute, its page and the paper.
"""

import hashlib
from collections.abc import Iterable
from pathlib import Path

from mobnet.core.errors import DataError
from mobnet.core.files import write_text

BETWEEN = "  "  # sha256sum's text between hash and name


def manifest(files: Iterable[Path], out: Path) -> None:
    """Write one line for each file, sorted by name: SHA-256 and path as given."""
    lines = [f"{file_hash(path)}{BETWEEN}{path}\n" for path in sorted(set(files))]
    write_text(out, "".join(lines))


def damaged_files(listed: Path) -> list[str]:
    """Return one line for each file that is missing or differs from its hash; paths are relative to the working folder.

    Args:
        listed: file that `manifest` wrote.
    """
    if not listed.is_file():
        raise DataError(f"{listed}: file is missing; ./reproduce all writes it")
    lines = listed.read_text(encoding="utf-8").splitlines()
    return [fault for fault in (_fault(*line.split(BETWEEN, 1)) for line in lines) if fault]


def _fault(expected: str, name: str) -> str | None:
    """Return what is wrong with a file, or None."""
    if not Path(name).is_file():
        return f"{name}: file is missing"
    found = file_hash(Path(name))
    return None if found == expected else f"{name}: hash {found[:12]}, the manifest says {expected[:12]}"


def file_hash(path: Path) -> str:
    """Return the SHA-256 of a file."""
    try:
        with path.open("rb") as file:
            return hashlib.file_digest(file, "sha256").hexdigest()
    except FileNotFoundError:
        raise DataError(f"{path}: file is missing") from None
