"""The paper's table of deviations is that of docs/deviations.md."""

from pathlib import Path

import pytest

from mobnet.core.errors import DataError
from mobnet.evaluation.report.deviations import deviations, markdown_rows, tex_text

DOC = Path(__file__).parents[3] / "docs/deviations.md"


def test_every_row_of_the_document_reaches_the_paper_in_order(tmp_path: Path) -> None:
    deviations(DOC, tmp_path / "d.tex")
    tex = (tmp_path / "d.tex").read_text()
    places = [tex.index(tex_text(row[0]) + " & ") for row in markdown_rows(DOC.read_text(), "d")]
    assert places == sorted(places)
    assert len(places) > 15


def test_code_is_set_as_code_and_specials_are_escaped() -> None:
    assert tex_text("tau_d of `a_b`, 5 %") == r"tau\_d of \texttt{a\_b}, 5 \%"


@pytest.mark.parametrize(
    ("text", "says"),
    [("no table", "no table"), ("|a|b|c|d|\n|---|---|---|---|\n|x|y|z|\n", "3 cells in the row of 'x'")],
)
def test_a_table_that_does_not_fit_is_refused(text: str, says: str) -> None:
    with pytest.raises(DataError, match=says):
        markdown_rows(text, "d.md")


def test_a_missing_document_is_named(tmp_path: Path) -> None:
    with pytest.raises(DataError, match=r"none\.md: file is missing"):
        deviations(tmp_path / "none.md", tmp_path / "d.tex")
