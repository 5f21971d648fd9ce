"""The one writer of tables: all numbers as CSV, and what a reader sees as TeX and Markdown.

In TeX only booktabs is needed, and longtable for a table of several pages.
"""

import logging
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from experiments.evaluation.number.number import Number, shown_name
from experiments.evaluation.number.rows import Field, write_csv
from mobnet.core.files import write_text

log = logging.getLogger(__name__)

TEX_SPECIAL = {
    "\\": r"\textbackslash{}",
    "&": r"\&",
    "%": r"\%",
    "$": r"\$",
    "#": r"\#",
    "_": r"\_",
    "{": r"\{",
    "}": r"\}",
    "~": r"\textasciitilde{}",
    "^": r"\textasciicircum{}",
    "<": r"\textless{}",
    ">": r"\textgreater{}",
    "|": r"\textbar{}",
}
MINUS = re.compile(r"(?<![\w-])-(?=\d)")
OUTSIDE = "*"  # behind a ratio that lies outside of its bounds
RULE = r"\midrule"
GAP = r"\addlinespace"
# Between the parts of a table that is wider than a page; a paper may define it to end a float and begin another.
PART = "\\providecommand{\\tablepart}{\\par\\medskip}\\tablepart\n"

Line = Sequence[str] | str  # cells of a row, or a rule or a gap between rows


@dataclass(frozen=True)
class Table:
    """A table as its three files hold it.

    Attributes:
        columns: names of the columns of the CSV file, whose rows are `rows`.
        header: heads of the columns that a reader sees, above `lines`.
        left: leading columns that are set flush left; the others hold numbers and are set flush right.
        align: TeX column specification where it is another one.
        note: text below the table.
    """

    columns: Sequence[str]
    rows: Iterable[Sequence[Field]]
    header: Sequence[str]
    lines: Sequence[Line]
    left: int = 1
    align: str = ""
    note: str = ""


def write_table(stem: Path, table: Table, tex: str = "") -> None:
    """Write a table as `stem.csv`, .tex and .md; `tex` takes the place of one tabular environment of plain text."""
    align = table.align or "l" * table.left + "r" * (len(table.header) - table.left)
    tabular = tex or text_table(align, table.header, table.lines)
    markdown = markdown_table(table.header, table.lines, table.left)
    write_csv(stem.with_suffix(".csv"), table.columns, table.rows)
    write_text(stem.with_suffix(".tex"), tabular + (note_tex(table.note) if table.note else ""))
    write_text(stem.with_suffix(".md"), markdown + (f"\n{table.note}\n" if table.note else ""))
    log.info("%s.csv: %d lines of text", stem, len(table.lines))


def in_blocks(blocks: Iterable[tuple[Sequence[str], Sequence[Sequence[str]]]], *, nested: bool = False) -> list[Line]:
    """Return the lines of blocks, the labels (k,) of a block before its first line and a rule between blocks.

    Args:
        blocks: labels, and the cells of each line after them.
        nested: whether a label is left out while it and those before it stay the same; while the first one does, blocks
            have a gap between them instead of a rule.
    """
    lines: list[Line] = []
    before: Sequence[str] = ()
    for labels, block in blocks:
        if lines:
            lines.append(GAP if nested and labels[:1] == before[:1] else RULE)
        same = [nested and labels[: k + 1] == before[: k + 1] for k in range(len(labels))]
        first = ["" if repeated else label for label, repeated in zip(labels, same, strict=True)]
        lines += [[*([""] * len(labels) if k else first), *cells] for k, cells in enumerate(block)]
        before = labels
    return lines


def with_intervals(
    labels: Sequence[str], numbers: Sequence[Number], confidence: float, digits: int = 2
) -> list[list[str]]:
    """Return a line of numbers and, where there are any, one of their intervals; `confidence` is a share [-]."""
    lines = [[*labels, *(number.text(digits) for number in numbers)]]
    if any(number.low is not None for number in numbers):
        blank = [""] * (len(labels) - 1)
        lines.append([*blank, f"{confidence:.0%}", *(number.interval(digits) for number in numbers)])
    return lines


