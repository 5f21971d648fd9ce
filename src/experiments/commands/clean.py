"""Remove what the workflow makes, after a list and a question."""

import os
import shutil
import sys
from collections.abc import Iterator
from pathlib import Path

from experiments.commands.tell import in_gb, say
from experiments.running.one_run import held_folder
from mobnet.core.errors import CommandError

PRODUCTS = {  # folder -> endings of what it holds besides products
    "tables": (".gitignore",),
    "figures": (".gitignore",),
    "paper": ("README.md", ".tex", ".bib"),
}
WHOLE = ("results", ".snakemake", "report.html", "MUJOCO_LOG.TXT")
ENVIRONMENT = (".venv", ".cache", ".pytest_cache", ".ruff_cache", ".hypothesis")


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


def clean(root: Path, *, everything: bool, is_dry: bool, is_sure: bool) -> int:
    """Remove the products, and with `everything` the environment and the caches; return 1 where the user says no.

    Raises:
        CommandError: a run is going on, or nobody is there to be asked.
    """
    to_remove = list(places(root, everything=everything))
    sizes = sizes_of(*to_remove)
    for size, place in zip(sizes, to_remove, strict=True):
        link = " (a link; what it names stays)" if place.is_symlink() else ""
        sys.stdout.write(f"{in_gb(size):>10}  {place.relative_to(root)}{link}\n")
    sys.stdout.write(f"{in_gb(sum(sizes)):>10}  in all\n")
    if is_dry or not to_remove:
        return 0
    with held_folder(root, ["clean"]):
        if not (is_sure or agreed()):
            say("nothing is removed")
            return 1
        for place in to_remove:
            remove(place)
    return 0


def places(root: Path, *, everything: bool) -> Iterator[Path]:
    """Yield what would be removed; a linked folder is one thing, whose content is not looked at."""
    for name in (*WHOLE, *(ENVIRONMENT if everything else ())):
        if (root / name).exists() or (root / name).is_symlink():
            yield root / name
    for name, kept in PRODUCTS.items():
        folder = root / name
        if folder.is_dir() and not folder.is_symlink():
            yield from (path for path in sorted(folder.iterdir()) if not path.name.endswith(kept))


def agreed() -> bool:
    """Ask the user.

    Raises:
        CommandError: the input is no terminal.
    """
    if not sys.stdin.isatty():
        raise CommandError("nothing is removed: no terminal to ask at; --yes removes without a question")
    sys.stderr.write("remove all of this? [y/N] ")
    return input().strip().lower() in ("y", "yes")
