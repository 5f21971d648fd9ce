"""The paper's own numbers, found in its tables."""

from mobnet.settings.published import PublishedTable


def published_row(table: PublishedTable, place: str, method: str) -> dict[str, float | None]:
    """Return the paper's numbers of a method at a place of a table, column -> [its unit]; empty if there are none."""
    row = table.numbers.get(place, {}).get(method)
    return {} if row is None else dict(zip(table.columns, row, strict=True))


def published_value(table: PublishedTable, place: str, method: str, column: str) -> float | None:
    """Return the paper's number in one column [its unit]; None where it prints none."""
    return published_row(table, place, method).get(column)
