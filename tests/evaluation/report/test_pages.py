"""A table's page shows every cell below its caption, as text, and needs nothing else."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from mobnet.core.errors import DataError
from mobnet.evaluation.report.pages import pages, table_page
from mobnet.evaluation.tables.layout import markdown_table

CAPTION = "Table 5: errors\n\nRMSE [N m], rule ``table_05``. *Simulated counterpart*.\n"


def test_cells_stand_in_their_rows_numbers_flush_right() -> None:
    table = markdown_table(["Method", "LL1"], [["MOB", "1.00"], ["a|b", "[0.5, 2.0]"]])
    page = table_page(table, CAPTION)
    rows = [re.findall(r"<t[hd][^>]*>(.*?)</t[hd]>", row) for row in re.findall(r"<tr>(.*?)</tr>", page, re.DOTALL)]
    assert rows == [["Method", "LL1"], ["MOB", "1.00"], ["a|b", "[0.5, 2.0]"]]
    assert page.count('style="text-align:right"') == len(rows)


def test_the_caption_stands_above_the_table() -> None:
    page = table_page(markdown_table(["a"], [["b"]]), CAPTION)
    assert "<h1>Table 5: errors</h1>" in page
    assert page.index("<em>Simulated counterpart</em>") < page.index("<table>")


def test_page_needs_nothing_else_and_text_is_never_markup() -> None:
    page = table_page(markdown_table(["<script>1</script>"], [["a < b"]]), "<b>title</b>\n\n<script>2</script>\n")
    assert not re.search(r"<script|<b>|https?:|@import|url\(|src=", page)
    assert "a &lt; b" in page


def test_every_table_gets_its_page(tmp_path: Path) -> None:
    for name in ("one", "two"):
        (tmp_path / f"{name}.md").write_text(markdown_table([name], [["1"]]))
        (tmp_path / f"{name}.rst").write_text(f"title of {name}\n")
    pages([tmp_path / "one.md", tmp_path / "two.md"], tmp_path, tmp_path / "pages")
    for name in ("one", "two"):
        assert f"<h1>title of {name}</h1>" in (tmp_path / "pages" / f"{name}.html").read_text()


def test_a_table_without_a_caption_is_named(tmp_path: Path) -> None:
    (tmp_path / "one.md").write_text(markdown_table(["a"], [["1"]]))
    with pytest.raises(DataError, match=r"one\.rst: file is missing"):
        pages([tmp_path / "one.md"], tmp_path, tmp_path / "pages")
