"""The page of the folder of published results names each table and figure once, and nothing that is not there."""

import re
import shutil
from pathlib import Path

import pytest
from links import broken

from experiments.site.folder_page import FIRST, PAGE, RUN, folder_page, write_page
from experiments.site.results import items_of, with_head

REPO = Path(__file__).parents[3]
PUBLISHED = REPO / "docs" / "results"
LINK = re.compile(r"\]\(([^)#:]+)\)")
AGAIN = "python -m experiments.site results writes it again"


@pytest.fixture
def results(tmp_path: Path) -> Path:
    """A folder with a figure of the original, one of ours, two tables, and a film."""
    folder = tmp_path / "results"
    (folder / "figures").mkdir(parents=True)
    for name in ("figure_15.png", "figures/figure_15.csv.gz", "commands.png", "table_05.md",
                 "table_05.csv", "compute.md", "push.webp"):  # fmt: skip
        (folder / name).touch()
    for name in ("claims.csv", "claims_summary.csv"):  # the numbers of captions are looked up in them
        shutil.copyfile(PUBLISHED / name, folder / name)
    for kind, names in (("figures", ("figure_15", "commands", "figure_07")), ("tables", ("table_05", "compute"))):
        (tmp_path / kind).mkdir()
        for name in names:
            (tmp_path / kind / f"{name}.rst").write_text(f"Title of {name} (ours)\n\nText.\n")
    return folder


def test_items_are_grouped_by_kind_and_by_whose_they_are(results: Path) -> None:
    write_page(results, results.parent)
    page = (results / PAGE).read_text()
    parts = dict(re.findall(r"^## (.*?)\n(.*?)(?=^## |\Z)", page, re.MULTILINE | re.DOTALL))
    assert "[PNG](figure_15.png), [numbers](figures/figure_15.csv.gz)" in parts["Figures of the original"]
    assert '<img src="commands.png" width="240" alt="Title of commands">' in parts["Our figures"]
    assert "* [Title of table_05](table_05.md) ([CSV](table_05.csv))\n" in parts["Tables of the original"]
    assert parts["Our tables"] == "\n* [Title of compute](compute.md)\n\n"
    assert "push.webp" in parts["Start here"]
    assert "figure_07" not in page  # not published
    assert "explore.html" not in page


def test_a_table_has_its_title_and_caption_above_its_rows_once(results: Path) -> None:
    table = results / "table_05.md"
    table.write_text("| a |\n| --- |\n| 1.25 |\n\nA note.\n")
    for _ in range(2):
        write_page(results, results.parent)
        assert table.read_text() == "# Title of table_05 (ours)\n\nText.\n\n| a |\n| --- |\n| 1.25 |\n\nA note.\n"


def captions() -> list[Path]:
    """Return the captions of tables and figures."""
    return [path for kind in ("figures", "tables") for path in sorted((REPO / f"workflow/report/{kind}").iterdir())]


def test_every_published_table_has_its_title_and_caption() -> None:
    tables = [item for item in items_of(PUBLISHED, captions()) if not item.is_figure]
    assert {item.shown for item in tables} == {*PUBLISHED.glob("*.md")} - {PUBLISHED / PAGE}
    for item in tables:
        assert item.shown.read_text() == with_head(item), AGAIN


def test_the_published_page_is_that_of_the_published_files_and_captions() -> None:
    assert (PUBLISHED / PAGE).read_text() == folder_page(PUBLISHED, captions()), AGAIN
    assert list(broken([PUBLISHED / PAGE])) == []


def test_every_published_file_is_on_the_page() -> None:
    """A picture by its PNG, a table by its Markdown and its CSV."""
    named = LINK.findall((PUBLISHED / PAGE).read_text())
    published = {str(path.relative_to(PUBLISHED)) for path in PUBLISHED.rglob("*") if path.is_file()}
    published = {name for name in published if not name.startswith("rows/")} - {PAGE}
    assert published - set(named) == set()
    assert len(named) == len(set(named))


def test_what_is_neither_a_table_nor_a_figure_is_said_in_a_sentence() -> None:
    assert all(text[0].isupper() and text.endswith(".") for text in {**FIRST, **RUN}.values())
