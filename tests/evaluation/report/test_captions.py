"""Captions of the report are those of the paper: their marks become TeX, and a number of the printed paper leaves."""

from pathlib import Path

import pytest

from experiments.evaluation.report.numbers import caption_tex, captions_tex, inline_tex
from mobnet.core.errors import DataError


@pytest.fixture
def caption(tmp_path: Path) -> Path:
    """A caption of two paragraphs."""
    path = tmp_path / "figures/figure_05.rst"
    path.parent.mkdir()
    path.write_text("Figure 5: one gait cycle (ours)\n\nWhat *moves* by 5 % [N m]?\nSee ``zero``.\n\nMore.\n")
    return path


def test_the_title_comes_first_without_the_number_that_the_paper_gave_it(caption: Path) -> None:
    text = r"\textbf{One gait cycle.} What \emph{moves} by 5 \% [N m]? See \texttt{zero}. More."
    assert caption_tex(caption).replace(r"~N\,m", " N m").replace("[N~m]", "[N m]") == text


def test_a_name_says_what_is_shown(caption: Path) -> None:
    assert rf"\csname capt@figures/figure_05\endcsname{{{caption_tex(caption)}}}" in captions_tex([caption])


@pytest.mark.parametrize(
    ("text", "tex"),
    [
        ("a_b & 5 %", r"a\_b \& 5 \%"),
        ("**not** *this* ``x_1``", r"\textbf{not} \emph{this} \texttt{x\_1}"),
        ("2 * 3 is 6", "2 * 3 is 6"),
        ("-3 dB", "$-$3 dB"),
    ],
)
def test_marks_of_a_line_become_tex(text: str, tex: str) -> None:
    assert inline_tex(text) == tex


def test_a_caption_without_text_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "legs.rst"
    path.write_text("A title\n\n")
    with pytest.raises(DataError, match=r"legs\.rst: no text below the title"):
        caption_tex(path)
