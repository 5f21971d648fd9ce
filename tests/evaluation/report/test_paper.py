"""The paper builds where TeX exists, says what is missing where it does not, and never changes on its own."""

import json
import re
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from mobnet.core.errors import DataError
from mobnet.evaluation.figures.commands import commands
from mobnet.evaluation.figures.figure_05 import figure_05
from mobnet.evaluation.figures.figure_19 import figure_19
from mobnet.evaluation.number.claim import read_claims
from mobnet.evaluation.number.rows import write_rows
from mobnet.evaluation.report import paper
from mobnet.evaluation.report.deviations import deviations
from mobnet.evaluation.report.numbers import numbers
from mobnet.evaluation.report.paper import PaperError, build, collect, missing_packages
from mobnet.evaluation.tables.claims import Verdict

REPO = Path(__file__).parents[3]
SOURCE = r"""\documentclass{article}
\pdfinfoomitdate=1 \pdftrailerid{} \providecommand{\tables}{../tables}
\begin{document}\input{\tables/table_05}\end{document}
"""
with_tex = pytest.mark.skipif(bool(missing_packages()), reason="TeX is not installed")


@pytest.fixture
def source(tmp_path: Path) -> Path:
    """A small paper that inputs one table."""
    for name in ("paper", "tables", "figures", "snapshot", "out"):
        (tmp_path / name).mkdir()
    (tmp_path / "snapshot/compute.tex").write_text("hours")
    (tmp_path / "tables/table_05.tex").write_text("nineteen")
    (tmp_path / "paper/main.tex").write_text(SOURCE)
    return tmp_path / "paper/main.tex"


def run(config: dict[str, Any], source: Path) -> dict[str, Any]:
    """Build and return the status."""
    root = source.parents[1]
    build(config, source, root / "tables", root / "figures", root / "snapshot", root / "out/main.pdf")
    return json.loads((root / "out/build.json").read_text())


def test_without_tex_the_status_names_the_packages(
    config: dict[str, Any], source: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr(paper.shutil, "which", lambda name: None)
    status = run(config, source)
    assert status["pdf"] is None
    assert "latexmk" in status["missing_packages"]
    assert "apt-get install texlive-latex-recommended texlive-publishers" in caplog.text
    assert not (source.parents[1] / "out/main.pdf").exists()


def test_a_stale_pdf_does_not_outlive_its_tex(
    config: dict[str, Any], source: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    stale = source.parents[1] / "out/main.pdf"
    stale.write_text("old")
    monkeypatch.setattr(paper.shutil, "which", lambda name: None)
    run(config, source)
    assert not stale.exists()


@with_tex
def test_with_tex_equal_input_gives_equal_bytes(config: dict[str, Any], source: Path) -> None:
    pdf = source.parents[1] / "out/main.pdf"
    assert run(config, source) == {"scale": "default", "pdf": "main.pdf", "missing_packages": []}
    once = pdf.read_bytes()
    run(config, source)
    assert pdf.read_bytes() == once
    assert once.startswith(b"%PDF")


@with_tex
def test_the_paper_itself_builds_from_the_golden_tables(
    config: dict[str, Any], tmp_path: Path, walk: Callable[..., dict[str, Any]], data_sets: dict[str, list[str]]
) -> None:
    for golden in (REPO / "tests/golden").glob("*.tex"):
        (tmp_path / golden.name).write_text(golden.read_text())
    deviations(REPO / "docs/deviations.md", tmp_path / "deviations.tex")
    verdicts = [
        Verdict(c.name, c.printed, c.says, c.published, 1.0, 0.9, 1.1, 6, c.unit, "yes", "-", "reproduced", c.cause)
        for c in read_claims(REPO / "configs/claims.yaml")
    ]
    write_rows(tmp_path / "claims.csv", Verdict, verdicts)
    numbers(config, [REPO / "tests/golden/table_05.csv"], tmp_path / "claims.csv", tmp_path / "numbers.tex")
    figure_05(config, [walk(1.0, method="MOB"), walk(2.0)], tmp_path)
    figure_19(config, {"with RTE": data_sets["walk"]}, [{"scenario": "t", "recordings": data_sets["test"]}], tmp_path)
    commands(config, {"walk": data_sets["walk"]}, tmp_path)
    for name in re.findall(r"\\figures/(\w+)", (REPO / "paper/main.tex").read_text()):
        if not (tmp_path / f"{name}.pdf").exists():  # one that needs trained networks: any picture in its place
            shutil.copy(tmp_path / "figure_05.pdf", tmp_path / f"{name}.pdf")
    build(config, REPO / "paper/main.tex", tmp_path, tmp_path, REPO / "docs/results", tmp_path / "out/main.pdf")
    assert (tmp_path / "out/main.pdf").stat().st_size > 50_000


@with_tex
def test_an_error_of_tex_is_shown_and_leaves_no_pdf(config: dict[str, Any], source: Path) -> None:
    source.write_text(SOURCE.replace("table_05", "table_99"))
    with pytest.raises(PaperError, match=r"table_99"):
        run(config, source)
    assert list((source.parents[1] / "out").iterdir()) == []


def test_a_missing_source_is_named(config: dict[str, Any], tmp_path: Path) -> None:
    with pytest.raises(DataError, match=r"none\.tex: file is missing"):
        build(config, tmp_path / "none.tex", tmp_path, tmp_path, tmp_path, tmp_path / "main.pdf")


def test_only_what_the_paper_needs_is_collected(source: Path, tmp_path: Path) -> None:
    (tmp_path / "tables/table_05.csv").write_text("x")
    folder = tmp_path / "build"
    folder.mkdir()
    places = (tmp_path / name for name in ("tables", "figures", "snapshot"))
    assert collect(source, *places, folder) == folder / "main.tex"
    found = sorted(str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file())
    assert found == ["main.tex", "snapshot/compute.tex", "tables/table_05.tex"]
