"""A page shows everything below its caption, as text, and needs no other file."""

import re
from collections.abc import Callable
from html import escape
from itertools import chain
from pathlib import Path

import pytest
from browser import Browser, with_browser
from paper_settings import STATISTICS

from experiments.evaluation.report.headline import COLUMNS
from experiments.evaluation.report.pages import pages, table_page, titled
from experiments.evaluation.tables.layout import markdown_table
from experiments.plan.products import HEADLINE, TEMPLATES
from mobnet.core.errors import DataError
from mobnet.core.rows import csv_text

REPO = Path(__file__).parents[4]
PARTS = {name: REPO / TEMPLATES / f"{name}.html" for name in ("table", "claims", "index")}
CAPTION = "Table 5: errors\n\nRMSE [N m], rule ``table_05``. *Simulated counterpart*.\n"
GOLDEN = REPO / "tests" / "golden" / "claims.csv"
PICTURE = REPO / "docs" / "results" / "figure_05.png"


def test_cells_stand_in_their_rows_below_the_caption_numbers_flush_right() -> None:
    table = markdown_table(["Method", "LL1"], [["MOB", "1.00"], ["a|b", "[0.5, 2.0]"]])
    page = table_page(PARTS["table"], table, *titled(CAPTION))
    rows = [re.findall(r"<t[hd][^>]*>(.*?)</t[hd]>", row) for row in re.findall(r"<tr>(.*?)</tr>", page, re.DOTALL)]
    assert rows == [["Method", "LL1"], ["MOB", "1.00"], ["a|b", "[0.5, 2.0]"]]
    assert page.count('style="text-align:right"') == len(rows)
    places = [page.index(text) for text in ("<h1>Table 5: errors</h1>", "<em>Simulated counterpart</em>", "<table>")]
    assert places == sorted(places)


def test_page_needs_nothing_else_and_text_is_never_markup() -> None:
    table = markdown_table(["<script>1</script>"], [["a < b"]])
    page = table_page(PARTS["table"], table, *titled("<b>title</b>\n\n<script>2</script>\n"))
    assert not re.search(r"<script|<b>|https?:|@import|url\(|src=", page)
    assert "a &lt; b" in page


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder of tables, captions and a picture, and the pages that are made of them."""
    folder = tmp_path_factory.mktemp("report")
    (folder / "claims.csv").write_bytes(GOLDEN.read_bytes())
    for name in HEADLINE:
        columns = ("scenario", "level", "metric", "joint", "method", "value", "published")
        places = [place for _, tables, place in COLUMNS if name in tables]
        rows = [{**place, "method": "MOB-Net", "value": 1.25, "published": 1.5} for place in places]
        (folder / f"{name}.csv").write_text(csv_text(columns, [[row.get(key) for key in columns] for row in rows]))
    for name in ("one", "two", "claims", "index", "picture"):
        (folder / f"{name}.md").write_text(markdown_table([name], [["1"]]))
        (folder / f"{name}.rst").write_text(f"title of {name}\n\nFirst ``words`` of\n{name}.\n\nMore of {name}.\n")
    (folder / "picture.png").write_bytes(PICTURE.read_bytes())
    write_pages(folder)
    return folder


def write_pages(folder: Path, **changes: Path | None) -> None:
    """Write the pages; changes are captions of tables."""
    names = ("one", "two", "claims")
    captions = {name: folder / f"{name}.rst" for name in names} | changes
    pages(
        [folder / f"{name}.md" for name in names], list(captions.values()),
        [(folder / "picture.png", folder / "picture.rst")], folder / "index.rst", STATISTICS, folder, PARTS,
        folder / "pages" / "one.html",
    )  # fmt: skip


def test_every_table_gets_its_page_and_one_without_a_caption_is_named(folder: Path) -> None:
    for name in ("one", "two", "claims", "index"):
        assert f"<h1>title of {name}</h1>" in (folder / "pages" / f"{name}.html").read_text()
    write_pages(folder, one=None)
    assert "<h1>one</h1>" in (folder / "pages" / "one.html").read_text()
    with pytest.raises(DataError, match=r"none\.rst: file is missing"):
        write_pages(folder, two=folder / "none.rst")


def test_the_tables_of_the_headline_are_those_that_the_plan_waits_for() -> None:
    assert list(chain.from_iterable(tables for _, tables, _ in COLUMNS)) == list(HEADLINE)


def test_docutils_takes_the_first_page_as_the_report_gives_it(folder: Path) -> None:
    """It refuses long lines, and leaves out whatever has one."""
    page = (folder / "pages" / "index.html").read_text()
    lines = escape(page.strip()).replace("\n", "\n   ")
    rst = f'.. raw:: html\n\n   <iframe srcdoc="{lines}"></iframe>\n'
    assert "title of picture" in titled(f"title\n\n{rst}")[1]


def test_equal_inputs_give_equal_pages_that_need_nothing_else(folder: Path) -> None:
    write_pages(folder)
    once = {path.name: path.read_bytes() for path in (folder / "pages").iterdir()}
    write_pages(folder)
    assert {path.name: path.read_bytes() for path in (folder / "pages").iterdir()} == once
    for content in once.values():
        assert not re.search(r"https?:|@import|url\(", content.decode())


@with_browser
def test_the_first_page_shows_verdicts_errors_pictures_and_links(
    folder: Path, open_page: Callable[..., Browser]
) -> None:
    write_pages(folder)
    browser = open_page(folder / "pages" / "index.html")
    said = browser.value("document.body.innerText")
    for text in (
        "title of index",
        "9 open",
        "statements of the original, by verdict",
        "By their first claim alone: ",
        "1.2 (1.5)",
        "title of picture. First words of picture.",
    ):
        assert text in said
    assert "More of picture" not in said
    browser.until("document.querySelector('img').naturalWidth > 100", True)
    links = browser.value("[...document.querySelectorAll('nav a')].map((link) => link.getAttribute('href'))")
    assert links == ["claims.html", "../runs.html", "one.html", "two.html"]
    assert browser.value("document.querySelector('nav').getClientRects().length") == 1
