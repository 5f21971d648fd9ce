"""What interrupted writes of a killed run left."""

from pathlib import Path

from mobnet.core.files import PARTIAL

WRITTEN = ("results", "tables", "figures", "paper")  # folders of a project in which jobs write
ANY = "[a-z0-9_]" * 8  # what tempfile puts into the name of a file


def sweep(root: Path) -> None:
    """Remove the unfinished files in a project's folder; the caller knows that nobody writes."""
    for folder in WRITTEN:
        for path in list((root / folder).glob(f"**/{PARTIAL}{ANY}.*")):
            path.unlink(missing_ok=True)
