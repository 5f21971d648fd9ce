"""The paper's own numbers, from `configs/published.yaml`."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from mobnet.core.config import read_yaml
from mobnet.core.errors import ConfigError, not_accepted
from mobnet.settings.published import PublishedTable


def read_published(path: Path, table: str) -> dict[str, Any]:
    """Return a table as the paper prints it, every row checked against its joints.

    Args:
        path: YAML file of published results.
        table: its key, such as `table_05`.

    Raises:
        ConfigError: the table is unknown, or a row has not one number for each joint.
    """
    tables = read_yaml(path)
    if table not in tables:
        raise ConfigError(f"{path}: " + not_accepted("table", table, tables))
    entry = tables[table]
    joints = entry["joints"]
    for place, numbers in rows_of(entry, table):
        if len(numbers) != len(joints):
            raise ConfigError(f"{path}: {place}: {len(numbers)} numbers for {len(joints)} joints ({', '.join(joints)})")
    return entry


def rows_of(node: Mapping[str, Any], place: str) -> Iterator[tuple[str, list[float | None]]]:
    """Yield the dotted place of every row of numbers below a place, and the row [in the table's units]."""
    for key, item in node.items():
        if isinstance(item, dict):
            yield from rows_of(item, f"{place}.{key}")
        elif isinstance(item, list) and key != "joints":
            yield f"{place}.{key}", item


def published_row(entry: Mapping[str, Any], place: str, method: str) -> dict[str, float | None]:
    """Return the paper's numbers of a method, column -> [N m], V1..V3 [N], or [%]; empty where it prints none.

    Args:
        entry: the table.
        place: dotted keys of the table that lead to its methods, such as `rows.ideal`.
        method: estimator.

    Raises:
        ConfigError: there is no such place.
    """
    node = entry
    for key in place.split("."):
        if key not in node:
            raise ConfigError(not_accepted(f"{place}: key of a published table", key, node))
        node = node[key]
    return dict(zip(entry["joints"], node[method], strict=True)) if method in node else {}


def published_value(table: PublishedTable, place: str, method: str, column: str) -> float | None:
    """Return the paper's number at a place of a table [its unit]; None where it prints none."""
    row = table.numbers.get(place, {}).get(method)
    return None if row is None else dict(zip(table.columns, row, strict=True)).get(column)
