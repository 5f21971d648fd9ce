"""What stands above the rows of a table as Markdown: its title, and what it shows in which unit, from its caption."""

import re
import textwrap
from pathlib import Path

from experiments.plan.project import project_file
from mobnet.core.files import read_text, write_text

CAPTIONS = Path("workflow/report")
FIELD = "{{"  # begins a field of a caption, a number of the results
FIRST_ROW = re.compile(r"^\|", re.MULTILINE)
WIDTH = 120  # characters of a line


def caption_of(kind: str, name: str) -> Path:
    """Return the file of a caption of the project, whether or not it is there."""
    return project_file(CAPTIONS / kind / f"{name}.rst")


def drawn(text: str) -> str:
    """Return the paragraph of a caption that says what is drawn: the first without a field, or the first of all.

    Args:
        text: what stands below the title.
    """
    paragraphs = [" ".join(part.split()) for part in text.strip().split("\n\n")]
    plain = [part for part in paragraphs if FIELD not in part]
    return [*plain, *paragraphs][0]


def head_of(caption: str) -> str:
    """Return the head of a table as Markdown, from its caption: a title, an empty line, and paragraphs."""
    title, _, text = caption.partition("\n")
    return f"# {title}\n\n{textwrap.fill(drawn(text), WIDTH)}\n\n"


def put_head(table: Path, head: str) -> None:
    """Write a head above the rows of a table (Markdown) that has none.

    Raises:
        DataError: there is no such table.
    """
    write_text(table, head + read_text(table))


def table_in(text: str) -> str:
    """Return the table of a Markdown file, and what stands below it, without what stands above."""
    start = FIRST_ROW.search(text)
    return text[start.start() :] if start else ""
