"""The snapshot holds tables, pictures and their origin, and every difference from it is told in one line."""

from __future__ import annotations

from pathlib import Path

import pytest

from mobnet.core.errors import DataError
from mobnet.core.files import read_json
from mobnet.evaluation.report import snapshot as module
from mobnet.evaluation.report.snapshot import (
    HEADLINE,
    compare_snapshot,
    main,
    read_keyed,
    with_headline,
    write_snapshot,
)

REPO = Path(__file__).parents[3]
TABLE = (
    "scenario,level,method,joint,metric,value,published\nwalk,ideal,MOB,LL1,rmse,1.5,2\nwalk,ideal,MOB,LL2,rmse,3,4\n"
)
CONFIG = {"scale": "default"}


@pytest.fixture
def stored(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A working folder with a fresh table and a snapshot of it."""
    monkeypatch.chdir(tmp_path)
    made = {
        "tables/table_05.csv": TABLE,
        "tables/table_05.md": "x",
        "figures/figure_05.png": "png",
        "results/c.md": "c",
    }
    for name, text in made.items():
        Path(name).parent.mkdir(exist_ok=True)
        Path(name).write_text(text)
    write_snapshot(CONFIG, Path("tables"), Path("figures"), Path("docs/results"), [Path("results/c.md")])
    return tmp_path


def rewrite(old: str, new: str) -> list[str]:
    """Return the differences after an edit of the fresh table."""
    Path("tables/table_05.csv").write_text(TABLE.replace(old, new))
    return compare_snapshot(Path("docs/results"), Path("tables"))


@pytest.mark.usefixtures("stored")
def test_snapshot_holds_tables_and_pictures_with_their_origin() -> None:
    names = sorted(path.name for path in Path("docs/results").iterdir())
    assert names == ["c.md", "figure_05.png", "provenance.json", "table_05.csv", "table_05.md"]
    assert set(read_json(Path("docs/results/provenance.json"))) == {"scale", "commit", "lock", "config"}


@pytest.mark.usefixtures("stored")
def test_identical_tables_do_not_differ() -> None:
    """Identity: nothing differs from itself."""
    assert rewrite("", "") == []


@pytest.mark.usefixtures("stored")
@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("1.5", "1.6", ["table_05.csv: walk ideal MOB LL1 rmse: value 1.5 -> 1.6"]),
        ("walk,ideal,MOB,LL2,rmse,3,4\n", "", ["table_05.csv: walk ideal MOB LL2 rmse: row is gone"]),
        ("MOB,LL1", "MOB,LL3", ["walk ideal MOB LL1 rmse: row is gone", "walk ideal MOB LL3 rmse: row is new"]),
    ],
)
def test_a_changed_cell_and_a_changed_row_are_told_once(old: str, new: str, told: list[str]) -> None:
    found = rewrite(old, new)
    assert len(found) == len(told)
    assert all(line.endswith(text) for line, text in zip(found, told, strict=True))


@pytest.mark.usefixtures("stored")
def test_missing_table_is_told() -> None:
    Path("tables/table_05.csv").unlink()
    assert compare_snapshot(Path("docs/results"), Path("tables")) == [
        "tables/table_05.csv: file is missing; ./reproduce all makes it"
    ]


def test_nothing_to_store_or_to_compare_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(DataError, match="holds no CSV"):
        write_snapshot(CONFIG, tmp_path, tmp_path, tmp_path / "out")
    with pytest.raises(DataError, match="holds no CSV"):
        compare_snapshot(tmp_path, tmp_path)


@pytest.mark.usefixtures("stored")
def test_a_file_that_is_not_there_is_named_and_nothing_is_copied() -> None:
    with pytest.raises(DataError, match=r"results/none\.md: file is missing"):
        write_snapshot(CONFIG, Path("tables"), Path("figures"), Path("out"), [Path("results/none.md")])
    assert not Path("out").exists()


@pytest.mark.usefixtures("stored")
def test_exit_status_tells_whether_anything_differs(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module.logging, "basicConfig", lambda **_: None)
    assert main(["compare"]) == 0
    assert rewrite("1.5", "1.6")
    assert main(["compare"]) == 1
    assert main(["verify"]) == 1  # there is no manifest


def test_the_headline_replaces_what_stood_between_the_marks_and_nothing_else() -> None:
    page = f"a\n<!-- {HEADLINE} -->\nold\n<!-- /{HEADLINE} -->\nb\n"
    once = with_headline(page, "| new |\n")
    assert once == page.replace("old", "| new |")
    assert with_headline(once, "| new |\n") == once


def test_a_page_without_marks_is_refused() -> None:
    with pytest.raises(DataError, match="marks"):
        with_headline("no marks", "| new |")


def test_the_readme_shows_the_committed_headline_table() -> None:
    root = Path(__file__).parents[3]
    page, table = (root / "README.md").read_text(), (root / "docs" / "results" / f"{HEADLINE}.md").read_text()
    assert with_headline(page, table) == page


@pytest.mark.parametrize("stored", sorted((REPO / "docs/results").glob("*.csv")), ids=lambda path: path.stem)
def test_every_row_of_the_stored_tables_has_a_name_of_its_own(stored: Path) -> None:
    """Else `compare` would look at the last one of a name alone."""
    assert len(read_keyed(stored)) == len(stored.read_text().splitlines()) - 1
