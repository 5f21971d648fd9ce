"""What is said of a table or a figure beside its section, and what a section says itself of what does not fit."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, cast

from pydantic import BaseModel

from mobnet.settings.base import Section
from mobnet.settings.reading import Place, Problem

if TYPE_CHECKING:  # both know the sections
    from experiments.settings.checks.results import Results
    from experiments.settings.claims import Cell
    from experiments.settings.settings import Settings

    Trials = Callable[[Settings, Cell], int | None]
    Hours = Callable[[Settings, Cell], float | None]


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
        trials: of how many trials a cell is a share; None where it is no share of a known number.
        hours: in how much walking a cell counts events at most [h]; None where it counts none.
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
    trials: "Trials | None" = None
    hours: "Hours | None" = None


class Checked(Section):
    """A section that says what in it does not fit the rest of the configuration."""

    def problems(self, results: "Results", place: Place) -> Iterator[Problem]:
        """Yield place and text of what is not accepted; the section stands at a place."""
        raise NotImplementedError


def rows_of(section: type[Section]) -> dict[str, MadeBy]:
    """Return field -> its row, of those fields of a section that have one."""
    found: dict[str, MadeBy] = {}
    for name, info in section.model_fields.items():
        for mark in info.metadata:
            if isinstance(mark, MadeBy):
                found[name] = mark
    return found


def problems_in(section: object, results: "Results", place: Place) -> Iterator[Problem]:
    """Yield what does not fit in a section, and in those that stand in it."""
    if isinstance(section, Checked):
        yield from section.problems(results, place)
    for key, item in items_of(section).items():
        yield from problems_in(item, results, (*place, key))


def items_of(section: object) -> Mapping[Any, object]:
    """Return what stands in a section, a mapping or a tuple, by key; nothing stands in anything else."""
    if isinstance(section, BaseModel):
        return {key: getattr(section, key) for key in type(section).model_fields}
    if isinstance(section, dict):
        return cast("Mapping[Any, object]", section)
    if isinstance(section, tuple):
        return dict(enumerate(cast("tuple[object, ...]", section)))
    return {}
