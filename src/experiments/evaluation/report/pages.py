"""Pages for Snakemake's report: each holds a caption and what it shows, and needs no other file."""

import logging
from collections.abc import Mapping, Sequence
from pathlib import Path

from docutils.core import publish_parts
from markdown_it import MarkdownIt

from experiments.evaluation.report.claims_page import claims_page
from experiments.evaluation.report.first_page import first_page
from experiments.evaluation.report.html import rendered
from experiments.plan.heads import table_in
from experiments.settings.runs import Statistics
from mobnet.core.files import read_text, write_text

log = logging.getLogger(__name__)

WARNING = 2  # docutils stops at a fault of this level
CLAIMS, FIRST = "claims", "index"  # pages that show more than one table
Titled = tuple[str, str]  # title, and HTML of the text below it


def pages(
    tables: Sequence[Path],
    captions: Sequence[Path | None],
    pictures: Sequence[tuple[Path, Path]],
    first: Path,
    statistics: Statistics,
    table_dir: Path,
    templates: Mapping[str, Path],
    out: Path,
) -> None:
    """Write a page for each table (Markdown) beside the first one, `out`, and `index.html`, on which the report opens.

    A caption is reStructuredText with its title in the first line; a table without one gets its name as title. The page
    of claims and the first page have captions too, and templates of their own; the first one shows pictures, each with
    its caption. `statistics` has the confidence of intervals, `table_dir` the CSV files of tables.

    Raises:
        DataError: a file is missing or damaged.
    """
    # Only pages with a plain table are listed by title: the first page shows the claims themselves.
    claims_csv = table_dir / f"{CLAIMS}.csv"
    titles = dict[str, str]()
    for table, caption in zip(tables, captions, strict=True):
        title, text = titled(read_text(caption) if caption else table.stem)
        if table.stem == CLAIMS:
            page = claims_page(claims_csv, statistics.confidence, title, text, templates[CLAIMS])
        else:
            page = table_page(templates["table"], read_text(table), title, text)
            titles[table.stem] = title
        write_text(out.parent / f"{table.stem}.html", page)
    page = first_page(*titled(read_text(first)), claims_csv, table_dir, pictures, titles, templates[FIRST])
    write_text(out.parent / f"{FIRST}.html", page)
    log.info("%s: %d pages", out.parent, len(tables) + 1)


def titled(caption: str) -> Titled:
    """Return the title of a caption, its first line, and what stands below it as HTML."""
    title, _, text = caption.partition("\n")
    parts = publish_parts(text, writer="html5", settings_overrides={"halt_level": WARNING, "report_level": WARNING})
    return title, parts.get("body", "")


def table_page(template: Path, table: str, title: str, text: str) -> str:
    """Return the page of a table (Markdown), without what stands above its rows, below its title and text (HTML)."""
    html = MarkdownIt("js-default").render(table_in(table)).strip()
    return rendered(template, title=title, text=text, table=html)
