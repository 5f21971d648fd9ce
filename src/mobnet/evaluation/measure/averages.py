"""Columns of a table of errors: a joint, or the mean over some joints or metrics."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from mobnet.core.errors import ConfigError
from mobnet.core.joints import JointLayout


@dataclass(frozen=True)
class Column:
    """A column of a table: the mean over joints and metrics, mostly one of each.

    Attributes:
        name: what its head says.
        unit: unit of its joints' torque.
        joints: limb and name of each joint, (n,).
        metrics: names of metrics; none: the metric of the row.
    """

    name: str
    unit: str
    joints: tuple[tuple[str, str], ...]
    metrics: tuple[str, ...] = ()


def columns_of(layout: JointLayout, items: Sequence[str | Mapping[str, Any]]) -> list[Column]:
    """Return the columns that a table's configuration asks for, such as those of Table 6.

    Args:
        layout: joints and limbs.
        items: a joint; a limb, for its joints one by one; or a mean: `name`, `joints` (and limbs) and, where it is not
            of the row's metric, `metrics`.

    Raises:
        ConfigError: a joint is unknown, or a mean is over joints of different units.
    """
    columns: list[Column] = []
    for item in items:
        if isinstance(item, str):
            columns += [column_of(layout, joint, [joint], ()) for joint in members(layout, item)]
        else:
            joints = [joint for name in item["joints"] for joint in members(layout, name)]
            columns.append(column_of(layout, item["name"], joints, item.get("metrics", ())))
    return columns


def column_of(layout: JointLayout, name: str, joints: Sequence[str], metrics: Sequence[str]) -> Column:
    """Return a column of some joints, whose torques must be all in N m or all in N.

    Raises:
        ConfigError: a joint is unknown, or the units differ.
    """
    layout.columns(joints)
    units = sorted({layout.unit(joint) for joint in joints})
    if len(units) > 1:
        raise ConfigError(f"column {name!r}: a mean over {', '.join(joints)} mixes {' and '.join(units)}")
    limbs = {joint: limb for limb, own in layout.groups.items() for joint in own}
    return Column(name, units[0], tuple((limbs[joint], joint) for joint in joints), tuple(metrics))


def members(layout: JointLayout, name: str) -> tuple[str, ...]:
    """Return the joints of a limb, or the joint itself."""
    return layout.groups.get(name, (name,))
