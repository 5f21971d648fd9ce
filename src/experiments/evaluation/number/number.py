"""What the paper prints beside a number, and the names of methods as readers see them."""

from experiments.intervals.number import Number as Number
from experiments.intervals.number import interval_text as interval_text
from experiments.intervals.number import is_missing as is_missing
from experiments.intervals.number import number_text as number_text
from experiments.settings.published import PublishedTable

# Names of methods that a reader would take for something else: of an error "below zero" nobody thinks of a method.
SHOWN = {"zero": "no estimate"}


def published_row(table: PublishedTable, place: str, method: str) -> dict[str, float | None]:
    """Return the paper's numbers of a method at a place of a table, column -> [its unit]; empty if there are none."""
    row = table.numbers.get(place, {}).get(method)
    return {} if row is None else dict(zip(table.columns, row, strict=True))


def published_value(table: PublishedTable, place: str, method: str, column: str) -> float | None:
    """Return the paper's number in one column [its unit]; None where it prints none."""
    return published_row(table, place, method).get(column)


def shown_name(name: str) -> str:
    """Return what readers of tables and figures see of a method's name: of most methods the name itself."""
    return SHOWN.get(name, name)
