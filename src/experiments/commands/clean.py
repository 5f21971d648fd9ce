"""Remove what the workflow makes, after a list and a question."""

import sys
from collections.abc import Iterator
from pathlib import Path

from experiments.commands.disk import remove, sizes_of
from experiments.commands.tell import in_gb, say
from mobnet.core.errors import CommandError

PRODUCTS = {  # folder -> endings of what it holds besides products
    "tables": (".gitignore",),
    "figures": (".gitignore",),
    "paper": ("README.md", ".tex", ".bib"),
}
WHOLE = ("results", ".snakemake", "report.html", "MUJOCO_LOG.TXT")
UNLOCK = "if none is going on, `./reproduce all --unlock` takes its locks away"
ENVIRONMENT = (".venv", ".cache", ".pytest_cache", ".ruff_cache", ".hypothesis")


def clean(root: Path, *, everything: bool, is_dry: bool, is_sure: bool) -> int:
    """Remove the products, and with `everything` the environment and the caches; return 1 where the user says no.

    Raises:
        CommandError: a run is going on, or nobody is there to be asked.
    """
    found = list(places(root, everything=everything))
    sizes = sizes_of(*found)
    for size, place in zip(sizes, found, strict=True):
        link = " (a link; what it names stays)" if place.is_symlink() else ""
        sys.stdout.write(f"{in_gb(size):>10}  {place.relative_to(root)}{link}\n")
    sys.stdout.write(f"{in_gb(sum(sizes)):>10}  in all\n")
    if is_dry or not found:
        return 0
    if is_in_use(root):
        raise CommandError(f"nothing is removed: a run is going on here, or was killed; {UNLOCK}")
    if not (is_sure or agreed()):
        say("nothing is removed")
        return 1
    for place in found:
        remove(place)
    return 0


def is_in_use(root: Path) -> bool:
    """Return whether a run of Snakemake holds a project's folder, or one that was killed left its locks there."""
    return any((root / ".snakemake" / "locks").glob("*"))


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
