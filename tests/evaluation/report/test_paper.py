"""The paper builds where TeX exists, says what is missing where it does not, and never changes on its own."""

import csv
import json
from pathlib import Path
from typing import Any

import pytest
from matplotlib.figure import Figure

from mobnet.core.errors import DataError
from mobnet.evaluation.report.deviations import deviations
from mobnet.evaluation.report.numbers import numbers
from mobnet.evaluation.report.paper import PACKAGES, PaperError, copy_sources, missing_packages, paper
from mobnet.evaluation.tables.claims import CAPTION
from mobnet.evaluation.tables.layout import long_table, text_table
from mobnet.plan.products import Folders, Products
from mobnet.plan.runs import Files
from mobnet.settings.data import Recordings
from mobnet.settings.settings import Settings

REPO = Path(__file__).parents[3]
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
    (tmp_path / "paper/refs.bib").write_text("")
    (tmp_path / "paper/main.tex").write_text(SOURCE)
    return tmp_path / "paper/main.tex"


def write_tex(table: Path, out: Path) -> None:
    """Write the first rows of a golden table as TeX, the claims with their caption."""
    header, *rows = csv.reader(table.read_text().splitlines())
    if table.stem == "claims":
        out.write_text(long_table("l" * len(header), CAPTION, header, rows))
    else:
        out.write_text(text_table("l" * len(header), header, rows[:5]))


def build(source: Path) -> Any:
    """Build the paper into a folder `out` and return the note."""
    root = source.parents[1]
    paper("default", source, source.with_name("refs.bib"), [root / "tables/table_05.tex"], [], root / "out/build.json")
    return json.loads((root / "out/build.json").read_text())


def test_without_tex_the_note_names_the_packages_and_no_old_pdf_is_left(
    source: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    stale = source.parents[1] / "out/main.pdf"
    stale.parent.mkdir()
    stale.write_text("old")
    monkeypatch.setattr("shutil.which", lambda name: None)
    assert build(source) == {"scale": "default", "pdf": None, "missing_packages": list(PACKAGES)}
    assert "apt-get install texlive-latex-recommended texlive-publishers" in caplog.text
    assert not stale.exists()


@with_tex
def test_with_tex_equal_input_gives_equal_bytes(source: Path) -> None:
    pdf = source.parents[1] / "out/main.pdf"
    assert build(source) == {"scale": "default", "pdf": "main.pdf", "missing_packages": []}
    once = pdf.read_bytes()
    build(source)
    assert pdf.read_bytes() == once
    assert once.startswith(b"%PDF")


@with_tex
def test_the_paper_itself_builds_from_the_golden_tables(tmp_path: Path, claims_csv: Path, settings: Settings) -> None:
    """Every figure is the same picture."""
    folders = Folders(tmp_path, tmp_path, tmp_path, tmp_path / "out", tmp_path / "MANIFEST.sha256")
    products = Products(settings, Files(settings, tmp_path), folders, with_pdf=True)
    golden = REPO / "tests/golden"
    deviations(REPO / "docs/deviations.md", tmp_path / "deviations.tex")
    train, table = Recordings(shards=1, shard_s=60.0), golden / "table_05.csv"
    numbers(settings.scale, settings.rates, settings.sizes, train, [table], claims_csv, tmp_path / "numbers.tex")
    (tmp_path / "compute.tex").write_text(text_table("lr", ["Stage", "Jobs"], [["collect", "1"]]))
    for name in products.table_names:
        write_tex(golden / f"{name}.csv", tmp_path / f"{name}.tex")
    tables = [tmp_path / f"{name}.tex" for name in (*products.table_names, "numbers", "deviations", "compute")]
    figures = [tmp_path / f"{name}.pdf" for name in products.figure_names]
    for path in figures:
        Figure().savefig(path)
    main, references = REPO / "paper/main.tex", REPO / "paper/refs.bib"
    paper(settings.scale, main, references, tables, figures, tmp_path / "out/build.json")
    assert (tmp_path / "out/main.pdf").stat().st_size > 50_000


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
