"""Tables as TeX and Markdown text. Only booktabs is needed in TeX, and longtable for a table of several pages."""

from __future__ import annotations

import re
from collections.abc import Sequence

TEX_SPECIAL = {
    "\\": r"\textbackslash{}", "&": r"\&", "%": r"\%", "$": r"\$", "#": r"\#", "_": r"\_", "{": r"\{", "}": r"\}",
    "~": r"\textasciitilde{}", "^": r"\textasciicircum{}", "<": r"\textless{}", ">": r"\textgreater{}",
    "|": r"\textbar{}",
}  # fmt: skip
MINUS = re.compile(r"(?<![\w-])-(?=\d)")
RULE = r"\midrule"
GAP = r"\addlinespace"

Line = Sequence[str] | str  # cells of a row, or a rule or a gap between rows


def tex_escape(text: str) -> str:
    """Return plain text with TeX's special characters escaped, N m kept together and a number's minus as one."""
    escaped = "".join(TEX_SPECIAL.get(character, character) for character in text).replace(" N m", r"~N\,m")
    return MINUS.sub("$-$", escaped)


def tex_table(columns: str, header: Sequence[str], lines: Sequence[Line]) -> str:
    """Return a tabular environment.

    Args:
        columns: TeX column specification.
        header: TeX of the header cells.
        lines: rows of TeX cells, `RULE` or `GAP`.
    """
    body = [line if isinstance(line, str) else tex_row(line) for line in lines]
    parts = [rf"\begin{{tabular}}{{{columns}}}", r"\toprule", tex_row(header), RULE, *body, r"\bottomrule"]
    return "\n".join([*parts, r"\end{tabular}"]) + "\n"


def text_table(columns: str, header: Sequence[str], lines: Sequence[Line]) -> str:
    """Return a tabular environment of plain text; `columns` is a TeX column specification."""
    escaped = [line if isinstance(line, str) else list(map(tex_escape, line)) for line in lines]
    return tex_table(columns, list(map(tex_escape, header)), escaped)


def long_table(columns: str, caption: str, header: Sequence[str], lines: Sequence[Line]) -> str:
    """Return a longtable environment of plain text, which breaks across pages and repeats its header.

    Args:
        columns: TeX column specification.
        caption: TeX of the caption; a longtable holds its own.
        header: header cells.
        lines: rows of cells, `RULE`, `GAP` or other TeX.
    """
    head = [r"\toprule", tex_row(list(map(tex_escape, header))), RULE, r"\endhead", r"\bottomrule", r"\endfoot"]
    body = [line if isinstance(line, str) else tex_row(list(map(tex_escape, line))) for line in lines]
    return "\n".join([rf"\begin{{longtable}}{{{columns}}}", rf"{caption} \\", *head, *body, r"\end{longtable}"]) + "\n"


def tex_row(cells: Sequence[str]) -> str:
    """Return a row of TeX cells."""
    return " & ".join(cells) + r" \\"


def markdown_table(header: Sequence[str], lines: Sequence[Line], left: int = 1) -> str:
    """Return a Markdown table; rules and gaps between rows are left out.

    Args:
        header: header cells.
        lines: rows of cells, `RULE` or `GAP`.
        left: columns set flush left; the others hold numbers and are set flush right.
    """
    marks = ["---"] * left + ["---:"] * (len(header) - left)
    rows = [header, marks, *(line for line in lines if not isinstance(line, str))]
    return "".join("| " + " | ".join(cell.replace("|", r"\|") for cell in row) + " |\n" for row in rows)


def number(value: float | None, digits: int = 2) -> str:
    """Return a number with fixed digits and no minus before zero, or a dash where there is none."""
    return "-" if value is None else f"{round(value, digits) + 0.0:.{digits}f}"


def span(low: float | None, high: float | None, digits: int = 2) -> str:
    """Return an interval in brackets, or nothing where there is none."""
    return "" if low is None or high is None else f"[{number(low, digits)}, {number(high, digits)}]"
