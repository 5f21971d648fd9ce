"""What is said of a table or a figure beside its section."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, cast

from pydantic import BaseModel

from mobnet.settings.base import Section


@dataclass(frozen=True)
class MadeBy:
    """The row of a product: the mark of a field of `Evaluation` whose section is that of a table or of a figure.

    A function gets by name what its signature names: its own section as `settings`, its own numbers of the paper as
    `published`, sections of the configuration, folders, and what this row names.

    Attributes:
        function: what makes it, `module:name`, below `experiments.evaluation`; braces stand for the name of an entry.
        needs: parameter of the function -> the function of `experiments.plan.needs` that says what it gets.
        sections: sections of other products that the function takes, each as a parameter of its name.
        published: section of the paper's numbers that it takes, where this has not its own name.
        table: whether it writes a table of its name.
        figure: whether it draws a figure of its name.
        further: names of more figures that it draws.
        bars: whether its figure has a second CSV file, of its bars.
        pictured: whether the first page of the report shows its figure.
        quoted: place among the tables, those of errors apart, that the paper's text takes numbers from; 0: none.
        source: whether tables of the paper's main text are made from it.
        columns: columns of its CSV file, where claims may name its fields.
        clustered: whether intervals in it are over robots.
    """

    function: str
    needs: Mapping[str, str] = field(default_factory=dict[str, str])
    sections: tuple[str, ...] = ()
    published: str = ""
    table: bool = False
    figure: bool = False
    further: tuple[str, ...] = ()
    bars: bool = False
    pictured: bool = False
    quoted: int = 0
    source: bool = False
    columns: tuple[str, ...] = ()
    clustered: bool = False


def rows_of(section: type[Section]) -> dict[str, MadeBy]:
    """Return field -> its row, of those fields of a section that have one."""
    rows: dict[str, MadeBy] = {}
    for name, info in section.model_fields.items():
        for mark in info.metadata:
            if isinstance(mark, MadeBy):
                rows[name] = mark
    return rows


def items_of(section: object) -> Mapping[Any, object]:
    """Return what stands in a section, a mapping or a tuple, by key; nothing stands in anything else."""
    if isinstance(section, BaseModel):
        return {key: getattr(section, key) for key in type(section).model_fields}
    if isinstance(section, dict):
        return cast("Mapping[Any, object]", section)
    if isinstance(section, tuple):
        return dict(enumerate(cast("tuple[object, ...]", section)))
    return {}
