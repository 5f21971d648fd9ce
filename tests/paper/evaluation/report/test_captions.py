"""Captions begin with a result: fields become numbers, marks TeX, and a number of the printed paper leaves."""

import re
from pathlib import Path

import pytest

from experiments.evaluation.report.captions import (
    caption_tex,
    captions_tex,
    cited,
    fill_captions,
    filled,
    inline_tex,
)
from experiments.plan.heads import drawn
from mobnet.core.errors import DataError

CAPTIONS = Path(__file__).parents[4] / "workflow/report"
VALUES = {
    "found@rte-walk": "1.04", "verdict@rte-walk": "not reproduced", "cell@peaks@all noise@MOB": "-0.80",
    "value@peaks@all noise@MOB": "-0.8000", "cell@peaks@all noise@MOB-Net": "0.50",
    "value@peaks@all noise@MOB-Net": "0.5000",
}  # fmt: skip
BELOW = '{{ below("peaks@all noise@MOB", "peaks@all noise@MOB-Net") }}'


@pytest.fixture
def caption(tmp_path: Path) -> Path:
    """A caption of two paragraphs."""
    path = tmp_path / "figures/figure_05.rst"
    path.parent.mkdir()
    path.write_text("Figure 5: one gait cycle (ours)\n\nIt *moves* by 5 % [N m].\nSee ``zero``.\n\nMore.\n")
    return path


def written(path: Path, text: str) -> Path:
    """Write a text below the title of a caption, and return its file."""
    path.write_text(f"A title\n\n{text}\n")
    return path


def test_the_title_comes_first_without_the_number_that_the_paper_gave_it(caption: Path) -> None:
    text = r"\textbf{One gait cycle.} It \emph{moves} by 5 \% [N m]. See \texttt{zero}. "
    text += r"After Figure~5~of~\cite{lim2023mobnet}."
    assert caption_tex(caption).replace(r"~N\,m", " N m").replace("[N~m]", "[N m]") == text


def test_the_paper_prints_what_is_drawn_and_neither_what_follows_from_it_nor_details(caption: Path) -> None:
    text = 'MOB has {{ found("rte-walk") }}.\n\nThe error [N m].\n\nDetails.'
    assert caption_tex(written(caption, text)) == r"\textbf{A title.} The error [N m]."


def test_a_caption_that_does_not_say_what_is_drawn_is_refused(caption: Path) -> None:
    with pytest.raises(DataError, match="every paragraph has a field; accepted: one without, which says what is drawn"):
        caption_tex(written(caption, 'MOB has {{ found("rte-walk") }}.'))


@pytest.mark.parametrize(
    ("text", "tex"),
    [
        ("see section 5.1.", r"see section~5.1~of~\cite{lim2023mobnet}."),
        ("the original's Table 2", r"Table~2~of~\cite{lim2023mobnet}"),
        ("Figure 9 of the original (section 5.2)", r"Figure~9~of~\cite{lim2023mobnet}"),
        ("equation (18)", r"equation~(18)~of~\cite{lim2023mobnet}"),
        ("as in Figure 5", r"as in Figure~\ref{fig:figure_05}"),
        ("as in Figure 9", r"as in Figure~9~of~\cite{lim2023mobnet}"),
    ],
)
def test_items_of_the_original_are_cited_and_ours_referred_to(caption: Path, text: str, tex: str) -> None:
    assert cited(text, caption.parents[1]) == tex


MAIN = (CAPTIONS.parents[1] / "paper/main.tex").read_text()
NARROW = set(
    re.findall(r"\\(?:columnfigure\{|includegraphics\[width=\\columnwidth.*\\figures/)(\w+)\}", MAIN)
)  # in a column
AROUND = len("Table S10. After Figure 10 of [1].")


