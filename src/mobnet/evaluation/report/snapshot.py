"""The committed snapshot of the default scale's results: writing it, and finding what differs from it.

`./reproduce` calls `python -m mobnet.evaluation.report.snapshot {snapshot,compare,verify}`.
"""

import argparse
import logging
import shutil
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path

from mobnet.core.errors import DataError, MobnetError
from mobnet.core.files import atomic_path, read_text, write_json, write_text
from mobnet.core.provenance import provenance
from mobnet.evaluation.number.files import read_texts
from mobnet.evaluation.report.manifest import differences, file_hash
from mobnet.settings.load import load_settings
from mobnet.settings.settings import Settings

log = logging.getLogger(__name__)

TABLES, FIGURES, SNAPSHOT = Path("tables"), Path("figures"), Path("docs/results")
COMPUTE, MANIFEST = Path("results/default/compute.md"), Path("results/MANIFEST.sha256")
README, HEADLINE = Path("README.md"), "table_05"
KEYS = (  # columns that name a row; the others are results
    "scenario", "level", "method", "joint", "metric", "claim",
    "set", "quantity", "part", "command", "bin_from", "measure", "limb", "test", "pushed", "share", "unit",
)  # fmt: skip
Rows = dict[tuple[str, ...], dict[str, str]]


def write_snapshot(settings: Settings, tables: Path, figures: Path, compute: Path, out: Path) -> None:
    """Copy a scale's tables (CSV, Markdown), figures (PNG) and table of compute, and note where they come from.

    The table of compute differs from run to run, so only its Markdown is stored, and no CSV to be compared.

    Raises:
        DataError: there is no table to copy, or a file is missing.
    """
    numbers = sorted(tables.glob("*.csv"))
    found = [*numbers, *(path.with_suffix(".md") for path in numbers), *sorted(figures.glob("*.png")), compute]
    if not numbers:
        raise DataError(f"{tables}: holds no CSV; ./reproduce all makes them")
    missing = [path for path in found if not path.is_file()]
    if missing:
        raise DataError(f"{missing[0]}: file is missing; ./reproduce all makes it")
    for source in found:
        with atomic_path(out / source.name) as temporary:
            shutil.copyfile(source, temporary)
    write_json(out / "provenance.json", {"scale": settings.scale, **provenance(settings.model_dump(mode="json"))})
    log.info("%s: %d files", out, len(found))


def with_headline(text: str, table: str) -> str:
    """Return a page with the headline table between its marks, which it must have."""
    first, last = f"<!-- {HEADLINE} -->\n", f"<!-- /{HEADLINE} -->"
    if first not in text or last not in text:
        raise DataError(f"{README}: the marks {first.strip()!r} and {last!r} are missing")
    return text[: text.index(first)] + first + table.strip() + "\n" + text[text.index(last) :]


def compare_snapshot(snapshot: Path, tables: Path) -> list[str]:
    """Return one line for each cell, row or table in which the present tables differ from a snapshot."""
    stored = sorted(snapshot.glob("*.csv"))
    if not stored:
        raise DataError(f"{snapshot}: holds no CSV; ./reproduce snapshot stores them")
    return [line for path in stored for line in table_differences(path, tables / path.name)]


def table_differences(old: Path, new: Path) -> Iterator[str]:
    """Yield one line for each cell or row in which a table differs, old value first."""
    if not new.exists():
        yield f"{new}: file is missing; ./reproduce all makes it"
        return
    before, after = read_keyed(old), read_keyed(new)
    for key in before | after:
        where = f"{new.name}: {' '.join(key)}"
        if key not in after:
            yield f"{where}: row is gone"
        elif key not in before:
            yield f"{where}: row is new"
        else:
            yield from (f"{where}: {text}" for text in cell_differences(before[key], after[key]))


def cell_differences(old: Mapping[str, str], new: Mapping[str, str]) -> Iterator[str]:
    """Yield `column old -> new` for each column in which two rows differ."""
    for column in dict.fromkeys([*old, *new]):
        was, now = old.get(column, "no such column"), new.get(column, "no such column")
        if was != now:
            yield f"{column} {was} -> {now}"


def read_keyed(path: Path) -> Rows:
    """Read a tidy CSV as (values of the naming columns) -> row."""
    return {tuple(row[key] for key in KEYS if key in row): row for row in read_texts(path)}


def main(words: list[str]) -> int:
    """Run one of the commands and return the exit status: 0 if nothing differs."""
    parser = argparse.ArgumentParser(prog="./reproduce", description="Store, compare or verify the results.")
    parser.add_argument("command", choices=("snapshot", "compare", "verify"))
    parser.add_argument("--manifest", type=Path, default=MANIFEST, help="manifest to verify (default: %(default)s)")
    options = parser.parse_args(words)
    logging.basicConfig(level=logging.INFO, format="%(message)s", stream=sys.stdout)
    try:
        if options.command == "snapshot":
            write_snapshot(load_settings(), TABLES, FIGURES, COMPUTE, SNAPSHOT)
            table = read_text(SNAPSHOT / f"{HEADLINE}.md")
            write_text(README, with_headline(read_text(README), table))
            return 0
        compares = options.command == "compare"
        found = compare_snapshot(SNAPSHOT, TABLES) if compares else differences(options.manifest)
    except MobnetError as error:
        log.error("%s", error)
        return 1
    for line in found:
        log.info("%s", line)
    listed = SNAPSHOT if compares else f"{options.manifest} ({file_hash(options.manifest)})"
    log.info("%s: %s", listed, f"{len(found)} differences" if found else "no difference")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
