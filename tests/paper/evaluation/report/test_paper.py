"""The paper builds and fits its pages where TeX exists, says what is missing elsewhere, never changes on its own."""

import csv
import json
import re
import shutil
import subprocess
from collections.abc import Callable, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any

import made_detections
import numpy as np
import pandas as pd
import pytest
from asked_numbers import asked_names
from matplotlib.figure import Figure
from PIL import Image

from experiments.evaluation.report.deviations import deviations
from experiments.evaluation.report.numbers import GUARDS, numbers
from experiments.evaluation.report.paper import (
    PACKAGES,
    PaperError,
    copy_sources,
    defined_texts,
    missing_packages,
    paper,
    unfit_words,
)
from experiments.evaluation.tables.further import claims_table, methods, ten_first
from experiments.evaluation.tables.further.uncertainty import PLANT, look_at
from experiments.evaluation.tables.layout import PART, long_table, note_tex, text_table
from experiments.evaluation.tables.look import lines_of
from experiments.plan.files import Files
from experiments.plan.product import Context, Folders
from experiments.plan.products import KEPT_TABLE, MAIN_TABLES, Products, sources
from experiments.settings.catalogue import Catalogue
from experiments.settings.load import load_settings
from experiments.settings.pages import PaperText
from experiments.settings.settings import Settings
from experiments.settings.table_columns import CLAIMS
from mobnet.core.errors import DataError
from mobnet.core.files import write_text
from mobnet.core.rows import csv_text, read_texts
from mobnet.settings.data import Recordings

REPO = Path(__file__).parents[4]
GOLDEN, PUBLISHED = REPO / "tests/golden", REPO / "docs/results"
DETECTION = ("table_09", "table_13", "false_alarms", "found_by_rate", "smallest_force", "links")
TEXT = PaperText(scale="default", pages=8, type_pt=6.5)
EDGE_MM = 8.0  # of a page's lower edge
SHOWN = 4  # columns of another table whose text nobody published yet
SOURCE = r"""\documentclass{article}
\pdfinfoomitdate=1 \pdftrailerid{} \providecommand{\tables}{../tables}
\begin{document}\input{\tables/table_05}\end{document}
"""
with_tex = pytest.mark.skipif(bool(missing_packages()), reason="TeX is not installed")


@pytest.fixture
def source(tmp_path: Path) -> Path:
    """A small paper that inputs one table."""
    for name in ("paper", "tables", "figures"):
        (tmp_path / name).mkdir()
    (tmp_path / "tables/table_05.tex").write_text("nineteen")
    for name in ("numbers", "captions"):
        (tmp_path / f"tables/{name}.tex").write_text("")
    (tmp_path / "paper/refs.bib").write_text("")
    (tmp_path / "paper/main.tex").write_text(SOURCE)
    return tmp_path / "paper/main.tex"


def text_of_table(name: str) -> tuple[list[str], list[list[str]], int, str]:
    """Return head, lines, columns flush left and note of a published table, or of the first of a golden one's."""
    path = PUBLISHED / f"{name}.md"
    if not path.is_file():
        header, *rows = csv.reader((GOLDEN / f"{name}.csv").read_text().splitlines())
        return header[:SHOWN], [row[:SHOWN] for row in rows[:5]], SHOWN, ""
    lines = path.read_text().splitlines()
    rows = [re.split(r" ?(?<!\\)\| ?", line)[1:-1] for line in lines if line.startswith("|")]
    header, marks, *cells = [[cell.replace(r"\|", "|") for cell in row] for row in rows]
    return header, cells, marks.count("---"), " ".join(line for line in lines if line and not line.startswith("|"))


def text_of_uncertainty() -> tuple[list[str], list[list[str]], int, str]:
    """Return the same of the published sizes of the uncertainty torque, laid out as they are now."""
    rows = pd.read_csv(PUBLISHED / "uncertainty.csv")
    is_of_robot = rows["set"].str.startswith("robot")
    rows["plant"] = rows["set"].where(is_of_robot, PLANT)
    rows["data"] = rows["set"].where(~is_of_robot).groupby(rows["joint"]).transform("first")
    look = look_at(list(rows["plant"].unique()), "")
    return look.header, [list(line) for line in lines_of(rows, look) if not isinstance(line, str)], 4, ""


