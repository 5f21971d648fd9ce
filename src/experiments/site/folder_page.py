"""What a code host shows of the published results: a page of the folder, and title and caption above each table.

`./reproduce snapshot` writes both; `python -m experiments.site results` does where a caption changed.
"""

from collections.abc import Iterator, Sequence
from pathlib import Path

from experiments.plan.heads import CAPTIONS
from experiments.site.results import PAPER, Item, items_of, with_head
from mobnet.core.files import write_text

RESULTS = Path("docs/results")
PAGE = "README.md"
WIDTH = 240  # of a small picture [px]
HEAD = """# Published results

What the run of the newest version in the [CHANGELOG](../../CHANGELOG.md) found: each table and figure by its title,
with its files. Commands wrote this folder, `./reproduce snapshot` first; nothing in it is edited by hand, and
`provenance.json` says what was made after the run. `./reproduce docs` makes pages of it with claims.
`./reproduce draw` draws figures as SVG and PDF from the numbers here; those that show more than their numbers are made
by a run. `./reproduce paper` builds the paper from this folder.
"""
# Files that are neither a table nor a figure: what they are, in the order of the page.
FIRST = {
    "paper.pdf": "The paper, with every table and figure in its supplement.",
    "explore.html": "Play with a push: open this file in a browser.",
    "push.webp": "The film of one push, as three methods estimate it.",
    "walk.webp": "The film of a walk.",
}
RUN = {
    "provenance.json": "The commit and the scale of the run, and what was made after it.",
    "rates.json": "How long each kind of job took.",
    "gpu.json": "Speed of training on GPUs.",
    "seeds.json": "The seeds of the tests of all published runs.",
    "rows": "Single collisions and walks.",
}


def folder_page(results: Path, captions: Sequence[Path]) -> str:
    """Return the page of a folder of published results; `captions` are those of tables and figures, by their folder."""
    items = items_of(results, captions)
    figures = [item for item in items if item.is_figure]
    tables = [item for item in items if not item.is_figure]
    groups = {
        "Figures of the original": _figures(_of_paper(figures), results),
        "Our figures": _figures(_ours(figures), results),
        "Tables of the original": _tables(_of_paper(tables), results),
        "Our tables": _tables(_ours(tables), results),
    }
    parts = [HEAD, _files("Start here", FIRST, results)]
    for title, lines in groups.items():
        parts.append("\n".join([f"## {title}\n", *lines, ""]))
    parts.append(_files("The run", RUN, results))
    return "\n".join(parts)


def _of_paper(items: Sequence[Item]) -> list[Item]:
    """Return those items that the original has a number of."""
    return [item for item in items if PAPER.match(item.name)]


def _ours(items: Sequence[Item]) -> list[Item]:
    """Return the others."""
    return [item for item in items if not PAPER.match(item.name)]


def _title(item: Item) -> str:
    """Return the title of an item, whose heading says whether it is ours."""
    return item.title.removesuffix(" (ours)")


def _files(title: str, files: dict[str, str], results: Path) -> str:
    """Return a list of those files that are there."""
    lines = [f"* [{name}]({name}): {text}" for name, text in files.items() if (results / name).exists()]
    return "\n".join([f"## {title}\n", *lines, ""])


def _figures(items: Sequence[Item], results: Path) -> Iterator[str]:
    """Yield the lines of a table of figures, small, each with a link to its files."""
    yield "| figure | title | files |"
    yield "| --- | --- | --- |"
    for item in items:
        picture = item.shown.name
        kinds = [(picture, "PNG"), *((path, "numbers") for path in item.csvs)]
        files = ", ".join(f"[{kind}]({path})" for path, kind in kinds if (results / path).is_file())
        shown = f'<a href="{picture}"><img src="{picture}" width="{WIDTH}" alt="{_title(item)}"></a>'
        yield f"| {shown} | {_title(item)} | {files} |"


def _tables(items: Sequence[Item], results: Path) -> Iterator[str]:
    """Yield a line for each table, with its other files where they are."""
    for item in items:
        kinds = [*((path, "CSV") for path in item.csvs), (f"{item.name}.tex", "TeX")]
        files = ", ".join(f"[{kind}]({path})" for path, kind in kinds if (results / path).is_file())
        yield f"* [{_title(item)}]({item.shown.name})" + (f" ({files})" if files else "")


def write_page(results: Path = RESULTS, captions: Path = CAPTIONS) -> None:
    """Write the page, and heads of tables, into a folder of published results; captions are those of a folder."""
    found = [path for kind in ("figures", "tables") for path in sorted((captions / kind).glob("*.rst"))]
    for item in items_of(results, found):
        if not item.is_figure:
            write_text(item.shown, with_head(item))
    write_text(results / PAGE, folder_page(results, found))
