"""The paper's own numbers, from `configs/published.yaml`."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from mobnet.core.config import read_yaml
from mobnet.core.errors import ConfigError, not_accepted


def read_published(path: Path, table: str) -> dict[str, Any]:
    """Return a table of levels and methods as the paper prints it, its rows checked against its joints.

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
    for level, methods in entry["rows"].items():
        for method, numbers in methods.items():
            if len(numbers) != len(entry["joints"]):
                raise ConfigError(
                    f"{path}: {table}.rows.{level}.{method}: {len(numbers)} numbers for "
                    f"{len(entry['joints'])} joints ({', '.join(entry['joints'])})"
                )
    return entry


def published_value(entry: Mapping[str, Any], level: str, method: str, joint: str) -> float | None:
    """Return the paper's number [N m], V1..V3 [N], or None where it prints none."""
    row = entry["rows"].get(level, {}).get(method)
    if row is None or joint not in entry["joints"]:
        return None
    return row[entry["joints"].index(joint)]
