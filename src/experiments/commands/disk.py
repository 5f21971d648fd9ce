"""Sizes of files and folders, and their removal; links are never followed."""

import os
import shutil
from collections.abc import Iterator
from pathlib import Path

from mobnet.core.errors import CommandError


def sizes_of(*places: Path) -> list[int]:
    """Return the bytes that files and folders take; what has several names counts where it is met first."""
    seen: set[tuple[int, int]] = set()
    sizes = [0] * len(places)
    for number, place in enumerate(places):
        for stat in stats(place):
            if (stat.st_dev, stat.st_ino) not in seen:
                sizes[number] += stat.st_blocks * 512
                seen.add((stat.st_dev, stat.st_ino))
    return sizes


def stats(place: Path) -> Iterator[os.stat_result]:
    """Yield what the system knows of a file, or of a folder and all below it."""
    yield place.lstat()
    if place.is_dir() and not place.is_symlink():
        for entry in os.scandir(place):
            if entry.is_dir(follow_symlinks=False):
                yield from stats(Path(entry.path))
            else:
                yield entry.stat(follow_symlinks=False)


def remove(place: Path) -> None:
    """Remove a file, a link or a folder, if there is one.

    Raises:
        CommandError: it cannot be removed.
    """
    try:
        if place.is_dir() and not place.is_symlink():
            shutil.rmtree(place)
        else:
            place.unlink(missing_ok=True)
    except OSError as problem:
        reason = f"{problem.strerror} ({problem.filename})"
        raise CommandError(f"{place}: cannot be removed: {reason}; accepted: what you may remove") from problem
