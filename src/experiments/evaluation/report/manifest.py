"""The lists of every result file with its hash, in the format of sha256sum: the manifest, and that of files with times.

They show whether files are still as their run wrote them. Equal runs have equal manifests. What a job took is only in
the files of the second list: the table of compute, the page of trainings, the paper.
"""

import hashlib
import re
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

from mobnet.core.errors import DataError
from mobnet.core.files import PARTIAL, read_text, write_text

LINE = re.compile(r"([0-9a-f]{64})  (.+)")
TIMES = "TIMES.sha256"  # beside the manifest
RESULTS = "results"
# Folders of results, and names of files, that no list has: logs, what a training goes on from, what stacks have learned
# (with its time), views, others' files
STATE = "state"
UNLISTED = ("logs", STATE, "stacks", "wandb", "wandb_live", "docs", "trials", "films")
KEPT = (".gitignore", ".snakemake_timestamp", TIMES, "MANIFEST.sha256")
TIMED = ("runs.html", "main.pdf")  # they show what jobs took, as the table of compute does
COMPUTE = "compute"


def manifest(results: Path, beside: Sequence[Path], built: Sequence[Path], out: Path) -> None:
    """Write one line for each file, sorted by name: SHA-256 and path as given; of files with times into `TIMES`.

    Args:
        results: folder of a scale's results, with those below it.
        beside: folders of its tables and figures, without those below them.
        built: files of the paper.
        out: the list; that of files with times stands beside it.
    """
    files = [path for path in results.rglob("*") if is_listed(path.relative_to(results))]
    for folder in beside:
        files += folder.glob("*")
    files = [path for path in [*files, *built] if path.is_file() and path.name not in KEPT]
    timed = [path for path in files if path.name in TIMED or path.stem == COMPUTE]
    write_lists(set(files) - set(timed), timed, out)


def write_lists(files: Iterable[Path], timed: Iterable[Path], out: Path) -> None:
    """Write the list of some files, and beside it that of files with times."""
    for listed, paths in ((out.with_name(TIMES), timed), (out, files)):
        write_text(listed, "".join(f"{file_hash(path)}  {path}\n" for path in sorted(set(paths))))


def differences(listed: Path) -> list[str]:
    """Return one line for each file that is missing, differs from its hash or is in no list.

    Paths are relative to the working folder.

    Args:
        listed: file that `manifest` wrote.

    Raises:
        DataError: one of the two lists is missing or damaged.
    """
    # What jobs took differs from run to run: files with times have a list of their own, so that equal runs have equal
    # manifests.
    hashes: dict[str, str] = {}
    for path in (listed, listed.with_name(TIMES)):
        hashes |= {name: found for found, name in read_lines(path)}
    faults = [fault for pair in hashes.items() if (fault := _fault(*pair))]
    return faults + [f"{path}: is in no list; accepted: the files of {listed}" for path in too_many(hashes)]


def read_lines(listed: Path) -> Iterator[tuple[str, str]]:
    """Yield hash and name of each file in a list."""
    if not listed.is_file():
        raise DataError(f"{listed}: file is missing; ./reproduce all writes it")
    for number, line in enumerate(read_text(listed).splitlines(), 1):
        match = LINE.fullmatch(line)
        if match is None:
            raise DataError(f"{listed}:{number}: {line[:80]!r} is not accepted; accepted: SHA-256, two spaces, a file")
        yield match[1], match[2]


def too_many(names: Iterable[str]) -> list[Path]:
    """Return the files that are not among those named, in a scale's folder of results and beside tables and figures."""
    known = {Path(name) for name in names}
    scales = {Path(*path.parts[:2]) for path in known if path.parts[0] == RESULTS}
    beside = {path.parent for path in known if path.parts[0] != RESULTS}
    found: set[Path] = set()
    for scale in scales:
        found.update(path for path in scale.rglob("*") if is_listed(path.relative_to(scale)))
    for folder in beside:
        if folder.name != "paper":
            found.update(folder.glob("*"))
    return sorted(path for path in found - known if path.is_file() and path.name not in KEPT)


def is_listed(path: Path) -> bool:
    """Return whether a list has a file below a scale's results; a robot's states lie in the folder of the robot."""
    is_unfinished = any(part.startswith(PARTIAL) for part in path.parts)
    return path.parts[0] not in UNLISTED and path.parts[1:2] != (STATE,) and not is_unfinished


def _fault(name: str, expected: str) -> str | None:
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