def write_tex(name: str, settings: Settings, out: Path) -> None:
    """Write a table as TeX of about the size that the one of the default scale has."""
    header, lines, left, note = text_of_uncertainty() if name == "uncertainty" else text_of_table(name)
    align = "l" * left + "r" * (len(header) - left)
    parts = getattr(settings.evaluation.tables.get(name), "parts", ())
    if name == "claims":
        width = len(claims_table.HEADER)  # what follows are lines below a claim
        shown = [line[:width] for line in lines]
        tex = long_table(claims_table.COLUMNS, claims_table.CAPTION, header[:width], shown)
    elif name == "ten_first":
        width = len(ten_first.HEADER)  # what follows is in the Markdown alone
        tex = text_table(ten_first.TEX_COLUMNS, header[:width], [line[:width] for line in lines])
    elif name == "methods":
        tex = long_table(align, methods.CAPTION, header, lines)
    elif parts:
        tex = in_parts(header, lines, left, parts)
    else:
        tex = text_table(align, header, lines)
    out.write_text(tex + (note_tex(note) if note else ""))


def in_parts(header: list[str], lines: list[list[str]], left: int, parts: Sequence[str]) -> str:
    """Return the parts of a table that is wider than a page, the ends of an interval one below the other."""
    names, texts = [head.split(" [")[0] for head in header], []
    stacked = [
        [*line[: left - 1], f"{line[left - 1]} {end}".strip(),
         *(cell.strip("[]").split(", ")[-k] for cell in line[left:])]
        for line in lines for k, end in (((2, "from"), (1, "to")) if line[left - 1].endswith("%") else ((1, ""),))
    ]  # fmt: skip
    for first, end in pairwise([left, *map(names.index, parts), len(header)]):
        cut = [[*line[:left], *line[first:end]] for line in (header, *stacked)]
        texts.append(text_table("l" * left + "r" * (end - first), cut[0], cut[1:]))
    return PART.join(texts)


def build(source: Path, scale: str = "smoke") -> Any:
    """Build the paper, whose words are those of another scale, into a folder `out` and return the note."""
    root = source.parents[1]
    tables = [root / f"tables/{name}.tex" for name in ("table_05", "numbers", "captions")]
    paper(scale, TEXT, source, source.with_name("refs.bib"), tables, [], root / "out/build.json")
    return json.loads((root / "out/build.json").read_text())


