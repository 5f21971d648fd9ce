"""The paper is built from the published results alone, and says what they lack; their TeX tables hold their numbers."""

import logging
import re
import shutil
from pathlib import Path

import pytest
from asked_numbers import asked_names

from experiments.evaluation.report.captions import names_in
from experiments.evaluation.report.numbers import numbers_tex
from experiments.evaluation.report.paper import defined_texts, missing_packages, turned_guards
from experiments.plan.plan import Plan, make_plan
from experiments.settings.load import load_settings
from experiments.site import published_paper as module
from experiments.site.published_paper import published_paper, values_in
from experiments.site.redraw import Stored
from mobnet.core.errors import DataError

REPO = Path(__file__).parents[3]
PUBLISHED = REPO / "docs" / "results"
MAIN = REPO / "paper/main.tex"
NUMBER = re.compile(r"(?<![\w.])-?\d+(?:\.\d+)?(?:e[+-]\d+)?")
SMALL = r"""\documentclass{article}
\usepackage{booktabs,graphicx}
\usepackage[paperwidth=60cm,textwidth=55cm]{geometry}
\providecommand{\tables}{../tables}\providecommand{\figures}{../figures}
\input{\tables/numbers}\input{\tables/captions}
\begin{document}
\found{mob-net-cut} \cell{links@nothing@found} \capt{figures/method}\holds{mob-net-cut}{reproduced}
\input{\tables/limbs}

\includegraphics{\figures/method}

\includegraphics[width=5cm]{\figures/figure_13}
\label{end:main}
\end{document}
"""
with_tex = pytest.mark.skipif(bool(missing_packages()), reason="TeX is not installed")


@pytest.fixture(scope="module")
def stored() -> Stored:
    """The published results."""
    return Stored(PUBLISHED, load_settings())


@pytest.fixture(scope="module")
def plan(stored: Stored) -> Plan:
    """The plan of a whole run."""
    return make_plan(stored.settings, with_pdf=True)


def test_without_tex_one_line_says_what_to_install(
    stored: Stored, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(module, "missing_packages", lambda: ["latexmk"])
    with pytest.raises(DataError, match="TeX is not complete; the paper needs: apt-get install texlive") as told:
        published_paper(stored, tmp_path / "out")
    assert "\n" not in str(told.value)
    assert not (tmp_path / "out").exists()


@with_tex
def test_a_paper_is_set_from_published_tables_and_pictures(
    stored: Stored, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    results = tmp_path / "results"
    (results / "figures").mkdir(parents=True)
    for path in (
        *PUBLISHED.glob("*.csv"),
        *PUBLISHED.glob("*.tex"),
        PUBLISHED / "method.png",
        PUBLISHED / "figure_13.png",
    ):
        shutil.copyfile(path, results / path.name)  # of two figures one is drawn, the other is its picture
    main = tmp_path / "main.tex"
    main.write_text(SMALL)
    monkeypatch.chdir(REPO)
    monkeypatch.setattr(module, "MAIN", main)
    with caplog.at_level(logging.WARNING):
        published_paper(Stored(results, stored.settings), tmp_path / "out")
    assert (tmp_path / "out/main.pdf").read_bytes().startswith(b"%PDF")
    assert "1 numbers of the text are not published yet" in caplog.text
    assert "cell@links@nothing@found" in caplog.text


def test_every_number_of_the_text_is_looked_for() -> None:
    """But for those of guards, which a missing number turns."""
    text = MAIN.read_text()
    guards = ("verdict@", "value@")
    asked = {name.replace("foundspan@", "span@") for name in asked_names(text) if not name.startswith(guards)}
    assert asked <= set(names_in(text))
    assert len(asked) > 150


def test_the_text_fits_the_published_results_but_for_what_they_lack(
    plan: Plan, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(REPO)
    values = values_in(plan, PUBLISHED)
    text = MAIN.read_text()
    absent = [name for name in names_in(text) if name not in values]
    # Detectors of the original, which 0.6.0 ran with more pushes in their training alone.
    assert {name.split("@")[3] for name in absent} <= {"FTS-e2e-mean", "MOB-Net-OR", "MOB-Net-sigma"}
    assert turned_guards(text, defined_texts(numbers_tex(values, absent))) == []


def numbers_in(table: Path) -> tuple[set[str], set[str]]:
    """Return the numbers in a table's Markdown, and those in its TeX."""
    lines = [line for line in table.with_suffix(".md").read_text().splitlines() if line.startswith("|")]
    return set(NUMBER.findall(" ".join(lines))), set(NUMBER.findall(table.read_text().replace("$-$", "-")))


@pytest.mark.parametrize("table", sorted(PUBLISHED.glob("*.tex")), ids=lambda path: path.stem)
def test_a_published_table_as_tex_has_the_numbers_of_its_markdown(table: Path) -> None:
    markdown, tex = numbers_in(table)
    if table.stem == "ten_first":  # in TeX it has no column of what would decide
        assert len(tex) > 20
        assert tex - markdown == set()
    elif table.stem == "claims":  # in TeX it has no rows of single joints
        assert len(tex) > 300
        assert len(tex - markdown) <= 3  # widths
    else:
        assert markdown - tex == set()


def test_every_published_table_is_there_as_tex(plan: Plan) -> None:
    assert {path.stem for path in PUBLISHED.glob("*.tex")} == {*plan.tables, "compute"}
