"""The size of a figure's type in print comes from its PDF and from TeX's log, and too small a one is refused."""

from pathlib import Path
from typing import Any

import pytest
from matplotlib import rc_context
from matplotlib.figure import Figure

from experiments.evaluation.figures.style import save_figure
from experiments.evaluation.report.paper import PaperError, missing_packages, paper
from experiments.evaluation.report.type_sizes import printed_types, printed_widths, type_faults, type_sizes
from experiments.settings.pages import PaperText
from experiments.settings.settings import Settings
from mobnet.core.errors import DataError
from mobnet.core.style import COLUMN_INCH, STYLE

LOG = """<figures/{name}.pdf, id=7, 245.7pt x 72.3pt>
File: figures/{name}.pdf Graphic file (type pdf)
<use figures/{name}.pdf>
Package pdftex.def Info: figures/{name}.pdf  used on input line 174.
(pdftex.def)             Requested size: {width}pt x 30.5pt.
"""
SOURCE = r"""\documentclass{article}
\usepackage{graphicx}
\providecommand{\figures}{../figures}
\begin{document}\includegraphics[width=\textwidth,height=WIDEcm,keepaspectratio]{\figures/shown}\end{document}
"""
with_tex = pytest.mark.skipif(bool(missing_packages()), reason="TeX is not installed")


def draw(path: Path, text: str = "torque", size: float = 8.0, **look: Any) -> None:
    """Write a figure of a column's width and an inch, with a text upright and a larger one across."""
    with rc_context(STYLE):
        figure = Figure(figsize=(COLUMN_INCH, 1.0))
        figure.text(0.1, 0.5, text, fontsize=size, **look)
        figure.text(0.5, 0.1, "\N{MINUS SIGN}1", fontsize=9.5, rotation=90)
        save_figure(figure, path.with_suffix(""), ["x"], [])


def test_every_size_is_found_that_a_figure_has(tmp_path: Path) -> None:
    """Those of subscripts and of characters beyond Latin, too."""
    draw(tmp_path / "a.pdf", "\N{GREEK SMALL LETTER TAU}", 6.5)
    assert type_sizes((tmp_path / "a.pdf").read_bytes()) == {6.5, 9.5}
    draw(tmp_path / "b.pdf", "$x_y$", 10.0)
    assert min(type_sizes((tmp_path / "b.pdf").read_bytes())) == pytest.approx(7.0)


def test_letters_drawn_as_outlines_are_refused(tmp_path: Path) -> None:
    from matplotlib.patheffects import withStroke

    with pytest.raises(ValueError, match="text with path effects: 'knee'; give it a box"):
        draw(tmp_path / "a.pdf", "knee", path_effects=[withStroke(linewidth=2)])


def test_a_size_is_that_of_the_smallest_print(tmp_path: Path) -> None:
    """A figure that the paper prints twice counts as it is smaller; half the width is half the type."""
    (tmp_path / "figures").mkdir()
    draw(tmp_path / "figures/arm.pdf")
    half = COLUMN_INCH / 2 * 72.27
    log = LOG.format(name="arm", width=100 * half) + LOG.format(name="arm", width=half)
    assert printed_widths(log)["figures/arm.pdf"] == pytest.approx(COLUMN_INCH / 2 * 72)
    (found,) = printed_types(log, tmp_path)
    assert (found.name, found.native_pt) == ("arm", 8.0)
    assert found.printed_pt == pytest.approx(4.0, abs=1e-3)
    assert type_faults([found], 3.9) == []
    (fault,) = type_faults([found], 6.5)
    assert fault.startswith("arm: smallest type in print 4.00 pt, drawn at 8 pt and printed at 0.500 of its size; ")
    assert "accepted: 6.5 pt, so draw it less high" in fault


def test_what_is_no_picture_is_named(tmp_path: Path) -> None:
    (tmp_path / "figures").mkdir()
    (tmp_path / "figures/arm.pdf").write_bytes(b"%PDF-1.4")
    with pytest.raises(DataError, match=r"figures/arm\.pdf: no page with a size"):
        printed_types(LOG.format(name="arm", width=100), tmp_path)


@with_tex
def test_the_paper_is_refused_with_a_figure_whose_type_is_too_small(tmp_path: Path, settings: Settings) -> None:
    """At any scale; a height that shrinks a figure shrinks its type, as the one that was printed has it."""
    for name in ("paper", "tables", "figures"):
        (tmp_path / name).mkdir()
    tables = [tmp_path / f"tables/{name}.tex" for name in ("numbers", "captions")]
    for path in tables:
        path.write_text("")
    (tmp_path / "paper/refs.bib").write_text("")
    main = tmp_path / "paper/main.tex"
    draw(tmp_path / "figures/shown.pdf")
    text: PaperText = settings.evaluation.paper
    given = (tmp_path / "paper/refs.bib", tables, [tmp_path / "figures/shown.pdf"], tmp_path / "build.json")
    main.write_text(SOURCE.replace("WIDE", "2.54"))  # as high as drawn
    paper("smoke", text, main, *given)
    assert (tmp_path / "main.pdf").is_file()
    main.write_text(SOURCE.replace("WIDE", "1.27"))
    with pytest.raises(PaperError, match=r"shown: smallest type in print 4\.00 pt.*accepted: 6\.5 pt, so draw it"):
        paper("smoke", text, main, *given)
    assert not (tmp_path / "main.pdf").exists()
