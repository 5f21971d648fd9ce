"""The page on which the report opens: verdicts, the errors of five methods, and four pictures, in one file."""

import base64
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from markdown_it import MarkdownIt

from experiments.evaluation.report.claims_page import first_counts, read_statements, verdict_counts
from experiments.evaluation.report.headline import headline
from experiments.evaluation.report.html import rendered
from experiments.settings.verdicts import OURS
from mobnet.core.errors import DataError
from mobnet.core.files import read_text


@dataclass(frozen=True)
class Picture:
    """A figure: its title, the first sentences of its caption, and its PNG file in base64.

    This has short lines, because docutils, which makes the report's first page, refuses those of 10 000 characters.
    """

    title: str
    text: str
    data: str


def first_page(
    title: str,
    text: str,
    claims_csv: Path,
    table_dir: Path,
    pictures: Sequence[tuple[Path, Path]],
    tables: Mapping[str, str],
    template: Path,
) -> str:
    """Return the page, from claims.csv, the folder of tables, PNG files with captions, and name of a table -> title.

    The title is text, what stands below it is HTML.

    Raises:
        DataError: a file is missing or damaged.
    """
    # Claims that the paper does not make say nothing about whether it is reproduced.
    papers = [one for one in read_statements(claims_csv) if one.kind != OURS]
    shown = MarkdownIt("js-default").render(headline(table_dir)).strip()
    return rendered(
        template,
        title=title,
        text=text,
        counts=verdict_counts(papers),
        firsts=first_counts(papers),
        linked=False,
        headline=shown,
        pictures=[_picture(*pair) for pair in pictures],
        tables=tables,
    )


def _picture(file: Path, caption: Path) -> Picture:
    """Return a picture with the title and the first paragraph of its caption (reStructuredText)."""
    title, *lines = read_text(caption).splitlines()
    return Picture(title, first_paragraph(lines), base64.encodebytes(_content(file)).decode())


def first_paragraph(lines: Sequence[str]) -> str:
    """Return the first paragraph of a text as one line, without the marks of code and emphasis."""
    paragraphs = "\n".join(lines).strip().split("\n\n")
    return " ".join(paragraphs[0].replace("``", "").replace("*", "").split())


def _content(file: Path) -> bytes:
    try:
        return file.read_bytes()
    except OSError as error:
        raise DataError(f"{file}: cannot be read: {error.strerror}; accepted: a picture") from None
