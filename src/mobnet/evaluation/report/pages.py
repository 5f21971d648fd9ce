"""Tables as pages for Snakemake's report, which shows HTML: each below its caption, in need of nothing else."""

from __future__ import annotations

import logging
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from docutils.core import publish_parts
from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markdown_it import MarkdownIt

from mobnet.core.errors import DataError
from mobnet.core.files import write_text

log = logging.getLogger(__name__)

TEMPLATES = Path(__file__).parent / "templates"
WARNING = 2  # docutils stops at a fault of this level


def pages(tables: Sequence[Path], captions_dir: Path, out_dir: Path) -> None:
    """Write a page for each table.

    Args:
        tables: Markdown files.
        captions_dir: a caption of each table's name, *.rst: its title in the first line, then what it shows.
        out_dir: gets a page of each table's name, *.html.

    Raises:
        DataError: a table or its caption is missing.
    """
    for table in tables:
        caption = _read(captions_dir / f"{table.stem}.rst")
        write_text(out_dir / f"{table.stem}.html", table_page(_read(table), caption))
    log.info("%s: %d pages", out_dir, len(tables))


def table_page(table: str, caption: str) -> str:
    """Return the page of a table (Markdown) below its caption (reStructuredText, title first)."""
    title, _, text = caption.partition("\n")
    parts = publish_parts(text, writer="html5", settings_overrides={"halt_level": WARNING, "report_level": WARNING})
    return rendered(
        "table.html", title=title, text=parts.get("body", ""), table=MarkdownIt("js-default").render(table).strip()
    )


def rendered(template: str, **values: Any) -> str:
    """Return the text of a template, its values escaped; one that the template needs and does not get is an error."""
    settings = Environment(
        loader=FileSystemLoader(TEMPLATES), autoescape=True, undefined=StrictUndefined,
        trim_blocks=True, lstrip_blocks=True, keep_trailing_newline=True,
    )  # fmt: skip
    return settings.get_template(template).render(values)


def _read(path: Path) -> str:
    """Return a file's text."""
    try:
        return path.read_text(encoding="utf-8")
    except FileNotFoundError:
        raise DataError(f"{path}: file is missing") from None