def tex_escape(text: str) -> str:
    """Return plain text with TeX's special characters escaped, N m kept together and a number's minus as one."""
    escaped = "".join(TEX_SPECIAL.get(character, character) for character in text).replace(" N m", r"~N\,m")
    return MINUS.sub("$-$", escaped)


def tex_table(columns: str, header: Sequence[str], lines: Sequence[Line]) -> str:
    """Return a tabular environment of TeX cells; `columns` is a TeX column specification."""
    body = [line if isinstance(line, str) else tex_row(line) for line in lines]
    parts = [rf"\begin{{tabular}}{{{columns}}}", r"\toprule", tex_row(header), RULE, *body, r"\bottomrule"]
    return "\n".join([*parts, r"\end{tabular}"]) + "\n"


def text_table(columns: str, header: Sequence[str], lines: Sequence[Line]) -> str:
    """Return a tabular environment of plain text; `columns` is a TeX column specification."""
    escaped = [line if isinstance(line, str) else list(map(tex_cell, line)) for line in lines]
    return tex_table(columns, list(map(tex_cell, header)), escaped)


def tex_in_groups(first: str, groups: Mapping[str, Iterable[str]], lines: Sequence[Line]) -> str:
    """Return a tabular environment of plain text: a column of names, then groups of columns of numbers with gaps.

    `groups` are title -> heads; `first` is the head of the names.
    """
    columns = "l"
    titles = [""]
    rules = ""
    heads = [first]
    for title, names in groups.items():
        begin = len(heads) + 1
        heads += names
        count = len(heads) + 1 - begin
        columns += r"@{\hspace{1.5em}}" + "r" * count
        titles.append(rf"\multicolumn{{{count}}}{{c}}{{{tex_escape(title)}}}")
        rules += rf"\cmidrule(lr){{{begin}-{len(heads)}}}"
    body = [line if isinstance(line, str) else tex_row(list(map(tex_cell, line))) for line in lines]
    above = [tex_row(titles), rules, tex_row(list(map(tex_cell, heads))), RULE]
    return (
        "\n".join([rf"\begin{{tabular}}{{{columns}}}", r"\toprule", *above, *body, r"\bottomrule", r"\end{tabular}"])
        + "\n"
    )


def long_table(columns: str, caption: str, header: Sequence[str], lines: Sequence[Line]) -> str:
    """Return a longtable environment of plain text: it breaks across pages, and each of them repeats its header.

    `columns` and `caption` are TeX, and so are lines that are no cells. The caption stands once: it defines a label.
    """
    escaped = [line if isinstance(line, str) else list(map(tex_cell, line)) for line in lines]
    return long_tex_table(columns, caption, list(map(tex_cell, header)), escaped)


def long_tex_table(columns: str, caption: str, header: Sequence[str], lines: Sequence[Line]) -> str:
    """Return a longtable environment of TeX cells, as `long_table` does of plain text."""
    head = [r"\toprule", tex_row(header), RULE]
    parts = [rf"\begin{{longtable}}{{{columns}}}", rf"{caption} \\", *head, r"\endfirsthead", *head, r"\endhead"]
    body = [line if isinstance(line, str) else tex_row(line) for line in lines]
    return "\n".join([*parts, r"\bottomrule", r"\endfoot", *body, r"\end{longtable}"]) + "\n"


def tex_cell(text: str) -> str:
    """Return a cell of plain text as TeX, a method by the name that readers see."""
    return tex_escape(shown_name(text))


def tex_row(cells: Sequence[str]) -> str:
    """Return a row of TeX cells."""
    return " & ".join(cells) + r" \\"


def markdown_table(header: Sequence[str], lines: Sequence[Line], left: int = 1) -> str:
    """Return a Markdown table without rules and gaps; columns after the first `left` ones hold numbers, flush right."""
    marks = ["---"] * left + ["---:"] * (len(header) - left)
    rows = [header, marks, *(line for line in lines if not isinstance(line, str))]
    text = ""
    for row in rows:
        cells = [shown_name(cell).replace("|", r"\|") for cell in row]  # a bare bar would end the cell
        text += f"| {' | '.join(cells)} |\n"
    return text


def note_tex(note: str) -> str:
    """Return a note to stand under a table."""
    return rf"\par\smallskip\parbox{{\linewidth}}{{\raggedright {tex_escape(note)}}}" + "\n"
