"""Tables as HTML pages for Snakemake's report: each page holds a caption and a table, and needs no other file."""

import logging
from collections.abc import Sequence
from pathlib import Path

from docutils.core import publish_parts
from markdown_it import MarkdownIt

from mobnet.core.files import read_text, write_text
from mobnet.evaluation.report.html import rendered

log = logging.getLogger(__name__)

WARNING = 2  # docutils stops at a fault of this level


def pages(tables: Sequence[Path], captions: Sequence[Path | None], template: Path, out: Path) -> None:
    """Write a page for each table (Markdown) beside the first one, `out`, with the places of an HTML template filled.

    A caption is reStructuredText with its title in the first line; a table without one gets its name as title.
    """
    for table, caption in zip(tables, captions, strict=True):
        text = read_text(caption) if caption else table.stem
        write_text(out.parent / f"{table.stem}.html", table_page(template, read_text(table), text))
    log.info("%s: %d pages", out.parent, len(tables))


def table_page(template: Path, table: str, caption: str) -> str:
    """Return the page of a table (Markdown) below its caption (reStructuredText, title first)."""
    title, _, text = caption.partition("\n")
    parts = publish_parts(text, writer="html5", settings_overrides={"halt_level": WARNING, "report_level": WARNING})
    html = MarkdownIt("js-default").render(table).strip()
    return rendered(template, title=title, text=parts.get("body", ""), table=html)
