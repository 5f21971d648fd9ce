"""Columns of a table of errors: a joint, or the mean over some joints or metrics."""

from collections.abc import Sequence
from dataclasses import dataclass

from experiments.settings.runs import Mean
from mobnet.core.errors import ConfigError
from mobnet.core.joints import JointLayout


@dataclass(frozen=True)
class Column:
    """A column of a table: the mean over its joints and its metrics, of which there is mostly one each.

    Attributes:
        name: its name.
        unit: that of the joints' torques.
        joints: limb and name of each joint, (n,).
        metrics: names of the metrics; empty where each row of the table names its own.
    """

    name: str
    unit: str
    joints: tuple[tuple[str, str], ...]
    metrics: tuple[str, ...] = ()


def columns_of(layout: JointLayout, items: Sequence[str | Mean]) -> list[Column]:
    """Return the columns that a table's configuration asks for, such as those of Table 6.

    An item is a joint, a limb for its joints one by one, or a mean over some of both.
    """
    columns: list[Column] = []
    for item in items:
        if isinstance(item, str):
            columns += [column_of(layout, joint, [joint], ()) for joint in members(layout, item)]
        else:
            joints: list[str] = []
            for name in item.joints:
                joints += members(layout, name)
            columns.append(column_of(layout, item.name, joints, item.metrics))
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
    limbs = layout.limb_of
    return Column(name, units[0], tuple((limbs[joint], joint) for joint in joints), tuple(metrics))


def members(layout: JointLayout, name: str) -> tuple[str, ...]:
    """Return the joints of a limb, or the joint itself."""
    return layout.groups.get(name, (name,))