def test_a_caption_of_the_paper_has_at_most_four_lines_and_neither_a_path_nor_a_formula() -> None:
    """About: in a column 68 letters of its type stand in a line, on a page 140."""
    typed = re.compile(r"docs/|configs/|\^|\.md|\.py")
    captions = [path for kind in ("tables", "figures") for path in sorted((CAPTIONS / kind).glob("*.rst"))]
    assert len(captions) > 60
    assert len(NARROW) > 1
    for path in captions:
        title, _, text = path.read_text().partition("\n")
        shown = drawn(text)
        width = 68 if path.stem in NARROW else 140
        if path.stem != "push":  # the film is not in the paper
            assert AROUND + len(title) + len(shown) <= 4 * width, path
            assert not typed.search(shown), path


def test_a_name_says_what_is_shown(caption: Path) -> None:
    assert rf"\csname capt@figures/figure_05\endcsname{{{caption_tex(caption)}}}" in captions_tex([caption])


def test_a_line_does_not_begin_with_a_space_where_its_first_number_is_none(caption: Path) -> None:
    values = {**VALUES, "span@rte-walk": ""}
    assert filled(written(caption, 'By\n{{ foundspan("rte-walk") }} more.'), values) == "A title\n\nBy\nmore.\n"


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


def test_a_field_is_a_number_of_the_results_also_where_a_line_breaks_in_it(caption: Path, tmp_path: Path) -> None:
    text = 'By {{ found("rte-walk") }} and {{ cell("peaks@all\nnoise@MOB") }}' + BELOW
    text += '{{ holds("rte-walk", "open", "not\nreproduced") }}.'
    fill_captions([written(caption, text)], VALUES, tmp_path / "out")
    assert (tmp_path / "out/figures/figure_05.rst").read_text() == "A title\n\nBy 1.04 and -0.80.\n"


def test_a_sentence_that_results_do_not_bear_out_has_a_dagger_that_is_explained(caption: Path) -> None:
    turned = '{{ below("peaks@all noise@MOB-Net", "peaks@all noise@MOB") }}'
    for guard in (turned, '{{ holds("rte-walk", "reproduced", "open") }}'):
        line, explained = filled(written(caption, f"It is so{guard}."), VALUES).split("\n\n")[1:]
        assert line == "It is so†."
        assert explained.startswith("† The results shown here do not bear out")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "no text below the title"),
        ("The method `zero`.", "'`zero`.' is not accepted; accepted: ``code`` in double backticks"),
        ('By {{ found("rte-wlak") }}.', "no table has 'found@rte-wlak'; accepted: a name of numbers.tex"),
        ('By {{ fuond("rte-walk") }}.', "'fuond' is undefined; accepted: ourcell, "),
        ("By {{ found }}.", "a field without its arguments in parentheses; accepted: ourcell, "),
        ('By {{ found("a", "b") }}.', 'found("a", "b"): 2 arguments are not accepted; accepted: 1'),
        ('So{{ holds("rte-walk") }}.', 'holds("rte-walk"): 1 arguments are not accepted; accepted: 2'),
        ('So{{ holds("rte-wlak", "open") }}.', "no table has 'verdict@rte-wlak'; accepted: a name of numbers.tex"),
        ('So{{ below("peaks@no", "peaks@no") }}.', "no table has 'cell@peaks@no'; accepted: a name of numbers.tex"),
    ],
)
def test_what_is_no_caption_is_refused_in_a_line(caption: Path, text: str, message: str) -> None:
    with pytest.raises(DataError) as error:
        filled(written(caption, text), VALUES)
    assert str(error.value).startswith(f"{caption}: {message}")
    assert "\n" not in str(error.value)


def test_a_field_that_is_not_closed_is_refused_with_its_line(caption: Path) -> None:
    with pytest.raises(DataError, match=r"figure_05\.rst, line 4: .*; accepted: a template of Jinja$"):
        filled(written(caption, 'By\n{{ found("rte-walk".'), VALUES)


@pytest.mark.parametrize("path", sorted(CAPTIONS.glob("*/*.rst")), ids=lambda path: f"{path.parent.name}/{path.stem}")
def test_no_caption_asks(path: Path) -> None:
    assert "?" not in path.read_text(encoding="utf-8")
