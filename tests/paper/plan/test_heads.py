"""A table to read has its title, and what it shows in which unit, above its rows."""

from pathlib import Path

import pytest

from experiments.evaluation.tables.layout import Table, write_table
from experiments.plan.heads import head_of, put_head, table_in
from experiments.plan.plan import make_plan
from experiments.settings.load import load_settings
from mobnet.core.errors import DataError

ROOT = Path(__file__).parents[3]


def test_a_head_is_the_title_and_the_paragraph_without_numbers_of_the_run() -> None:
    head = head_of(
        'Table 5: left leg\n\nMOB-Net has {{ ours("a", "b") }} N m.\n\nRMSE [N m]\nof the leg.\n\nA detail.\n'
    )
    assert head == "# Table 5: left leg\n\nRMSE [N m] of the leg.\n\n"


def test_rows_and_note_stand_below_the_head_as_they_were(tmp_path: Path) -> None:
    write_table(tmp_path / "a", Table(("x",), [("1",)], ("x",), [["1"]], note="A note."))
    rows = (tmp_path / "a.md").read_text()
    csv = (tmp_path / "a.csv").read_bytes()
    put_head(tmp_path / "a.md", "# A\n\nText.\n\n")
    assert (tmp_path / "a.md").read_text() == f"# A\n\nText.\n\n{rows}"
    assert table_in((tmp_path / "a.md").read_text()) == rows
    assert (tmp_path / "a.csv").read_bytes() == csv


def test_a_table_that_was_not_made_is_told(tmp_path: Path) -> None:
    with pytest.raises(DataError, match=r"a\.md"):
        put_head(tmp_path / "a.md", "# A\n\n")


def test_every_table_of_a_run_has_a_head_without_a_field(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    plan = make_plan(load_settings(overrides={"scale": "smoke"}), with_pdf=False, with_mp4=False)
    heads: dict[str, str] = {}
    for product in plan.products:
        heads |= product.heads
    tables = [file for product in plan.products for file in product.outputs if file.endswith(".md")]
    assert len(tables) > 30
    assert [file for file in tables if not heads.get(file, "").startswith("# ")] == []
    assert [file for file, head in heads.items() if "{" in head] == []