def test_without_tex_the_note_names_the_packages_and_no_old_pdf_is_left(
    source: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    stale = source.parents[1] / "out/main.pdf"
    stale.parent.mkdir()
    stale.write_text("old")
    monkeypatch.setattr("shutil.which", lambda name: None)
    assert build(source) == {"scale": "smoke", "pdf": None, "missing_packages": list(PACKAGES), "unfit": []}
    assert "apt-get install texlive-latex-recommended texlive-publishers" in caplog.text
    assert not stale.exists()


@with_tex
def test_with_tex_equal_input_gives_equal_bytes(source: Path) -> None:
    pdf = source.parents[1] / "out/main.pdf"
    assert build(source) == {"scale": "smoke", "pdf": "main.pdf", "missing_packages": [], "unfit": []}
    once = pdf.read_bytes()
    build(source)
    assert pdf.read_bytes() == once
    assert once.startswith(b"%PDF")


@pytest.fixture
def write_detection(
    tmp_path: Path, make_table: Callable[..., Path], settings: Settings, monkeypatch: pytest.MonkeyPatch
) -> Callable[[], None]:
    """Write the tables of detection as the configuration has them: of robots, a made-up number for each detector."""

    configured = load_settings()

    def write() -> None:
        for name in settings.detection.detectors:
            monkeypatch.setitem(made_detections.FOUND, name, 0.75)
            monkeypatch.setitem(made_detections.DELAY_S, name, 0.123)
        for name in DETECTION:
            section = getattr(configured.evaluation, name)
            made = made_detections.write_detections(tmp_path / "detection", ["robot_1"])
            given: dict[str, Any] = {"settings": section, "detections": made}
            if name != "table_13":  # it has all that it shows in the rows of thresholds
                given["detection"] = configured.detection
            make_table(name, **given)

    return write


def published(name: str) -> Path:
    """Return a table's CSV file: the published one, or the golden one of a table that nobody published yet."""
    path = PUBLISHED / f"{name}.csv"
    return path if path.is_file() else GOLDEN / f"{name}.csv"


def published_claims(made: Path, out: Path) -> Path:
    """Write the published claims, and of those that nobody published yet the made-up ones, and return the file."""
    rows = {row["claim"]: row for path in (made, PUBLISHED / "claims.csv") for row in read_texts(path)}
    write_text(out, csv_text(CLAIMS, [[row[name] for name in CLAIMS] for row in rows.values()]))
    return out


def write_numbers(products: Products, settings: Settings, claims_csv: Path, summary_csv: Path, out: Path) -> None:
    """Write numbers and captions from what is published, and a made-up number for each other one that the text asks."""
    (product,) = (product for product in products.all() if product.name == "numbers")
    wanted: Any = product.call.arguments
    kept = KEPT_TABLE.with_suffix(".csv")
    tables = [published(path.stem) for path in wanted["table_csvs"]]
    further = [REPO / path if path == kept else published(path.stem) for path in wanted["further_csvs"]]
    train, sizes = Recordings(shards=1, shard_s=60.0), (settings.scale, settings.rates, settings.sizes, settings.fleet)
    captions = [REPO / path for path in wanted["captions"]]
    used = [published(name) for name in sources(settings.evaluation)]
    compared = settings.evaluation.main_tables
    numbers(
        *sizes, train, tables, further, claims_csv, summary_csv, captions, compared, used, out.with_name("said"), out
    )
    known = defined_texts(out.read_text())
    made = (name for name in asked_names((REPO / "paper/main.tex").read_text()) if name not in known)
    out.write_text(
        out.read_text() + "".join(rf"\expandafter\def\csname {name}\endcsname{{0.5}}" + "\n" for name in made)
    )


@pytest.fixture(scope="session")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder of the paper's own PDF, with the published numbers and tables as large as the published ones."""
    return tmp_path_factory.mktemp("built")


@with_tex
def test_the_paper_itself_builds_from_the_published_tables(
    tmp_path: Path, claims_csv: Path, summary_csv: Path, settings: Settings, write_detection: Callable[[], None],
    built: Path,
) -> None:  # fmt: skip
    """And fits its pages and its results: every guard of its words holds. Every figure is the same picture."""
    folders = Folders(tmp_path, tmp_path, tmp_path, tmp_path / "out", tmp_path / "MANIFEST.sha256")
    context = Context(settings, Files(Catalogue(settings), tmp_path), folders)
    products = Products(context, with_pdf=True)
    deviations(REPO / "docs/deviations.md", tmp_path / "deviations.tex")
    claims = published_claims(claims_csv, tmp_path / "published_claims.csv")
    write_numbers(products, settings, claims, summary_csv, tmp_path / "numbers.tex")
    write_detection()
    for name in {*products.table_names, "compute"}.difference(DETECTION, MAIN_TABLES):
        write_tex(name, settings, tmp_path / f"{name}.tex")
    names = (*products.table_names, "numbers", "captions", "deviations", "compute")
    figures = [tmp_path / f"{name}.pdf" for name in dict.fromkeys(products.drawn)]
    for path in figures:
        Figure().savefig(path)
    main, references, tables = REPO / "paper/main.tex", REPO / "paper/refs.bib", [tmp_path / f"{n}.tex" for n in names]
    tables.append(REPO / KEPT_TABLE.with_suffix(".tex"))
    paper(settings.scale, settings.evaluation.paper, main, references, tables, figures, built / "build.json")
    assert (built / "main.pdf").stat().st_size > 50_000
    assert unfit_words(built / "build.json") == []


@with_tex
@pytest.mark.skipif(shutil.which("pdftoppm") is None, reason="pdftoppm, of poppler-utils, is not installed")
def test_no_ink_comes_near_the_lower_edge(built: Path) -> None:
    """A table that TeX let run off its page would be there."""
    if not (built / "main.pdf").is_file():
        pytest.skip("the paper was not built in this run")
    subprocess.run(["pdftoppm", "-r", "50", "-gray", built / "main.pdf", built / "page"], check=True)
    pages = sorted(built.glob("page-*.pgm"))
    assert len(pages) > TEXT.pages
    edge = int(EDGE_MM / 25.4 * 50)
    inked = [path.name for path in pages if np.asarray(Image.open(path))[-edge:].min() < 128]
    assert inked == []


@with_tex
def test_what_runs_off_its_page_or_has_a_label_twice_is_named_and_leaves_no_pdf(source: Path) -> None:
    """Each once; what is hardly seen is no fault."""
    document = r"\begin{document}\section{a}\label{a}\section{b}\label{a}\input{\tables/table_05}\end{document}"
    source.write_text(re.sub(r"\\begin\{doc.*", lambda _: document, SOURCE))
    wide, high = r"\noindent\rule{\dimexpr\linewidth+%spt}{1pt}\par", r"\begin{table}\rule{1pt}{1200pt}\end{table}"
    (source.parents[1] / "tables/table_05.tex").write_text("\n".join([wide % 300, wide % 4, high]))
    with pytest.raises(PaperError) as failure:
        build(source)
    (line,) = str(failure.value).splitlines()
    assert [re.sub(r"\d[\d.]*pt", "", fault) for fault in line.partition("pages: ")[2].split("; ")] == [
        "Label `a' multiply defined",
        r"Overfull \hbox ( too wide) in paragraph at lines 1--1 (after tables/table_05.tex)",
        "Float too large for page by  on input line 3 (after tables/table_05.tex)",
    ]
    assert not (source.parents[1] / "out").exists()


@with_tex
def test_words_that_do_not_fit_the_results_stop_no_run_and_are_noted_of_the_text_s_own_scale(
    source: Path, caplog: pytest.LogCaptureFixture
) -> None:
    r"""Another processor or seed turns verdicts; `smoke`'s mean nothing."""
    (source.parents[1] / "tables/numbers.tex").write_text(
        GUARDS + "\\expandafter\\def\\csname verdict@a-claim\\endcsname{inconclusive}\n"
    )
    guarded = r"\begin{document}\input{\tables/numbers}it holds\holds{a-claim}{reproduced,direction}"
    guarded += r"\label{end:main}\end{document}"
    source.write_text(re.sub(r"\\begin\{doc.*", lambda _: guarded, SOURCE))
    told = "claim 'a-claim' is 'inconclusive', and the text needs 'reproduced' or 'direction'"
    with caplog.at_level("INFO"):
        note = build(source)
    assert note["pdf"] == "main.pdf"
    assert note["unfit"] == []
    assert told in caplog.text
    assert "1 guarded sentences do not fit" in caplog.text
    note = build(source, "default")
    assert note["pdf"] == "main.pdf"
    assert note["unfit"] == [told]


@with_tex
def test_a_main_text_that_is_too_long_stops_no_run_and_is_noted_of_the_text_s_own_scale(source: Path) -> None:
    long = r"\begin{document}a%s\label{end:main}\end{document}" % (r"\newpage b" * TEXT.pages)
    source.write_text(re.sub(r"\\begin\{doc.*", lambda _: long, SOURCE))
    assert build(source)["unfit"] == []
    assert build(source, "default")["unfit"] == ["the main text ends on page 9; accepted: 8"]


@with_tex
def test_an_error_of_tex_is_shown_and_leaves_no_pdf(source: Path) -> None:
    source.write_text(SOURCE.replace("table_05", "table_99"))
    with pytest.raises(PaperError, match=r"table_99"):
        build(source)
    assert not (source.parents[1] / "out").exists()


def test_files_are_copied_into_folders_and_a_missing_one_is_named(source: Path, tmp_path: Path) -> None:
    folder, table = tmp_path / "build", tmp_path / "tables/table_05.tex"
    folder.mkdir()
    copy_sources({".": [source], "tables": [table], "figures": []}, folder)
    found = sorted(str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file())
    assert found == ["main.tex", "tables/table_05.tex"]
    with pytest.raises(DataError, match=r"none\.tex: file is missing"):
        copy_sources({".": [tmp_path / "none.tex"]}, folder)
