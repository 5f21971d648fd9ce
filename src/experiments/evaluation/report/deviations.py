"""The table of deviations: written once in Markdown, set in the paper as TeX."""

import re
from pathlib import Path

from experiments.evaluation.tables.layout import GAP, Line, long_tex_table, tex_escape
from mobnet.core.errors import DataError
from mobnet.core.files import read_text, write_text

WIDTHS = (0.12, 0.25, 0.25, 0.32)  # shares of the text width, one a column
CAPTION = r"\deviationscaption"  # the paper's
LINK = re.compile(r"\[([^]]*)\]\([^)]*\)")


def deviations(markdown: Path, out: Path) -> None:
    """Write the table of a Markdown file, which must be as wide as the paper's, as a TeX longtable."""
    header, *rows = markdown_rows(read_text(markdown), str(markdown))
    columns = "".join(rf">{{\raggedright\arraybackslash}}p{{{width}\textwidth}}" for width in WIDTHS)
    lines: list[Line] = []
    for row in rows:
        lines += [GAP, [tex_text(cell) for cell in row]]
    write_text(out, long_tex_table(columns, CAPTION, [tex_text(cell) for cell in header], lines[1:]))


def markdown_rows(text: str, name: str) -> list[list[str]]:
    """Return the cells of the first Markdown table in a text, header first.

    Raises:
        DataError: there is no table, or a row has another number of cells.
    """
    rows: list[list[str]] = []
    for line in text.splitlines():
        if not line.startswith("|"):
            continue
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        # The line below the header says on which side the text of each column stands: it is no row.
        if not all(set(cell) <= set("-: ") for cell in cells):
            rows.append(cells)
    wrong = [row for row in rows if len(row) != len(WIDTHS)]
    if wrong or not rows:
        found = f"{len(wrong[0])} cells in the row of {wrong[0][0]!r}" if wrong else "no table"
        raise DataError(f"{name}: {found}; expected rows of {len(WIDTHS)} cells")
    return rows


def tex_text(text: str) -> str:
    """Return Markdown text with `code` as TeX, of links their words alone."""
    parts = re.split(r"`([^`]*)`", LINK.sub(r"\1", text))
    return "".join(rf"\texttt{{{tex_escape(part)}}}" if i % 2 else tex_escape(part) for i, part in enumerate(parts))
