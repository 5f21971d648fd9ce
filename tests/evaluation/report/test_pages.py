"""A table's page shows every cell below its caption, as text, and needs no other file."""

import re
from pathlib import Path

import pytest

from mobnet.core.errors import DataError
from mobnet.evaluation.report.pages import pages, table_page
from mobnet.evaluation.tables.layout import markdown_table
from mobnet.plan.products import TEMPLATES

TEMPLATE = Path(__file__).parents[3] / TEMPLATES / "table.html"
CAPTION = "Table 5: errors\n\nRMSE [N m], rule ``table_05``. *Simulated counterpart*.\n"


def test_cells_stand_in_their_rows_below_the_caption_numbers_flush_right() -> None:
    table = markdown_table(["Method", "LL1"], [["MOB", "1.00"], ["a|b", "[0.5, 2.0]"]])
    page = table_page(TEMPLATE, table, CAPTION)
    rows = [re.findall(r"<t[hd][^>]*>(.*?)</t[hd]>", row) for row in re.findall(r"<tr>(.*?)</tr>", page, re.DOTALL)]
    assert rows == [["Method", "LL1"], ["MOB", "1.00"], ["a|b", "[0.5, 2.0]"]]
    assert page.count('style="text-align:right"') == len(rows)
    places = [page.index(text) for text in ("<h1>Table 5: errors</h1>", "<em>Simulated counterpart</em>", "<table>")]
    assert places == sorted(places)


def test_page_needs_nothing_else_and_text_is_never_markup() -> None:
    table = markdown_table(["<script>1</script>"], [["a < b"]])
    page = table_page(TEMPLATE, table, "<b>title</b>\n\n<script>2</script>\n")
    assert not re.search(r"<script|<b>|https?:|@import|url\(|src=", page)
    assert "a &lt; b" in page


def test_every_table_gets_its_page_and_one_without_a_caption_is_named(tmp_path: Path) -> None:
    names, out = ("one", "two"), tmp_path / "pages" / "one.html"
    for name in names:
        (tmp_path / f"{name}.md").write_text(markdown_table([name], [["1"]]))
        (tmp_path / f"{name}.rst").write_text(f"title of {name}\n")
    tables, captions = ([tmp_path / f"{name}.{ending}" for name in names] for ending in ("md", "rst"))
    pages(tables, captions, TEMPLATE, out)
    for name in names:
        assert f"<h1>title of {name}</h1>" in (out.parent / f"{name}.html").read_text()
    pages(tables, [None, captions[1]], TEMPLATE, out)
    assert "<h1>one</h1>" in out.read_text()
    captions[1].unlink()
    with pytest.raises(DataError, match=r"two\.rst: file is missing"):
        pages(tables, captions, TEMPLATE, out)
