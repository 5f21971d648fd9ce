"""What runs have begun: Snakemake removes the outputs of a job before it starts, and would not miss all of them.

It makes a missing file again where it is asked for, or where a job that runs anyway reads it. What lies between is
forgotten where its job was stopped: of a job that would make the same bytes, nothing else has changed.
"""

from collections.abc import Iterable
from pathlib import Path

from mobnet.core.files import write_text

BEGUN = Path("state") / "begun.txt"  # below the results of a scale


def lost(path: Path) -> list[str]:
    """Return the files and folders that runs have begun to make, by a list of them, and that are not there."""
    names = path.read_text(encoding="utf-8").splitlines() if path.exists() else []
    return [name for name in names if not Path(name).exists()]


def record_begun(path: Path, outputs: Iterable[str]) -> None:
    """Record what a run is about to make, beside what earlier ones have lost."""
    write_text(path, "".join(f"{name}\n" for name in sorted({*lost(path), *outputs})))


def record_end(path: Path) -> None:
    """Record the end of a run that made all of its files: what others have lost is still missing."""
    missing = lost(path)
    if missing:
        write_text(path, "".join(f"{name}\n" for name in missing))
    else:
        path.unlink(missing_ok=True)
