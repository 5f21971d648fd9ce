"""Pages of the published results: each table and figure with its caption, its command, its numbers and its claims."""

import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from experiments.evaluation.report.captions import filled
from experiments.evaluation.report.numbers import texts_in
from experiments.plan.heads import table_in
from experiments.settings.claims import Claim
from experiments.site.contents import menu
from mobnet.core.files import read_text
from mobnet.core.rows import read_texts

PLACE = "docs/results"
FIGURES = "figures"  # folder of their captions and of the CSVs of their numbers
PRINTED = re.compile(r"\b(Table|Figure) (\d+)")
PAPER = re.compile(r"(table|figure)_\d")
ALL_CLAIMS = "claims"
CLAIMS_PAGE = f"{PLACE}/all_claims.html"  # the page of the report: as a plain table the claims are 24 000 px high
HEAD = """# Tables and figures

What the newest version published: each table and figure with its caption, the command that makes it, its numbers as CSV
and the claims about it. [One page](claims.md) lists all claims.
"""


class Item(NamedTuple):
    """A published table or figure.

    Attributes:
        name: of its rule.
        page: name of its page.
        shown: the picture of a figure, the Markdown of a table.
        title: first line of its caption.
        caption: the rest, reStructuredText.
        csvs: files of its numbers, from its page.
    """

    name: str
    page: str
    shown: Path
    title: str
    caption: str
    csvs: tuple[str, ...]

    @property
    def is_figure(self) -> bool:
        """Whether it is a figure."""
        return self.shown.suffix != ".md"

    @property
    def target(self) -> str:
        """The file by which `./reproduce` is told to make it."""
        kind, ending = (FIGURES, "pdf") if self.is_figure else ("tables", "md")
        return f"{kind}/{self.name}.{ending}" if self.csvs else f"results/default/{self.name}.{ending}"


def result_pages(results: Path, captions: Sequence[Path], claims: Mapping[str, Claim]) -> Iterator[tuple[str, str]]:
    """Yield path and text of the page of each item that a folder has, and of the gallery of all.

    Raises:
        DataError: a file is missing or damaged.
    """
    items = items_of(results, captions)
    verdicts = {row["claim"]: row["verdict"] for row in read_texts(results / f"{ALL_CLAIMS}.csv")}
    for item in items:
        yield f"{PLACE}/{item.page}.md", _page(item, _claims_about(item.name, claims, verdicts))
    yield f"{PLACE}/README.md", _gallery(items)


def items_of(results: Path, captions: Sequence[Path]) -> list[Item]:
    """Return the items of captions that a folder has, those of the paper first."""
    texts = texts_in(results)
    found = [item for caption in captions if (item := _item(results, caption, texts)) is not None]
    return sorted(found, key=lambda item: not PAPER.match(item.name))


def _item(results: Path, caption: Path, texts: Mapping[str, str]) -> Item | None:
    """Return the item of a caption, None if it is not published.

    The folder of the caption tells its kind; a table keeps a name that a figure has too.
    """
    name = caption.stem
    table = results / f"{name}.md"
    picture = results / f"{name}.png"
    is_table = caption.parent.name != FIGURES
    if not (table if is_table else picture).is_file():
        return None
    (title, _, text) = filled(caption, texts).partition("\n")
    if is_table:
        csvs = (f"{name}.csv",) if table.with_suffix(".csv").is_file() else ()
        return Item(name, name, table, title, text.strip(), csvs)
    named = [f"{FIGURES}/{stem}.csv.gz" for stem in (name, f"{name}_bars")]
    csvs = tuple(path for path in named if (results / path).is_file())
    return Item(name, f"{name}_figure" if table.is_file() else name, picture, title, text.strip(), csvs)


def _page(item: Item, claims: Sequence[str]) -> str:
    """Return the page of an item."""
    csvs = ", ".join(f"[{path}]({path})" for path in item.csvs)
    made = f"`./reproduce {item.target}` makes it." + (f" Its numbers: {csvs}." if csvs else "")
    picture = item.shown.name
    shown = f"[![{item.title}]({picture})]({picture})" if item.is_figure else _table(item)
    parts = [f"# {item.title}", f"```{{eval-rst}}\n{item.caption}\n```", shown, made]
    if claims:
        parts.append("## Claims about it\n\n" + "\n".join(claims))
    return "\n\n".join(parts) + "\n"


def _table(item: Item) -> str:
    """Return the table of an item, or the link to the page of all claims, which is no page of Sphinx."""
    if item.name == ALL_CLAIMS:
        return f'<p><a href="{Path(CLAIMS_PAGE).name}">All claims, to filter, sort and open</a></p>'
    return table_in(read_text(item.shown)).strip()


def with_head(item: Item) -> str:
    """Return the Markdown of a table with its title and caption above, as a code host shows it."""
    return f"# {item.title}\n\n{item.caption}\n\n{table_in(read_text(item.shown))}"


def _gallery(items: Sequence[Item]) -> str:
    """Return the page that shows every figure small and names every table."""
    figures = [f"[![]({item.shown.name}) {item.title}]({item.page}.md)\n" for item in items if item.is_figure]
    tables = [f"* [{item.title}]({item.page}.md)\n" for item in items if not item.is_figure]
    drawn = "## Figures\n\n:::{container} gallery\n" + "\n".join(figures) + ":::\n"
    listed = "## Tables\n\n" + "".join(tables)
    return "\n".join([HEAD, drawn, listed, menu(f"{PLACE}/{item.page}" for item in items)])


def _claims_about(name: str, claims: Mapping[str, Claim], verdicts: Mapping[str, str]) -> list[str]:
    """Return a line for each claim that the paper prints in an item, or whose cells come from it."""
    if name == ALL_CLAIMS:
        return []

    def is_about(claim: Claim) -> bool:
        printed = (f"{kind.lower()}_{int(number):02d}" for kind, number in PRINTED.findall(claim.printed))
        return name in printed or any(cell.table == name for cell in claim.cells)

    about = {claim: row for claim, row in claims.items() if is_about(row)}
    return [f"* {row.says} ({row.printed}): {verdicts.get(claim, 'not measured')}." for claim, row in about.items()]
